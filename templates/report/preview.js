// A scene as it begins: names, axes and scale over the picture, and what is known of what is under the pointer.

const scene = JSON.parse(document.getElementById("data").textContent);
const get = (id) => document.getElementById(id);
const state = { view: null, colour: 0 };
let stage = null, over = null;

function lines(found, parts) {
  if (found.mesh?.says) return { part: found.mesh.name, title: found.mesh.name, texts: [found.mesh.says] };
  const said = ofPart(found, parts, scene);
  if (said && found.box !== undefined) {
    const { name: what, unit, least, most, values } = stage.runs[0].colours[state.colour];
    if (unit) said.texts.push(`${what} ${number(least + (most - least) * values[found.box] / 255)} ${unit}`);
  }
  return said;
}

function pin(name) {
  if (!over) return;
  over.pinned = over.pinned === name ? null : name;
  for (const button of document.querySelectorAll("[data-part].key")) button.setAttribute("aria-pressed", String(button.dataset.part === over.pinned));
  if (over.pinned) get("stage").scrollIntoView({ block: "nearest" });
  over.place();
}

function colour(index) {
  const colours = scene.animation.colours;
  state.colour = (index + colours.length) % colours.length;
  get("colour").value = state.colour;
  legendOf(colours[state.colour], scene.keys[colours[state.colour].name]);
  stage?.colour(state.colour);
}

function view(name) {
  state.view = name;
  for (const button of document.querySelectorAll("[data-view]")) button.setAttribute("aria-pressed", String(button.dataset.view === name));
  if (name) stage?.view(name);
}

for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => view(button.dataset.view));
for (const button of document.querySelectorAll(".key[data-part]")) button.addEventListener("click", () => pin(button.dataset.part));
get("nearer").addEventListener("click", () => stage?.near());
get("colour").addEventListener("change", (event) => colour(Number(event.target.value)));
for (const id of ["arrows", "machine"]) get(id).addEventListener("change", (event) => stage?.[id](event.target.checked));
document.addEventListener("keydown", (event) => {
  if (event.target.matches("select, input, button") || event.ctrlKey || event.metaKey || event.altKey) return;
  const views = { 1: "xz", 2: "yz", 3: "xy", 4: "iso" };
  if (views[event.key]) view(views[event.key]);
  else if (event.key === "n") stage?.near();
  else if (event.key === "c") colour(state.colour + 1);
});

onPaper(() => stage);
try {
  stage = await player(get("canvas"), () => view(null));
  stage.add(scene.animation);
  over = overlay(stage, lines);
  over.take(scene);
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
window.mdlgen = { state, view, colour, pin, stage, scene, tell: over?.tell };
document.documentElement.dataset.ready = "yes";
