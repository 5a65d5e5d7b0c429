// The figures: uPlot's, with one cursor and one span of time for all.

const DASHES = [[], [6, 3], [2, 2], [8, 3, 2, 3], [1, 3]];
const HIGH = 230, PRINTED = [330, 165]; // px
const OVER_TIME = "time [ms]";
const STILL = 3; // px that a pointer goes at most where it was a click
const FLAT = 1e-6; // of its size: what a line varies by that is said to be constant

// At twice a coarse screen's pixels, for what is printed.
async function uplot() {
  const text = document.querySelector('script[data-library="uPlot.iife.min.js"]').textContent;
  const code = `const devicePixelRatio = Math.max(2, window.devicePixelRatio);\n${text}\nexport default uPlot;`;
  return (await import(URL.createObjectURL(new Blob([code], { type: "text/javascript" })))).default;
}
const Plot = await uplot();
const drawnCharts = new Set();

function tone(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }

// ---- the span of time that all figures show: null is all of it

let span = null;
function zoom(next) {
  const over = [...drawnCharts].filter((one) => one.overTime);
  if (!over.length) return;
  const first = Math.min(...over.map((one) => one.ends[0])), last = Math.max(...over.map((one) => one.ends[1]));
  if (next) {
    const long = Math.min(Math.max(next[1] - next[0], 1e-4 * (last - first)), last - first);
    const low = Math.min(Math.max(next[0], first), last - long);
    next = long < last - first ? [low, low + long] : null;
  }
  span = next;
  for (const one of over) { const [min, max] = span ?? one.ends; one.plot.setScale("x", { min, max }); }
}
// Nearer by a factor about a time, or on by a part of what is seen.
function nearer(factor, about) {
  const [low, high] = seenSpan(), at = about ?? (low + high) / 2;
  zoom([at - (at - low) * factor, at + (high - at) * factor]);
}
function further(part) { const [low, high] = seenSpan(), by = part * (high - low); zoom([low + by, high + by]); }
function seenSpan() {
  const over = [...drawnCharts].filter((one) => one.overTime);
  return span ?? [Math.min(...over.map((one) => one.ends[0])), Math.max(...over.map((one) => one.ends[1]))];
}
const SPANS = { in: () => nearer(0.5), out: () => nearer(2), back: () => further(-0.25), on: () => further(0.25), all: () => zoom(null) };
for (const button of document.querySelectorAll("[data-span]")) button.addEventListener("click", SPANS[button.dataset.span]);

// Drag chooses a span; shift and drag, or a finger, moves it, two fingers and ctrl with the wheel stretch it.
function gestures(plot) {
  const { over } = plot, held = new Map();
  const time = (x) => plot.posToVal(x - over.getBoundingClientRect().left, "x");
  over.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    nearer(Math.exp(event.deltaY * 0.002), time(event.clientX));
  }, { passive: false });
  over.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "touch" && !event.shiftKey) return;
    over.setPointerCapture(event.pointerId);
    held.set(event.pointerId, event.clientX);
  });
  over.addEventListener("pointermove", (event) => {
    if (!held.has(event.pointerId)) return;
    const before = [...held.values()];
    held.set(event.pointerId, event.clientX);
    const now = [...held.values()];
    if (now.length === 2) {
      const apart = Math.abs(now[0] - now[1]);
      if (apart > STILL) nearer(Math.abs(before[0] - before[1]) / apart, time((now[0] + now[1]) / 2));
    } else if (span) {
      const by = time(before[0]) - time(now[0]);
      zoom([span[0] + by, span[1] + by]);
    }
  });
  for (const kind of ["pointerup", "pointercancel"]) over.addEventListener(kind, (event) => held.delete(event.pointerId));
}

const KEYS = { "+": SPANS.in, "-": SPANS.out, ArrowLeft: SPANS.back, ArrowRight: SPANS.on, 0: SPANS.all };
function strokesOf(box) {
  box.tabIndex = 0;
  box.addEventListener("keydown", (event) => {
    const stroke = !event.ctrlKey && !event.metaKey && !event.altKey && KEYS[event.key];
    if (!stroke) return;
    event.preventDefault();
    event.stopPropagation(); // the animation has some of these, too
    stroke();
  });
}

// ---- one figure

// Of one or more runs; `seek(ms)` is called where it is clicked. One that does not change is a line of words.
// Returns what moves its mark of the time; `drop` gives back what it takes.
function chart(parent, runs, key, seek) {
  const content = runs.map((run) => run.panels.find((panel) => panel.key === key)).find((panel) => panel);
  const figure = piece("figure", {}, parent);
  figure.dataset.key = key;
  const names = [], lines = [];
  runs.forEach((run, r) => {
    for (const line of run.panels.find((panel) => panel.key === key)?.lines ?? []) {
      if (!names.includes(line.name)) names.push(line.name);
      lines.push({ name: line.name, run: r, time: line.x, x: unpack(line.x, Float32Array), y: unpack(line.y, Float32Array) });
    }
  });
  const overTime = content.x_title === OVER_TIME;
  if (overTime && lines.every((line) => isFlat(line, content.least))) return constant(figure, content, runs, lines);
  piece("figcaption", { textContent: `${content.title} [${content.unit}]` }, figure);
  const box = piece("div", { className: "plot" }, figure), keys = piece("div", { className: "keys-of" }, figure);
  if (content.note) piece("p", { className: "note", textContent: content.note }, figure);
  box.setAttribute("role", "img");
  box.setAttribute("aria-label", spoken(content, runs, lines, overTime));

  // lines of the same times share a table
  const tables = new Map();
  for (const line of lines) {
    if (!tables.has(line.time)) tables.set(line.time, []);
    tables.get(line.time).push(line);
  }
  const ordered = [...tables.values()].flat();
  ordered.forEach((line, k) => { line.series = k + 1; });
  const columns = [...tables.values()].map((some) => [some[0].x, ...some.map((line) => line.y)]);
  const data = content.equal ? [null, ...ordered.map((line) => [line.x, line.y])] : columns.length > 1 ? Plot.join(columns) : columns[0];
  const ends = overTime ? [Math.min(...lines.map((l) => l.x[0])), Math.max(...lines.map((l) => l.x.at(-1)))] : range(lines.flatMap((l) => [...l.x]), 1e-6);

  const font = "12px system-ui, sans-serif";
  const axis = { stroke: () => tone("--axis"), grid: { stroke: () => tone("--rule"), width: 1 }, ticks: { show: false }, font, labelFont: font };
  const colour = (line) => () => tone(`--line-${names.indexOf(line.name) % COLOURS.length}`);
  const options = {
    width: 560, height: HIGH, mode: content.equal ? 2 : 1, legend: { show: false }, padding: [8, 12, 0, 0],
    scales: {
      x: { time: false, range: overTime ? (u, low, high) => [low ?? ends[0], high ?? ends[1]] : () => (content.equal ? even(0) : ends) },
      y: { range: (u, low, high) => (content.equal ? even(1) : spread(low ?? 0, high ?? 0, content.least)) },
    },
    axes: [
      { ...axis, label: content.x_title, size: 26, labelSize: 18, gap: 4, values: (u, at) => at.map(number) },
      { ...axis, size: 60, gap: 4, space: 34, values: (u, at) => at.map(number) },
    ],
    series: [content.equal ? null : {}, ...ordered.map((line) => ({
      label: line.name, stroke: colour(line), width: 1.6, dash: dash(line), spanGaps: true, points: { show: false }, ...(content.equal ? { facets: FACETS, paths: joined } : {}),
    }))],
    cursor: {
      show: !content.equal, y: false, points: { size: 6 }, drag: { x: overTime, y: false, setScale: false },
      ...(overTime ? { sync: { key: "time", scales: ["x", null], setSeries: false } } : {}),
      bind: { mousedown: (u, target, handler) => (event) => { if (!event.shiftKey) handler(event); return null; }, dblclick: () => () => { zoom(null); return null; } },
    },
    hooks: {
      setSelect: [(u) => {
        const { left, width } = u.select;
        if (width > STILL) zoom([u.posToVal(left, "x"), u.posToVal(left + width, "x")]);
        if (width) u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
      }],
      setCursor: [(u) => { if (inSight) read(u.cursor.idx); }],
      setScale: [() => move(at)],
      setSize: [() => move(at)],
    },
  };
  let wide = 560 - 72, high = HIGH - 52, at = 0, inSight = true;
  // one scale for both axes
  function even(k) {
    const [x, y] = [range(ordered.flatMap((l) => [...l.x]), 1e-6), range(ordered.flatMap((l) => [...l.y]), content.least)];
    const mm = Math.max((x[1] - x[0]) / wide, (y[1] - y[0]) / high), half = mm * (k ? high : wide) / 2;
    const middle = ((k ? y : x)[0] + (k ? y : x)[1]) / 2;
    return [middle - half, middle + half];
  }
  // of several runs each has its dashes; of many lines of one, those whose colours come round
  function dash(line) {
    return DASHES[(runs.length > 1 ? line.run : Math.floor(names.indexOf(line.name) / COLOURS.length)) % DASHES.length];
  }

  const plot = new Plot(options, data, box);
  const mark = piece("div", { className: "cursor" }, plot.over);
  const made = { figure, plot, overTime, ends, move, drop, print };
  drawnCharts.add(made);
  if (overTime && span) plot.setScale("x", { min: span[0], max: span[1] });

  function size(width, height) {
    wide = width - 72; high = height - 52;
    plot.setSize({ width, height });
  }
  let printing = false;
  function fill() { if (!printing && box.clientWidth) size(box.clientWidth, HIGH); }
  function print(on) {
    printing = on;
    if (on) size(...PRINTED); else fill();
  }
  const watch = new ResizeObserver(() => { if (Math.abs(box.clientWidth - plot.width) > 1) fill(); });
  watch.observe(box);
  const sight = new IntersectionObserver(([entry]) => { inSight = entry.isIntersecting; move(at); });
  sight.observe(box);

  function move(time) {
    at = time;
    if (!inSight) return;
    const x = plot.valToPos(time, "x");
    mark.hidden = !overTime || !(x >= -0.5 && x <= plot.over.clientWidth + 0.5);
    // over the picture of the lines, which need not be drawn anew
    if (!mark.hidden) mark.style.transform = `translateX(${x.toFixed(1)}px)`;
  }

  function drop() {
    watch.disconnect(); sight.disconnect();
    drawnCharts.delete(made);
    plot.destroy();
  }

  const groups = new Map();
  for (const line of lines) {
    const name = runs.length > 1 ? `${runs[line.run].name}: ${line.name}` : line.name;
    if (!groups.has(name)) groups.set(name, []);
    groups.get(name).push(line);
  }
  const values = [];
  for (const [name, members] of groups) {
    const button = piece("button", { type: "button", className: "key" }, keys);
    button.setAttribute("aria-pressed", "true");
    const swatch = element("svg", { viewBox: "0 0 24 8", "aria-hidden": "true" });
    element("line", { x1: 0, x2: 24, y1: 4, y2: 4, "stroke-width": 2.5, stroke: COLOURS[names.indexOf(members[0].name) % COLOURS.length],
      "stroke-dasharray": dash(members[0]).join(" ") }, swatch);
    button.append(swatch, ` ${name}`);
    if (overTime) {
      values.push([members[0], piece("span", { textContent: ` ${number(members[0].y.at(-1))}` }, button)]);
      Object.assign(button.dataset, { name: members[0].name, run: members[0].run, last: members[0].y.at(-1) });
    }
    button.addEventListener("click", () => {
      const show = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", String(show));
      plot.batch(() => { for (const line of members) plot.setSeries(line.series, { show }); });
    });
  }
  // the values at the pointer, or at the end
  function read(index) {
    for (const [line, text] of values) {
      let k = index ?? -1;
      const column = plot.data[line.series];
      while (k > 0 && column[k] == null) k -= 1; // that line has no state at this time
      text.textContent = ` ${number(index == null ? line.y.at(-1) : column[k] ?? line.y[0])}`;
    }
  }
  if (overTime) {
    let down = 0;
    plot.over.addEventListener("mousedown", (event) => { down = event.clientX; });
    plot.over.addEventListener("click", (event) => {
      if (Math.abs(event.clientX - down) <= STILL && !event.shiftKey) seek(plot.posToVal(event.offsetX, "x"));
    });
    gestures(plot);
    strokesOf(box);
  }
  return made;
}

const FACETS = [{ scale: "x", auto: true }, { scale: "y", auto: true }];
// Points in their own order, which need not go along x.
function joined(u, index) {
  Plot.orient(u, index, (series, xs, ys, scaleX, scaleY, toX, toY, left, top, wide, high) => {
    const path = new Path2D();
    for (let k = 0; k < xs.length; k += 1) path[k ? "lineTo" : "moveTo"](toX(xs[k], scaleX, wide, left), toY(ys[k], scaleY, high, top));
    u.ctx.save();
    u.ctx.strokeStyle = series.stroke(u, index);
    u.ctx.lineWidth = 2 * series.width;
    u.ctx.setLineDash((series.dash ?? []).map((k) => 2 * k));
    u.ctx.stroke(path);
    u.ctx.restore();
  });
  return null;
}

function isFlat({ y }, least) {
  let low = Infinity, high = -Infinity;
  for (const value of y) { if (value < low) low = value; if (value > high) high = value; }
  return high - low <= Math.max(least, FLAT * Math.max(Math.abs(low), Math.abs(high)));
}

function constant(figure, content, runs, lines) {
  figure.className = "constant";
  piece("figcaption", { textContent: `${content.title}, constant:` }, figure);
  for (const line of lines) {
    const name = runs.length > 1 ? `${runs[line.run].name}: ${line.name}` : line.name;
    const small = Math.abs(line.y.at(-1)) < content.least; // round-off
    const made = piece("span", { className: "key", textContent: `${name} ${small ? 0 : number(line.y.at(-1))} ${content.unit}` }, figure);
    Object.assign(made.dataset, { name: line.name, run: line.run, last: line.y.at(-1) });
  }
  return { figure, move() {}, drop() {} };
}

// A figure for those who hear the page.
function spoken(content, runs, lines, overTime) {
  const said = lines.slice(0, 8).map((line) => {
    const [low, high] = line.y.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
    return `${runs.length > 1 ? `${runs[line.run].name} ` : ""}${line.name} from ${number(low)} to ${number(high)}${overTime ? `, at the end ${number(line.y.at(-1))}` : ""}`;
  });
  return `${content.title} in ${content.unit}: ${said.join("; ")}${lines.length > 8 ? "; and others" : ""}`;
}

window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { for (const one of drawnCharts) one.plot.redraw(false); });
