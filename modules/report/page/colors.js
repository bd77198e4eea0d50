// Colours of the page and of the points. The scale is viridis (N. Smith, S. van der Walt, CC0): it
// grows evenly in lightness, which is told apart with any kind of colour vision, and in print.

const kViridis = [
  '440154', '481467', '482576', '453781', '404688', '39558c', '33638d', '2d718e', '287d8e', '238a8d',
  '1f968b', '20a386', '29af7f', '3dbc74', '56c667', '75d054', '95d840', 'bade28', 'dde318', 'fde725'];

function themeColor(name) {
  return getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
}

function isDark() {
  return !document.documentElement.dataset.print && matchMedia('(prefers-color-scheme: dark)').matches;
}

/** The part of the scale that stands out from the ground. */
function scaleRange() {
  return isDark() ? [0.18, 1] : [0, 0.93];
}

/** Colour of a share of the scale, as [r, g, b] of 0 to 255. */
function scaleColor(share) {
  const [low, high] = scaleRange();
  const at = Math.min(1, Math.max(0, low + (high - low) * share)) * (kViridis.length - 1);
  const i = Math.min(kViridis.length - 2, Math.floor(at));
  const part = (hex, k) => parseInt(hex.slice(2 * k, 2 * k + 2), 16);
  return [0, 1, 2].map(k => Math.round(
    part(kViridis[i], k) + (at - i) * (part(kViridis[i + 1], k) - part(kViridis[i], k))));
}

/** The scale as texels for the graphics card. */
function scaleTexels() {
  const texels = new Uint8Array(256 * 3);
  for (let i = 0; i < 256; i++) texels.set(scaleColor(i / 255), 3 * i);
  return texels;
}

function scaleGradient() {
  const stops = [];
  for (let i = 0; i <= 10; i++) stops.push(`rgb(${scaleColor(i / 10).join(',')})`);
  return `linear-gradient(to right, ${stops.join(',')})`;
}
