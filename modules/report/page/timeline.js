// The present time: one value that the slider, the body and the plots share.

class Timeline {
  constructor(data, path) {
    this.data = data;
    this.begin = path.begin;
    this.end = Math.max(path.end, path.begin + 1e-3);
    this.t = this.begin;
    this.listeners = [];
    this.slider = document.getElementById('time');
    this.slider.min = this.begin;
    this.slider.max = this.end;
    this.slider.addEventListener('input', () => this.set(Number(this.slider.value)));
    this.slider.addEventListener('keydown', event => this.step(event));
    this.button = document.getElementById('play');
    this.button.addEventListener('click', () => this.toggle());
    this.strip = document.getElementById('strip');
    new ResizeObserver(() => this.drawStrip()).observe(this.strip);
  }

  /** Calls `listener(t)` for each new time. */
  listen(listener) { this.listeners.push(listener); }

  set(t) {
    this.t = Math.min(this.end, Math.max(this.begin, t));
    this.slider.value = this.t;
    document.getElementById('clock').replaceChildren(
      clock(this.t), element('span', {}, ' of ' + clock(this.end)));
    this.slider.setAttribute('aria-valuetext', clock(this.t));
    for (const listener of this.listeners) listener(this.t);
  }

  /** Keys move by a hundredth: a slider without steps would jump by a tenth of what it shows. */
  step(event) {
    const sign = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1}[event.key];
    if (!sign) return;
    event.preventDefault();
    this.set(this.t + sign * (this.end - this.begin) / (event.shiftKey ? 1000 : 100));
  }

  toggle() {
    this.playing = !this.playing;
    this.button.textContent = this.playing ? '\u275A\u275A' : '\u25B6';
    this.button.setAttribute('aria-label', this.playing ? 'Pause' : 'Play');
    if (!this.playing) return;
    if (this.t >= this.end) this.set(this.begin);
    let last = performance.now();
    const advance = now => {
      if (!this.playing) return;
      const speed = Number(document.getElementById('speed').value);
      this.set(this.t + Math.max(0, now - last) / 1000 * speed);
      last = now;
      if (this.t >= this.end) this.toggle();
      else requestAnimationFrame(advance);
    };
    requestAnimationFrame(advance);
  }

  /** Marks of doubtful stretches (bars) and warnings (ticks) above the slider. */
  drawStrip() {
    const {context, width, height} = sharpContext(this.strip);
    const kThumb = 8;  // the slider's ends are half a thumb inside
    const x = t => kThumb + (t - this.begin) / (this.end - this.begin) * (width - 2 * kThumb);
    context.fillStyle = themeColor('line');
    context.fillRect(kThumb, height / 2 - 1, width - 2 * kThumb, 2);
    context.fillStyle = themeColor('doubt');
    for (const s of this.data.stretches.list)
      context.fillRect(x(s.from), 2, Math.max(2, x(s.to) - x(s.from)), height - 4);
    context.fillStyle = themeColor('ink');
    for (const kind of this.data.warnings)
      for (const w of kind.first) if (w.t !== null) context.fillRect(x(w.t) - 1, 0, 2, height);
  }
}

/** A cleared context whose units are CSS pixels. */
function sharpContext(canvas) {
  const ratio = document.documentElement.dataset.print ? 3 : window.devicePixelRatio || 1;
  const width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext('2d');
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return {context, width, height};
}
