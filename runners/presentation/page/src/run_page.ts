// One run, or two together: picture, plots, time and texts.
import { Address, type RunPlace } from "./address";
import { button } from "./button";
import type { Run } from "./data";
import { FlatView } from "./flat";
import { Pace, PaceNote } from "./pace";
import { aboutDialog, helpDialog, legend, licence, Values, whichIsWhich } from "./panel";
import { Player } from "./player";
import { RunPlots } from "./run_plots";
import { pictureName, savePng } from "./save";
import { type CameraPreset, SceneView } from "./scene";
import { EventList, eventsOf, mostImportantTick } from "./story";
import { Timeline } from "./timeline";

function firstTicksOfFrames(run: Run): number[] {
  const frames = run.column("frame_index"), list: number[] = [];
  let last = Number.NaN;
  for (let tick = 0; tick < run.ticks; ++tick) {
    if (!run.has(tick) || frames.value(tick) === last) continue;
    last = frames.value(tick);
    list.push(tick);
  }
  return list;
}

interface Picture {
  box: HTMLElement; show: (tick: number) => void; save: (name: string) => void; scene: SceneView | null; mmPerN: number; longestMm: number;
}

function makePicture(runs: Run[]): Picture {
  const box = document.createElement("div"), canvas = document.createElement("canvas"), bar = document.createElement("span");
  box.className = "picture";
  bar.className = "bar";
  box.append(canvas, bar);
  try {
    const scene = new SceneView(canvas, bar, runs);
    const save = (name: string) => {
      scene.draw();
      savePng(canvas, bar, name);
    };
    const show = (tick: number) => scene.show(tick);
    return { box, scene, save, show, mmPerN: scene.mmPerN, longestMm: scene.longestMm };
  } catch (error) {
    const note = document.createElement("p");
    note.className = "note";
    note.textContent = `No 3-D here (${(error as Error).message}). From the side instead: x to the right, y up.`;
    const plain = document.createElement("canvas"); // the first may have a context already
    plain.role = "img";
    plain.ariaLabel = "the scene from the side: x to the right, y up";
    box.replaceChildren(plain, note);
    const flat = new FlatView(plain, runs);
    const { mmPerN, longestMm } = flat;
    return { box, scene: null, save: (name) => savePng(plain, null, name), show: (tick) => flat.show(tick), mmPerN, longestMm };
  }
}

const presets: CameraPreset[] = ["sensor", "side", "follow", "across"];
const meaningOf: Record<CameraPreset, string> = {
  sensor: "where the sensor is", side: "beside the whole scene", follow: "near the proxy", across: "across the force, as the page opens",
};

function cameraButtons(scene: SceneView): HTMLElement[] {
  return presets.map((preset, i) =>
    button(preset, `camera ${meaningOf[preset]} (${i + 1})`, () => scene.setCamera(preset)));
}

// Returns true if the focused control handles the key: a list receives every key, a slider every key but space, and a button
// or a link only space.
function isForControl(event: KeyboardEvent): boolean {
  const { target, key } = event;
  if (target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement) return key !== " ";
  return key === " " && target instanceof HTMLElement && target.closest("button, summary, a") !== null;
}

function listenToKeys(player: Player, timeline: Timeline, plots: RunPlots, scene: SceneView | null,
  dialogs: Record<string, HTMLDialogElement>, signal: AbortSignal): void {
  const hidden = new Set<string>(["spheres"]);
  const toggle = (what: "truth" | "regions" | "spheres") => {
    if (!hidden.delete(what)) hidden.add(what);
    scene?.setVisible(what, !hidden.has(what));
  };
  const acts: Record<string, () => void> = {
    " ": () => player.toggle(), ",": () => player.step(-1), ".": () => player.step(1),
    e: () => timeline.goToEvent(1), E: () => timeline.goToEvent(-1),
    ArrowLeft: () => timeline.stepFrame(-1), ArrowRight: () => timeline.stepFrame(1),
    "-": () => timeline.faster(-1), "+": () => timeline.faster(1),
    z: () => plots.zoomIn(), x: () => plots.zoomOut(), "[": () => plots.pan(-0.25), "]": () => plots.pan(0.25),
    0: () => plots.axis.showAll(), f: () => plots.showFrame(),
    t: () => toggle("truth"), r: () => toggle("regions"), s: () => toggle("spheres"),
    i: () => dialogs.about.showModal(), h: () => dialogs.help.showModal(), "?": () => dialogs.help.showModal(),
  };
  presets.forEach((preset, i) => { acts[i + 1] = () => scene?.setCamera(preset); });
  document.addEventListener("keydown", (event) => {
    const act = acts[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey || isForControl(event) || document.querySelector("dialog[open]")) return;
    event.preventDefault();
    act();
  }, { signal });
}

// While it plays, slow graphics draw fewer points; a picture that stands has all of them.
function keepPace(player: Player, { scene, box }: Picture): void {
  if (!scene) return;
  const note = new PaceNote(box);
  let pace = new Pace();
  const draw = (share: number) => {
    for (const cloud of scene.clouds) cloud.setShare(share);
    note.show(share);
  };
  player.onChange(() => {
    if (player.playing && pace.picture(performance.now())) draw(pace.share);
    if (player.playing || pace.share === 1) return;
    pace = new Pace();
    draw(1);
  });
}

// The page opens at the moment of its address, or else at the most important event; its address follows.
function listenToAddress(address: Address, player: Player, timeline: Timeline, goToEvent: (tick: number) => void, opensAt: number,
  signal: AbortSignal): void {
  const go = (other: number) => {
    const { tick, problem } = address.read(player.ticks);
    timeline.tell(problem);
    goToEvent(tick ?? other);
  };
  go(opensAt);
  window.addEventListener("hashchange", () => go(player.tick), { signal });
  player.onChange(() => { if (!player.playing) address.show(player.tick); });
}

export interface Shown { player: Player; scene: SceneView | null; plots: RunPlots; end: () => void }

// top: shown above the plots. place: null where the page has one run, or two together. end() removes all from the document.
export function showRuns(runs: Run[], top: HTMLElement | null, heading = "", place: RunPlace | null = null): Shown {
  const run = runs[0], ended = new AbortController(), events = eventsOf(runs), frames = firstTicksOfFrames(run);
  const player = new Player(Math.max(...runs.map((one) => one.ticks)), run.stored.haptic_rate_hz);
  const picture = makePicture(runs), values = new Values(runs);
  const goToEvent = (tick: number) => {
    player.step(tick - player.tick);
    picture.scene?.showEvent(tick);
  };
  const timeline = new Timeline(player, events, frames, (tick) => tick / run.stored.haptic_rate_hz, goToEvent);
  const plots = new RunPlots(runs, player, events, frames, ended.signal), list = new EventList(events, goToEvent);
  const dialogs = { help: helpDialog(), about: aboutDialog(runs, licence) };
  const head = headerOf(heading || run.stored.title || run.stored.file, picture, dialogs, () => pictureName(run.stored.file, player.tick, "png"));
  const side = document.createElement("aside"), details = detailsOf(values, player);
  side.append(...notes(runs), ...(runs.length === 2 ? whichIsWhich(runs) : []), ...(top ? [top] : []), list.element,
    legend(runs, picture.mmPerN, picture.longestMm), plots.element, details, ...shownPoints(runs));
  const parts = [head, picture.box, side, timeline.element, dialogs.help, dialogs.about];
  document.body.append(...parts);
  player.onChange(() => {
    picture.show(player.tick);
    list.show(player.tick);
    if (details.open) values.show(player.tick);
  });
  keepPace(player, picture);
  listenToKeys(player, timeline, plots, picture.scene, dialogs, ended.signal);
  picture.scene?.setCamera("across");
  const address = new Address(place);
  listenToAddress(address, player, timeline, goToEvent, mostImportantTick(events), ended.signal);
  const end = () => {
    player.stop();
    address.end();
    ended.abort();
    picture.scene?.dispose();
    for (const part of parts) part.remove();
  };
  return { player, scene: picture.scene, plots, end };
}

function headerOf(heading: string, picture: Picture, dialogs: Record<string, HTMLDialogElement>, fileName: () => string): HTMLElement {
  const head = document.createElement("header"), title = document.createElement("h1");
  title.textContent = title.title = heading;
  head.append(title, ...(picture.scene ? cameraButtons(picture.scene) : []));
  head.append(button("Save picture", "the scene as a picture in PNG", () => picture.save(fileName())),
    button("What is this?", "configuration and command (i)", () => dialogs.about.showModal()),
    button("Keys", "mouse and keys (h)", () => dialogs.help.showModal()));
  return head;
}

function detailsOf(values: Values, player: Player): HTMLDetailsElement {
  const details = document.createElement("details"), summary = document.createElement("summary");
  summary.textContent = "All columns at this tick";
  details.append(summary, values.element);
  details.addEventListener("toggle", () => values.show(player.tick));
  return details;
}

function shownPoints(runs: Run[]): HTMLElement[] {
  return runs.map((one, i) => {
    const shown = document.createElement("p");
    shown.className = "shown";
    shown.textContent = runs.length === 2 ? `Run ${i + 1}: ${one.stored.shown}` : one.stored.shown;
    return shown;
  });
}

function notes(runs: Run[]): HTMLElement[] {
  return runs.filter((run) => run.stored.note).map((run) => {
    const note = document.createElement("p");
    note.className = "warning";
    note.textContent = run.stored.note;
    return note;
  });
}
