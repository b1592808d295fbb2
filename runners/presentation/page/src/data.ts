// The page shows the JSON that runners/presentation/result_pages.cpp writes, and the numbers beside it.

export type Numbers = Float64Array | Float32Array | Int32Array | Uint32Array | Uint16Array | Uint8Array;
export type Vector = [number, number, number];

interface Packed { at: number; type: string; length: number }

interface StoredColumn { name: string; unit: string; meaning: string; width: number; names: string[]; numbers: Packed }
interface StoredFrame {
  index: number; captured_s: number; measured: number;
  positions: Packed; colours?: Packed; fixture_radius_m?: Packed; touching: Packed; touching_end: Packed;
}
// stays: until the next of the times, at which there was a capture; otherwise it moves evenly between them.
interface StoredTruth { columns: number; stays: boolean; low_m: Vector; high_m: Vector; time_s: Packed; height_m: Packed }
// low + step * number is a vertex, in the frame of the object. A pose, 7 numbers: position and orientation w x y z, is that
// of its time until the next of the times. NaN: not known.
export interface StoredMesh { name: string; low_m: Vector; step_m: number; vertices: Packed; triangles: Packed; time_s: Packed; poses: Packed }
interface StoredSensor { position_m: Vector; forward: Vector; up: Vector }

export interface RunEvent { tick: number; kind: string; text: string }

export interface Claim { claim: string; paper: string; measured: number | string | null; unit: string; criterion: string; verdict: string }

export interface StoredRun {
  file: string; title: string; command: string; version: string; digest: string; note: string; configuration: unknown;
  haptic_rate_hz: number; contact_radius_m: number; shown: string;
  columns: StoredColumn[]; events: RunEvent[]; low_m: Vector; high_m: Vector; corner_m: Vector; step_m: number; frames: StoredFrame[];
  claims?: Claim[]; truth?: StoredTruth; true_meshes?: StoredMesh[]; tool?: { vertices: Packed; triangles: Packed; spheres?: Packed }; sensor?: StoredSensor;
}

export interface LiveParameter { name: string; meaning: string; value: number; low: number; high: number; is_switch: boolean }
// Of a run that is going on; what comes later is not in it.
export type StoredLive = StoredRun & {
  touch_radius_m: number; near_m: number; start_m: Vector; device: string; depth: string; parameters: LiveParameter[]; protocol: number;
};

const kinds = {
  f64: Float64Array, f32: Float32Array, i32: Int32Array, u32: Uint32Array, u16: Uint16Array, u8: Uint8Array,
} as const;

function unpacked(buffer: ArrayBuffer, array: Packed): Numbers {
  return new kinds[array.type as keyof typeof kinds](buffer, array.at, array.length);
}

// Returns the numbers of ticks, increasing, from their times. last: the number of the tick before them, or -1.
export function ticksOf(times: Numbers, rateHz: number, last: number): number[] {
  let before = last;
  return Array.from(times, (timeS) => {
    const tick = Math.round(timeS * rateHz);
    before = tick > before ? tick : before + 1;
    return before;
  });
}

// A column of a trace; value(tick, part) of a vector's part. kept: a live run overwrites its oldest ticks. rows: the row of
// each tick, or -1; null: row and tick are the same.
export class Column {
  private leastShown = 0; // 0: not known yet

  constructor(readonly name: string, readonly unit: string, readonly meaning: string, readonly width: number,
    readonly names: string[], readonly numbers: Numbers, private readonly kept = Number.POSITIVE_INFINITY,
    private readonly rows: Int32Array | null = null) {}

  // NaN in a tick without a row.
  value(tick: number, part = 0): number {
    if (this.rows && !(this.rows[tick] >= 0)) return Number.NaN;
    const row = this.rows ? this.rows[tick] : tick < this.kept ? tick : tick % this.kept; // a division would take most of the time of a plot
    return this.numbers[row * this.width + part] ?? Number.NaN;
  }
  // Of a vector its length.
  magnitude(tick: number): number {
    if (this.width === 1) return this.value(tick);
    let sum = 0;
    for (let part = 0; part < this.width; ++part) sum += this.value(tick, part) ** 2;
    return Math.sqrt(sum);
  }
  text(tick: number): string {
    if (this.width === 1) return this.names[this.value(tick)] ?? (this.name === "time" ? timeDigits(this.value(tick)) : this.digits(this.value(tick)));
    return Array.from({ length: this.width }, (_, part) => this.digits(this.value(tick, part))).join("  ");
  }
  // A value that only rounding of larger ones has left is shown as 0.
  digits(value: number): string {
    return digits(Math.abs(value) < this.rounding() ? 0 : value);
  }
  private rounding(): number {
    const isLive = this.kept < Number.POSITIVE_INFINITY; // its largest value is not known yet
    if (this.leastShown === 0) {
      let largest = 0;
      if (!isLive) for (const value of this.numbers) if (Number.isFinite(value)) largest = Math.max(largest, Math.abs(value));
      this.leastShown = Math.max(1e-12 * largest, 1e-15);
    }
    return this.leastShown;
  }
}

// NaN: not known. Infinite is the distance of what is not there.
export function digits(value: number): string {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "unknown" : "none";
  return Number.isInteger(value) ? String(value) : String(Number(value.toPrecision(5)));
}

// Of a time in s: microseconds, so that each tick has its own.
export function timeDigits(timeS: number): string {
  return Number.isFinite(timeS) ? String(Number(timeS.toFixed(6))) : digits(timeS);
}

// A round number of that size or a little less: 1, 2 or 5 times a power of ten.
export function round125(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value)), first = value / power;
  return power * (first >= 5 ? 5 : first >= 2 ? 2 : 1);
}

export interface Frame {
  index: number;
  capturedS: number;
  positions: Uint16Array;
  colours: Uint8Array | null;
  fixtureRadiusM: Float32Array | null;
  touching: Uint32Array; // the points that touch, row after row from that of firstTick on
  touchingEnd: Uint32Array;
  firstTick: number; // that used the frame
}

function rowsOf(tickOfRow: number[]): Int32Array | null {
  const ticks = (tickOfRow.at(-1) ?? -1) + 1;
  if (ticks === tickOfRow.length) return null;
  const rows = new Int32Array(ticks).fill(-1);
  tickOfRow.forEach((tick, row) => { rows[tick] = row; });
  return rows;
}

// Ticks are numbered by their time: of a live session those that its loop left out have no row.
export class Run {
  contactRadiusM: number; // of the proxy; 0 where there is none
  readonly columns = new Map<string, Column>();
  readonly frames = new Map<number, Frame>();
  private readonly tickOfRow: number[];
  private readonly rowOfTick: Int32Array | null; // -1: none; null: row and tick are the same

  constructor(readonly stored: StoredRun, private readonly buffer: ArrayBuffer) {
    this.contactRadiusM = stored.contact_radius_m;
    const time = stored.columns.find((c) => c.name === "time");
    this.tickOfRow = time ? ticksOf(unpacked(buffer, time.numbers), stored.haptic_rate_hz, -1) : [];
    this.rowOfTick = rowsOf(this.tickOfRow);
    for (const c of stored.columns)
      this.columns.set(c.name, new Column(c.name, c.unit, c.meaning, c.width, c.names, unpacked(buffer, c.numbers), Number.POSITIVE_INFINITY, this.rowOfTick));
    for (const f of stored.frames)
      this.frames.set(f.index, {
        index: f.index,
        capturedS: f.captured_s,
        positions: unpacked(buffer, f.positions) as Uint16Array,
        colours: f.colours ? (unpacked(buffer, f.colours) as Uint8Array) : null,
        fixtureRadiusM: f.fixture_radius_m ? (unpacked(buffer, f.fixture_radius_m) as Float32Array) : null,
        touching: unpacked(buffer, f.touching) as Uint32Array,
        touchingEnd: unpacked(buffer, f.touching_end) as Uint32Array,
        firstTick: 0,
      });
    for (const tick of [...this.tickOfRow].reverse()) {
      const frame = this.frameAt(tick);
      if (frame) frame.firstTick = tick;
    }
  }

  get ticks(): number {
    return (this.tickOfRow.at(-1) ?? -1) + 1;
  }
  // Whether the run has made this tick.
  has(tick: number): boolean {
    return tick < this.ticks && (this.rowOfTick === null || this.rowOfTick[tick] >= 0);
  }
  // Returns this tick or, if the run has not made it, the newest tick before it, or else the first tick.
  known(tick: number): number {
    let known = Math.min(tick, this.ticks - 1);
    while (known > 0 && !this.has(known)) --known;
    return this.has(known) ? known : (this.tickOfRow[0] ?? known);
  }
  // A stored event names the row of its tick.
  get events(): RunEvent[] {
    return this.stored.events.map((event) => ({ ...event, tick: this.tickOfRow[event.tick] ?? event.tick }));
  }
  column(name: string): Column {
    const column = this.columns.get(name);
    if (!column) throw new Error(`the trace has no column ${name}`);
    return column;
  }
  // NaN where there is no such column.
  vector(name: string, tick: number): Vector {
    const c = this.columns.get(name);
    return c ? [c.value(tick, 0), c.value(tick, 1), c.value(tick, 2)] : [Number.NaN, Number.NaN, Number.NaN];
  }
  // w x y z, as stored.
  rotation(name: string, tick: number): [number, number, number, number] {
    const c = this.column(name);
    return [c.value(tick, 0), c.value(tick, 1), c.value(tick, 2), c.value(tick, 3)];
  }
  frameAt(tick: number): Frame | undefined {
    return this.frames.get(this.column("frame_index").value(tick));
  }
  touching(frame: Frame, tick: number): number[] {
    const k = this.rowOfTick ? this.rowOfTick[tick] - this.rowOfTick[frame.firstTick] : tick - frame.firstTick;
    return [...frame.touching.subarray(k > 0 ? frame.touchingEnd[k - 1] : 0, frame.touchingEnd[k])];
  }
  // Points that are drawn even where graphics are slow. A stored run has none: all its points are drawn when it is stopped.
  nearHand(_frame: Frame, _tick: number): number[] {
    return [];
  }
  // The radius of the slave's ball; 0 in a run without a slave.
  get slaveRadiusM(): number {
    const { slave } = this.stored.configuration as { slave?: { radius_m: number } };
    return slave && this.columns.has("slave_position") ? slave.radius_m : 0;
  }
  numbers(packed: Packed): Numbers {
    return unpacked(this.buffer, packed);
  }
  // The column of the force that acts on the hand: of the device, where it is known, which may be limited, else what the
  // renderer commands.
  get forceName(): string {
    return this.columns.has("device_force") ? "device_force" : "force";
  }
  // The column of the force that the device is to exert; null if it is not known. In a live run with a slave it is not the
  // force of the renderer. A stored run has only the force that the device exerts on the hand of a slave's operator.
  get commandedForceName(): string | null {
    if (this.columns.has("commanded_force")) return "commanded_force";
    return this.columns.has("slave_position") ? null : "force";
  }
  // The surface from which signed_distance is measured.
  get truthName(): string {
    return this.stored.truth?.stays ? "true surface at the last capture" : "true surface";
  }
  // A position is low + step * number, m.
  grid(): { low: Vector; step: number } {
    return { low: this.stored.corner_m, step: this.stored.step_m };
  }
  // The position of a point of a frame, m.
  point(frame: Frame, i: number): Vector {
    const { low, step } = this.grid(), p = frame.positions;
    return [low[0] + step * p[3 * i], low[1] + step * p[3 * i + 1], low[2] + step * p[3 * i + 2]];
  }
}

// How far two runs are apart in a column, tick by tick; of vectors the length of the difference. NaN: one of them has no such tick.
export function differenceOf(runs: Run[], name: string): Column | null {
  const [a, b] = runs.map((run) => run.columns.get(name));
  if (!a || !b) return null;
  const ticks = Math.min(runs[0].ticks, runs[1].ticks), apart = new Float64Array(ticks);
  for (let tick = 0; tick < ticks; ++tick) {
    let sum = 0;
    for (let part = 0; part < a.width; ++part) sum += (a.value(tick, part) - b.value(tick, part)) ** 2;
    apart[tick] = Math.sqrt(sum);
  }
  return new Column(`difference of ${name}`, a.unit, `distance between both traces: ${a.meaning}`, 1, [], apart);
}

interface StoredSweep {
  file: string; title: string; replicates: number; judged: string; threshold: number; runs: number[];
  done: number[]; // runs of each cell that are done
  notes: string[]; // how many runs have each kind of note
  axes: { name: string; unit: string; values: (number | string)[] }[];
  measures: { name: string; unit: string; meaning: string; numbers: Packed }[];
}

// The map of a sweep. Cells are numbered with the last axis running fastest.
export class Sweep {
  constructor(readonly stored: StoredSweep, private readonly buffer: ArrayBuffer) {}

  measure(name: string): Numbers {
    const found = this.stored.measures.find((measure) => measure.name === name);
    if (!found) throw new Error(`the sweep has no measure ${name}`);
    return unpacked(this.buffer, found.numbers);
  }
  private finite(numbers: Numbers, cell: number): number[] {
    const { replicates } = this.stored;
    return [...numbers.subarray(cell * replicates, (cell + 1) * replicates)].filter(Number.isFinite);
  }
  // The mean of the replicates that have a number; NaN if none has.
  mean(numbers: Numbers, cell: number): number {
    const values = this.finite(numbers, cell);
    return values.length > 0 ? values.reduce((sum, value) => sum + value, 0) / values.length : Number.NaN;
  }
  // ", mean of 4 of 5 runs": those that have a number, and those that are done. Empty for a single run with a number.
  meanOf(numbers: Numbers, cell: number): string {
    const known = this.finite(numbers, cell).length, done = this.stored.done[cell];
    if (done === known) return done > 1 ? `, mean of ${done} runs` : "";
    return known > 0 ? `, mean of ${known} of ${done} runs` : "";
  }
  cellOf(shown: number): number {
    return Math.floor(this.stored.runs[shown] / this.stored.replicates);
  }
  place(cell: number): number[] {
    const place: number[] = [];
    let rest = cell;
    for (const axis of [...this.stored.axes].reverse()) {
      place.unshift(rest % axis.values.length);
      rest = Math.floor(rest / axis.values.length);
    }
    return place;
  }
  cellAt(place: number[]): number {
    return place.reduce((cell, at, k) => cell * this.stored.axes[k].values.length + at, 0);
  }
  // "noise_sigma_m = 0.003 m, rule = none"
  text(cell: number): string {
    const place = this.place(cell);
    return this.stored.axes.map(({ name, unit, values }, k) => {
      const value = values[place[k]];
      return `${name} = ${typeof value === "number" ? digits(value) : value}${unit === "1" ? "" : ` ${unit}`}`;
    }).join(", ");
  }
}

export interface View { runs: Run[]; sweep: Sweep | null; live: StoredLive | null; buffer: ArrayBuffer }

async function decompressed(base64: string): Promise<ArrayBuffer> {
  const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

export async function readView(): Promise<View> {
  const text = (id: string) => document.getElementById(id)?.textContent ?? "";
  const page = JSON.parse(text("view")) as { schema: string; runs: StoredRun[]; sweep?: StoredSweep; live?: StoredLive };
  const buffer = await decompressed(text("numbers"));
  const runs = page.runs.map((run) => new Run(run, buffer));
  return { runs, sweep: page.sweep ? new Sweep(page.sweep, buffer) : null, live: page.live ?? null, buffer };
}
