// The plots of one run, or of two together, with one time axis and its buttons.
import { button } from "./button";
import { colours, columnColour, darkPage } from "./colours";
import { differenceOf, type Run, type RunEvent } from "./data";
import type { Player } from "./player";
import { componentCurves, type Curve, curvesOf, forceCurves, Plot } from "./plots";
import { pictureName, saveSvg } from "./save";
import { leastImportantFirst } from "./story";
import { plotsAsSvg } from "./svg";
import { TimeAxis } from "./time_axis";

const zoomStep = 2;

// The surface of a recording without true meshes is what its camera measured. Of a tool the distance is that of its centre.
function distanceLabel(run: Run): string {
  const { scenario } = run.stored.configuration as { scenario?: { name?: string } };
  const isMeasured = ["recording", "live-session"].includes(scenario?.name ?? "") && !run.stored.true_meshes;
  const surface = isMeasured ? "measured surface" : run.truthName;
  return run.stored.tool ? `tool's centre to the ${surface}` : `distance to the ${surface}`;
}

// A column that is the same in all ticks says nothing.
function changes(curve: Curve): boolean {
  const first = curve.column.numbers[0];
  return curve.column.numbers.some((value) => Number.isFinite(value) && value !== first);
}

function standardCurves(runs: Run[]): Curve[][] {
  const run = runs[0], components = runs.length === 1 ? componentCurves(run, run.forceName, "force") : [];
  const lists = [forceCurves(runs), components, curvesOf(runs, "signed_distance", colours.truth, distanceLabel(run)),
    curvesOf(runs, "slave_force", colours.robot, "force on the slave"), curvesOf(runs, "slave_clearance", colours.robot, "clearance of the slave"),
    curvesOf(runs, "contact_count", colours.normal, "contacts"), curvesOf(runs, "surface_velocity", colours.estimate, "velocity estimate")];
  for (const [name, colour] of runs.length === 2 ? [["force", colours.force], ["proxy_position", colours.proxy]] : []) {
    const column = differenceOf(runs, name);
    if (column) lists.push([{ column, colour, label: column.name, dashed: false }]);
  }
  return lists.filter((curves) => curves.some(changes));
}

export class RunPlots {
  readonly element = document.createElement("section");
  readonly axis: TimeAxis;
  private readonly range = document.createElement("output");
  private readonly plots: Plot[];

  constructor(private readonly runs: Run[], private readonly player: Player, events: RunEvent[], frames: number[], signal: AbortSignal) {
    this.axis = new TimeAxis(player.ticks, leastImportantFirst(events), frames, (tick) => player.go(tick));
    this.plots = standardCurves(runs).map((curves) => this.plotOf(curves));
    const chosen = this.plotOf([]);
    this.element.append(this.buttons(), ...this.plots.map((plot) => plot.element), this.choiceFor(chosen), chosen.element);
    this.plots.push(chosen);
    for (const plot of this.plots) player.onChange(() => plot.show(player.tick));
    player.onChange(() => this.axis.follow(player.tick));
    this.axis.onChange(() => this.showRange());
    this.showRange();
    darkPage.addEventListener("change", () => {
      for (const plot of this.plots) plot.redraw();
    }, { signal });
  }

  zoom(by: number): void {
    const { axis, player } = this, middle = axis.first + axis.shown / 2;
    const isSeen = player.tick >= axis.first && player.tick < axis.first + axis.shown;
    axis.zoom(by, isSeen ? player.tick : middle);
  }
  zoomIn(): void {
    this.zoom(1 / zoomStep);
  }
  zoomOut(): void {
    this.zoom(zoomStep);
  }
  pan(part: number): void {
    this.axis.pan(part * this.axis.shown);
  }
  showFrame(): void {
    this.axis.showFrame(this.player.tick);
  }
  svg(): string {
    const { title, file } = this.runs[0].stored;
    return plotsAsSvg(this.plots, title || file);
  }

  private plotOf(curves: Curve[]): Plot {
    return new Plot(curves, this.player.ticks, this.runs[0].stored.haptic_rate_hz, this.axis);
  }
  private choiceFor(chosen: Plot): HTMLSelectElement {
    const choice = document.createElement("select");
    choice.ariaLabel = "column of the last plot";
    for (const name of this.runs[0].columns.keys()) choice.add(new Option(name, name));
    const choose = () => {
      const parts = this.runs.length === 1 ? componentCurves(this.runs[0], choice.value, choice.value) : [];
      chosen.setCurves(parts.length > 0 ? parts : curvesOf(this.runs, choice.value, columnColour(choice.value), choice.value));
    };
    choice.addEventListener("change", () => {
      choose();
      choice.blur(); // keys are for the time
    });
    choice.value = "nearest_distance";
    choose();
    return choice;
  }
  private buttons(): HTMLElement {
    const box = document.createElement("div"), save = () =>
      saveSvg(this.svg(), pictureName(this.runs[0].stored.file, this.player.tick, "svg"));
    box.className = "zoom";
    box.append(button("+", "more detail (z; wheel or pinch over a plot)", () => this.zoomIn()), button("\u2212", "more time (x)", () => this.zoomOut()),
      button("<", "earlier ([)", () => this.pan(-0.25)), button(">", "later (])", () => this.pan(0.25)),
      button("All", "the whole run (0)", () => this.axis.showAll()), button("One frame", "the time in which this frame is in use (f)", () => this.showFrame()),
      button("Save plots", "the plots as a picture in SVG, with this part of the time", save), this.range);
    return box;
  }
  private showRange(): void {
    const { first, shown } = this.axis, rateHz = this.runs[0].stored.haptic_rate_hz, from = Math.round(first), to = from + Math.round(shown) - 1;
    this.range.textContent = `${(from / rateHz).toFixed(3)} to ${(to / rateHz).toFixed(3)} s`;
  }
}
