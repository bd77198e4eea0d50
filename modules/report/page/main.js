// Puts the page together.

function makeView(data, path) {
  try {
    return new View(data, path);
  } catch (error) {
    const note = document.getElementById('scene-note');
    note.hidden = false;
    note.textContent = 'The map cannot be drawn: this browser offers no WebGL. Everything else works.';
    for (const id of ['tools', 'legend']) document.getElementById(id).hidden = true;
    return null;
  }
}

function updateLegend(data, view) {
  const by_intensity = document.getElementById('color-by').value === 'intensity';
  const {low, high} = view.points.material.uniforms;
  const height = share => short(data.origin[2] + share * data.points.size[2], 3);
  const intensity = share => short(share * data.points.max_intensity, 3);
  document.getElementById('legend-name').textContent = by_intensity ? 'Intensity' : 'Height [m]';
  document.getElementById('legend-low').textContent =
    by_intensity ? intensity(low.value.z) : height(low.value.x);
  document.getElementById('legend-high').textContent =
    by_intensity ? intensity(high.value.z) : height(high.value.x);
  document.getElementById('legend-bar').style.background = scaleGradient();
}

function addKeys(view, data) {
  const key = (name, color) => {
    const e = element('span', {class: 'key'}, name);
    e.style.setProperty('--key', `var(--${color})`);
    return e;
  };
  const keys = document.getElementById('legend-keys');
  if (view.pathLines) keys.append(key('trajectory', 'path'));
  if (data.stretches.list.length > 0) keys.append(key('in doubt', 'doubt'));
  if (view.loopLines) keys.append(key('loop', 'loop'));
  if (view.truthLines) keys.append(key('truth', 'truth'));
}

function connectPoints(view, data) {
  const get = id => document.getElementById(id);
  const uniforms = view.points.material.uniforms;
  const set = action => () => { action(); updateLegend(data, view); view.invalidate(); };
  get('color-by').addEventListener('change', set(() => {
    uniforms.byIntensity.value = get('color-by').value === 'intensity' ? 1 : 0;
  }));
  if (data.points.max_intensity <= 0) get('color-by').parentElement.hidden = true;
  const cut = () => {
    const share = get('cut').value / 1000;
    view.setCut(share);
    get('cut-value').textContent =
      share >= 1 ? 'nothing' : short(data.origin[2] + share * data.points.size[2], 3) + ' m';
  };
  get('cut').addEventListener('input', set(cut));
  const roof = roofCut(data, view.packed, view.path);
  if (roof !== null) get('cut').value = 1000 * roof;
  cut();
  view.look('oblique');
  const size = () => { uniforms.size.value = get('point-size').value * view.renderer.getPixelRatio(); };
  get('point-size').addEventListener('input', set(size));
  // Few points are drawn larger, so that surfaces look closed.
  get('point-size').value = data.points.count > 400000 ? 1.5 : data.points.count > 50000 ? 2 : 3;
  size();
  updateLegend(data, view);
}

function connectView(view, data) {
  const get = id => document.getElementById(id);
  for (const from of ['oblique', 'top', 'side'])
    get('view-' + from).addEventListener('click', () => view.look(from));
  get('view-follow').addEventListener('click', event => {
    view.setFollow(!view.follow);
    event.currentTarget.setAttribute('aria-pressed', view.follow);
  });
  const show = (id, object) => {
    if (!object) { get(id).parentElement.hidden = true; return; }
    get(id).parentElement.hidden = false;
    get(id).addEventListener('change', () => { object.visible = get(id).checked; view.invalidate(); });
  };
  show('show-points', view.points);
  show('show-path', view.pathLines);
  show('show-loops', view.loopLines);
  show('show-truth', view.truthLines);
  show('show-grid', view.grid);
  get('grid-label').textContent = `grid of ${short(view.grid.userData.step)} m`;
  addKeys(view, data);
  if (view.points) connectPoints(view, data);
  else document.querySelector('.legend-row').hidden = true;
}

/** Draws everything in the colours of now: of the theme, or of paper. */
function recolor(view, plots, timeline, data) {
  if (view) {
    view.recolor();
    if (view.points) updateLegend(data, view);
    if (document.documentElement.dataset.print) view.drawAll();
    else view.invalidate();
  }
  plots.draw();
  timeline.drawStrip();
}

function start() {
  const data = readData();
  const path = new Path(data.numbers(data.path));
  fillTexts(data);
  const timeline = new Timeline(data, path);
  const plots = new Plots(data, timeline);
  plots.add(data.plots, data, document.getElementById('plots'));
  document.getElementById('plots-section').hidden = plots.all.length === 0;
  if (data.accuracy) plots.add(data.accuracy.plots, data, document.querySelector('#accuracy .plots'));
  const view = makeView(data, path);
  if (view) {
    connectView(view, data);
    timeline.listen(t => view.place(t));
  }
  document.getElementById('timeline').hidden = path.count < 2;
  fillLists(data, (t, place) => {
    timeline.set(t);
    if (!view) return;
    if (place) view.approach(new THREE.Vector3(...place));
    else if (path.count > 0) view.approach(path.at(t).position);
    if (view.canvas.getBoundingClientRect().bottom < 100) view.canvas.scrollIntoView({block: 'center'});
  });
  timeline.set(path.begin);
  const refresh = () => recolor(view, plots, timeline, data);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', refresh);
  const print = on => () => {
    if (on) document.documentElement.dataset.print = 'yes';
    else delete document.documentElement.dataset.print;
    refresh();
  };
  window.addEventListener('beforeprint', print(true));
  window.addEventListener('afterprint', print(false));
  refresh();
  if (view) view.draw();
  // For tests, and for whoever wants to drive the page from the console.
  window.tautReport = {data, path, view, plots, timeline, milliseconds: performance.now()};
}

start();
