// A live run: the last seconds of its ticks and its newest frame, as they come.
import { Column, digits, type Frame, Run, type StoredLive, type Vector } from "./data";

const keptS = 20;

export interface ColumnInfo { name: string; unit: string; meaning: string; width: number; names: string[] }

// Texts about camera and force that do not work while the run goes on; empty: they work. The server sends both at every change.
export interface Trouble { camera: string; force: string }

// Why the device gets another force than the renderer commands; empty: it gets that, or the trouble says why.
export function whyLimited(run: Run, tick: number, trouble: Trouble): string {
  if (trouble.force) return "";
  const sent = run.vector("device_force", tick), commanded = run.vector("force", tick);
  const size = (v: Vector) => Math.hypot(...v), apart = size(sent.map((x, k) => x - commanded[k]) as Vector);
  if (!(apart > 0.01 * size(commanded) + 0.01)) return "";
  const newtons = (v: Vector) => `${digits(Number(size(v).toPrecision(3)))} N`, gate = run.column("gate").text(tick);
  const why = ({
    waiting: "the force begins when the hand is free", ramping: "the force begins slowly", engaged: "limited for safety, or to what the device can do",
    latched: "the safety gate has switched the force off",
  } as Record<string, string>)[gate];
  return `The device receives ${newtons(sent)} of ${newtons(commanded)}: ${why}. `;
}

// Its ticks are numbered from the first that came; those before the last keptS seconds are gone.
export class LiveRun extends Run {
  count = 0; // ticks that came
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
    const near: number[] = [], proxy = this.vector("proxy_position", tick);
    if (!(this.touchRadiusM > 0) || !proxy.every(Number.isFinite)) return near;
    const { positions: p, fixtureRadiusM: radii } = frame, c = proxy.map((x, k) => (x - this.corner[k]) / this.step);
    const reach = this.touchRadiusM / this.step;
    for (let i = 0; i < p.length / 3; ++i) {
      const r = radii ? reach + radii[i] / this.step : reach, dx = p[3 * i] - c[0], dy = p[3 * i + 1] - c[1], dz = p[3 * i + 2] - c[2];
      if (dx * dx + dy * dy + dz * dz <= r * r) near.push(i);
    }
    return near;
  }

  takeTicks(view: DataView): void {
    const count = view.getUint32(8, true), all = new Float64Array(view.buffer, view.byteOffset + 16);
    let at = 0;
    for (const [column, numbers] of this.rows) {
      for (let i = 0; i < count; ++i) {
        const row = ((this.count + i) % this.kept) * column.width;
        numbers.set(all.subarray(at, at + column.width), row);
        at += column.width;
      }
    }
    this.count += count;
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
