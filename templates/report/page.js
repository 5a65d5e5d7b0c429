// The page of one or more runs.

const panels = get("panels");
const keys = [...new Set(runs.flatMap((run) => run.panels.map((panel) => panel.key)))];
for (const key of keys) movers.push(chart(panels, runs, key, (time) => seek(time)).move);

try {
  stage = await player(get("canvas"), () => view(null));
  for (const run of runs) stage.add(run.animation);
  over = overlay(stage, lines);
} catch (error) {
  get("no-drawing").hidden = false;
  get("no-drawing").textContent = `This browser does not draw in space (WebGL): ${error.message}. The figures and tables are all here.`;
}
// nothing moves at rest: what bends is shown then
if (shown().static) state.colour = shown().colours.findIndex((c) => c.name === "curvature");
choose(0);
if (runs.length > 1) under(1);
rate(rates.findIndex((r) => r >= (end() - start()) / 10));
// what a link asks for, as #t=18&view=xz&colour=strain
const asked = new URLSearchParams(location.hash.slice(1));
view(["xz", "yz", "xy", "iso"].includes(asked.get("view")) ? asked.get("view") : "iso");
const wanted = shown().colours.findIndex((c) => c.name === asked.get("colour"));
if (wanted >= 0) colour(wanted);
seek(asked.has("t") ? Number(asked.get("t")) || 0 : shown().static ? end() : start());
window.mdlgen = { state, seek, play, colour, view, choose, under, check, stage, runs, charts: drawnCharts, zoom };
document.documentElement.dataset.ready = "yes";
