// The part of the time that all plots of a page show: it zooms and moves by wheel, drag, pinch, keys and buttons. In ticks.
import type { RunEvent } from "./data";

const least = 8; // ticks
const clickPx = 4; // a pointer that moves less makes a click

export class TimeAxis {
  first = 0;
  shown: number; // number of ticks
  hover: number | null = null; // tick under the pointer
  private readonly listeners: (() => void)[] = [];
  private readonly pointers = new Map<number, number>(); // x of each that is down
  private moved = false;
  private waiting = false;

  // frames: the first tick of each frame. goTo: shows another tick.
  constructor(readonly ticks: number, readonly events: RunEvent[], readonly frames: number[],
    private readonly goTo: (tick: number) => void) {
    this.shown = ticks;
  }

  // Called once before the next picture of the browser, however much has changed until then.
  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
  get isWhole(): boolean {
    return this.shown >= this.ticks;
  }
  // factor: of the shown time; < 1 shows more detail. The tick `at` stays where it is.
  zoom(factor: number, at: number): void {
    const shown = Math.min(Math.max(this.shown * factor, Math.min(least, this.ticks)), this.ticks);
    this.set(at - ((at - this.first) * shown) / this.shown, shown);
  }
  pan(ticks: number): void {
    this.set(this.first + ticks, this.shown);
  }
  showAll(): void {
    this.set(0, this.ticks);
  }
  // The time in which one frame is in use, and a fifth of it before and after.
  showFrame(tick: number): void {
    const begin = this.frames.findLast((first) => first <= tick) ?? 0, end = this.frames.find((first) => first > tick) ?? this.ticks;
    this.set(begin - 0.2 * (end - begin), 1.4 * (end - begin));
  }
  // Moves, if that tick is outside.
  follow(tick: number): void {
    if (tick < this.first || tick > this.first + this.shown - 1) this.set(tick - 0.3 * this.shown, this.shown);
  }

  // The plot of all shown ticks fills the canvas to the right of `left`.
  listen(canvas: HTMLCanvasElement, left: number): void {
    const tickAt = (x: number) => {
      const box = canvas.getBoundingClientRect();
      return this.first + ((x - box.left - left) / Math.max(box.width - left - 1, 1)) * (this.shown - 1);
    };
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1, { deltaX, deltaY } = event;
      if (event.shiftKey || Math.abs(deltaX) > Math.abs(deltaY)) this.pan(((lines * (deltaX + deltaY)) / 800) * this.shown);
      else this.zoom(Math.exp(0.002 * lines * deltaY), tickAt(event.clientX));
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      if (this.pointers.size === 0) this.moved = false;
      else this.moved = true; // a pinch is no click
      this.pointers.set(event.pointerId, event.clientX);
    });
    canvas.addEventListener("pointermove", (event) => this.move(event, tickAt));
    canvas.addEventListener("pointerup", (event) => {
      if (this.pointers.delete(event.pointerId) && !this.moved) this.goTo(tickAt(event.clientX));
    });
    canvas.addEventListener("pointercancel", (event) => { this.pointers.delete(event.pointerId); });
    canvas.addEventListener("pointerleave", () => this.setHover(null));
  }
  private move(event: PointerEvent, tickAt: (x: number) => number): void {
    const before = this.pointers.get(event.pointerId), now = event.clientX;
    if (event.pointerType !== "touch") this.setHover(tickAt(now));
    if (before === undefined || (!this.moved && Math.abs(now - before) < clickPx)) return;
    this.moved = true;
    const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
    this.pointers.set(event.pointerId, now);
    if (other !== undefined) {
      const held = tickAt((before + other) / 2);
      if (Math.abs(now - other) > 10 && Math.abs(before - other) > 10) this.zoom(Math.abs((before - other) / (now - other)), held);
      this.pan(held - tickAt((now + other) / 2));
    } else if (this.isWhole) this.goTo(tickAt(now));
    else this.pan(tickAt(before) - tickAt(now));
  }
  private setHover(tick: number | null): void {
    this.hover = tick === null ? null : Math.min(Math.max(Math.round(tick), 0), this.ticks - 1);
    this.tell();
  }
  private set(first: number, shown: number): void {
    this.shown = Math.min(shown, this.ticks);
    this.first = Math.min(Math.max(first, 0), this.ticks - this.shown);
    this.tell();
  }
  private tell(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      for (const listener of this.listeners) listener();
    });
  }
}
