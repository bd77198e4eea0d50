// The 3D view: camera, controls, and drawing when something changed.

const kFluent = 35, kBearable = 1200;  // [ms] of a picture: while something moves, and after that
const kSettled = 250;                   // [ms] without a new picture: nothing moves any more
const kFewestPoints = 50000;

class View {
  constructor(data, path) {
    this.data = data;
    this.path = path;
    this.canvas = document.getElementById('scene');
    this.renderer = new THREE.WebGLRenderer({canvas: this.canvas, antialias: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.camera = new THREE.PerspectiveCamera(50, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.scene = new THREE.Scene();
    this.fill();
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.screenSpacePanning = true;
    this.controls.enableKeys = false;  // the arrows belong to the slider
    this.controls.addEventListener('change', () => this.invalidate());
    this.budget = 2 * kFewestPoints;  // until it is known how fast this machine is
    this.follow = false;
    new ResizeObserver(() => { if (this.resize()) this.draw(); }).observe(this.canvas.parentElement);
    this.resize();
    this.look('oblique');
  }

  fill() {
    const data = this.data, path = this.path;
    this.packed = packedPoints(data);
    this.box = path.box();
    if (data.points.count > 0) {
      this.points = makePoints(data, this.packed);
      this.scene.add(this.points);
      this.box.union(this.robustBox());
    }
    if (this.box.isEmpty()) this.box.set(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1));
    this.grid = makeGrid(this.box);
    this.scene.add(this.grid);
    const doubtful = t => data.stretches.list.some(s => t >= s.from && t <= s.to);
    const {ends, marks} = path.pieces(doubtful);
    if (marks.length > 0) {
      this.pathLines = makeLines(ends, marks.map(m => m ? 'doubt' : 'path'), 3, 3);
      this.scene.add(this.pathLines);
    }
    this.addLoops();
    this.addTruth();
    this.body = makeBody();
    this.body.visible = path.count > 0;
    this.scene.add(this.body);
    if (path.count > 0) this.place(path.begin);
  }

  /** The box of all points but the outermost of each axis. */
  robustBox() {
    const low = [], high = [];
    for (let axis = 0; axis < 3; axis++) {
      low.push(quantile(this.packed, axis, 4, 0.002) * this.data.points.size[axis]);
      high.push(quantile(this.packed, axis, 4, 0.998) * this.data.points.size[axis]);
    }
    return new THREE.Box3(new THREE.Vector3(...low), new THREE.Vector3(...high));
  }

  addLoops() {
    const believed = this.data.loops.list.filter(loop => loop.believed);
    if (believed.length === 0) return;
    const ends = [];
    for (const loop of believed) ends.push(...loop.from, ...loop.to);
    this.loopLines = makeLines(ends, believed.map(() => 'loop'), 3, 4);
    this.scene.add(this.loopLines);
  }

  addTruth() {
    if (!this.data.accuracy) return;
    const p = this.data.numbers(this.data.accuracy.path);
    if (p.length < 6) return;
    const ends = [];
    for (let i = 3; i < p.length; i += 3) ends.push(...p.subarray(i - 3, i + 3));
    this.truthLines = makeLines(ends, new Array(ends.length / 6).fill('truth'), 1.5, 2);
    this.scene.add(this.truthLines);
  }

  recolor() {
    this.renderer.setClearColor(new THREE.Color(themeColor('scene')));
    if (this.points) {
      const scale = this.points.material.uniforms.scale.value;
      scale.image.data.set(scaleTexels());
      scale.needsUpdate = true;
    }
    this.scene.traverse(o => { if (o.userData.recolor) o.userData.recolor(); });
    this.invalidate();
  }

  /** Fits the picture to its place; false where it fits already. */
  resize() {
    const {clientWidth: w, clientHeight: h} = this.canvas.parentElement;
    if (w === 0 || h === 0 || (w === this.width && h === this.height)) return false;
    this.width = w;
    this.height = h;
    this.renderer.setSize(w, h, false);
    this.camera.aspect = w / h;
    this.camera.updateProjectionMatrix();
    for (const lines of [this.pathLines, this.loopLines, this.truthLines])
      if (lines) lines.material.resolution.set(w, h);
    return true;
  }

  /** Looks at everything: 'oblique', 'top' or 'side'. */
  look(from) {
    const middle = this.box.getCenter(new THREE.Vector3());
    const direction = {
      oblique: new THREE.Vector3(-0.55, -0.75, 0.75),
      top: new THREE.Vector3(0, -1e-3, 1),
      side: new THREE.Vector3(0, -1, 0.12)}[from].normalize();
    this.camera.position.copy(middle).add(direction);
    this.camera.lookAt(middle);
    this.camera.updateMatrixWorld();
    const distance = this.distanceToSee(this.outline(), middle);
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(direction, distance);
    this.camera.far = 20 * (distance + this.box.getSize(new THREE.Vector3()).length());
    this.camera.near = this.camera.far / 1e5;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.invalidate();
  }

  /** Some of the points that are shown, and of the path. */
  outline() {
    const some = [], size = this.data.points.size;
    for (let i = 0; i < this.path.count; i += 1 + Math.floor(this.path.count / 500))
      some.push(this.path.position(i));
    const cut = this.points ? this.points.material.uniforms.cut.value : 2;
    for (let i = 0; i < Math.min(this.packed.length, 4 * 4000); i += 4) {
      const share = [0, 1, 2].map(axis => this.packed[i + axis] / 65535);
      const p = new THREE.Vector3(...share.map((s, axis) => s * size[axis]));
      if (share[2] <= cut && this.box.containsPoint(p)) some.push(p);
    }
    return some.length > 0 ? some : [this.box.min, this.box.max];
  }

  /** How far from `middle` the camera sees all places, in its present direction. Moves `middle`
   * across that direction to where they are in the middle of the picture. */
  distanceToSee(places, middle) {
    const inverse = new THREE.Quaternion().copy(this.camera.quaternion).conjugate();
    const seen = places.map(p => p.clone().sub(middle).applyQuaternion(inverse));
    const box = new THREE.Box3().setFromPoints(seen);
    const shift = box.getCenter(new THREE.Vector3()).setZ(0);
    middle.add(shift.clone().applyQuaternion(this.camera.quaternion));
    const tall = Math.tan(this.camera.fov / 2 * Math.PI / 180), wide = tall * this.camera.aspect;
    let distance = 1;
    for (const p of seen) {
      p.sub(shift);
      distance = Math.max(distance, p.z + Math.abs(p.x) / wide, p.z + Math.abs(p.y) / tall);
    }
    return 1.06 * distance;
  }

  /** Hides what is above a share of the points' box, and spreads the colours below it. */
  setCut(share) {
    const uniforms = this.points.material.uniforms;
    uniforms.cut.value = share >= 1 ? 2 : share;
    uniforms.high.value.x = Math.min(share, quantile(this.packed, 2, 4, 0.99));
    this.invalidate();
  }

  /** Moves the body to where it was at a time. */
  place(t) {
    if (this.path.count === 0) return;
    const {position, rotation} = this.path.at(t);
    if (this.follow) this.center(position);
    this.body.position.copy(position);
    this.body.quaternion.copy(rotation);
    this.invalidate();
  }

  center(position) {
    const shift = position.clone().sub(this.controls.target);
    this.camera.position.add(shift);
    this.controls.target.add(shift);
    this.controls.update();
  }

  setFollow(on) {
    this.follow = on;
    if (!on || this.path.count === 0) return;
    this.approach(this.body.position);
  }

  /** Brings a place to the middle, near enough to see it. */
  approach(position) {
    this.center(position);
    const offset = this.camera.position.clone().sub(this.controls.target);
    const near = Math.max(6, 0.25 * this.box.getSize(new THREE.Vector3()).length());
    if (offset.length() > near) this.camera.position.copy(this.controls.target).add(offset.setLength(near));
    this.controls.update();
    this.invalidate();
  }

  invalidate() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => { this.waiting = 0; this.draw(); });
  }

  /** Draws as many points as can be drawn fluently, and more when nothing has moved for a while: the
   * first ones are an even sample of all. */
  draw() {
    this.render(this.budget);
    clearTimeout(this.settling);
    if (this.drawn < this.data.points.count)
      this.settling = setTimeout(() => this.render(this.affordable), kSettled);
  }

  drawAll() { this.render(Infinity); }

  render(most) {
    const far = this.camera.position.distanceTo(this.body.position);
    this.body.scale.setScalar(Math.max(0.01, 0.022 * far));
    this.drawn = Math.min(this.data.points.count, most);
    if (this.points) this.points.geometry.setDrawRange(0, this.drawn);
    const begin = performance.now();
    this.renderer.render(this.scene, this.camera);
    this.waitForPicture();
    this.learn(performance.now() - begin);
  }

  /** Returns when the graphics card is done. */
  waitForPicture() {
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  /** From the time that a picture took: how many points make a fluent one, and a bearable one. */
  learn(milliseconds) {
    const fitting = limit =>
      Math.max(kFewestPoints, Math.floor(this.drawn * limit / Math.max(milliseconds, 1)));
    this.budget = fitting(kFluent);
    this.affordable = fitting(kBearable);
  }
}
