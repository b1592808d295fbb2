// One run, or two together: picture, plots, time and texts.
import { button } from "./button";
import { colours } from "./colours";
import { differenceOf, type Run } from "./data";
import { FlatView } from "./flat";
import { aboutDialog, helpDialog, legend, licence, Values } from "./panel";
import { Player } from "./player";
import { type Curve, curvesOf, Plot } from "./plots";
import { type CameraPreset, SceneView } from "./scene";
import { Timeline } from "./timeline";

const standard: [string, string, string][] = [
  ["force", colours.force, "force"],
  ["signed_distance", colours.truth, "distance to the true surface"],
  ["contact_count", colours.normal, "contacts"],
  ["surface_velocity", colours.velocity, "velocity estimate"],
];

function firstTicksOfFrames(run: Run): number[] {
  const frames = run.column("frame_index"), list: number[] = [];
  for (let tick = 0; tick < run.ticks; ++tick)
    if (tick === 0 || frames.value(tick) !== frames.value(tick - 1)) list.push(tick);
  return list;
}

// A column that is the same in all ticks says nothing.
function changes(curve: Curve): boolean {
  const first = curve.column.numbers[0];
  return curve.column.numbers.some((value) => Number.isFinite(value) && value !== first);
}

function makePlots(runs: Run[], player: Player): HTMLElement {
  const box = document.createElement("section");
  const plots = standard.map(([name, colour, label]) => curvesOf(runs, name, colour, label).filter(changes))
    .filter((curves) => curves.length > 0)
    .map((curves) => new Plot(curves, player.ticks, (tick) => player.go(tick)));
  for (const [name, colour] of runs.length === 2 ? [["force", colours.force], ["proxy_position", colours.proxy]] : []) {
    const column = differenceOf(runs, name);
    if (column) plots.push(new Plot([{ column, colour, label: column.name, dashed: false }], player.ticks, (tick) => player.go(tick)));
  }
  const chosen = new Plot([], player.ticks, (tick) => player.go(tick)), choice = document.createElement("select");
  for (const name of runs[0].columns.keys()) choice.add(new Option(name, name));
  const choose = () => chosen.setCurves(curvesOf(runs, choice.value, colours.proxy, choice.value));
  choice.addEventListener("change", choose);
  choice.value = "nearest_distance";
  choose();
  box.append(...plots.map((plot) => plot.element), choice, chosen.element);
  for (const plot of [...plots, chosen]) player.onChange(() => plot.show(player.tick));
  return box;
}

function makePicture(runs: Run[]): { box: HTMLElement; show: (tick: number) => void; scene: SceneView | null } {
  const box = document.createElement("div"), canvas = document.createElement("canvas"), bar = document.createElement("span");
  box.className = "picture";
  bar.className = "bar";
  box.append(canvas, bar);
  try {
    const scene = new SceneView(canvas, bar, runs);
    return { box, scene, show: (tick) => scene.show(tick) };
  } catch (error) {
    const note = document.createElement("p");
    note.className = "note";
    note.textContent = `No 3-D here (${(error as Error).message}). From the side instead: x to the right, y up.`;
    const plain = document.createElement("canvas"); // the first may have a context already
    box.replaceChildren(plain, note);
    const flat = new FlatView(plain, runs);
    return { box, scene: null, show: (tick) => flat.show(tick) };
  }
}

function cameraButtons(scene: SceneView): HTMLElement[] {
  return (["sensor", "side", "follow"] as CameraPreset[]).map((preset, i) =>
    button(preset, `camera (${i + 1})`, () => scene.setCamera(preset)));
}

function listenToKeys(player: Player, timeline: Timeline, scene: SceneView | null, dialogs: Record<string, HTMLDialogElement>,
  signal: AbortSignal): void {
  const hidden = new Set<string>(["spheres"]);
  const toggle = (what: "truth" | "regions" | "spheres") => {
    if (!hidden.delete(what)) hidden.add(what);
    scene?.setVisible(what, !hidden.has(what));
  };
  const acts: Record<string, () => void> = {
    " ": () => player.toggle(), ",": () => player.step(-1), ".": () => player.step(1), e: () => timeline.nextEvent(),
    ArrowLeft: () => timeline.stepFrame(-1), ArrowRight: () => timeline.stepFrame(1),
    "-": () => timeline.faster(-1), "+": () => timeline.faster(1),
    1: () => scene?.setCamera("sensor"), 2: () => scene?.setCamera("side"), 3: () => scene?.setCamera("follow"),
    t: () => toggle("truth"), r: () => toggle("regions"), s: () => toggle("spheres"),
    i: () => dialogs.about.showModal(), h: () => dialogs.help.showModal(), "?": () => dialogs.help.showModal(),
  };
  document.addEventListener("keydown", (event) => {
    const act = acts[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey || event.target instanceof HTMLSelectElement || document.querySelector("dialog[open]"))
      return;
    event.preventDefault();
    act();
  }, { signal });
}

// Where two runs part; of one run where the hand begins to feel a good part of the largest force.
function opensAt(run: Run): number {
  const divergence = run.stored.events.find((event) => event.kind === "divergence");
  if (divergence) return divergence.tick;
  const force = run.column("force");
  let largest = 0, tick = 0;
  for (let i = 0; i < run.ticks; ++i) largest = Math.max(largest, force.magnitude(i) || 0);
  while (tick < run.ticks - 1 && !(force.magnitude(tick) > 0.4 * largest)) ++tick;
  return largest > 0 ? tick : 0;
}

// top: shown above the plots. end() takes it off the document.
export function showRuns(runs: Run[], top: HTMLElement | null): { player: Player; scene: SceneView | null; end: () => void } {
  const run = runs[0], ended = new AbortController();
  const player = new Player(Math.max(...runs.map((one) => one.ticks)), run.stored.haptic_rate_hz);
  const timeline = new Timeline(player, run.stored.events, firstTicksOfFrames(run),
    (tick) => run.column("time").value(Math.min(tick, run.ticks - 1)));
  const picture = makePicture(runs), values = new Values(runs);
  const dialogs = { help: helpDialog(), about: aboutDialog(runs, licence) };
  const head = document.createElement("header"), title = document.createElement("h1"), side = document.createElement("aside");
  title.textContent = run.stored.title || run.stored.file;
  head.append(title, ...(picture.scene ? cameraButtons(picture.scene) : []));
  head.append(button("What is this of?", "configuration and command (i)", () => dialogs.about.showModal()),
    button("Keys", "mouse and keys (h)", () => dialogs.help.showModal()));
  const details = document.createElement("details"), summary = document.createElement("summary");
  summary.textContent = "All columns at this tick";
  details.append(summary, values.element);
  side.append(...notes(runs), ...(top ? [top] : []), makePlots(runs, player), legend(run, picture.scene?.mmPerN ?? 5), details);
  for (const one of runs) {
    const shown = document.createElement("p");
    shown.className = "shown";
    shown.textContent = one.stored.shown;
    side.append(shown);
  }
  const parts = [head, picture.box, side, timeline.element, dialogs.help, dialogs.about];
  document.body.append(...parts);
  player.onChange(() => {
    picture.show(player.tick);
    if (details.open) values.show(player.tick);
  });
  details.addEventListener("toggle", () => values.show(player.tick));
  listenToKeys(player, timeline, picture.scene, dialogs, ended.signal);
  player.step(opensAt(run));
  const end = () => {
    player.stop();
    ended.abort();
    picture.scene?.dispose();
    for (const part of parts) part.remove();
  };
  return { player, scene: picture.scene, end };
}

function notes(runs: Run[]): HTMLElement[] {
  return runs.filter((run) => run.stored.note).map((run) => {
    const note = document.createElement("p");
    note.className = "warning";
    note.textContent = run.stored.note;
    return note;
  });
}
