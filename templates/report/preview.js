// A scene as it begins: names, axes and scale over the picture, and what is known of what is under the pointer.

const scene = JSON.parse(document.getElementById("data").textContent);
const get = (id) => document.getElementById(id);
const state = { view: null, colour: 0, over: null, pinned: null, names: true };
let stage = null;

const parts = new Map(scene.parts.map((part) => [part.name, part]));
const labels = scene.parts.map((part) => {
  const made = document.createElement("span");
  made.textContent = part.lints.length ? `${part.name} ⚠` : part.name;
  made.className = part.lints.length ? "bad" : "";
  made.dataset.part = part.name;
  get("labels").append(made);
  return { part, made, wide: 0, high: 0 };
});
// those that are in the way of others give way: probes to parts, parts without a warning to those with one
const ORDER = ["sheet", "roller", "mesh", "guide", "plane", "probe"];
const rank = ({ part }) => (part.name === (state.over ?? state.pinned) ? -200 : 0) - (part.lints.length ? 100 : 0) + ORDER.indexOf(part.kind);

function place() {
  const taken = [];
  const chosen = state.over ?? state.pinned;
  const mates = new Set(chosen ? parts.get(chosen)?.contacts.map((text) => text.split(":")[0]) : []);
  const { clientWidth: width, clientHeight: height } = get("canvas");
  for (const label of [...labels].sort((a, b) => rank(a) - rank(b))) {
    const [x, y] = stage.project(label.part.at);
    if (!label.wide) { label.wide = label.made.offsetWidth; label.high = label.made.offsetHeight; }
    // beside the part's middle, so that this is seen
    const box = [x + 6, y - label.high / 2, x + 6 + label.wide, y + label.high / 2];
    const inside = x > 0 && y > 0 && x < width && y < height;
    const free = taken.every((other) => box[2] < other[0] || box[0] > other[2] || box[3] < other[1] || box[1] > other[3]);
    const seen = state.names && inside && free;
    if (seen) taken.push(box);
    label.made.style.visibility = seen ? "visible" : "hidden";
    label.made.style.transform = `translate(${box[0]}px, ${box[1]}px)`;
    label.made.classList.toggle("chosen", label.part.name === chosen);
    label.made.classList.toggle("mate", mates.has(label.part.name));
  }
}

function axes() {
  const svg = get("axes");
  svg.replaceChildren();
  const size = Math.hypot(...scene.gravity);
  const ways = [["x", [1, 0, 0], "--line-1"], ["y", [0, 1, 0], "--line-2"], ["z", [0, 0, 1], "--line-0"]];
  if (size > 0) ways.push(["g", scene.gravity.map((g) => g / size), "--text"]);
  for (const [name, way, tone] of ways.sort((a, b) => stage.seenAlong(a[1])[2] - stage.seenAlong(b[1])[2])) {
    const [x, y] = stage.seenAlong(way);
    const [length, off] = name === "g" ? [22, 31] : [30, 40];
    element("line", { x1: 0, y1: 0, x2: length * x, y2: -length * y, style: `stroke: var(${tone})`, "stroke-dasharray": name === "g" ? "3 2" : "" }, svg);
    // seen along its way it is a point, which has its name beside it
    const flat = Math.hypot(x, y) < 0.2;
    const text = element("text", { x: flat ? 8 : off * x, y: (flat ? 12 : -off * y) + 4, style: `fill: var(${tone})`, "text-anchor": "middle" }, svg);
    text.textContent = name;
  }
}

function scale() {
  const per = stage.pixelsPerMm();
  const raw = 130 / per, tens = 10 ** Math.floor(Math.log10(raw));
  const length = tens * [5, 2, 1].find((k) => k * tens <= raw);
  get("scale").style.width = `${length * per}px`;
  get("scale").firstElementChild.textContent = length >= 1 ? `${number(length)} mm` : `${number(1000 * length)} um`;
}

function lines(found) {
  if (!found) return null;
  if (found.mesh?.says) return { part: found.mesh.name, title: found.mesh.name, texts: [found.mesh.says] };
  const name = found.mesh ? found.mesh.name.split(" ")[0] : scene.sheets.findLast((s) => found.box >= s.first).name;
  const part = parts.get(name);
  if (!part) return null;
  const texts = [...part.facts];
  if (found.box !== undefined) {
    const sheet = scene.sheets.find((s) => s.name === name), own = found.box - sheet.first;
    const zones = sheet.zones.filter(([, boxes]) => boxes.includes(own)).map(([zone]) => zone);
    texts.push(`box ${own % sheet.n_x + 1}, ${Math.floor(own / sheet.n_x) + 1}${zones.length ? ` in ${zones.join(", ")}` : ""}`);
    const { name: what, unit, most, values } = stage.runs[0].colours[state.colour];
    if (unit) texts.push(`${what} ${number(most * values[found.box] / 255)} ${unit}`);
  }
  return { part: name, title: `${name} (${part.kind})`, texts, contacts: part.contacts, lints: part.lints };
}

function tell(found, x, y) {
  const said = lines(found), tip = get("tip");
  const before = state.over;
  state.over = said?.part ?? null;
  tip.hidden = !said;
  if (said) {
    tip.replaceChildren();
    const add = (tag, text, kind = "") => { const made = document.createElement(tag); made.textContent = text; made.className = kind; tip.append(made); };
    add("b", said.title);
    for (const text of said.texts) add("div", text);
    for (const text of said.contacts ?? []) add("div", `contact with ${text}`, "contact");
    for (const text of said.lints ?? []) add("div", text, "bad");
    const { clientWidth: width, clientHeight: height } = get("canvas");
    tip.style.left = `${Math.max(4, Math.min(x + 14, width - tip.offsetWidth - 6))}px`;
    tip.style.top = `${Math.max(4, Math.min(y + 14, height - tip.offsetHeight - 6))}px`;
  }
  if (before !== state.over) place();
}

function pin(name) {
  state.pinned = state.pinned === name ? null : name;
  for (const button of document.querySelectorAll("[data-part].key")) button.setAttribute("aria-pressed", String(button.dataset.part === state.pinned));
  if (state.pinned) get("stage").scrollIntoView({ block: "nearest" });
  place();
}

function colour(index) {
  const colours = scene.animation.colours;
  state.colour = (index + colours.length) % colours.length;
  get("colour").value = state.colour;
  const { name, unit, most } = colours[state.colour];
  const legend = get("legend");
  legend.replaceChildren();
  const piece = (text, kind, parent) => { const made = document.createElement("div"); made.textContent = text; made.className = kind; parent.append(made); return made; };
  const keys = scene.keys[name];
  if (keys) {
    for (const [text, part] of keys) {
      const row = piece("", "chip", legend);
      piece("", "spot", row).style.background = ramp(part);
      piece(text, "", row);
    }
  } else {
    piece({ depth: "how deep boxes are in rollers", thickness: "thickness" }[name], "", legend);
    piece("", "ramp", legend).style.background = RAMP;
    const ends = piece("", "ends", legend);
    piece("0", "", ends);
    piece(`${number(most)} ${unit}`, "", ends);
  }
  stage?.colour(state.colour);
}

function ramp(part) {
  const at = part * (VIRIDIS.length - 1), first = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return `color-mix(in srgb, ${VIRIDIS[first + 1]} ${100 * (at - first)}%, ${VIRIDIS[first]})`;
}

function view(name) {
  state.view = name;
  for (const button of document.querySelectorAll("[data-view]")) button.setAttribute("aria-pressed", String(button.dataset.view === name));
  if (name) stage?.view(name);
}

const canvas = get("canvas");
let asked = null;
canvas.addEventListener("pointermove", (event) => {
  if (event.buttons) { tell(null); return; }
  if (!asked) requestAnimationFrame(() => { const [x, y] = asked; asked = null; tell(stage?.pick(x, y), x, y); });
  asked = [event.offsetX, event.offsetY];
});
canvas.addEventListener("pointerleave", () => tell(null));
for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => view(button.dataset.view));
for (const button of document.querySelectorAll(".key[data-part]")) button.addEventListener("click", () => pin(button.dataset.part));
get("nearer").addEventListener("click", () => stage?.near());
get("colour").addEventListener("change", (event) => colour(Number(event.target.value)));
get("names").addEventListener("change", (event) => { state.names = event.target.checked; place(); });
for (const id of ["arrows", "machine"]) get(id).addEventListener("change", (event) => stage?.[id](event.target.checked));
document.addEventListener("keydown", (event) => {
  if (event.target.matches("select, input, button") || event.ctrlKey || event.metaKey || event.altKey) return;
  const views = { 1: "xz", 2: "yz", 3: "xy", 4: "iso" };
  if (views[event.key]) view(views[event.key]);
  else if (event.key === "n") stage?.near();
  else if (event.key === "c") colour(state.colour + 1);
});

try {
  stage = await player(canvas, () => view(null));
  stage.add(scene.animation);
  stage.drew = () => { place(); axes(); scale(); };
  stage.choose(0);
} catch (error) {
  get("no-drawing").hidden = false;
  get("no-drawing").textContent = `This browser does not draw in space (WebGL): ${error.message}. The tables are all here.`;
}
get("colour").replaceChildren(...scene.animation.colours.map((c, k) => new Option(c.name, k)));
colour(0);
// what a link asks for, as #view=xz
const wanted = new URLSearchParams(location.hash.slice(1)).get("view");
view(["xz", "yz", "xy", "iso"].includes(wanted) ? wanted : "iso");
window.mdlgen = { state, view, colour, tell, pin, stage, scene };
document.documentElement.dataset.ready = "yes";
