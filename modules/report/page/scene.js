// What the 3D view shows: points, trajectory, loops, truth, the body, a grid.

const kPointsVertexShader = `
attribute vec4 point;  // position in the box, and intensity
uniform sampler2D scale;
uniform vec3 low, high;  // of what the colour tells: height, nothing, intensity
uniform float byIntensity, cut, size;
varying vec3 vColor;
void main() {
  vec4 at = modelViewMatrix * vec4(point.xyz, 1.0);
  gl_Position = projectionMatrix * at;
  if (point.z > cut) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = size;
  float value = mix(point.z, point.w, byIntensity);
  float from = mix(low.x, low.z, byIntensity), to = mix(high.x, high.z, byIntensity);
  vColor = texture2D(scale, vec2(clamp((value - from) / max(to - from, 1e-6), 0.002, 0.998), 0.5)).rgb;
}`;

const kPointsFragmentShader = `
varying vec3 vColor;
void main() { gl_FragColor = vec4(vColor, 1.0); }`;

/** The share of `values[offset], values[offset + stride]...` below which `share` of them lie. */
function quantile(values, offset, stride, share) {
  const counts = new Uint32Array(1024);
  let count = 0;
  for (let i = offset; i < values.length; i += stride, count++) counts[values[i] >> 6]++;
  let below = 0;
  for (let b = 0; b < 1024; b++) {
    below += counts[b];
    if (below >= share * count) return (b + (share > 0.5 ? 1 : 0)) / 1024;
  }
  return 1;
}

/** All points in one array for the graphics card: x, y, z and intensity in 16 bits each. */
function packedPoints(data) {
  const count = data.points.count;
  const packed = new Uint16Array(4 * count);
  const with_intensity = data.intensities.length === count;
  for (let i = 0; i < count; i++) {
    packed[4 * i] = data.positions[3 * i];
    packed[4 * i + 1] = data.positions[3 * i + 1];
    packed[4 * i + 2] = data.positions[3 * i + 2];
    packed[4 * i + 3] = with_intensity ? 257 * data.intensities[i] : 0;
  }
  return packed;
}

function makePoints(data, packed) {
  const size = new THREE.Vector3(...data.points.size);
  const geometry = new THREE.BufferGeometry();
  const attribute = new THREE.BufferAttribute(packed, 4, true);
  geometry.setAttribute('point', attribute);
  geometry.setAttribute('position', attribute);  // three.js counts by it
  geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(0.5, 0.5, 0.5), 1);
  const scale = new THREE.DataTexture(scaleTexels(), 256, 1, THREE.RGBFormat);
  scale.minFilter = scale.magFilter = THREE.LinearFilter;
  scale.needsUpdate = true;
  const material = new THREE.ShaderMaterial({
    uniforms: {
      scale: {value: scale},
      low: {value: new THREE.Vector3(quantile(packed, 2, 4, 0.01), 0, 0)},
      high: {value: new THREE.Vector3(quantile(packed, 2, 4, 0.99), 0, quantile(packed, 3, 4, 0.98))},
      byIntensity: {value: 0}, cut: {value: 2}, size: {value: 2}},
    vertexShader: kPointsVertexShader,
    fragmentShader: kPointsFragmentShader});
  const points = new THREE.Points(geometry, material);
  points.scale.set(...size.toArray().map(s => Math.max(s, 1e-6)));
  points.frustumCulled = false;
  return points;
}

/** Lines some pixels wide that are seen through everything. `colors`: one name a piece. */
function makeLines(ends, colors, width, order) {
  const geometry = new THREE.LineSegmentsGeometry();
  geometry.setPositions(new Float32Array(ends));
  const material = new THREE.LineMaterial({
    color: 0xffffff, linewidth: width, vertexColors: THREE.VertexColors,
    depthTest: false, depthWrite: false, transparent: true});
  const lines = new THREE.LineSegments2(geometry, material);
  lines.renderOrder = order;
  lines.frustumCulled = false;
  lines.userData.recolor = () => {
    const rgb = [];
    for (const name of colors) {
      const c = new THREE.Color(themeColor(name)).toArray();
      rgb.push(...c, ...c);
    }
    geometry.setColors(new Float32Array(rgb));
  };
  lines.userData.recolor();
  return lines;
}

/** The body: an arrow along its x axis, and a short line up along its z axis. Of size 1. */
function makeBody() {
  const body = new THREE.Group();
  const material = new THREE.MeshBasicMaterial({depthTest: false, depthWrite: false, transparent: true});
  const outline = new THREE.MeshBasicMaterial({depthTest: false, depthWrite: false, transparent: true});
  const cone = (radius, length, m, order) => {
    const mesh = new THREE.Mesh(new THREE.ConeGeometry(radius, length, 24), m);
    mesh.rotation.z = -Math.PI / 2;  // the cone's axis is y
    mesh.renderOrder = order;
    return mesh;
  };
  body.add(cone(0.5, 1.5, outline, 8), cone(0.36, 1.2, material, 9));
  const up = new THREE.Mesh(new THREE.CylinderGeometry(0.07, 0.07, 1, 8), material);
  up.rotation.x = Math.PI / 2;
  up.position.z = 0.5;
  up.renderOrder = 9;
  body.add(up);
  body.userData.recolor = () => {
    material.color.set(themeColor('body'));
    outline.color.set(themeColor('ink'));
  };
  body.userData.recolor();
  return body;
}

/** A length of 1, 2 or 5 times a power of ten that is at least x. */
function roundLength(x) {
  const power = Math.pow(10, Math.floor(Math.log10(x)));
  return [1, 2, 5, 10].map(f => f * power).find(f => f >= x * 0.999);
}

function makeGrid(box) {
  const size = box.getSize(new THREE.Vector3());
  const step = roundLength(Math.max(size.x, size.y, 1) / 12);
  const from = [Math.floor(box.min.x / step), Math.floor(box.min.y / step)];
  const to = [Math.ceil(box.max.x / step), Math.ceil(box.max.y / step)];
  const z = box.min.z, ends = [];
  for (let i = from[0]; i <= to[0]; i++) ends.push(i * step, from[1] * step, z, i * step, to[1] * step, z);
  for (let i = from[1]; i <= to[1]; i++) ends.push(from[0] * step, i * step, z, to[0] * step, i * step, z);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(ends), 3));
  const grid = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial());
  grid.userData.step = step;
  grid.userData.recolor = () => grid.material.color.set(themeColor('grid'));
  grid.userData.recolor();
  return grid;
}

/** The height above which a roof hides the trajectory, as a share of the box; null: there is none.
 * A roof is there where most of the cells around the trajectory have points well above it. */
function roofCut(data, packed, path) {
  const size = data.points.size, kCell = 2, kAbove = 0.5;
  if (path.count === 0 || size[2] <= 0) return null;
  const cells = new Map();
  let top = -Infinity;
  for (let i = 0; i < path.count; i++) {
    const p = path.position(i);
    top = Math.max(top, p.z);
    cells.set(Math.floor(p.x / kCell) + ',' + Math.floor(p.y / kCell), 0);
  }
  const step = 4 * Math.max(1, Math.floor(data.points.count / 200000));
  for (let i = 0; i < packed.length; i += step) {
    if (packed[i + 2] / 65535 * size[2] < top + kAbove) continue;
    const key = Math.floor(packed[i] / 65535 * size[0] / kCell) + ',' +
                Math.floor(packed[i + 1] / 65535 * size[1] / kCell);
    if (cells.has(key)) cells.set(key, cells.get(key) + 1);
  }
  const covered = [...cells.values()].filter(n => n > 0).length;
  return covered > 0.5 * cells.size ? Math.min(1, (top + kAbove) / size[2]) : null;
}
