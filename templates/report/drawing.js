// What figures of all pages are drawn with: packed numbers, shapes, numbers as words, places of ticks.

const SVG = "http://www.w3.org/2000/svg";
const COLOURS = [0, 1, 2, 3, 4, 5, 6].map((k) => `var(--line-${k})`);

function unpack(text, Kind) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k += 1) bytes[k] = raw.charCodeAt(k);
  return new Kind(bytes.buffer);
}

function element(name, attributes, parent) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (parent) parent.appendChild(made);
  return made;
}

function piece(name, attributes, parent) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made[key] = value;
  parent?.append(made);
  return made;
}

// In four figures; what is below round-off is 0.
function number(value) {
  if (value === 0 || Math.abs(value) < 1e-9) return "0";
  const text = Math.abs(value) >= 1000 && Math.abs(value) < 1e7 ? value.toFixed(0) : value.toPrecision(4);
  return text.includes("e") ? text.replace(/\.?0+e/, "e") : text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

function ticks(low, high, about) {
  const raw = (high - low) / about;
  const size = 10 ** Math.floor(Math.log10(raw));
  const step = size * [1, 2, 5, 10].find((k) => k * size >= raw * 0.999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9; k += 1) found.push(k * step);
  return found;
}

function range(values, least) {
  let low = Infinity, high = -Infinity;
  for (const value of values) { if (value < low) low = value; if (value > high) high = value; }
  return spread(low, high, least);
}

// Some room around two ends, which are not drawn nearer to each other than `least`.
function spread(low, high, least) {
  if (high - low < least) { const middle = (low + high) / 2; return [middle - least / 2, middle + least / 2]; }
  return [low - 0.05 * (high - low), high + 0.05 * (high - low)];
}
