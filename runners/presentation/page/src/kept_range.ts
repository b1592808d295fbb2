// The range of an axis of a live run. It grows with the values. It shrinks only after they have used little of it for a
// while, because nobody can compare heights on an axis that changes all the time.
import { round125 } from "./data";

const little = 0.3; // part of the range
const patienceMs = 10000;

export type Range = [low: number, high: number, step: number];

export class KeptRange {
  private range: Range | null = null;
  private littleSinceMs: number | null = null;

  // seen: the range of the values that are shown now.
  of(seen: Range, nowMs: number): Range {
    const [low, high, step] = seen, before = this.range ?? seen;
    const isLittle = high - low < little * (before[1] - before[0]);
    this.littleSinceMs = isLittle ? (this.littleSinceMs ?? nowMs) : null;
    if (this.littleSinceMs !== null && nowMs - this.littleSinceMs > patienceMs) {
      this.littleSinceMs = null;
      this.range = seen;
    } else this.range = this.grown(before, low, high, step);
    return this.range;
  }
  // To a multiple of the step, so that it does not grow a little with every picture.
  private grown(before: Range, low: number, high: number, leastStep: number): Range {
    if (low >= before[0] && high <= before[1]) return before;
    const step = Math.max(round125((Math.max(high, before[1]) - Math.min(low, before[0])) / 2), leastStep);
    const [down, up] = [Math.floor(low / step) * step, Math.ceil(high / step) * step];
    return [low < before[0] ? down : before[0], high > before[1] ? up : before[1], step];
  }
}
