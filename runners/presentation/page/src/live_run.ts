// A live run: the last seconds of its ticks and its newest frame, as they come.
import { Column, digits, type Frame, Run, type StoredLive, ticksOf, type Vector } from "./data";

const keptS = 20;

export interface ColumnInfo { name: string; unit: string; meaning: string; width: number; names: string[] }

// Texts about camera and force that do not work while the run goes on; empty: they work. The server sends both at every change.
export interface Trouble { camera: string; force: string }

// A statement about the force that the safety gate passes. gate: it passes none; limited: it passes less than is commanded.
export interface Limit { kind: "gate" | "limited"; text: string }

// Returns why the device receives another force than is commanded; null if it receives that force.
export function limitOf(run: Run, tick: number): Limit | null {
  const sent = run.vector("device_force", tick), commanded = run.vector(run.commandedForceName ?? "force", tick);
  const size = (v: Vector) => Math.hypot(...v), apart = size(sent.map((x, k) => x - commanded[k]) as Vector);
  if (!(apart > 0.01 * size(commanded) + 0.01)) return null;
  const newtons = (v: Vector) => `${digits(Number(size(v).toPrecision(3)))} N`, gate = run.column("gate").text(tick);
  if (gate === "latched") return { kind: "gate", text: "Force is off: the safety gate has switched it off." };
  if (gate === "waiting" && size(sent) < 0.01)
    return { kind: "gate", text: `Force is off: the safety gate passes none of ${newtons(commanded)} until the hand is free. Move it out of the surface.` };
  const why = ({
    waiting: "the safety gate lets it fall to zero, until the hand is free", ramping: "the force begins slowly",
    engaged: "limited for safety, or to what the device can do",
  } as Record<string, string>)[gate];
  return { kind: "limited", text: `The device receives ${newtons(sent)} of ${newtons(commanded)}: ${why}.` };
}

// Counts the ticks of the newest seconds that arrived. missed: ticks that the haptic loop left out, because it was too late for
// them. Ticks before the page was opened, and those that were lost on the way to it, are in neither count.
export function missedDeadlines(run: Run, tick: number, seconds: number): { missed: number; ticks: number; longestS: number } {
  const interval = run.column("tick_interval"), time = run.column("time"), rate = run.stored.haptic_rate_hz;
  const first = Math.max(0, tick + 1 - Math.round(seconds * rate));
  let missed = 0, ticks = 0, longestS = 0;
  for (let i = first; i <= tick; ++i) {
    if (Number.isFinite(time.value(i))) ++ticks;
    const s = interval.value(i);
    if (!(s > 0)) continue;
    missed += Math.max(Math.round(s * rate) - 1, 0);
    longestS = Math.max(longestS, s);
  }
  return { missed, ticks, longestS };
}

// Its ticks are numbered by their time, so ticks that did not arrive leave a gap: before the page was opened, or while
// the connection was lost. Those before the last keptS seconds are gone.
export class LiveRun extends Run {
  count = 0; // the number of the newest tick, plus one
  frameCount = 0; // frames that came
  private readonly kept: number;
  private readonly rows: [Column, Float64Array][] = [];
  private touchRadiusM: number;
  private newest: Frame | undefined;
  private corner: Vector = [0, 0, 0];
  private step = 1;

  declare readonly stored: StoredLive & Run["stored"];

  constructor(stored: StoredLive, buffer: ArrayBuffer, infos: ColumnInfo[]) {
    const around = 0.12, [x, y, z] = stored.start_m;
    super({ ...stored, columns: [], events: [], frames: [], shown: "", step_m: 1, corner_m: [0, 0, 0],
      low_m: [x - around, y - around, z - around], high_m: [x + around, y + around, z + around] }, buffer);
    this.kept = Math.round(keptS * stored.haptic_rate_hz);
    for (const info of infos) {
      const numbers = new Float64Array(this.kept * info.width).fill(Number.NaN);
      const column = new Column(info.name, info.unit, info.meaning, info.width, info.names, numbers, this.kept);
      this.columns.set(info.name, column);
      this.rows.push([column, numbers]);
    }
    this.touchRadiusM = stored.touch_radius_m;
  }

  // The ticks that come from now on do not follow those that came.
  restart(): void {
    this.count = 0;
    for (const [, numbers] of this.rows) numbers.fill(Number.NaN);
  }
  // r1 and r2 of the proxy were changed.
  setRadii(r1M: number, r2M: number): void {
    this.contactRadiusM = (r1M + r2M) / 2;
    this.touchRadiusM = r2M;
  }
  override get ticks(): number {
    return this.count;
  }
  override frameAt(): Frame | undefined {
    return this.newest;
  }
  override grid(): { low: Vector; step: number } {
    return { low: this.corner, step: this.step };
  }
  // Those of the newest frame within the contact radius and the region of the point; of a tool they are not known.
  override touching(frame: Frame, tick: number): number[] {
    if (!(this.touchRadiusM > 0)) return [];
    return this.within(frame, this.vector("proxy_position", tick), this.touchRadiusM, frame.fixtureRadiusM);
  }
  // Returns the points of the newest frame within near_m of the HIP or the proxy. near_m grows with the contact radius.
  override nearHand(frame: Frame, tick: number): number[] {
    const { near_m, contact_radius_m } = this.stored, reach = contact_radius_m > 0 ? (near_m * this.contactRadiusM) / contact_radius_m : near_m;
    const around = ["proxy_position", "hip_position"].flatMap((name) => this.within(frame, this.vector(name, tick), reach, null));
    return [...new Set(around)];
  }
  private within(frame: Frame, centre: Vector, reachM: number, radii: Float32Array | null): number[] {
    const near: number[] = [], p = frame.positions, c = centre.map((x, k) => (x - this.corner[k]) / this.step), reach = reachM / this.step;
    if (!centre.every(Number.isFinite)) return near;
    for (let i = 0; i < p.length / 3; ++i) {
      const r = radii ? reach + radii[i] / this.step : reach, dx = p[3 * i] - c[0], dy = p[3 * i + 1] - c[1], dz = p[3 * i + 2] - c[2];
      if (dx * dx + dy * dy + dz * dz <= r * r) near.push(i);
    }
    return near;
  }

  takeTicks(view: DataView): void {
    const count = view.getUint32(8, true), all = new Float64Array(view.buffer, view.byteOffset + 16);
    const ticks = this.numbersOf(all, count);
    this.forget(this.count, ticks[count - 1]);
    let at = 0;
    for (const [column, numbers] of this.rows)
      for (const tick of ticks) {
        numbers.set(all.subarray(at, at + column.width), (tick % this.kept) * column.width);
        at += column.width;
      }
    if (count > 0) this.count = ticks[count - 1] + 1;
  }
  // The numbers of ticks that arrive.
  private numbersOf(all: Float64Array, count: number): number[] {
    let at = 0;
    for (const [column] of this.rows) {
      if (column.name === "time") break;
      at += count * column.width;
    }
    return ticksOf(all.subarray(at, at + count), this.stored.haptic_rate_hz, this.count - 1);
  }
  // Sets the ticks from first to last to unknown.
  private forget(first: number, last: number): void {
    for (let tick = Math.max(first, last - this.kept + 1); tick <= last; ++tick)
      for (const [column, numbers] of this.rows) numbers.fill(Number.NaN, (tick % this.kept) * column.width, (tick % this.kept + 1) * column.width);
  }
  takeFrame(view: DataView): void {
    const at = view.byteOffset, count = view.getUint32(12, true), parts = view.getUint32(16, true);
    this.step = view.getFloat64(24, true);
    this.corner = [32, 40, 48].map((place) => view.getFloat64(place, true)) as Vector;
    const positions = new Uint16Array(view.buffer, at + 56, 3 * count);
    let next = 56 + Math.ceil((6 * count) / 8) * 8;
    const colours = parts & 1 ? new Uint8Array(view.buffer, at + next, 3 * count) : null;
    if (colours) next += 3 * count;
    next = Math.ceil(next / 8) * 8;
    const radii = parts & 2 ? new Float32Array(view.buffer, at + next, count) : null;
    this.newest = {
      index: view.getInt32(8, true), capturedS: Number.NaN, positions, colours, fixtureRadiusM: radii, touching: new Uint32Array(),
      touchingEnd: new Uint32Array(), firstTick: this.count,
    };
    ++this.frameCount;
  }
}
