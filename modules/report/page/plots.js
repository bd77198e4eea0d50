// Curves over time. Each plot has a canvas with the curves and one above it with what moves.

const kMargin = {left: 52, right: 8, top: 6, bottom: 18};
const kDragPixels = 6;

/** Ticks for a range: about `wanted` of them, at round values. */
function linearTicks(low, high, wanted) {
  const step = roundLength((high - low) / Math.max(1, wanted));
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) ticks.push(i * step);
  return ticks;
}

/** Values in a range of logarithms: powers of ten, or 1, 2 and 5 times such where few are there. */
function logarithmicTicks(low, high) {
  const stride = Math.max(1, Math.ceil((high - low) / 5));
  const factors = high - low < 1.6 ? [1, 2, 5] : [1];
  const ticks = [];
  for (let e = Math.floor(low); e <= Math.floor(high); e += stride)
    for (const f of factors) ticks.push(f * Math.pow(10, e));
  return ticks.filter(v => Math.log10(v) >= low && Math.log10(v) <= high);
}

/** Seconds in which a time axis is divided well. */
function timeTicks(low, high, wanted) {
  const steps = [60, 120, 300, 600, 1200, 1800, 3600, 7200, 14400, 36000];
  const rough = (high - low) / Math.max(1, wanted);
  const step = rough <= 30 ? roundLength(rough) : steps.find(s => s >= rough) || 86400;
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high; i++) ticks.push(i * step);
  return ticks;
}

function timeLabel(t) {
  if (t < 60) return short(t, 3) + ' s';
  return clock(t).replace(/\.0$/, '');
}

class Plot {
  constructor(plots, spec, data) {
    this.plots = plots;
    this.spec = spec;
    this.times = data.numbers(spec.times);
    this.curves = spec.curves.map(curve => ({
      name: curve.name,
      values: data.numbers(curve.values),
      halves: curve.half_widths ? data.numbers(curve.half_widths) : null}));
    this.back = element('canvas', {'aria-hidden': 'true'});
    this.front = element('canvas', {role: 'img', 'aria-label': spec.title + ' over time'});
    this.area = element('div', {class: 'plot-area'}, this.back, this.front);
    this.keys = this.curves.map(() => element('span', {class: 'key'}));
    this.card = element('div', {class: 'plot'},
      element('div', {class: 'plot-head'},
        element('h3', {}, spec.title, ' ', element('span', {class: 'unit'}, spec.unit)),
        element('div', {class: 'plot-keys'}, ...this.keys)),
      element('p', {class: 'hint'}, spec.hint), this.area);
    this.listen();
    new ResizeObserver(() => this.draw()).observe(this.area);
  }

  transform(v) { return this.spec.logarithmic ? (v > 0 ? Math.log10(v) : NaN) : v; }

  x(t) {
    const [from, to] = this.plots.range;
    return kMargin.left + (t - from) / (to - from) * (this.width - kMargin.left - kMargin.right);
  }

  time(x) {
    const [from, to] = this.plots.range;
    return from + (x - kMargin.left) / (this.width - kMargin.left - kMargin.right) * (to - from);
  }

  y(v) {
    const share = (this.transform(v) - this.low) / (this.high - this.low);
    return this.height - kMargin.bottom - share * (this.height - kMargin.top - kMargin.bottom);
  }

  /** The part of the samples that is in sight, with one more at both ends. */
  visible() {
    const [from, to] = this.plots.range;
    return [Math.max(0, lastNotAbove(this.times, from)),
            Math.min(this.times.length, lastNotAbove(this.times, to) + 2)];
  }

  findRange() {
    let low = Infinity, high = -Infinity;
    const [first, end] = this.visible();
    for (const {values, halves} of this.curves)
      for (let i = first; i < end; i++) {
        const half = halves && isFinite(halves[i]) ? halves[i] : 0;
        const a = this.transform(values[i] - half), b = this.transform(values[i] + half);
        if (isFinite(a)) low = Math.min(low, a);
        if (isFinite(b)) high = Math.max(high, b);
      }
    if (!(low <= high)) [low, high] = [0, 1];
    if (!this.spec.logarithmic && low > 0 && low < 0.5 * high) low = 0;
    const least = this.spec.logarithmic ? 1 : Math.max(1e-9, 1e-3 * Math.abs(high));
    if (high - low < least) [low, high] = [(low + high - least) / 2, (low + high + least) / 2];
    const pad = 0.06 * (high - low);
    this.low = low === 0 ? 0 : low - pad;
    this.high = high + pad;
  }

  draw() {
    const {context, width, height} = sharpContext(this.back);
    if (width === 0) return;
    this.width = width;
    this.height = height;
    this.findRange();
    this.drawStretches(context);
    this.drawAxes(context);
    context.save();
    context.beginPath();
    context.rect(kMargin.left, 0, width - kMargin.left - kMargin.right, height - kMargin.bottom);
    context.clip();
    this.curves.forEach((curve, i) => this.drawCurve(context, curve, themeColor(`curve-${i % 7}`)));
    context.restore();
    this.drawCursor();
  }

  drawStretches(context) {
    context.globalAlpha = 0.18;
    context.fillStyle = themeColor('doubt');
    const left = kMargin.left, right = this.width - kMargin.right;
    for (const s of this.plots.stretches) {
      const from = Math.max(left, this.x(s.from)), to = Math.min(right, Math.max(this.x(s.to), this.x(s.from) + 1));
      if (to > from) context.fillRect(from, kMargin.top, to - from, this.height - kMargin.top - kMargin.bottom);
    }
    context.globalAlpha = 1;
  }

  drawAxes(context) {
    const logarithmic = this.spec.logarithmic;
    const ticks = (logarithmic ? logarithmicTicks : linearTicks)(this.low, this.high, 4);
    context.font = '11px system-ui, "DejaVu Sans", sans-serif';
    context.fillStyle = themeColor('soft');
    context.strokeStyle = themeColor('line');
    context.lineWidth = 1;
    context.textAlign = 'right';
    context.textBaseline = 'middle';
    const step = ticks.length > 1 ? ticks[1] - ticks[0] : 1;
    for (const tick of ticks) {
      const y = this.y(tick);
      context.beginPath();
      context.moveTo(kMargin.left, y);
      context.lineTo(this.width - kMargin.right, y);
      context.stroke();
      context.fillText(logarithmic ? powerLabel(tick) : tickLabel(tick, step), kMargin.left - 5, y);
    }
    context.textAlign = 'center';
    context.textBaseline = 'bottom';
    const [from, to] = this.plots.range;
    for (const t of timeTicks(from, to, (this.width - kMargin.left) / 90))
      if (this.x(t) < this.width - 22) context.fillText(timeLabel(t), this.x(t), this.height - 2);
  }

  drawCurve(context, {values, halves}, color) {
    const [first, end] = this.visible();
    if (halves) {
      context.fillStyle = color;
      context.globalAlpha = 0.16;
      this.fillBand(context, values, halves, first, end);
      context.globalAlpha = 1;
    }
    context.strokeStyle = color;
    context.lineWidth = 1.4;
    context.lineJoin = 'round';
    context.beginPath();
    let drawing = false, column = null, low = 0, high = 0;
    for (let i = first; i < end; i++) {
      const x = this.x(this.times[i]), y = this.y(values[i]);
      if (!isFinite(y)) { drawing = false; continue; }
      // Many samples in a column of pixels: the extremes are enough.
      const here = Math.round(x);
      if (drawing && here === column && y >= low && y <= high) continue;
      if (here !== column) { column = here; low = high = y; }
      low = Math.min(low, y);
      high = Math.max(high, y);
      if (drawing) context.lineTo(x, y); else context.moveTo(x, y);
      drawing = true;
    }
    context.stroke();
  }

  fillBand(context, values, halves, first, end) {
    const stride = Math.max(1, Math.floor((end - first) / (2 * this.width)));
    context.beginPath();
    for (let i = first; i < end; i += stride)
      if (isFinite(values[i] + halves[i])) context.lineTo(this.x(this.times[i]), this.y(values[i] + halves[i]));
    for (let i = first + Math.floor((end - 1 - first) / stride) * stride; i >= first; i -= stride)
      if (isFinite(values[i] - halves[i])) context.lineTo(this.x(this.times[i]), this.y(values[i] - halves[i]));
    context.fill();
  }

  /** The present time, what is being selected, and the values of the present time in the keys. */
  drawCursor() {
    const {context, width, height} = sharpContext(this.front);
    if (width === 0) return;
    if (this.drag && this.drag.zooming) {
      context.globalAlpha = 0.2;
      context.fillStyle = themeColor('accent');
      context.fillRect(Math.min(this.drag.from, this.drag.to), kMargin.top,
        Math.abs(this.drag.to - this.drag.from), height - kMargin.top - kMargin.bottom);
      context.globalAlpha = 1;
    }
    const t = this.hover !== undefined ? this.hover : this.plots.t, x = this.x(t);
    if (x >= kMargin.left - 1 && x <= width - kMargin.right + 1) {
      context.strokeStyle = themeColor(this.hover !== undefined ? 'soft' : 'ink');
      context.lineWidth = 1;
      context.beginPath();
      context.moveTo(x, kMargin.top);
      context.lineTo(x, height - kMargin.bottom);
      context.stroke();
    }
    this.writeKeys(t);
  }

  writeKeys(t) {
    if (this.times.length === 0) return;
    let i = lastNotAbove(this.times, t);
    if (i + 1 < this.times.length && this.times[i + 1] - t < t - this.times[i]) i++;
    this.curves.forEach((curve, k) => {
      const band = curve.halves && isFinite(curve.halves[i]) ? ` \u00B1 ${short(curve.halves[i], 2)}` : '';
      this.keys[k].textContent = `${curve.name} ${short(curve.values[i], 3)}${band}`;
      this.keys[k].style.setProperty('--key', `var(--curve-${k % 7})`);
    });
  }

  listen() {
    const x = event => event.clientX - this.area.getBoundingClientRect().left;
    this.area.addEventListener('pointerdown', event => {
      if (event.button !== 0) return;
      this.drag = {from: x(event), to: x(event), zooming: false, mouse: event.pointerType === 'mouse'};
      if (this.drag.mouse) this.area.setPointerCapture(event.pointerId);
    });
    this.area.addEventListener('pointermove', event => {
      this.hover = event.pointerType === 'mouse' ? this.time(x(event)) : undefined;
      if (this.drag && this.drag.mouse) {
        this.drag.to = x(event);
        this.drag.zooming = Math.abs(this.drag.to - this.drag.from) > kDragPixels;
      }
      this.drawCursor();
    });
    this.area.addEventListener('pointerup', () => this.endDrag());
    for (const name of ['pointerleave', 'pointercancel'])
      this.area.addEventListener(name, () => { this.hover = this.drag = undefined; this.drawCursor(); });
    this.area.addEventListener('dblclick', () => this.plots.zoom(null));
  }

  endDrag() {
    const drag = this.drag;
    this.drag = undefined;
    if (!drag) return;
    const from = this.time(Math.min(drag.from, drag.to)), to = this.time(Math.max(drag.from, drag.to));
    if (drag.zooming) this.plots.zoom([from, to]);
    else this.plots.timeline.set(this.time(drag.from));
  }
}

/** "0.02", "1", "5\u00B710\u2076". */
function powerLabel(value) {
  const exponent = Math.floor(Math.log10(value) + 1e-9), factor = Math.round(value / Math.pow(10, exponent));
  if (exponent >= -3 && exponent <= 3) return String(Number(value.toPrecision(1)));
  const digits = {'-': '\u207B', 0: '\u2070', 1: '\u00B9', 2: '\u00B2', 3: '\u00B3', 4: '\u2074',
    5: '\u2075', 6: '\u2076', 7: '\u2077', 8: '\u2078', 9: '\u2079'};
  return (factor > 1 ? factor + '\u00B7' : '') + '10' + [...String(exponent)].map(c => digits[c]).join('');
}

function tickLabel(value, step) {
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e5 || step < 1e-4) return value.toExponential(1).replace('e+', 'e');
  return value.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
}

/** All plots of the page: they share the time and the range of it that is shown. */
class Plots {
  constructor(data, timeline) {
    this.timeline = timeline;
    this.stretches = data.stretches.list;
    this.t = timeline.t;
    this.whole = [timeline.begin, timeline.end];
    this.range = this.whole;
    this.all = [];
    timeline.listen(t => { this.t = t; this.all.forEach(plot => plot.drawCursor()); });
  }

  add(specs, data, parent) {
    for (const spec of specs) {
      if (spec.times[1] === 0) continue;
      const plot = new Plot(this, spec, data);
      this.all.push(plot);
      parent.append(plot.card);
    }
  }

  zoom(range) {
    this.range = range || this.whole;
    this.draw();
  }

  draw() { this.all.forEach(plot => plot.draw()); }
}
