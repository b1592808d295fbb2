// One run, or two together: picture, plots, time and texts.
import { button } from "./button";
import { colours } from "./colours";
import { differenceOf, type Run, type RunEvent } from "./data";
import { FlatView } from "./flat";
import { Pace } from "./pace";
import { aboutDialog, helpDialog, legend, licence, Values, whichIsWhich } from "./panel";
import { Player } from "./player";
import { type Curve, curvesOf, forceCurves, Plot } from "./plots";
import { type CameraPreset, SceneView } from "./scene";
import { Timeline } from "./timeline";

// The surface of a recording is what its camera measured. Of a tool the distance is that of its centre.
function distanceLabel(run: Run): string {
  const { scenario } = run.stored.configuration as { scenario?: { name?: string } };
  const surface = ["recording", "live-session"].includes(scenario?.name ?? "") ? "measured surface" : run.truthName;
  return run.stored.tool ? `tool's centre to the ${surface}` : `distance to the ${surface}`;
}

function standard(run: Run): [string, string, string][] {
  return [
    ["signed_distance", colours.truth, distanceLabel(run)],
    ["contact_count", colours.normal, "contacts"],
    ["surface_velocity", colours.velocity, "velocity estimate"],
  ];
}

// Of two runs those of both, and whose they are.
function eventsOf(runs: Run[]): RunEvent[] {
  if (runs.length === 1) return runs[0].stored.events;
  return runs.flatMap((run, i) => run.stored.events.map((event) =>
    event.kind === "divergence" ? event : { ...event, text: `Run ${i + 1}: ${event.text}` })).sort((a, b) => a.tick - b.tick);
}

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
  const plotOf = (curves: Curve[]) => new Plot(curves, player.ticks, runs[0].stored.haptic_rate_hz, (tick) => player.go(tick));
  const standards = standard(runs[0]).map(([name, colour, label]) => curvesOf(runs, name, colour, label));
  const plots = [forceCurves(runs), ...standards].map((curves) => curves.filter(changes)).filter((curves) => curves.length > 0).map(plotOf);
  for (const [name, colour] of runs.length === 2 ? [["force", colours.force], ["proxy_position", colours.proxy]] : []) {
    const column = differenceOf(runs, name);
    if (column) plots.push(plotOf([{ column, colour, label: column.name, dashed: false }]));
  }
  const chosen = plotOf([]), choice = document.createElement("select");
  for (const name of runs[0].columns.keys()) choice.add(new Option(name, name));
  const choose = () => chosen.setCurves(curvesOf(runs, choice.value, colours.proxy, choice.value));
  choice.addEventListener("change", () => {
    choose();
    choice.blur(); // keys are for the time
  });
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
  const force = run.column(run.forceName);
  let largest = 0, tick = 0;
  for (let i = 0; i < run.ticks; ++i) largest = Math.max(largest, force.magnitude(i) || 0);
  while (tick < run.ticks - 1 && !(force.magnitude(tick) > 0.4 * largest)) ++tick;
  return largest > 0 ? tick : 0;
}

// While it plays, slow graphics draw fewer points; a picture that stands has all of them.
function keepPace(player: Player, timeline: Timeline, scene: SceneView): void {
  let pace = new Pace();
  const draw = (share: number) => {
    for (const cloud of scene.clouds) cloud.setShare(share);
    timeline.tell(share < 1 ? `slow graphics: 1 of ${1 / share} points` : "");
  };
  player.onChange(() => {
    if (player.playing && pace.picture(performance.now())) draw(pace.share);
    if (player.playing || pace.share === 1) return;
    pace = new Pace();
    draw(1);
  });
}

// top: shown above the plots. end() takes it off the document.
export function showRuns(runs: Run[], top: HTMLElement | null, heading = ""): { player: Player; scene: SceneView | null; end: () => void } {
  const run = runs[0], ended = new AbortController();
  const player = new Player(Math.max(...runs.map((one) => one.ticks)), run.stored.haptic_rate_hz);
  const timeline = new Timeline(player, eventsOf(runs), firstTicksOfFrames(run),
    (tick) => run.column("time").value(Math.min(tick, run.ticks - 1)));
  const picture = makePicture(runs), values = new Values(runs);
  const dialogs = { help: helpDialog(), about: aboutDialog(runs, licence) };
  const head = document.createElement("header"), title = document.createElement("h1"), side = document.createElement("aside");
  title.textContent = title.title = heading || run.stored.title || run.stored.file;
  head.append(title, ...(picture.scene ? cameraButtons(picture.scene) : []));
  head.append(button("What is this?", "configuration and command (i)", () => dialogs.about.showModal()),
    button("Keys", "mouse and keys (h)", () => dialogs.help.showModal()));
  const details = document.createElement("details"), summary = document.createElement("summary");
  summary.textContent = "All columns at this tick";
  details.append(summary, values.element);
  side.append(...notes(runs), ...(runs.length === 2 ? [whichIsWhich(runs)] : []), legend(runs, picture.scene?.mmPerN ?? 5),
    ...(top ? [top] : []), makePlots(runs, player), details);
  runs.forEach((one, i) => {
    const shown = document.createElement("p");
    shown.className = "shown";
    shown.textContent = runs.length === 2 ? `Run ${i + 1}: ${one.stored.shown}` : one.stored.shown;
    side.append(shown);
  });
  const parts = [head, picture.box, side, timeline.element, dialogs.help, dialogs.about];
  document.body.append(...parts);
  player.onChange(() => {
    picture.show(player.tick);
    if (details.open) values.show(player.tick);
  });
  if (picture.scene) keepPace(player, timeline, picture.scene);
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
