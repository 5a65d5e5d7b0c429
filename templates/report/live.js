// A scene that is followed and turned: its values, the run that belongs to them, what is wrong with them.

const SECTIONS = ["headline", "numbers", "events", "lints", "map"];
const SEVERAL = "several at once"; // the group of values that one slider turns
const MOST_LINES = 5000; // of the file, that are numbered
const live = { seen: 0, kind: null, log: [] }; // the number of the run that is drawn, and when each was
let session = null, listed = -1, written = -1, pinned = null;
let kept = null, placed = null; // the time to go back to when a run that grows is as far

// ---- asking

async function ask(name, body) {
  const more = body === undefined ? {} : { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body) };
  const answer = await fetch(name, more);
  if (!answer.ok) throw new Error((await answer.json().catch(() => null))?.says ?? `${answer.status}`);
  return answer.status === 204 ? null : answer.json();
}

function say(text, bad = false) {
  get("said").textContent = text;
  get("said").className = bad ? "note bad" : "note";
}

// What is turned while an answer is on its way goes with the next question, the newest value of each; while a
// value is dragged, once the picture of the one before is drawn.
const AWAITED = 400; // ms that a picture is waited for at most
let waiting = null, asking = false, goOn = () => {};
function turn(values, held) {
  waiting = { values: { ...waiting?.values, ...values }, held };
  if (!held) goOn();
  if (!asking) send();
}

async function send() {
  asking = true;
  while (waiting) {
    const next = waiting;
    waiting = null;
    try { await ask("turn", next); } catch (error) { say(error.message, true); }
    if (next.held && waiting?.held !== false) await new Promise((done) => { goOn = done; setTimeout(done, AWAITED); });
  }
  asking = false;
}

// ---- values

const rows = new Map(); // by path: what shows a value
let held = null; // the path of the slider that is held

function digits(value) { return String(Number(value.toPrecision(10))); }
function textOf(control, value) { return control.unit ? `${digits(value)} ${control.unit}` : digits(value); }

// The number of a text in the unit of a control; NaN where it is another, or a formula.
function numberOf(control, text) {
  const match = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$/.exec(text);
  return match && match[2] === control.unit ? Number(match[1]) : NaN;
}

function row(control, k) {
  const line = piece("div", { className: "value" });
  line.dataset.path = control.path;
  const name = control.group === "parameters" ? control.label : `${control.group} ${control.label}`;
  piece("label", { textContent: control.label, htmlFor: `value-${k}`, title: control.path }, line);
  const made = { control, line, slider: null, field: null, wrong: null };
  if (control.number !== null) {
    made.slider = piece("input", { type: "range", min: control.low, max: control.high, step: control.step, ariaLabel: `${name}, slider` }, line);
    made.slider.addEventListener("input", () => {
      held = control.path;
      const text = textOf(control, made.slider.valueAsNumber);
      made.field.value = text;
      made.slider.ariaValueText = text;
      turn({ [control.path]: text }, true);
    });
    for (const kind of ["pointerup", "blur"]) made.slider.addEventListener(kind, () => { held = null; });
    made.slider.addEventListener("change", () => { held = null; turn({ [control.path]: made.field.value }, false); });
  } else {
    piece("span", { className: "note", textContent: "follows" }, line);
  }
  made.field = piece("input", { type: "text", id: `value-${k}`, spellcheck: false, autocomplete: "off" }, line);
  made.field.addEventListener("change", () => turn({ [control.path]: made.field.value.trim() || null }, false));
  const back = piece("button", { type: "button", textContent: "↺", title: `${control.text}, as in the file`, ariaLabel: `${name}: as in the file, ${control.text}` }, line);
  back.addEventListener("click", () => turn({ [control.path]: null }, false));
  made.wrong = piece("span", { className: "wrong bad", id: `wrong-${k}`, hidden: true }, line);
  return made;
}

function list(controls) {
  const open = new Set([...document.querySelectorAll("#groups details[open]")].map((group) => group.dataset.group));
  const first = !rows.size, known = new Set([...document.querySelectorAll("#groups details")].map((group) => group.dataset.group));
  rows.clear();
  const groups = new Map();
  controls.forEach((control, k) => {
    const made = row(control, k);
    rows.set(control.path, made);
    if (!groups.has(control.group)) groups.set(control.group, []);
    groups.get(control.group).push(made.line);
  });
  get("groups").replaceChildren(...[...groups].map(([name, lines]) => {
    const group = document.createElement("details");
    group.dataset.group = name;
    group.open = name === SEVERAL ? !known.has(name) || open.has(name) : first ? name === (groups.has("parameters") ? "parameters" : [...groups.keys()].find((one) => one.startsWith("sheets."))) : open.has(name);
    piece("summary", { textContent: name }, group);
    group.append(...lines);
    return group;
  }));
  shownBefore = "";
  if (!controls.length) piece("p", { className: "note", textContent: "The file has no values to turn yet; it is followed." }, get("groups"));
  find();
}

// The values whose names have all the words, in open groups.
function find() {
  const words = get("filter").value.toLowerCase().split(/\s+/).filter(Boolean);
  for (const group of document.querySelectorAll("#groups details")) {
    let some = false;
    for (const line of group.querySelectorAll(".value")) {
      line.hidden = !words.every((word) => line.dataset.path.toLowerCase().includes(word));
      some ||= !line.hidden;
    }
    group.hidden = !some;
    if (words.length && some) group.open = true;
  }
}

let shownBefore = "";
function show(turned, errors) {
  const now = JSON.stringify([turned, errors, listed, held]);
  if (now === shownBefore) return; // to write into so many fields makes the page slow
  shownBefore = now;
  const wrong = new Map(errors.filter((error) => error.path).map((error) => [error.path, error.says]));
  for (const [path, made] of rows) {
    const text = turned[path] ?? made.control.text;
    made.line.classList.toggle("turned", path in turned);
    if (path !== held && document.activeElement !== made.field) made.field.value = text;
    if (path !== held && made.slider) {
      const value = numberOf(made.control, text);
      if (!Number.isNaN(value)) {
        made.slider.min = Math.min(made.control.low, value);
        made.slider.max = Math.max(made.control.high, value);
        made.slider.value = value;
      }
      made.slider.ariaValueText = text;
    }
    const says = wrong.get(path);
    made.wrong.hidden = !says;
    made.wrong.textContent = says ?? "";
    made.field.setAttribute("aria-invalid", String(Boolean(says)));
    if (says) {
      made.field.setAttribute("aria-describedby", made.wrong.id);
      made.line.closest("details").open = true;
    } else made.field.removeAttribute("aria-describedby");
  }
}

// ---- the state of the session

// A text that is the same is not written again: who hears the page would hear it again.
function write(id, text) { if (get(id).textContent !== text) get(id).textContent = text; }

function heard(next) {
  session = next;
  document.title = `${next.scene}: mdlgen live`;
  write("scene", next.scene);
  write("command", next.command);
  const turned = Object.keys(next.turned).length;
  get("write").disabled = get("reset").disabled = !turned;
  complain(next.errors);
  const bar = get("progress"), { progress, word, busy, errors, run } = next;
  bar.hidden = !progress;
  if (progress) bar.value = progress.time / progress.end;
  const doing = { preparing: "preparing the solver, once on this machine", compiling: "compiling the solver, once on this machine (some minutes)" }[word];
  get("far").textContent = progress ? `${progress.time.toFixed(1)} of ${number(progress.end)} ms` : "";
  const what = doing ?? (busy ? "running" : errors.length ? "the last run that was right is shown" : run.solved_s === null ? "up to date" : `up to date, solved in ${number(run.solved_s)} s`);
  write("status", `${next.file}: ${what}${run.kind === "draft" ? "; a draft at a coarse step is shown" : ""}`);
  if (listed !== next.controls) { listed = next.controls; ask("controls").then((found) => { list(found); show(session.turned, session.errors); }); }
  if (written !== next.text) { written = next.text; ask("text").then(({ text }) => numberLines(text)); }
  show(next.turned, next.errors);
  fetchRun();
  document.documentElement.dataset.ready = "yes";
}

function complain(errors) {
  const text = errors.map((error) => error.says).join("\n");
  if (get("errors").dataset.text !== text) {
    get("errors").dataset.text = text;
    get("errors").replaceChildren(...errors.map((error) => {
      const made = piece("p", { className: "bad" });
      if (error.line) piece("a", { href: "#lines", textContent: error.says }, made).addEventListener("click", (event) => { event.preventDefault(); lineOf(error.line)?.scrollIntoView({ block: "center" }); });
      else made.textContent = error.says;
      return made;
    }));
  }
  markLines(errors);
}

const lineOf = (line) => document.querySelector(`#lines div[data-line="${line}"]`);

function numberLines(text) {
  const lines = text.split("\n");
  if (lines.length > MOST_LINES) { get("lines").textContent = text; return; }
  if (lines.at(-1) === "") lines.pop();
  get("lines").replaceChildren(...lines.map((line, k) => { const made = piece("div", { textContent: line }); made.dataset.line = k + 1; return made; }));
  markLines(session.errors);
}

function markLines(errors) {
  for (const old of document.querySelectorAll("#lines p")) old.remove();
  for (const old of document.querySelectorAll("#lines .wrong")) old.classList.remove("wrong");
  for (const error of errors) {
    const line = error.line && lineOf(error.line);
    if (!line) continue;
    line.classList.add("wrong");
    line.after(piece("p", { textContent: error.says }));
  }
}

// ---- the run

let fetching = false;
async function fetchRun() {
  if (fetching) return;
  fetching = true;
  try {
    while (session.run.number !== live.seen || session.run.kind !== live.kind) {
      const { number: wanted, kind } = session.run;
      const found = wanted === live.seen ? null : await ask("run");
      if (found) take(found, kind);
      await new Promise((done) => requestAnimationFrame(() => setTimeout(done))); // it is drawn
      goOn();
      live.seen = wanted;
      live.kind = kind;
      live.log.push({ number: wanted, kind, at: performance.now() });
      if (live.log.length > 1000) live.log.shift();
      if (found) describe(found, kind); // what is drawn in space is seen first
      document.documentElement.dataset.shown = `${wanted} ${kind}`;
    }
  } catch (error) {
    say(error.message, true);
  }
  fetching = false;
}

// Draws a run in the place of the one before; the view, the colour and the time stay.
function take(found, kind) {
  const first = !runs.length, grows = kind === "part" || kind === "start";
  const atEnd = !first && state.time >= end() - 1e-9 && !growing;
  runs[0] = { ...found, panels: found.panels ?? runs[0]?.panels ?? [] };
  stage?.replace(0, found.animation);
  choose(0);
  if (found.animation.static && !atRest) colour(shown().colours.findIndex((c) => c.name === "curvature")); // what bends
  atRest = found.animation.static;
  if (first) { view("iso"); fitted(); }
  else refit();
  if (!timed) {
    rate(rates.findIndex((r) => r >= (end() - start()) / 10));
    timed = !grows; // a choice of one's own stays
  }
  if (growing && state.time !== placed) kept = state.time; // moved by hand meanwhile
  if (grows) {
    if (!growing) kept = first ? Infinity : atEnd ? Infinity : state.time;
    seek(kept);
    placed = state.time;
  } else {
    seek(growing ? kept : first || atEnd ? Infinity : state.time);
    kept = null;
  }
  growing = grows;
}

// The figures, numbers and words of a run; of a draft those that are in sight.
const inSight = (element) => { const { bottom, top } = element.getBoundingClientRect(); return bottom > 0 && top < window.innerHeight; };
function describe(found, kind) {
  const grows = kind === "part" || kind === "start";
  get("panels").classList.toggle("stale", grows);
  for (const name of SECTIONS) {
    const place = name === "headline" ? get("headline") : get(`html-${name}`);
    const fresh = found.html && name in found.html && (kind === "full" || inSight(place));
    if (fresh) place.innerHTML = found.html[name];
    place.classList.toggle("stale", !fresh);
  }
  if (!grows) {
    figures(kind === "draft");
    if (pinned && kind === "full") ghost();
  }
}
let growing = false, timed = false, atRest = false;

// The view anew where what moves takes up much more room than when it was chosen, or much less; not once the
// picture was moved by hand.
const MUCH = 1.4;
let room = 0, byHand = false;
function refit() {
  const { step } = runs[0].animation, now = Math.hypot(...step);
  if (byHand || !state.view || (now < MUCH * room && now > room / MUCH)) return;
  view(state.view);
  fitted();
}
function fitted() { room = runs.length ? Math.hypot(...runs[0].animation.step) : 0; byHand = false; }
for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", fitted);
for (const kind of ["wheel", "pointerdown"]) get("canvas").addEventListener(kind, () => { byHand = true; });

// The figures anew; lines that were hidden stay so. While a value is dragged, those that are in sight.
function figures(draft) {
  const shownRuns = pinned ? [{ ...runs[0], name: "current" }, pinned] : [runs[0]];
  const wanted = [...new Set(shownRuns.flatMap((run) => run.panels.map((panel) => panel.key)))];
  const there = new Map([...get("panels").children].map((figure) => [figure.dataset.key, figure]));
  for (const [key, figure] of there) if (!wanted.includes(key)) { made.get(key).drop(); made.delete(key); figure.remove(); }
  for (const key of wanted) {
    const old = there.get(key);
    if (old && draft && !inSight(old)) continue;
    const hidden = old ? [...old.querySelectorAll('.key[aria-pressed="false"]')].map((button) => button.dataset.name) : [];
    const fresh = chart(get("panels"), shownRuns, key, (time) => seek(time));
    if (old) { made.get(key).drop(); old.replaceWith(fresh.figure); }
    made.set(key, fresh);
    for (const button of fresh.figure.querySelectorAll("button.key")) if (hidden.includes(button.dataset.name)) button.click();
  }
  movers.splice(0, movers.length, ...[...made.values()].map((one) => one.move));
  mark();
}
const made = new Map(); // figures by their keys

// ---- two designs

function pin() {
  if (pinned) pinned = null;
  else if (runs.length) {
    const values = Object.entries(session.turned).map(([path, text]) => `${path} = ${text}`);
    pinned = { ...runs[0], name: "pinned", says: `pinned (${values.join(", ") || "as in the file"}): `, headline: get("headline").innerHTML };
  }
  get("pin").setAttribute("aria-pressed", String(Boolean(pinned)));
  get("pin").textContent = pinned ? "let go of the pinned design" : "pin this design";
  get("ghost").disabled = !pinned;
  get("pinned").hidden = !pinned;
  if (pinned) {
    get("pinned").replaceChildren(piece("b", { textContent: pinned.says }), ...piece("span", { innerHTML: pinned.headline }).childNodes);
  }
  ghost();
  if (runs.length) figures(false);
}

function ghost() { stage?.ghost(pinned && get("ghost").checked ? pinned.animation : null); }

// ---- controls

get("filter").addEventListener("input", find);
get("several").addEventListener("submit", async (event) => {
  event.preventDefault();
  try { await ask("add", { path: get("pattern").value }); get("pattern").value = ""; say(""); } catch (error) { say(error.message, true); }
});
get("reset").addEventListener("click", () => turn(Object.fromEntries(Object.keys(session.turned).map((path) => [path, null])), false));
get("write").addEventListener("click", async () => {
  try { await ask("write", {}); say(`written into ${session.file}`); } catch (error) { say(error.message, true); }
});
get("copy").addEventListener("click", async () => {
  try { await navigator.clipboard.writeText(session.command); say("copied"); } catch {
    getSelection().selectAllChildren(get("command"));
    say("the browser does not let it be copied; it is selected");
  }
});
get("pin").addEventListener("click", pin);
get("ghost").addEventListener("change", ghost);

try {
  stage = await player(get("canvas"), () => view(null));
  over = overlay(stage, lines);
} catch (error) {
  get("no-drawing").hidden = false;
  get("no-drawing").textContent = `This browser does not draw in space (WebGL): ${error.message}. The figures and tables are all here.`;
}
const source = new EventSource("events");
source.addEventListener("message", (event) => heard(JSON.parse(event.data)));
source.addEventListener("error", () => { get("status").textContent = "mdlgen live has ended; what it showed last stays"; });
window.mdlgen = { state, seek, play, colour, view, choose, check, stage, runs, live, rows, session: () => session };
