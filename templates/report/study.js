// The figures of a study: a response curve, a map, parallel coordinates, and the case that is chosen.

const content = JSON.parse(document.getElementById("data").textContent);
const get = (id) => document.getElementById(id);
const BAD = "#b13c00", NONE = "#b9c0c7";
// viridis, at equal steps; on a dark page it begins lighter, so that lines are seen
const DARK = window.matchMedia("(prefers-color-scheme: dark)").matches;
const RAMP = [...(DARK ? [[140, 105, 215], [95, 125, 195], [50, 160, 155]] : [[68, 1, 84], [59, 82, 139], [33, 145, 140]]), [94, 201, 98], [253, 231, 37]];
const count = content.kind.length;
const rows = [...Array(count).keys()];
const columns = content.columns.map(scaled);
const variables = columns.filter((column) => column.role === "variable");
const measures = columns.filter((column) => column.role === "measure");
const order = columns.find((column) => column.role === "case");
const measured = (row) => content.kind[row] === "ok" || content.kind[row] === "inaccurate";
const state = { measure: 0, along: 0, across: Math.min(1, variables.length - 1), chosen: content.best ?? 0 };

// A column with the place of each cell: itself, or of texts which one it is.
function scaled(column) {
  const texts = column.cells.some((cell) => typeof cell === "string");
  const words = texts ? [...new Set(column.cells)] : [];
  const at = column.cells.map((cell) => (cell === null ? null : texts ? words.indexOf(cell) : cell));
  const known = at.filter((value) => value !== null);
  return { ...column, words, at, ends: known.length ? range(known, texts ? 0.5 : 1e-12) : [0, 1],
    levels: [...new Set(known)].sort((a, b) => a - b) };
}

const text = (column, row) => (column.cells[row] === null ? "none" : column.words.length ? column.cells[row] : number(column.cells[row]));
const title = (column) => (column.unit ? `${column.name} [${column.unit}]` : column.name);
// the end of a long name, as much as there is room for
const short = (name, most) => (name.length > most ? `…${name.slice(1 - most)}` : name);

function colour(column, row) {
  const value = column.at[row];
  if (value === null || !measured(row)) return NONE;
  const [low, high] = [column.levels[0], column.levels.at(-1)];
  const part = high > low ? (value - low) / (high - low) * (RAMP.length - 1) : 0;
  const k = Math.min(Math.floor(part), RAMP.length - 2);
  return `rgb(${RAMP[k].map((c, i) => Math.round(c + (part - k) * (RAMP[k + 1][i] - c))).join(",")})`;
}

function say(shape, row) {
  const lines = [`case ${order.cells[row]}`, ...variables.map((v) => `${v.name}: ${text(v, row)} ${v.unit}`)];
  if (measured(row)) lines.push(`${measures[state.measure].name}: ${text(measures[state.measure], row)}`);
  if (content.reason[row]) lines.push(content.reason[row]);
  element("title", {}, shape).textContent = lines.join("\n");
  shape.dataset.row = row;
  shape.addEventListener("click", () => choose(row));
  return shape;
}

function cross(x, y, row, parent) {
  const shape = element("path", { d: `M${x - 4} ${y - 4}l8 8m0 -8l-8 8`, stroke: BAD, "stroke-width": 2, fill: "none", class: "point failed" }, parent);
  return say(shape, row);
}

function frame(figure, caption, width, height, left) {
  figure.replaceChildren();
  const words = document.createElement("figcaption");
  words.textContent = caption;
  const svg = element("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": caption });
  figure.append(words, svg);
  return { svg, left, right: width - 14, top: 10, bottom: height - 42, width, height };
}

// Draws the axes and returns what turns values into places.
function axes(box, x, y) {
  const { svg, left, right, top, bottom } = box;
  const wide = (v) => left + (right - left) * (v - x.ends[0]) / (x.ends[1] - x.ends[0]);
  const high = (v) => bottom - (bottom - top) * (v - y.ends[0]) / (y.ends[1] - y.ends[0]);
  const marks = (axis, about) => (axis.words.length ? axis.words.map((_, k) => k) : ticks(...axis.ends, about));
  const word = (axis, v) => (axis.words.length ? short(axis.words[v], 14) : number(v));
  for (const v of marks(x, 6)) {
    element("line", { x1: wide(v), x2: wide(v), y1: top, y2: bottom, stroke: "var(--rule)" }, svg);
    element("text", { x: wide(v), y: bottom + 15, "text-anchor": "middle" }, svg).textContent = word(x, v);
  }
  for (const v of marks(y, 5)) {
    element("line", { x1: left, x2: right, y1: high(v), y2: high(v), stroke: "var(--rule)" }, svg);
    element("text", { x: left - 5, y: high(v) + 4, "text-anchor": "end" }, svg).textContent = word(y, v);
  }
  element("text", { x: (left + right) / 2, y: bottom + 34, "text-anchor": "middle" }, svg).textContent = short(title(x), 70);
  return [wide, high];
}

// A measure over one variable; joined where that is the only one, with the means of its values otherwise.
function response() {
  const x = along(), y = measures[state.measure];
  const coloured = variables.length > 1 && x.role !== "case";
  const box = frame(get("response"), `${title(y)}, over ${short(title(x), 40)}${coloured ? `, coloured by ${short(title(across()), 40)}` : ""}`, 560, coloured ? 340 : 300, 70);
  box.top += 12;
  if (coloured) box.bottom -= 34;
  const [wide, high] = axes(box, x, y);
  const seen = rows.filter((row) => measured(row) && y.at[row] !== null);
  let steps = [];
  if (x.role === "case") {
    let least = Infinity;
    const better = seen.filter((row) => content.met[row] && y.name === content.objective);
    for (const row of better) { least = Math.min(least, y.at[row]); steps.push([x.at[row], least]); }
  } else if (variables.length === 1) steps = seen.map((row) => [x.at[row], y.at[row]]).sort((a, b) => a[0] - b[0]);
  else if (2 * x.levels.length <= seen.length) {
    for (const level of x.levels) {
      const here = seen.filter((row) => x.at[row] === level).map((row) => y.at[row]);
      if (here.length) steps.push([level, here.reduce((a, b) => a + b, 0) / here.length]);
    }
  }
  const path = steps.map(([a, b], k) => `${k ? "L" : "M"}${wide(a).toFixed(2)} ${high(b).toFixed(2)}`).join("");
  element("path", { d: path, fill: "none", stroke: COLOURS[0], "stroke-width": 1.6 }, box.svg);
  for (const row of seen) {
    const fill = variables.length > 1 && x.role !== "case" ? colour(across(), row) : COLOURS[0];
    say(element("circle", { cx: wide(x.at[row]), cy: high(y.at[row]), r: 4, fill, class: "point" }, box.svg), row);
  }
  for (const row of rows) if (!measured(row) && x.at[row] !== null) cross(wide(x.at[row]), box.bottom - 6, row, box.svg);
  const crossed = rows.some((row) => !measured(row)), joined = steps.length > 1;
  if (variables.length > 1 && x.role !== "case") legend({ ...box, height: 334 }, across(), "colour");
  // what the marks are
  const marks = [["circle", "a case"], ...(joined ? [["line", x.role === "case" ? "best so far" : variables.length === 1 ? "joins cases" : "mean of a value"]] : []), ...(crossed ? [["cross", "without measures"]] : [])];
  let at = box.left;
  for (const [kind, words] of marks) {
    const y = 8;
    if (kind === "circle") element("circle", { cx: at + 6, cy: y, r: 4, fill: COLOURS[0] }, box.svg);
    else if (kind === "line") element("line", { x1: at, x2: at + 14, y1: y, y2: y, stroke: COLOURS[0], "stroke-width": 1.6 }, box.svg);
    else element("path", { d: `M${at + 2} ${y - 4}l8 8m0 -8l-8 8`, stroke: BAD, "stroke-width": 2, fill: "none" }, box.svg);
    element("text", { x: at + 18, y: y + 4, class: "legend" }, box.svg).textContent = words;
    at += 34 + 7 * words.length;
  }
}

// Two variables, the measure as colour: fields where the values form a grid, points elsewhere.
function map() {
  const figure = get("map");
  figure.replaceChildren();
  if (variables.length < 2 || along() === across() || along().role === "case") return;
  const x = along(), y = across(), z = measures[state.measure];
  const box = frame(figure, `${title(z)}, over ${short(title(x), 40)} and ${short(title(y), 40)}`, 560, 340, 70);
  box.bottom -= 34;
  const grid = x.levels.length * y.levels.length <= count && x.levels.length <= 100 && y.levels.length <= 100;
  const half = (axis) => (axis.levels.length > 1 ? Math.min(...axis.levels.slice(1).map((v, k) => v - axis.levels[k])) / 2 : 0.5);
  const widened = (axis) => (grid ? { ...axis, ends: [axis.levels[0] - half(axis), axis.levels.at(-1) + half(axis)] } : axis);
  const [wide, high] = axes(box, widened(x), widened(y));
  element("text", { x: 12, y: (box.top + box.bottom) / 2, transform: `rotate(-90 12 ${(box.top + box.bottom) / 2})`, "text-anchor": "middle" }, box.svg)
    .textContent = short(title(y), 46);
  for (const row of rows) {
    if (x.at[row] === null || y.at[row] === null) continue;
    const [cx, cy] = [wide(x.at[row]), high(y.at[row])];
    if (grid) {
      const [w, h] = [wide(half(x)) - wide(-half(x)), high(-half(y)) - high(half(y))];
      say(element("rect", { x: cx - w / 2, y: cy - h / 2, width: w, height: h, fill: measured(row) ? colour(z, row) : "#f3e3db", class: "point" }, box.svg), row);
    } else if (measured(row)) say(element("circle", { cx, cy, r: 5, fill: colour(z, row), class: "point" }, box.svg), row);
    if (!measured(row)) cross(cx, cy, row, box.svg);
  }
  legend(box, z);
}

// The colours of a measure: its values where there are few, a ramp otherwise.
function legend(box, z, what = "") {
  const y = box.height - 22;
  if (!z.levels.length) return;
  element("text", { x: 4, y: y + 9, class: "legend" }, box.svg).textContent = what;
  const few = z.levels.length <= 5;
  const shown = few ? z.levels : [...Array(41).keys()].map((k) => z.levels[0] + (z.levels.at(-1) - z.levels[0]) * k / 40);
  const size = few ? 70 : 6;
  shown.forEach((value, k) => {
    const row = z.at.indexOf(value);
    const fill = row >= 0 && few ? colour(z, row) : ramp(k / 40);
    element("rect", { x: box.left + k * size, y, width: few ? 14 : size, height: 10, fill }, box.svg);
    if (few) element("text", { x: box.left + k * size + 18, y: y + 9, class: "legend" }, box.svg).textContent = z.words.length ? short(z.words[value], 8) : number(value);
  });
  if (!few) {
    element("text", { x: box.left - 5, y: y + 9, "text-anchor": "end" }, box.svg).textContent = number(z.levels[0]);
    element("text", { x: box.left + 41 * size + 5, y: y + 9, class: "legend" }, box.svg).textContent = number(z.levels.at(-1));
  }
}

function ramp(part) {
  const at = part * (RAMP.length - 1), k = Math.min(Math.floor(at), RAMP.length - 2);
  return `rgb(${RAMP[k].map((c, i) => Math.round(c + (at - k) * (RAMP[k + 1][i] - c))).join(",")})`;
}

// Every case a line over all variables and measures; one without measures ends after its values.
function parallel() {
  // a measure that is the same in all cases says nothing
  const most = 14, all = [...variables, ...measures.filter((measure) => !isConstant(measure))].slice(0, most);
  const z = measures[state.measure];
  const box = frame(get("parallel"), `All values and measures of each case, coloured by ${title(z)}`, 1120, 376, 60);
  const top = 52, bottom = 320;
  const x = (k) => box.left + (all.length > 1 ? (1120 - 120) * k / (all.length - 1) : 500);
  const y = (axis, v) => bottom - (bottom - top) * (v - axis.ends[0]) / (axis.ends[1] - axis.ends[0]);
  const marked = rows.filter((row) => !measured(row));
  for (const row of [...rows.filter(measured), ...marked]) {
    let path = "", pen = "M", last = null;
    all.forEach((axis, k) => {
      if (axis.at[row] === null) { pen = "M"; return; }
      last = [x(k), y(axis, axis.at[row])];
      path += `${pen}${last[0].toFixed(1)} ${last[1].toFixed(1)}`;
      pen = "L";
    });
    if (!last) continue;
    const good = measured(row);
    say(element("path", { d: path, fill: "none", stroke: good ? colour(z, row) : BAD, "stroke-width": 1.4,
      "stroke-dasharray": good ? "" : "4 3", "stroke-opacity": 0.8, class: good ? "line" : "line failed" }, box.svg), row);
    if (!good) cross(...last, row, box.svg);
  }
  all.forEach((axis, k) => {
    element("line", { x1: x(k), x2: x(k), y1: top, y2: bottom, stroke: "var(--axis)" }, box.svg);
    const place = { x: x(k), "text-anchor": all.length === 1 ? "middle" : k === 0 ? "start" : k === all.length - 1 ? "end" : "middle" };
    const name = element("text", { ...place, y: 14 + 14 * (k % 2), "font-weight": 600 }, box.svg);
    name.textContent = short(title(axis), Math.max(16, Math.floor(250 / all.length)));
    element("title", {}, name).textContent = title(axis);
    const ends = axis.words.length ? [axis.words[0], axis.words.at(-1)].map((word) => short(word, 14)) : axis.levels.length ? [axis.levels[0], axis.levels.at(-1)].map(number) : ["", ""];
    element("text", { x: x(k), y: bottom + 14, "text-anchor": "middle" }, box.svg).textContent = ends[0];
    element("text", { x: x(k), y: top - 6, "text-anchor": "middle" }, box.svg).textContent = ends[1];
  });
  legend(box, z);
}

const isConstant = ({ levels }) => levels.length < 2 || levels.at(-1) - levels[0] <= 1e-9 * Math.max(1, Math.abs(levels.at(-1)));
const along = () => [...variables, order][state.along];
const across = () => variables[state.across];

function draw() {
  response();
  map();
  parallel();
  mark();
}

function mark() {
  for (const shape of document.querySelectorAll(".chosen")) shape.classList.remove("chosen");
  for (const shape of document.querySelectorAll(`[data-row="${state.chosen}"]`)) {
    shape.classList.add("chosen");
    shape.parentNode.append(shape); // over the others
  }
}

// What is known of a case, and how it is opened.
function choose(row) {
  if (!(row >= 0 && row < count)) return;
  state.chosen = row;
  get("number").value = order.cells[row];
  const table = document.createElement("table");
  const line = (name, value, kind) => {
    const made = table.insertRow();
    const head = document.createElement("th");
    head.textContent = name;
    made.append(head);
    const cell = made.insertCell();
    cell.textContent = value;
    if (kind) cell.className = kind;
  };
  line("status", content.reason[row] ? `${content.kind[row]}: ${content.reason[row]}` : content.kind[row], measured(row) ? "good" : "bad");
  for (const column of columns) if (column.role !== "case") line(title(column), text(column, row));
  const open = document.createElement(content.links[row] ? "p" : "pre");
  if (content.links[row]) {
    const link = document.createElement("a");
    link.href = content.links[row];
    link.textContent = `Open the report of case ${order.cells[row]}`;
    open.append(link);
  } else open.textContent = content.commands[row];
  get("case").replaceChildren(table, open);
  mark();
}

function options(id, all, chosen) {
  for (const [k, column] of all.entries()) {
    const made = document.createElement("option");
    made.value = k;
    made.textContent = column.name;
    get(id).append(made);
  }
  get(id).value = state[id] = chosen;
  get(id).addEventListener("change", (event) => { state[id] = Number(event.target.value); draw(); });
}

const first = [(measure) => measure.event && !isConstant(measure), (measure) => !isConstant(measure)].map((found) => measures.findIndex(found)).find((k) => k >= 0);
options("measure", measures, first ?? 0);
options("along", [...variables, order], content.objective ? variables.length : 0);
options("across", variables, state.across);
get("across-label").hidden = variables.length < 2;
get("before").addEventListener("click", () => choose(state.chosen - 1));
get("after").addEventListener("click", () => choose(state.chosen + 1));
get("number").addEventListener("change", (event) => choose(order.cells.indexOf(Number(event.target.value))));
draw();
choose(state.chosen);
document.documentElement.dataset.ready = "yes";
