// The page of a live run: the scene as it comes, the mouse as the hand.
import { button } from "./button";
import { colours } from "./colours";
import { Connection } from "./connection";
import type { StoredLive } from "./data";
import { ForceSound } from "./force_sound";
import { type ColumnInfo, LiveRun, whyLimited } from "./live_run";
import { MouseHand } from "./mouse_hand";
import { Pace } from "./pace";
import { aboutDialog, keysDialog, legend, licence, Values } from "./panel";
import { curvesOf, forceCurves, Plot } from "./plots";
import { type CameraPreset, SceneView } from "./scene";
import { Sliders } from "./sliders";

const keys: [string, string][] = [
  ["drag", "moves the hand in the plane of the view"], ["wheel, page up and down", "moves it away from you or towards you"],
  ["w s a d q e", "turn it"], ["b", "the button of the device"], ["right button, or shift and drag", "turns the camera"],
  ["control and wheel", "zooms"], ["1 2 3", "camera: sensor, side, follow"], ["h, ?", "this help"],
];
const plotted: [string, string, string][] = [
  ["nearest_distance", colours.proxy, "nearest distance"],
  ["contact_count", colours.normal, "contacts"], ["surface_velocity", colours.velocity, "velocity estimate"],
];

const plottedS = 5;

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
  private readonly sound = new ForceSound();
  private readonly hint = document.createElement("span");
  private readonly limited = document.createElement("span"); // why the device gets another force than is commanded
  private readonly startMs = performance.now();
  private begun = false;
  private ended = "";

  constructor(stored: StoredLive, buffer: ArrayBuffer, infos: ColumnInfo[], private readonly connection: Connection) {
    this.run = new LiveRun(stored, buffer, infos);
    const box = document.createElement("div"), canvas = document.createElement("canvas"), bar = document.createElement("span");
    box.className = "picture";
    bar.className = "bar";
    box.append(canvas, bar);
    document.body.append(box);
    this.scene = new SceneView(canvas, bar, [this.run], 5);
    if (this.isHand) this.scene.leaveLeftButtonAndWheel();
    this.canvas = canvas;
    this.values = new Values([this.run]);
    this.sliders = new Sliders(stored.parameters, (changes) => this.connection.change(changes));
    const curves = [forceCurves([this.run]), ...plotted.map(([name, colour, label]) => curvesOf([this.run], name, colour, label))];
    this.plots = curves.map((some) => new Plot(some, 0, stored.haptic_rate_hz, null));
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
  end(why: string): void {
    this.ended = why;
    this.hint.textContent = "";
    this.sliders.end();
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
    this.hint.textContent = this.isHand ? "Drag to move the hand, turn the wheel to push it. " : `The hand is ${this.run.stored.device}. `;
    this.limited.className = "warning limited";
    foot.append(this.hint, this.limited, this.clock);
    document.body.append(head, side, foot, about, help);
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
    const tick = this.run.ticks - 1;
    if (tick < 0) return;
    if (!this.begun && this.run.frameCount > 0) this.begin(tick);
    this.scene.show(tick);
    ++this.pictures;
    this.sound.show(this.run.column(this.run.forceName).magnitude(tick));
    if (this.pictures % 4 === 0) this.showTexts(tick);
  };
  private begin(tick: number): void {
    const hip = this.run.vector("hip_position", tick);
    const turned = this.run.columns.has("hip_orientation") ? this.run.rotation("hip_orientation", tick) : [1, 0, 0, 0];
    if (this.isHand) new MouseHand(this.scene, this.canvas, hip, turned, (pose) => this.connection.move(pose));
    this.begun = true;
    document.body.dataset.ready = "yes";
  }
  private showTexts(tick: number): void {
    const shown = Math.round(plottedS * this.run.stored.haptic_rate_hz);
    for (const plot of this.plots) plot.showWindow(Math.max(0, tick + 1 - shown), shown, tick);
    if (this.details.open) this.values.show(tick);
    this.limited.textContent = this.ended ? "" : whyLimited(this.run, tick);
    this.limited.hidden = this.limited.textContent === "";
    const seconds = (performance.now() - this.startMs) / 1000;
    this.clock.textContent = this.ended || `${this.run.column("time").value(tick).toFixed(1)} s, ${(this.pictures / seconds).toFixed(0)} pictures/s${this.pace.share < 1 ? `; slow graphics: 1 of ${1 / this.pace.share} points is drawn` : ""}`;
  }
}

export function showLive(stored: StoredLive, buffer: ArrayBuffer): void {
  let page: LivePage | null = null;
  const connection: Connection = new Connection({
    columns: (infos) => {
      try {
        page = new LivePage(stored, buffer, infos, connection);
      } catch (error) { // no WebGL 2
        document.body.textContent = `No 3-D here, which a live run needs: ${(error as Error).message}`;
        connection.close();
        return;
      }
      Object.assign(window, { remoteTouch: { page, run: page.run, scene: page.scene, connection } });
    },
    parameters: (values, refused) => page?.showParameters(values, refused),
    ticks: (view) => page?.run.takeTicks(view),
    frame: (view) => page?.run.takeFrame(view),
    ended: (why) => {
      document.body.dataset.ended = why;
      if (page) page.end(why);
      else if (!document.body.textContent?.startsWith("No 3-D")) document.body.textContent = why;
    },
  });
}
