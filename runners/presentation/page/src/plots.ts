// Curves over time below each other, with a line at the tick that is shown. Lengths are in mm.
import { colours, curveColour, darkPage, eventColour } from "./colours";
import type { Column, Run } from "./data";
import { digits, round125, timeDigits } from "./data";
import type { TimeAxis } from "./time_axis";

// part: component of a vector; without it the magnitude is shown.
export interface Curve { column: Column; colour: string; label: string; dashed: boolean; part?: number }

// The part of a canvas's context that draws plots: a picture in SVG is drawn by the same calls.
export type Pen = Pick<CanvasRenderingContext2D, "beginPath" | "moveTo" | "lineTo" | "stroke" | "fillText" | "fillRect" | "setLineDash"
  | "strokeStyle" | "fillStyle" | "lineWidth" | "font" | "textAlign" | "textBaseline">;
// Colours of the ground; isDark chooses those of the curves.
export interface Ink { line: string; quiet: string; isDark: boolean }

// Plots are drawn by the CPU: on a machine without a GPU this makes a zoom six times as fast.
const plain: CanvasRenderingContext2DSettings = { willReadFrequently: true };

// A unit as it is plotted, how many of them the stored one is, and the least range of an axis: below it changes are those
// of rounding.
interface Unit { name: string; factor: number; least: number }
const units: Record<string, Unit> = {
  m: { name: "mm", factor: 1000, least: 0.01 }, "m/s": { name: "mm/s", factor: 1000, least: 0.1 }, N: { name: "N", factor: 1, least: 0.01 },
  1: { name: "", factor: 1, least: 1 }, rad: { name: "rad", factor: 1, least: 1e-3 },
};
function unitOf(column: Column): Unit {
  return units[column.unit] ?? { name: column.unit, factor: 1, least: 1e-6 };
}

const dotPx = 1; // how wide a value is drawn that has no neighbour

// The value of a curve at a tick, in the unit of the plot.
function valuesOf({ column, part }: Curve): (tick: number) => number {
  const { factor } = unitOf(column);
  return part === undefined ? (tick) => factor * column.magnitude(tick) : (tick) => factor * column.value(tick, part);
}

// The first and last value on the axis and the distance of its ticks.
function scaleOf(curves: Curve[], begin: number, end: number): [number, number, number] {
  let low = Number.POSITIVE_INFINITY, high = Number.NEGATIVE_INFINITY;
  for (const curve of curves) {
    const valueAt = valuesOf(curve);
    for (let tick = begin; tick < end; ++tick) {
      const value = valueAt(tick);
      if (value < low && Number.isFinite(value)) low = value;
      if (value > high && Number.isFinite(value)) high = value;
    }
  }
  if (!(high >= low)) return [0, 1, 1];
  const { least } = unitOf(curves[0].column);
  if (high - low < least) {
    const begins = low >= 0 ? Math.max((low + high - least) / 2, 0) : (low + high - least) / 2;
    [low, high] = [begins, begins + least];
  }
  const step = round125((high - low) / 2);
  return [low, high, curves.some((curve) => curve.column.names.length > 0) ? Math.max(step, 1) : step];
}

export class Plot {
  readonly element = document.createElement("figure");
  private readonly canvas = document.createElement("canvas");
  private readonly still = document.createElement("canvas"); // without the line at the tick
  private drawn = false; // the still picture is of the present curves
  private readonly caption = document.createElement("figcaption");
  private scale: [number, number, number] = [0, 1, 1];
  private readonly left = 60;
  private readonly bottom = 15; // for the time
  private tick = 0;
  private first = 0; // tick that is drawn
  private isLive = false;
  rangeFor = (seen: [number, number, number]): [number, number, number] => seen; // a live run keeps its range

  // axis: null where the shown time moves by itself, in a live run.
  constructor(private curves: Curve[], private ticks: number, private readonly rateHz: number, private readonly axis: TimeAxis | null) {
    this.element.append(this.caption, this.canvas);
    this.canvas.role = "img";
    this.setCurves(curves);
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    axis?.listen(this.canvas, this.left);
    axis?.onChange(() => this.showAxis(axis));
  }

  setCurves(curves: Curve[]): void {
    this.curves = curves;
    this.canvas.ariaLabel = `${curves.map((curve) => curve.label).join(", ")} over time`;
    this.drawn = false;
    this.scale = this.rangeFor(scaleOf(curves, this.first, Math.min(this.first + this.ticks, this.last + 1)));
    this.draw();
  }
  redraw(): void {
    this.setCurves(this.curves);
  }
  // Other ticks than before, of a run that goes on.
  showWindow(first: number, ticks: number, tick: number): void {
    this.isLive = true;
    this.first = first;
    this.ticks = ticks;
    this.tick = tick;
    this.setCurves(this.curves);
  }
  show(tick: number): void {
    this.tick = tick;
    this.draw();
  }
  private showAxis(axis: TimeAxis): void {
    const first = Math.round(axis.first), ticks = Math.round(axis.shown);
    if (first === this.first && ticks === this.ticks) this.draw(); // another tick is under the pointer
    else {
      this.first = first;
      this.ticks = ticks;
      this.redraw();
    }
  }

  // The curves are drawn once, as long as they and the size stay; then only the line at the tick moves.
  private draw(): void {
    const ratio = window.devicePixelRatio, width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    const pen = this.canvas.getContext("2d", plain);
    if (width < 2 || height < 2 || !pen) return;
    if (!this.drawn || this.canvas.width !== Math.round(ratio * width) || this.canvas.height !== Math.round(ratio * height))
      this.drawCurves(ratio, width, height);
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.still, 0, 0);
    pen.scale(ratio, ratio);
    pen.strokeStyle = getComputedStyle(document.body).color;
    for (const [tick, dash] of [[this.tick, []], [this.axis?.hover ?? Number.NaN, [2, 2]]] as [number, number[]][]) {
      const x = this.x(tick, width);
      pen.setLineDash(dash);
      if (x >= this.left) this.line(pen, x, 0, x, height - this.bottom);
    }
    this.writeCaption();
  }
  private drawCurves(ratio: number, width: number, height: number): void {
    for (const canvas of [this.canvas, this.still]) {
      canvas.width = Math.round(ratio * width);
      canvas.height = Math.round(ratio * height);
    }
    const pen = this.still.getContext("2d", plain);
    if (!pen) return;
    pen.scale(ratio, ratio);
    const style = getComputedStyle(document.body);
    this.drawOn(pen, width, height, { line: style.getPropertyValue("--line"), quiet: style.getPropertyValue("--quiet"), isDark: darkPage.matches });
    this.drawn = true;
  }
  // Everything but the line at the tick.
  drawOn(pen: Pen, width: number, height: number, ink: Ink): void {
    this.drawAxis(pen, width, height, ink);
    this.drawMarks(pen, width, height, ink);
    for (const curve of this.curves) this.drawCurve(pen, curve, width, height, ink);
    pen.setLineDash([]);
  }
  get labels(): { text: string; colour: string }[] {
    return this.curves.map(({ column, label, colour }) => {
      const { name } = unitOf(column);
      return { text: name ? `${label} (${name})` : label, colour };
    });
  }
  // Of a live run no tick after the newest is known.
  private get last(): number {
    return this.isLive ? this.tick : Number.POSITIVE_INFINITY;
  }
  private x(tick: number, width: number): number {
    return this.left + ((tick - this.first) / Math.max(this.ticks - 1, 1)) * (width - this.left - 1);
  }
  private y(value: number, height: number): number {
    const [low, high] = this.scale;
    return height - this.bottom - 3 - ((value - low) / (high - low)) * (height - this.bottom - 7);
  }
  private drawAxis(pen: Pen, width: number, height: number, ink: Ink): void {
    const [low, high, step] = this.scale, foot = height - this.bottom, names = this.curves[0]?.column.names ?? [];
    pen.font = "11px system-ui, sans-serif";
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    pen.lineWidth = 1;
    pen.strokeStyle = ink.line;
    pen.fillStyle = ink.quiet;
    for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; ++n) {
      const value = Number((n * step).toPrecision(6)), y = this.y(value, height);
      this.line(pen, this.left, y, width, y);
      pen.fillText(names[value] ?? digits(value), this.left - 5, Math.min(Math.max(y, 6), foot - 5), this.left - 6);
    }
    this.drawTimes(pen, width, foot);
  }
  private drawTimes(pen: Pen, width: number, foot: number): void {
    const beginS = this.first / this.rateHz, endS = (this.first + this.ticks - 1) / this.rateHz;
    if (!(endS > beginS)) return;
    const stepS = round125((endS - beginS) / 3);
    for (let n = Math.ceil(beginS / stepS - 1e-9); n * stepS <= endS; ++n) {
      const x = this.x(n * stepS * this.rateHz, width);
      this.line(pen, x, 0, x, foot);
      pen.textAlign = x < this.left + 12 ? "left" : x > width - 24 ? "right" : "center";
      pen.fillText(`${Number((n * stepS).toPrecision(6))} s`, x, foot + 9);
    }
  }
  private line(pen: Pen, x1: number, y1: number, x2: number, y2: number): void {
    pen.beginPath();
    pen.moveTo(x1, y1);
    pen.lineTo(x2, y2);
    pen.stroke();
  }
  // New frames, where there is room for them, and events.
  private drawMarks(pen: Pen, width: number, height: number, ink: Ink): void {
    if (!this.axis) return;
    const inside = (tick: number) => tick >= this.first && tick < this.first + this.ticks, foot = height - this.bottom;
    const frames = this.axis.frames.filter(inside);
    pen.strokeStyle = ink.quiet;
    pen.setLineDash([1, 3]);
    if (frames.length < width / 20) for (const tick of frames) this.line(pen, this.x(tick, width), 0, this.x(tick, width), foot);
    pen.setLineDash([]);
    for (const { tick, kind } of this.axis.events) {
      if (!inside(tick)) continue;
      const x = this.x(tick, width);
      pen.strokeStyle = pen.fillStyle = curveColour(eventColour(kind), ink.isDark);
      this.line(pen, x, 0, x, foot);
      pen.fillRect(x - 2.5, 0, 5, 6);
    }
  }
  private drawCurve(pen: Pen, curve: Curve, width: number, height: number, ink: Ink): void {
    pen.strokeStyle = curveColour(curve.colour, ink.isDark);
    pen.lineWidth = 1.4;
    pen.setLineDash(curve.dashed ? [5, 3] : []);
    pen.beginPath();
    if (this.ticks > width - this.left) this.addColumns(pen, curve, width, height);
    else this.addTicks(pen, curve, width, height);
    pen.stroke();
  }
  // The smallest and the largest value of all ticks in each column of pixels.
  private addColumns(pen: Pen, curve: Curve, width: number, height: number): void {
    const pixels = Math.max(Math.floor(width - this.left), 1);
    const firstOf = (pixel: number) => Math.floor((pixel * this.ticks) / pixels); // exact at the end of the last pixel
    const valueAt = valuesOf(curve);
    let down = false;
    for (let pixel = 0; pixel < pixels; ++pixel) {
      const begin = firstOf(pixel), end = Math.max(firstOf(pixel + 1), begin + 1);
      let low = Number.POSITIVE_INFINITY, high = Number.NEGATIVE_INFINITY;
      for (let k = begin; k < end && k < this.ticks && this.first + k <= this.last; ++k) {
        const value = valueAt(this.first + k);
        if (value < low && Number.isFinite(value)) low = value;
        if (value > high && Number.isFinite(value)) high = value;
      }
      if (!(high >= low)) {
        down = false;
        continue;
      }
      const x = this.left + pixel;
      if (down) pen.lineTo(x, this.y(low, height));
      else {
        pen.moveTo(x, this.y(low, height));
        pen.lineTo(x + dotPx, this.y(low, height)); // seen even if no tick of the next pixel is known
      }
      if (high > low) pen.lineTo(x, this.y(high, height));
      down = true;
    }
  }
  // Each tick, as a small cross where there is room.
  private addTicks(pen: Pen, curve: Curve, width: number, height: number): void {
    const valueAt = valuesOf(curve), room = (width - this.left) / this.ticks > 6;
    let down = false;
    for (let tick = this.first; tick < this.first + this.ticks && tick <= this.last; ++tick) {
      const x = this.x(tick, width), y = this.y(valueAt(tick), height), before = down;
      down = Number.isFinite(y);
      if (!down) continue;
      if (before) pen.lineTo(x, y);
      else pen.moveTo(x, y);
      if (!before && !Number.isFinite(valueAt(tick + 1))) pen.lineTo(x + dotPx, y); // between two ticks that are not known
      if (!room) continue;
      pen.moveTo(x, y - 2);
      pen.lineTo(x, y + 2);
      pen.moveTo(x, y);
    }
  }
  // The values at the tick under the pointer, or at the tick that is shown.
  private writeCaption(): void {
    const at = this.axis?.hover ?? this.tick, tick = Math.min(at, this.first + this.ticks - 1);
    const parts = this.curves.map((curve) => {
      const part = document.createElement("span"), value = valuesOf(curve)(this.axis ? at : tick);
      const { name } = unitOf(curve.column);
      part.style.setProperty("--dot", curveColour(curve.colour));
      part.title = curve.column.meaning;
      const number = curve.column.name === "time" ? timeDigits(value) : curve.column.digits(Number(value.toPrecision(4)));
      const shown = Number.isFinite(value) ? `${number} ${name}` : digits(value);
      part.textContent = `${curve.label} ${curve.column.names[value] ?? shown}`;
      return part;
    });
    if (this.axis && this.axis.hover !== null) {
      const where = document.createElement("em");
      where.textContent = `tick ${at}, ${(at / this.rateHz).toFixed(3)} s`;
      parts.push(where);
    }
    this.caption.replaceChildren(...parts);
  }
}

// The force on the hand; of a device what it exerts, and dashed what is commanded, or the renderer's force if that is not known.
export function forceCurves(runs: Run[]): Curve[] {
  const name = runs[0].forceName, felt = curvesOf(runs, name, colours.force, name === "force" ? "force" : "force of the device");
  const commanded = runs[0].commandedForceName, label = commanded ? "commanded" : "force of the renderer";
  return runs.length > 1 || name === "force" ? felt
    : [...felt, { column: runs[0].column(commanded ?? "force"), colour: colours.slave, label, dashed: true }];
}

export function curvesOf(runs: Run[], name: string, colour: string, label: string): Curve[] {
  return runs.flatMap((run, i) => {
    const column = run.columns.get(name);
    const inSecond = runs[0].columns.has(name) ? "in run 2" : `${label} in run 2`;
    return column ? [{ column, colour: i === 0 ? colour : colours.second, label: i === 0 ? label : inSecond, dashed: i > 0 }] : [];
  });
}

// The components of a vector in one run.
export function componentCurves(run: Run, name: string, label: string): Curve[] {
  const column = run.columns.get(name);
  if (column?.width !== 3) return [];
  return (["x", "y", "z"] as const).map((axis, part) => ({ column, colour: colours[axis], label: `${label} ${axis}`, dashed: false, part }));
}
