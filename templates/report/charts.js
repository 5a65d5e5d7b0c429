// The figures: lines as SVG, drawn from the numbers of the page.

const SVG = "http://www.w3.org/2000/svg";
const COLOURS = [0, 1, 2, 3, 4, 5, 6].map((k) => `var(--line-${k})`);
const DASHES = ["", "6 3", "2 2", "8 3 2 3", "1 3"];
const WIDTH = 560, HEIGHT = 250, LEFT = 62, RIGHT = 12, TOP = 8, BOTTOM = 40;

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

function number(value) {
  if (value === 0 || Math.abs(value) < 1e-12) return "0";
  const text = value.toPrecision(5);
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
  if (high - low < least) { const middle = (low + high) / 2; return [middle - least / 2, middle + least / 2]; }
  return [low - 0.05 * (high - low), high + 0.05 * (high - low)];
}

// One figure of one or more runs; `seek(ms)` is called where it is clicked. Returns what moves its cursor.
function chart(parent, runs, key, seek) {
  const content = runs.map((run) => run.panels.find((panel) => panel.key === key)).find((panel) => panel);
  const figure = document.createElement("figure");
  figure.dataset.key = key;
  const caption = document.createElement("figcaption");
  caption.textContent = `${content.title} [${content.unit}]`;
  figure.append(caption);
  const lines = [];
  const names = [];
  runs.forEach((run, r) => {
    for (const line of run.panels.find((panel) => panel.key === key)?.lines ?? []) {
      if (!names.includes(line.name)) names.push(line.name);
      lines.push({ name: line.name, run: r, x: unpack(line.x, Float32Array), y: unpack(line.y, Float32Array), shown: true });
    }
  });
  const plot = document.createElement("div"), cursor = document.createElement("div");
  plot.className = "plot";
  cursor.className = "cursor";
  const svg = element("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": content.title }, plot);
  plot.append(cursor);
  figure.append(plot);
  const keys = document.createElement("div");
  keys.className = "keys-of";
  figure.append(keys);
  if (content.note) {
    const note = document.createElement("p");
    note.className = "note";
    note.textContent = content.note;
    figure.append(note);
  }
  parent.append(figure);
  const overTime = content.x_title === "time [ms]";
  let scaleX, unscaleX, at = 0, inSight = true;

  function draw() {
    svg.replaceChildren();
    const seen = lines.filter((line) => line.shown);
    const drawn = seen.length ? seen : lines;
    let [x0, x1] = overTime ? [Math.min(...drawn.map((l) => l.x[0])), Math.max(...drawn.map((l) => l.x.at(-1)))]
      : range(drawn.flatMap((l) => [...l.x]), 1e-6);
    let [y0, y1] = range(drawn.flatMap((l) => [...l.y]), content.least);
    const wide = WIDTH - LEFT - RIGHT, high = HEIGHT - TOP - BOTTOM;
    if (content.equal) {
      const mm = Math.max((x1 - x0) / wide, (y1 - y0) / high);
      const [cx, cy] = [(x0 + x1) / 2, (y0 + y1) / 2];
      [x0, x1, y0, y1] = [cx - mm * wide / 2, cx + mm * wide / 2, cy - mm * high / 2, cy + mm * high / 2];
    }
    scaleX = (x) => LEFT + wide * (x - x0) / (x1 - x0);
    unscaleX = (p) => x0 + (x1 - x0) * (p - LEFT) / wide;
    const scaleY = (y) => TOP + high * (y1 - y) / (y1 - y0);
    for (const x of ticks(x0, x1, 7)) {
      element("line", { x1: scaleX(x), x2: scaleX(x), y1: TOP, y2: TOP + high, class: "grid" }, svg);
      element("text", { x: scaleX(x), y: TOP + high + 15, "text-anchor": "middle" }, svg).textContent = number(x);
    }
    for (const y of ticks(y0, y1, 5)) {
      element("line", { x1: LEFT, x2: LEFT + wide, y1: scaleY(y), y2: scaleY(y), class: "grid" }, svg);
      element("text", { x: LEFT - 5, y: scaleY(y) + 4, "text-anchor": "end" }, svg).textContent = number(y);
    }
    element("text", { x: LEFT + wide / 2, y: HEIGHT - 6, "text-anchor": "middle" }, svg).textContent = content.x_title;
    for (const line of seen) {
      let path = "";
      for (let k = 0; k < line.x.length; k += 1) path += `${k ? "L" : "M"}${scaleX(line.x[k]).toFixed(2)} ${scaleY(line.y[k]).toFixed(2)}`;
      element("path", { d: path, fill: "none", "stroke-width": 1.6, "stroke-linejoin": "round",
        stroke: COLOURS[names.indexOf(line.name) % COLOURS.length], "stroke-dasharray": dash(line) }, svg);
    }
    move(at);
  }

  // of several runs each has its dashes; of many lines of one, those whose colours come round
  function dash(line) {
    return DASHES[(runs.length > 1 ? line.run : Math.floor(names.indexOf(line.name) / COLOURS.length)) % DASHES.length];
  }

  function move(time) {
    at = time;
    if (!inSight) return;
    const x = scaleX(time);
    const outside = !overTime || !(x >= LEFT - 0.5 && x <= WIDTH - RIGHT + 0.5);
    cursor.hidden = outside;
    // over the picture of the lines, which need not be drawn anew
    if (!outside) cursor.style.transform = `translateX(${(100 * x / WIDTH).toFixed(3)}cqw)`;
  }

  const groups = new Map();
  for (const line of lines) {
    const name = runs.length > 1 ? `${runs[line.run].name}: ${line.name}` : line.name;
    if (!groups.has(name)) groups.set(name, []);
    groups.get(name).push(line);
  }
  for (const [name, members] of groups) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "key";
    button.setAttribute("aria-pressed", "true");
    const swatch = element("svg", { viewBox: "0 0 24 8", "aria-hidden": "true" });
    element("line", { x1: 0, x2: 24, y1: 4, y2: 4, "stroke-width": 2.5, stroke: COLOURS[names.indexOf(members[0].name) % COLOURS.length],
      "stroke-dasharray": dash(members[0]) }, swatch);
    button.append(swatch, ` ${name}`);
    if (overTime) {
      const last = members[0].y.at(-1);
      button.append(` ${number(last)}`);
      button.dataset.name = members[0].name;
      button.dataset.run = members[0].run;
      button.dataset.last = last;
    }
    button.addEventListener("click", () => {
      for (const line of members) line.shown = !line.shown;
      button.setAttribute("aria-pressed", String(members[0].shown));
      draw();
    });
    keys.append(button);
  }
  if (overTime) {
    svg.style.cursor = "crosshair";
    svg.addEventListener("click", (event) => {
      const box = svg.getBoundingClientRect();
      seek(unscaleX((event.clientX - box.left) * WIDTH / box.width));
    });
  }
  draw();
  new IntersectionObserver(([entry]) => { inSight = entry.isIntersecting; move(at); }).observe(svg);
  return move;
}
