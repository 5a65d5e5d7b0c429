// What the controls of the animation do.

const runs = JSON.parse(document.getElementById("data").textContent);
const get = (id) => document.getElementById(id);
let over = null;
const state = { run: 0, under: -1, time: 0, playing: false, colour: 0, view: null, rate: 1, frames: 0 };
const shown = () => runs[state.run].animation;
// runs that are seen together have one clock, to the end of the longer one
const end = () => Math.max(shown().time.at(-1), state.under >= 0 ? runs[state.under].animation.time.at(-1) : -Infinity), start = () => shown().time[0];
const movers = [];
let stage = null;

function seek(time) {
  state.time = Math.min(Math.max(time, start()), end());
  get("time").value = end() > start() ? 1000 * (state.time - start()) / (end() - start()) : 0;
  get("clock").textContent = shown().static ? (state.time < 0.5 ? "before" : "after") : `${state.time.toFixed(2)} ms`;
  const now = performance.now();
  if (!state.playing || now - marked > MARKS) { marked = now; mark(); }
  stage?.seek(state.time);
}

// The marks in the charts make the browser paint these again, which may take as long as the picture.
const MARKS = 100; // [ms]
let marked = 0;
function mark() {
  for (const move of movers) move(state.time);
}

function step(count) {
  play(false);
  const times = shown().time;
  let k = times.findIndex((t) => t >= state.time - 1e-9);
  if (k < 0) k = times.length - 1;
  seek(times[Math.min(Math.max(k + count, 0), times.length - 1)]);
}

let last = 0;
function tick(now) {
  if (!state.playing) return;
  state.frames += 1;
  const next = state.time + state.rate * (now - last) / 1000;
  stage?.pace(now - last);
  last = now;
  if (next >= end()) { seek(end()); play(false); return; }
  seek(next);
  requestAnimationFrame(tick);
}

function play(on) {
  if (on === state.playing) return;
  state.playing = on;
  get("play").textContent = on ? "pause" : "play";
  get("play").setAttribute("aria-pressed", String(on));
  if (!on) { mark(); stage?.pace(null); return; }
  if (state.time >= end() - 1e-9) seek(start());
  last = performance.now();
  requestAnimationFrame(tick);
}

function colour(index) {
  state.colour = (index + shown().colours.length) % shown().colours.length;
  get("colour").value = state.colour;
  const seen = shown().colours[state.colour];
  legendOf(seen, runs[state.run].keys?.[seen.name]);
  stage?.colour(state.colour);
}

function view(name) {
  state.view = name;
  for (const button of document.querySelectorAll("[data-view]")) button.setAttribute("aria-pressed", String(button.dataset.view === name));
  if (name) stage?.view(name);
}

function choose(index) {
  state.run = index;
  stage?.choose(index);
  if (state.under === index) under(-1);
  if (over && runs[index].parts) over.take(runs[index]);
  const list = get("colour");
  list.replaceChildren(...shown().colours.map((c, k) => new Option(c.name, k)));
  colour(state.colour);
  seek(state.time);
}

// Another run as a ghost over the one that is seen, on the same clock.
function under(index) {
  state.under = index === state.run ? -1 : index;
  get("over-choice").value = state.under;
  stage?.ghost(state.under >= 0 ? runs[state.under].animation : null);
}

// What is known of what is under the pointer: the part, the box's colour, and the part's values at the time.
const MOST_VALUES = 12;
function lines(found, parts) {
  const said = ofPart(found, parts, runs[state.run]);
  if (!said) return null;
  if (found.box !== undefined) {
    const own = stage.runs[state.run].colours[state.colour];
    if (!runs[state.run].keys?.[own.name]) said.texts.push(`${COLOUR_WORDS[own.name]} ${stage.valueAt(found.box)}`);
  }
  for (const panel of runs[state.run].panels) {
    if (panel.x_title !== OVER_TIME) continue;
    for (const line of panel.lines) {
      if (said.texts.length >= MOST_VALUES || (line.name !== said.part && !line.name.startsWith(`${said.part} `))) continue;
      line.values ??= [unpack(line.x, Float32Array), unpack(line.y, Float32Array)];
      const [x, y] = line.values;
      let k = x.findIndex((time) => time >= state.time);
      if (k < 0) k = x.length - 1;
      const what = line.name === said.part ? "" : ` ${line.name.slice(said.part.length + 1)}`;
      said.texts.push(`${panel.short}${what} ${number(Math.abs(y[k]) < panel.least ? 0 : y[k])} ${panel.unit}`);
    }
  }
  return said;
}

const rates = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
function rate(index) {
  const k = Math.min(Math.max(index, 0), rates.length - 1);
  state.rate = rates[k];
  get("rate").value = k;
}
get("rate").replaceChildren(...rates.map((r, k) => new Option(`${r} ms`, k)));

function check(id, value) {
  get(id).checked = value;
  stage?.[id](value);
}

get("play").addEventListener("click", () => play(!state.playing));
get("back").addEventListener("click", () => step(-1));
get("forth").addEventListener("click", () => step(1));
get("nearer").addEventListener("click", () => stage?.near());
get("time").addEventListener("input", (event) => { play(false); seek(start() + event.target.value / 1000 * (end() - start())); });
get("colour").addEventListener("change", (event) => colour(Number(event.target.value)));
get("rate").addEventListener("change", (event) => rate(Number(event.target.value)));
get("over-choice")?.addEventListener("change", (event) => { under(Number(event.target.value)); seek(state.time); });
get("run-choice")?.addEventListener("change", (event) => choose(Number(event.target.value)));
for (const id of ["follow", "machine"]) get(id).addEventListener("change", (event) => check(id, event.target.checked));
for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => view(button.dataset.view));
document.addEventListener("click", (event) => {
  const link = event.target.closest("[data-time]");
  if (!link) return;
  event.preventDefault();
  play(false);
  seek(Number(link.dataset.time));
  get("animation").scrollIntoView({ block: "start" });
});

onPaper(() => stage, drawnCharts);

const strokes = {
  " ": () => play(!state.playing), ArrowLeft: (event) => step(event.shiftKey ? -10 : -1), ArrowRight: (event) => step(event.shiftKey ? 10 : 1),
  Home: () => { play(false); seek(start()); }, End: () => { play(false); seek(end()); },
  1: () => view("xz"), 2: () => view("yz"), 3: () => view("xy"), 4: () => view("iso"), n: () => stage?.near(),
  c: () => colour(state.colour + 1), f: () => check("follow", !get("follow").checked), m: () => check("machine", !get("machine").checked),
  "+": () => rate(rates.indexOf(state.rate) + 1), "-": () => rate(rates.indexOf(state.rate) - 1),
};
document.addEventListener("keydown", (event) => {
  // a control that has the focus keeps its own keys
  if (!runs.length || event.ctrlKey || event.metaKey || event.altKey || event.target.closest("button, select, input, a, summary")) return;
  const stroke = strokes[event.key];
  if (stroke) { event.preventDefault(); stroke(event); }
});
