// Reads what the run left in this page.

function bytesOf(id) {
  const text = atob(document.getElementById(id).textContent.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

function readData() {
  const data = JSON.parse(document.getElementById('report-data').textContent);
  const numbers = new Float32Array(bytesOf('report-numbers').buffer);
  // A reference is [position, count] in the block of numbers.
  data.numbers = ([at, count]) => numbers.subarray(at, at + count);
  data.positions = new Uint16Array(bytesOf('report-positions').buffer);
  data.intensities = bytesOf('report-intensities');
  for (const id of ['report-data', 'report-numbers', 'report-positions', 'report-intensities'])
    document.getElementById(id).remove();  // their memory is needed once only
  return data;
}

function element(name, attributes, ...children) {
  const e = document.createElement(name);
  for (const [key, value] of Object.entries(attributes || {})) {
    if (key.startsWith('on')) e.addEventListener(key.slice(2), value);
    else e.setAttribute(key, value);
  }
  e.append(...children);  // strings become text, never HTML
  return e;
}

/** A number in as many digits as tell something. */
function short(value, digits = 4) {
  if (!isFinite(value)) return '-';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(Math.max(0, digits - 2));
  return String(Number(value.toPrecision(digits)));
}

/** "12.34 s", "3:25.1", "1:02:03". */
function clock(seconds) {
  const sign = seconds < 0 ? '-' : '';
  const s = Math.abs(seconds);
  if (s < 59.995) return sign + s.toFixed(2) + ' s';
  const tenths = Math.round(s * 10);
  const minutes = Math.floor(tenths / 600);
  const rest = ((tenths % 600) / 10).toFixed(1).padStart(4, '0');
  if (minutes < 60) return `${sign}${minutes}:${rest}`;
  return `${sign}${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, '0')}:${rest.slice(0, 2)}`;
}

/** Position of the last value that is not above x; values ascend. At least 0. */
function lastNotAbove(values, x) {
  let low = 0, high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= x) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}
