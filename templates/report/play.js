// What the controls of the animation do.

const runs = JSON.parse(document.getElementById("data").textContent);
const get = (id) => document.getElementById(id);
const state = { run: 0, time: 0, playing: false, colour: 0, view: null, rate: 1, frames: 0 };
const shown = () => runs[state.run].animation;
const end = () => shown().time.at(-1), start = () => shown().time[0];
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
  const { name, unit, most } = shown().colours[state.colour];
  const legend = get("legend");
  legend.replaceChildren();
  const ramp = document.createElement("div"), ends = document.createElement("div"), title = document.createElement("div");
  ramp.className = "ramp";
  ramp.style.background = RAMP;
  ends.className = "ends";
  for (const text of ["0", `${number(most)}${unit ? ` ${unit}` : ""}`]) {
    const piece = document.createElement("span");
    piece.textContent = text;
    ends.append(piece);
  }
  title.textContent = { speed: "speed", strain: "strain of the box's joints", curvature: "curvature of the box's joints", contact: "contact force of the box" }[name];
  legend.append(title, ramp, ends);
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
  const list = get("colour");
  list.replaceChildren(...shown().colours.map((c, k) => new Option(c.name, k)));
  colour(state.colour);
  seek(state.time);
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
