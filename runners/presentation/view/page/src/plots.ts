// Curves over time below each other, with a line at the tick that is shown. A click goes to a tick. Lengths are in mm.
import { colours, curveColour } from "./colours";
import type { Column, Run } from "./data";
import { digits, round125 } from "./data";

export interface Curve { column: Column; colour: string; label: string; dashed: boolean }

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

// The first and last value on the axis and the distance of its ticks.
function scaleOf(curves: Curve[], begin: number, end: number): [number, number, number] {
  let low = Number.POSITIVE_INFINITY, high = Number.NEGATIVE_INFINITY;
  for (const curve of curves)
    for (let tick = begin; tick < end; ++tick) {
      const value = unitOf(curve.column).factor * curve.column.magnitude(tick);
      if (Number.isFinite(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
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

  // goTo: null where a click goes nowhere.
  constructor(private curves: Curve[], private ticks: number, private readonly rateHz: number, goTo: ((tick: number) => void) | null) {
    this.element.append(this.caption, this.canvas);
    this.setCurves(curves);
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    if (goTo) this.listen(goTo);
  }
  private listen(goTo: (tick: number) => void): void {
    const pick = (event: PointerEvent) => {
      const box = this.canvas.getBoundingClientRect();
      goTo(((event.clientX - box.left - this.left) / Math.max(box.width - this.left, 1)) * (this.ticks - 1));
    };
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      pick(event);
    });
    this.canvas.addEventListener("pointermove", (event) => { if (event.buttons === 1) pick(event); });
  }

  setCurves(curves: Curve[]): void {
    this.curves = curves;
    this.drawn = false;
    this.scale = scaleOf(curves, this.first, Math.min(this.first + this.ticks, this.last + 1));
    this.draw();
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

  // The curves are drawn once, as long as they and the size stay; then only the line at the tick moves.
  private draw(): void {
    const ratio = window.devicePixelRatio, width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    const pen = this.canvas.getContext("2d");
    if (width < 2 || height < 2 || !pen) return;
    if (!this.drawn || this.canvas.width !== Math.round(ratio * width) || this.canvas.height !== Math.round(ratio * height))
      this.drawCurves(ratio, width, height);
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.still, 0, 0);
    pen.scale(ratio, ratio);
    pen.strokeStyle = getComputedStyle(document.body).color;
    pen.lineWidth = 1;
    const x = this.x(this.tick, width);
    pen.beginPath();
    pen.moveTo(x, 0);
    pen.lineTo(x, height - this.bottom);
    pen.stroke();
    this.writeCaption();
  }
  private drawCurves(ratio: number, width: number, height: number): void {
    for (const canvas of [this.canvas, this.still]) {
      canvas.width = Math.round(ratio * width);
      canvas.height = Math.round(ratio * height);
    }
    const pen = this.still.getContext("2d");
    if (!pen) return;
    pen.scale(ratio, ratio);
    this.drawAxis(pen, width, height, getComputedStyle(document.body));
    for (const curve of this.curves) this.drawCurve(pen, curve, width, height);
    this.drawn = true;
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
  private drawAxis(pen: CanvasRenderingContext2D, width: number, height: number, style: CSSStyleDeclaration): void {
    const [low, high, step] = this.scale, foot = height - this.bottom, names = this.curves[0]?.column.names ?? [];
    pen.font = "11px system-ui, sans-serif";
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    pen.strokeStyle = style.getPropertyValue("--line");
    pen.fillStyle = style.getPropertyValue("--quiet");
    for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; ++n) {
      const value = Number((n * step).toPrecision(6)), y = this.y(value, height);
      this.line(pen, this.left, y, width, y);
      pen.fillText(names[value] ?? digits(value), this.left - 5, Math.min(Math.max(y, 6), foot - 5), this.left - 6);
    }
    this.drawTimes(pen, width, foot);
  }
  private drawTimes(pen: CanvasRenderingContext2D, width: number, foot: number): void {
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
  private line(pen: CanvasRenderingContext2D, x1: number, y1: number, x2: number, y2: number): void {
    pen.beginPath();
    pen.moveTo(x1, y1);
    pen.lineTo(x2, y2);
    pen.stroke();
  }
  // Of all ticks in a pixel the smallest and the largest value.
  private drawCurve(pen: CanvasRenderingContext2D, curve: Curve, width: number, height: number): void {
    const { factor } = unitOf(curve.column);
    pen.strokeStyle = curveColour(curve.colour);
    pen.lineWidth = 1.4;
    pen.setLineDash(curve.dashed ? [5, 3] : []);
    pen.beginPath();
    const pixels = Math.max(Math.floor(width - this.left), 1), perPixel = this.ticks / pixels;
    let down = false;
    for (let pixel = 0; pixel < pixels; ++pixel) {
      const begin = Math.floor(pixel * perPixel), end = Math.max(Math.floor((pixel + 1) * perPixel), begin + 1);
      let low = Number.POSITIVE_INFINITY, high = Number.NEGATIVE_INFINITY;
      for (let k = begin; k < end && k < this.ticks && this.first + k <= this.last; ++k) {
        const value = factor * curve.column.magnitude(this.first + k);
        if (Number.isFinite(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
      }
      if (!(high >= low)) {
        down = false;
        continue;
      }
      const x = this.left + pixel;
      if (down) pen.lineTo(x, this.y(low, height));
      else pen.moveTo(x, this.y(low, height));
      if (high > low) pen.lineTo(x, this.y(high, height));
      down = true;
    }
    pen.stroke();
  }
  private writeCaption(): void {
    this.caption.replaceChildren(...this.curves.map((curve) => {
      const part = document.createElement("span"), value = curve.column.magnitude(Math.min(this.tick, this.first + this.ticks - 1));
      const { name, factor } = unitOf(curve.column);
      part.style.setProperty("--dot", curveColour(curve.colour));
      part.title = curve.column.meaning;
      const shown = Number.isFinite(value) ? `${digits(Number((factor * value).toPrecision(4)))} ${name}` : digits(value);
      part.textContent = `${curve.label} ${curve.column.names[value] ?? shown}`;
      return part;
    }));
  }
}

// The force on the hand; of a device what it exerts, and dashed what the renderer commands.
export function forceCurves(runs: Run[]): Curve[] {
  const name = runs[0].forceName, felt = curvesOf(runs, name, colours.force, name === "force" ? "force" : "force of the device");
  return runs.length > 1 || name === "force" ? felt
    : [...felt, { column: runs[0].column("force"), colour: colours.slave, label: "commanded", dashed: true }];
}

export function curvesOf(runs: Run[], name: string, colour: string, label: string): Curve[] {
  return runs.flatMap((run, i) => {
    const column = run.columns.get(name);
    return column ? [{ column, colour: i === 0 ? colour : colours.second, label: i === 0 ? label : "in run 2", dashed: i > 0 }] : [];
  });
}
