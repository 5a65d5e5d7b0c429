// Over the picture in space: names of parts, axes, scale, and what is known of what is under the pointer.

// those that are in the way of others give way: probes to parts, parts without a warning to those with one; kinds
// that are not listed come before planes, which are wide
const ORDER = ["sheet", "roller", "mesh", "guide", "", "plane", "probe"];
const order = (kind) => (ORDER.includes(kind) ? ORDER.indexOf(kind) : ORDER.indexOf(""));

// `stage` draws, `lines` says what is known of something that was hit: part, title, texts, contacts, lints.
function overlay(stage, lines) {
  const get = (id) => document.getElementById(id);
  const canvas = get("canvas");
  const own = { over: null, pinned: null, names: true, scene: null, chosen: null };
  let parts = new Map(), labels = [];

  // Another scene: its parts with `at` [mm], `row` of what they move with, contacts and lints.
  own.take = (scene) => {
    own.scene = scene;
    parts = new Map(scene.parts.map((part) => [part.name, part]));
    labels = scene.parts.map((part) => {
      const bad = Boolean(part.lints?.length);
      const made = piece("span", { textContent: bad ? `${part.name} ⚠` : part.name, className: bad ? "bad" : "" });
      made.dataset.part = part.name;
      return { part, made, wide: 0, high: 0 };
    });
    get("labels").replaceChildren(...labels.map((label) => label.made));
  };
  const rank = ({ part }) => (part.name === (own.over ?? own.pinned) ? -200 : 0) - (part.lints?.length ? 100 : 0) + order(part.kind);

  own.place = () => {
    const taken = [];
    const chosen = own.over ?? own.pinned;
    const mates = new Set(chosen ? parts.get(chosen)?.contacts?.map((text) => text.split(":")[0]) : []);
    const [width, height] = stage.size();
    for (const label of [...labels].sort((a, b) => rank(a) - rank(b))) {
      const [x, y] = stage.project(stage.where(label.part));
      if (!label.wide) { label.wide = label.made.offsetWidth; label.high = label.made.offsetHeight; }
      // beside the part's middle, so that this is seen
      const box = [x + 6, y - label.high / 2, x + 6 + label.wide, y + label.high / 2];
      const inside = x > 0 && y > 0 && x < width && y < height;
      const free = taken.every((other) => box[2] < other[0] || box[0] > other[2] || box[3] < other[1] || box[1] > other[3]);
      const seen = own.names && inside && free;
      if (seen) taken.push(box);
      label.made.style.visibility = seen ? "visible" : "hidden";
      label.made.style.transform = `translate(${box[0]}px, ${box[1]}px)`;
      label.made.classList.toggle("chosen", label.part.name === chosen);
      label.made.classList.toggle("mate", mates.has(label.part.name));
    }
  };

  function axes() {
    const svg = get("axes"), { gravity } = own.scene;
    svg.replaceChildren();
    const size = Math.hypot(...gravity);
    const ways = [["x", [1, 0, 0], "--line-1"], ["y", [0, 1, 0], "--line-2"], ["z", [0, 0, 1], "--line-0"]];
    if (size > 0) ways.push(["g", gravity.map((g) => g / size), "--text"]);
    for (const [name, way, tint] of ways.sort((a, b) => stage.seenAlong(a[1])[2] - stage.seenAlong(b[1])[2])) {
      const [x, y] = stage.seenAlong(way);
      const [length, off] = name === "g" ? [22, 31] : [30, 40];
      element("line", { x1: 0, y1: 0, x2: length * x, y2: -length * y, stroke: `var(${tint})`, "stroke-dasharray": name === "g" ? "3 2" : "" }, svg);
      // seen along its way it is a point, which has its name beside it
      const flat = Math.hypot(x, y) < 0.2;
      const text = element("text", { x: flat ? 8 : off * x, y: (flat ? 12 : -off * y) + 4, "text-anchor": "middle" }, svg);
      text.style.fill = `var(${tint})`;
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

  // axes and scale stay as they are while the picture only plays
  let looked = "";
  own.drew = () => {
    if (!own.scene) return;
    own.place();
    const look = JSON.stringify([stage.seenAlong([1, 0, 0]), stage.seenAlong([0, 1, 0]), stage.pixelsPerMm(), own.scene.gravity]);
    if (look !== looked) { axes(); scale(); }
    looked = look;
  };

  own.tell = (found, x, y) => {
    const said = found ? lines(found, parts) : null, tip = get("tip");
    const before = own.over;
    own.over = said?.part ?? null;
    tip.hidden = !said;
    if (said) {
      tip.replaceChildren();
      const add = (tag, text, kind = "") => piece(tag, { textContent: text, className: kind }, tip);
      add("b", said.title);
      for (const text of said.texts) add("div", text);
      for (const text of said.contacts ?? []) add("div", `contact with ${text}`, "contact");
      for (const text of said.lints ?? []) add("div", text, "bad");
      const [width, height] = stage.size();
      tip.style.left = `${Math.max(4, Math.min(x + 14, width - tip.offsetWidth - 6))}px`;
      tip.style.top = `${Math.max(4, Math.min(y + 14, height - tip.offsetHeight - 6))}px`;
    }
    if (before !== own.over) own.place();
  };

  let asked = null;
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons || !own.scene) { own.tell(null); return; }
    if (!asked) requestAnimationFrame(() => { const [x, y] = asked; asked = null; own.tell(stage.pick(x, y), x, y); });
    asked = [event.offsetX, event.offsetY];
  });
  canvas.addEventListener("pointerleave", () => own.tell(null));
  get("names").addEventListener("change", (event) => { own.names = event.target.checked; own.place(); });
  stage.drew = own.drew;
  return own;
}

// Print has the picture as one that stays, and figures of its own size, in the light colours.
function onPaper(stageOf, charts = []) {
  const print = (on) => {
    document.documentElement.toggleAttribute("data-print", on);
    for (const one of charts) one.print(on);
    stageOf()?.print(on, document.getElementById("printed"));
  };
  window.addEventListener("beforeprint", () => print(true));
  window.addEventListener("afterprint", () => print(false));
}

// What is known of a part, and of the box of a sheet that was hit.
function ofPart(found, parts, scene) {
  const name = found.mesh ? found.mesh.name.split(" ")[0] : scene.sheets.findLast((s) => found.box >= s.first).name;
  const part = parts.get(name);
  if (!part) return null;
  const texts = [...part.facts];
  if (found.box !== undefined) {
    const sheet = scene.sheets.find((s) => s.name === name), own = found.box - sheet.first;
    const zones = sheet.zones.filter(([, boxes]) => boxes.includes(own)).map(([zone]) => zone);
    texts.push(`box ${own % sheet.n_x + 1}, ${Math.floor(own / sheet.n_x) + 1}${zones.length ? ` in ${zones.join(", ")}` : ""}`);
  }
  return { part: name, title: `${name} (${part.kind})`, texts, contacts: part.contacts, lints: part.lints };
}

// A part of the ramp of colours.
function rampAt(part) {
  const at = part * (VIRIDIS.length - 1), first = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return `color-mix(in srgb, ${VIRIDIS[first + 1]} ${100 * (at - first)}%, ${VIRIDIS[first]})`;
}

// The legend of a colour: names where it is no number, else a ramp with its ends, and what is beyond them.
const COLOUR_WORDS = {
  speed: "speed", strain: "strain of the box's joints", curvature: "curvature of the box's joints", contact: "contact force of the box",
  depth: "how deep boxes are in rollers", thickness: "thickness",
};
function legendOf(colour, keys) {
  const legend = document.getElementById("legend");
  legend.replaceChildren();
  const put = (text, className, parent = legend) => piece("div", { textContent: text, className }, parent);
  if (keys) {
    for (const [text, part] of keys) {
      const row = put("", "chip");
      put("", "spot", row).style.background = rampAt(part);
      put(text, "", row);
    }
    return;
  }
  put(COLOUR_WORDS[colour.name], "");
  put("", "ramp").style.background = RAMP;
  const ends = put("", "ends");
  for (const value of [colour.least, colour.most]) piece("span", { textContent: `${number(value)}${colour.unit ? ` ${colour.unit}` : ""}` }, ends);
  if (colour.beyond) put(colour.beyond, "beyond");
}
