// The map of a sweep: a measure over two of its axes. Cells whose run is on the page have a frame and can be clicked.
import { colours, measures, rampColour, rampStyle } from "./colours";
import { digits, type Numbers, type Sweep } from "./data";
import { named } from "./words";

const left = 64, bottom = 34, margin = 4; // at the top and to the right, for frames of cells

interface Axis { name: string; unit: string; values: (number | string)[] }

// "noise sigma (mm)"
function axisName({ name, unit }: Axis): string {
  const { words, name: shown } = named(name), of = shown || (unit === "1" ? "" : unit);
  return of ? `${words} (${of})` : words;
}

// At most `most` values of an axis, evenly apart from the first on: how far along the axis each is, and its text.
function ticksOf(values: (number | string)[], factor: number, most: number): [number, string][] {
  const every = Math.ceil(values.length / Math.max(Math.min(most, 6), 1)), ticks: [number, string][] = [];
  for (let i = 0; i < values.length; i += every) {
    const value = values[i];
    ticks.push([(i + 0.5) / values.length, typeof value === "number" ? digits(Number((factor * value).toPrecision(3))) : value]);
  }
  return ticks;
}

export class SweepMap {
  readonly element = document.createElement("section");
  private readonly canvas = document.createElement("canvas");
  private readonly caption = document.createElement("figcaption");
  private readonly scale = document.createElement("figcaption"); // the bar of colours with its ends
  private readonly choice = document.createElement("select");
  private readonly runs = document.createElement("select");
  private readonly fixed: HTMLSelectElement[]; // the places on the axes that the map does not show
  private numbers: Numbers = new Float64Array();
  private range: [number, number] = [0, 1];

  // shown: which of the runs of the page is seen now.
  constructor(private readonly sweep: Sweep, private readonly shown: number, choose: (run: number) => void) {
    const { stored } = sweep, figure = document.createElement("figure");
    this.element.className = "map";
    for (const measure of stored.measures) this.choice.add(new Option(measure.name, measure.name));
    this.choice.value = stored.judged;
    this.choice.title = "measure";
    this.choice.addEventListener("change", () => {
      this.setMeasure();
      this.choice.blur(); // keys are for the time
    });
    stored.runs.forEach((_, i) => { this.runs.add(new Option(sweep.text(sweep.cellOf(i)), String(i))); });
    this.runs.value = String(shown);
    this.runs.title = "the run that is shown";
    this.runs.addEventListener("change", () => choose(Number(this.runs.value)));
    const place = sweep.place(sweep.cellOf(shown));
    this.fixed = stored.axes.slice(0, -2).map((axis, k) => {
      const select = document.createElement("select");
      select.title = axis.name;
      axis.values.forEach((value, i) => { select.add(new Option(`${axis.name} = ${value}`, String(i))); });
      select.value = String(place[k]);
      select.addEventListener("change", () => {
        this.draw();
        select.blur();
      });
      return select;
    });
    this.canvas.role = "img";
    this.canvas.ariaLabel = `map of a measure over ${stored.axes.map((axis) => axis.name).join(", ")}; the list below it chooses a run`;
    this.canvas.addEventListener("click", (event) => {
      const run = this.runAt(event);
      if (run >= 0) choose(run);
      else this.tellAbsent(this.cellUnder(event));
    });
    this.canvas.addEventListener("pointermove", (event) => this.describe(this.cellUnder(event)));
    this.canvas.addEventListener("pointerleave", () => this.describe(sweep.cellOf(shown)));
    figure.append(this.scale, this.canvas, this.caption);
    const notes = stored.notes.map((text) => {
      const note = document.createElement("p");
      note.className = "warning";
      note.textContent = text;
      return note;
    });
    this.element.append(this.choice, ...this.fixed, figure, this.runs, ...notes);
    this.setMeasure();
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  private setMeasure(): void {
    this.numbers = this.sweep.measure(this.choice.value);
    let low = Number.POSITIVE_INFINITY, high = Number.NEGATIVE_INFINITY;
    for (let cell = 0; cell < this.numbers.length / this.sweep.stored.replicates; ++cell) {
      const mean = this.sweep.mean(this.numbers, cell);
      if (Number.isFinite(mean)) [low, high] = [Math.min(low, mean), Math.max(high, mean)];
    }
    this.range = high > low ? [low, high] : [low, low + 1];
    this.showScale(low, high);
    this.describe(this.sweep.cellOf(this.shown));
    this.draw();
  }
  private showScale(low: number, high: number): void {
    const bar = document.createElement("i"), span = (text: string) => {
      const made = document.createElement("span");
      made.textContent = text;
      return made;
    };
    bar.style.background = rampStyle(measures);
    this.scale.className = "scale";
    this.scale.replaceChildren(...(high > low ? [span(digits(low)), bar, span(`${digits(high)}${this.unit()}`)] : []), span("white frames: the runs of this page"));
  }
  private unit(): string {
    const unit = this.sweep.stored.measures.find((measure) => measure.name === this.choice.value)?.unit ?? "1";
    return unit === "1" ? "" : ` ${unit}`;
  }
  // The last axis to the right, the one before it up.
  private get size(): [number, number] {
    const axes = this.sweep.stored.axes;
    return [axes[axes.length - 1].values.length, axes.length > 1 ? axes[axes.length - 2].values.length : 1];
  }
  private cellAt(column: number, row: number): number {
    const place = this.fixed.map((select) => Number(select.value));
    return this.sweep.cellAt(this.sweep.stored.axes.length > 1 ? [...place, row, column] : [column]);
  }
  private cellUnder(event: MouseEvent): number {
    const box = this.canvas.getBoundingClientRect(), [columns, rows] = this.size;
    const column = Math.floor(((event.clientX - box.left - left) / (box.width - left - margin)) * columns);
    const row = rows - 1 - Math.floor(((event.clientY - box.top - margin) / (box.height - bottom - margin)) * rows);
    return column >= 0 && column < columns && row >= 0 && row < rows ? this.cellAt(column, row) : -1;
  }
  // The shown run that is at most 12 pixels away, or -1: cells of a fine map are small.
  private runAt(event: MouseEvent): number {
    const box = this.canvas.getBoundingClientRect(), [columns, rows] = this.size;
    let best = -1, least = 12 + 0.5 * Math.max((box.width - left - margin) / columns, (box.height - bottom - margin) / rows);
    this.shownCells().forEach(([run, column, row]) => {
      const x = left + ((column + 0.5) * (box.width - left - margin)) / columns;
      const y = margin + ((rows - row - 0.5) * (box.height - bottom - margin)) / rows;
      const distance = Math.hypot(event.clientX - box.left - x, event.clientY - box.top - y);
      if (distance < least) [best, least] = [run, distance];
    });
    return best;
  }
  // Run, column and row of those that this part of the map has.
  private shownCells(): [number, number, number][] {
    const list: [number, number, number][] = [], fixed = this.fixed.map((select) => Number(select.value));
    this.sweep.stored.runs.forEach((_, run) => {
      const place = this.sweep.place(this.sweep.cellOf(run));
      if (fixed.every((at, k) => at === place[k])) list.push([run, place[place.length - 1], place.length > 1 ? place[place.length - 2] : 0]);
    });
    return list;
  }
  private describe(cell: number): void {
    if (cell < 0) return;
    const mean = this.sweep.mean(this.numbers, cell);
    const value = Number.isFinite(mean) ? `${digits(mean)}${this.unit()}` : "no value";
    this.caption.textContent = `${this.choice.value} ${value} at ${this.sweep.text(cell)}${this.sweep.meanOf(this.numbers, cell)}`;
  }
  private tellAbsent(cell: number): void {
    if (cell >= 0) this.caption.textContent = `${this.sweep.text(cell)}: not on this page. Click a framed cell, or make a page with --cells.`;
  }

  private draw(): void {
    const ratio = window.devicePixelRatio, width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    const pen = this.canvas.getContext("2d");
    if (width < 2 || height < 2 || !pen) return;
    this.canvas.width = ratio * width;
    this.canvas.height = ratio * height;
    pen.scale(ratio, ratio);
    const [columns, rows] = this.size, w = (width - left - margin) / columns, h = (height - bottom - margin) / rows, tint = new Uint8Array(3);
    for (let row = 0; row < rows; ++row)
      for (let column = 0; column < columns; ++column) {
        const mean = this.sweep.mean(this.numbers, this.cellAt(column, row));
        if (!Number.isFinite(mean)) continue;
        rampColour(measures, (mean - this.range[0]) / (this.range[1] - this.range[0]), tint, 0);
        pen.fillStyle = `rgb(${tint.join(" ")})`;
        pen.fillRect(left + column * w, margin + (rows - 1 - row) * h, w + 0.5, h + 0.5);
      }
    for (const [run, column, row] of this.shownCells()) {
      const now = run === this.shown, x = left + column * w, y = margin + (rows - 1 - row) * h, room = Math.max(0, (9 - Math.min(w, h)) / 2);
      pen.lineWidth = now ? 3 : 1.5;
      pen.strokeStyle = now ? colours.force : "#fff";
      pen.strokeRect(x - room, y - room, w + 2 * room, h + 2 * room);
      pen.lineWidth = 0.75;
      pen.strokeStyle = "#000";
      pen.strokeRect(x - room - 1.5, y - room - 1.5, w + 2 * room + 3, h + 2 * room + 3);
    }
    this.drawAxes(pen, width, height);
  }
  private drawAxes(pen: CanvasRenderingContext2D, width: number, height: number): void {
    const { axes } = this.sweep.stored, across = axes[axes.length - 1], up = axes[axes.length - 2];
    pen.fillStyle = pen.strokeStyle = getComputedStyle(this.canvas).color;
    pen.font = "11px system-ui, sans-serif";
    pen.lineWidth = 1;
    const write = (what: string, x: number, y: number, align: CanvasTextAlign) => {
      pen.textAlign = align;
      pen.fillText(what, x, y);
    };
    const wide = width - left - margin, high = height - bottom - margin;
    for (const [part, text] of ticksOf(across.values, named(across.name).factor, Math.floor(wide / 60))) {
      const x = left + part * wide;
      pen.fillRect(x, height - bottom, 1, 4);
      write(text, x, height - bottom + 15, "center");
    }
    write(axisName(across), left + wide / 2, height - 4, "center");
    if (!up) return;
    for (const [part, text] of ticksOf(up.values, named(up.name).factor, Math.floor(high / 30))) {
      const y = margin + (1 - part) * high;
      pen.fillRect(left - 4, y, 4, 1);
      write(text, left - 7, y + 4, "right");
    }
    pen.save();
    pen.translate(11, margin + high / 2);
    pen.rotate(-Math.PI / 2);
    write(axisName(up), 0, 0, "center");
    pen.restore();
  }
}
