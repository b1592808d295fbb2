// The page of a live run: the scene as it comes, the mouse as the hand.
import { Banner, missedText, noticesOf } from "./banner";
import { button } from "./button";
import { colours } from "./colours";
import { Connection } from "./connection";
import type { StoredLive } from "./data";
import { ForceSound } from "./force_sound";
import { KeptRange } from "./kept_range";
import { type LinkState, stateOf } from "./link_state";
import { type ColumnInfo, type Limit, limitOf, LiveRun, type Trouble } from "./live_run";
import { MouseHand } from "./mouse_hand";
import { Pace, PaceNote } from "./pace";
import { aboutDialog, keysDialog, legend, licence, Values } from "./panel";
import { curvesOf, forceCurves, Plot } from "./plots";
import { type CameraPreset, SceneView } from "./scene";
import { Sliders } from "./sliders";

const keys: [string, string][] = [
  ["drag, arrow keys", "moves the hand in the plane of the view"], ["wheel, page up and down", "moves it away from you or towards you"],
  ["w s a d q e", "turn it"], ["shift with a key or the wheel", "fine steps"], ["alt with a key or the wheel", "coarse steps"],
  ["b", "the button of the device"], ["right button, or shift and drag", "turns the camera"],
  ["control and wheel", "zooms"], ["1 2 3", "camera: sensor, side, follow"], ["h, ?", "this help"],
];
const plotted: [string, string, string][] = [
  ["nearest_distance", colours.proxy, "nearest distance"],
  ["contact_count", colours.normal, "contacts"], ["surface_velocity", colours.estimate, "velocity estimate"],
];

const plottedS = 5;
const watchedS = 5; // for missed deadlines
const asleepMs = 5000; // between two pictures, of a page that was hidden or a machine that slept

class LivePage {
  readonly run: LiveRun;
  readonly scene: SceneView;
  readonly sliders: Sliders;
  pictures = 0;
  private readonly canvas: HTMLCanvasElement;
  private readonly clock = document.createElement("output");
  private readonly details = document.createElement("details");
  private readonly plots: Plot[];
  private readonly values: Values;
  private readonly pace = new Pace();
  private readonly paceNote: PaceNote;
  private readonly sound = new ForceSound();
  private readonly hint = document.createElement("span");
  private readonly steps = document.createElement("span"); // of keys and wheel
  private readonly takeOver = button("Take over", "", () => this.connection.takeHand());
  private readonly banner = new Banner(this.takeOver); // of connection, camera, haptic loop and safety gate
  private readonly startMs = performance.now();
  private mouse: MouseHand | null = null;
  private begun = false;
  private hasHand: boolean | null = null; // null: the run has not said so yet
  private hadHand = false; // before another page took it over
  private follows = false; // the mouse's hand is where the run has it
  private link: LinkState = { kind: "open", text: "" };
  private trouble: Trouble = { camera: "", force: "" };
  private limit: Limit | null = null;
  private missed = "";
  private tickMs = performance.now(); // when ticks came, or the page woke up
  private pictureMs = performance.now();

  constructor(stored: StoredLive, buffer: ArrayBuffer, infos: ColumnInfo[], private readonly connection: Connection) {
    this.run = new LiveRun(stored, buffer, infos);
    const box = document.createElement("div"), canvas = document.createElement("canvas"), bar = document.createElement("span");
    box.className = "picture";
    bar.className = "bar";
    box.append(canvas, bar, this.banner.element);
    document.body.append(box);
    this.scene = new SceneView(canvas, bar, [this.run], 5);
    if (this.isHand) this.scene.leaveLeftButtonAndWheel();
    this.canvas = canvas;
    this.paceNote = new PaceNote(box);
    this.values = new Values([this.run]);
    this.sliders = new Sliders(stored.parameters, (changes) => this.connection.change(changes));
    const curves = [forceCurves([this.run]), ...plotted.map(([name, colour, label]) => curvesOf([this.run], name, colour, label))];
    this.plots = curves.map((some) => {
      const plot = new Plot(some, 0, stored.haptic_rate_hz, null), range = new KeptRange();
      plot.rangeFor = (seen) => range.of(seen, performance.now());
      return plot;
    });
    this.layOut(canvas);
    requestAnimationFrame(this.picture);
  }

  // The mouse is the hand, and no device.
  private get isHand(): boolean {
    return this.run.stored.device === "browser:";
  }
  showParameters(values: number[], refused: string): void {
    const value = (name: string) => values[this.run.stored.parameters.findIndex((p) => p.name === name)];
    const r1M = value("renderer.r1_m"), r2M = value("renderer.r2_m");
    if (r1M > 0 && r2M > 0) this.run.setRadii(r1M, r2M);
    this.sliders.show(values, refused);
  }
  // A new connection to the same run.
  restart(): void {
    this.run.restart();
    this.follows = false;
    this.tickMs = performance.now();
  }
  takeTicks(view: DataView): void {
    this.run.takeTicks(view);
    this.tickMs = performance.now();
    if (!this.follows && this.begun) this.follow();
  }
  // The mouse's hand begins where the run has it.
  private follow(): void {
    const tick = this.run.ticks - 1;
    this.follows = true;
    this.mouse?.start(this.run.vector("hip_position", tick), this.orientation(tick)); // first, so that it tells no older place
    this.showState();
  }
  showHand(has: boolean): void {
    this.hadHand = this.hasHand === true && !has;
    this.hasHand = has;
    this.follows = false;
    this.showState();
  }
  showTrouble(trouble: Trouble): void {
    this.trouble = trouble;
    this.showState();
  }
  showLink(link: LinkState): void {
    if (link.kind === this.link.kind && link.text === this.link.text) return;
    this.link = link;
    if (link.kind !== "open" && link.kind !== "silent") this.follows = false;
    this.showState();
  }
  private get isLive(): boolean {
    return this.link.kind === "open";
  }
  private showState(): void {
    const mayAct = this.isLive && this.hasHand === true;
    if (this.mouse) this.mouse.isActive = mayAct && this.follows;
    this.sliders.enable(mayAct);
    this.hint.textContent = this.isLive ? this.howToAct() : "";
    this.steps.hidden = !mayAct || !this.mouse;
    this.showStatus();
  }
  private howToAct(): string {
    if (!this.isHand) return `The hand is ${this.run.stored.device}.`;
    return this.mouse?.isActive ? "Drag to move the hand, turn the wheel to push it." : "";
  }
  // Empty: this page, or there is nothing to act on.
  private whoActs(): string {
    const what = this.isHand ? "hand" : "sliders";
    if (this.hasHand !== false || (!this.isHand && this.run.stored.parameters.length === 0)) return "";
    this.takeOver.textContent = `Take over the ${what}`;
    this.takeOver.title = `this page controls the ${what}, and the other page watches`;
    return this.hadHand ? `Another page has taken over the ${what}. This page only watches now.`
      : `Another page controls the ${what}. This page only watches.`;
  }
  private showStatus(): void {
    this.banner.show(noticesOf({
      link: this.link, trouble: this.trouble, limit: this.limit, missed: this.missed, whoActs: this.whoActs(),
      silentS: (performance.now() - this.tickMs) / 1000,
    }), this.isLive);
  }

  private layOut(canvas: HTMLCanvasElement): void {
    const head = document.createElement("header"), title = document.createElement("h1"), side = document.createElement("aside");
    const about = aboutDialog([this.run], licence), help = keysDialog(keys, "Force: the arrow, and how far the proxy stays behind the hand.");
    title.textContent = `live: ${this.run.stored.title}`;
    head.append(title, ...(["sensor", "side", "follow"] as CameraPreset[]).map((preset) =>
      button(preset, "camera", () => this.scene.setCamera(preset))));
    const sound = button("Sound", "the force as a sound", () => {
      this.sound.toggle();
      sound.textContent = this.sound.on ? "Silent" : "Sound";
    });
    head.append(sound, button("What is this?", "experiment and command", () => about.showModal()),
      button("Keys", "mouse and keys", () => help.showModal()));
    const details = this.details, summary = document.createElement("summary"), foot = document.createElement("footer");
    summary.textContent = "All columns now";
    details.append(summary, this.values.element);
    side.append(legend([this.run], this.scene.mmPerN, this.scene.longestMm), ...this.plots.map((plot) => plot.element));
    if (this.run.stored.parameters.length > 0) side.append(this.sliders.element);
    side.append(details);
    this.steps.className = "steps";
    foot.append(this.hint, this.steps, this.clock);
    this.showState();
    document.body.append(head, side, foot, about, help);
    document.addEventListener("visibilitychange", () => { this.tickMs = performance.now(); }); // no picture, no tick
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    document.addEventListener("keydown", (event) => {
      const preset = ({ 1: "sensor", 2: "side", 3: "follow" } as Record<string, CameraPreset>)[event.key];
      if (preset) this.scene.setCamera(preset);
      if (event.key === "h" || event.key === "?") help.showModal();
    });
  }
  private readonly picture = (nowMs: number): void => {
    requestAnimationFrame(this.picture);
    if (this.pace.picture(nowMs)) for (const cloud of this.scene.clouds) cloud.setShare(this.pace.share);
    this.connection.acknowledge();
    if (nowMs - this.pictureMs > asleepMs) this.tickMs = performance.now();
    this.pictureMs = nowMs;
    const tick = this.run.ticks - 1;
    if (tick < 0) {
      this.showStatus();
      return;
    }
    if (!this.begun && this.run.frameCount > 0) this.begin();
    this.scene.show(tick);
    ++this.pictures;
    this.sound.show(this.isLive ? this.run.column(this.run.forceName).magnitude(tick) : 0);
    if (this.pictures % 4 === 0) this.showTexts(tick);
  };
  private begin(): void {
    if (this.isHand) this.mouse = new MouseHand(this.scene, this.canvas, (pose) => this.connection.move(pose));
    this.begun = true;
    this.follow();
    document.body.dataset.ready = "yes";
  }
  private orientation(tick: number): number[] {
    return this.run.columns.has("hip_orientation") ? this.run.rotation("hip_orientation", tick) : [1, 0, 0, 0];
  }
  private showTexts(tick: number): void {
    const shown = Math.round(plottedS * this.run.stored.haptic_rate_hz);
    for (const plot of this.plots) plot.showWindow(Math.max(0, tick + 1 - shown), shown, tick);
    if (this.details.open) this.values.show(tick);
    this.limit = limitOf(this.run, tick);
    this.missed = missedText(this.run, tick, watchedS);
    this.showStatus();
    this.steps.textContent = this.mouse?.stepText ?? "";
    const seconds = (performance.now() - this.startMs) / 1000, time = `${this.run.column("time").value(tick).toFixed(1)} s`;
    this.paceNote.show(this.pace.share, ", and all near the hand");
    this.clock.textContent = this.isLive ? `${time}, ${(this.pictures / seconds).toFixed(0)} pictures/s` : `last tick: ${time}`;
  }
}

// The page has only a text before the first tick.
function showText(text: string): void {
  document.body.classList.add("text");
  document.body.textContent = text;
}

export function showLive(stored: StoredLive, buffer: ArrayBuffer): void {
  let page: LivePage | null = null;
  const connection: Connection = new Connection({
    columns: (infos) => {
      if (page) {
        page.restart();
        return;
      }
      try {
        document.body.textContent = "";
        document.body.classList.remove("text");
        page = new LivePage(stored, buffer, infos, connection);
      } catch (error) { // no WebGL 2
        connection.close();
        showText(`No 3-D here, which a live run needs: ${(error as Error).message}`);
        return;
      }
      Object.assign(window, { remoteTouch: { page, run: page.run, scene: page.scene, connection, stateOf, KeptRange } });
    },
    parameters: (values, refused) => page?.showParameters(values, refused),
    ticks: (view) => page?.takeTicks(view),
    frame: (view) => page?.run.takeFrame(view),
    hand: (has) => page?.showHand(has),
    trouble: (trouble) => page?.showTrouble(trouble),
    state: (state) => {
      document.body.dataset.state = state.kind;
      if (page) page.showLink(state);
      else showText(state.text || "Connected. The run has made no tick yet.");
    },
  }, stored.protocol);
}
