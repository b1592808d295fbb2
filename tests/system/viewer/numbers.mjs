// What the pages compute from the numbers of runs, without a browser: ticks by their time, differences, missed deadlines,
// regions, texts. Usage: node numbers.mjs SOURCES, the folder src of the page
import assert from "node:assert/strict";
import { test } from "node:test";
import { buildSync } from "esbuild";

// Only what modules use while they load.
globalThis.window = { matchMedia: () => ({ matches: false }), addEventListener() {} };
const names = ["data", "live_run", "banner", "cloud", "hand", "words"];
const contents = names.map((name) => `export * from "./${name}";`).join("\n");
const [{ text }] = buildSync({ stdin: { contents, resolveDir: process.argv[2] }, bundle: true, format: "esm", write: false, nodePaths: ["node_modules"] }).outputFiles;
const { Column, differenceOf, digits, LiveRun, missedText, named, regionKey, Run, timeDigits, wayTo } = await import(`data:text/javascript;base64,${Buffer.from(text).toString("base64")}`);

const rateHz = 1000;
// A stored run of these ticks. at(tick): its HIP and proxy, m.
function runOf(ticks, at, events = []) {
  const parts = { time: [1, ticks.map((tick) => tick / rateHz)], frame_index: [1, ticks.map((tick) => Math.floor(tick / 10))] };
  for (const name of ["hip_position", "proxy_position"]) parts[name] = [3, ticks.flatMap((tick) => [at(tick), 0, 0])];
  const frames = [...new Set(parts.frame_index[1])].map((index) => ({ index, rows: parts.frame_index[1].filter((one) => one === index).length }));
  const arrays = [...Object.values(parts).map(([, numbers]) => Float64Array.from(numbers))];
  for (const { rows } of frames) arrays.push(new Uint16Array(30), Uint32Array.from({ length: rows }, (_, k) => k), Uint32Array.from({ length: rows }, (_, k) => k + 1));
  const bytes = arrays.map((array) => Buffer.from(array.buffer)), padded = bytes.map((one) => Buffer.concat([one, Buffer.alloc((8 - (one.length % 8)) % 8)]));
  const whole = Buffer.concat(padded), buffer = whole.buffer.slice(whole.byteOffset, whole.byteOffset + whole.length);
  let at_ = 0;
  const packed = arrays.map((array, i) => {
    const one = { at: at_, type: { Float64Array: "f64", Uint16Array: "u16", Uint32Array: "u32" }[array.constructor.name], length: array.length };
    at_ += padded[i].length;
    return one;
  });
  const columns = Object.entries(parts).map(([name, [width]], i) => ({ name, unit: "m", meaning: name, width, names: [], numbers: packed[i] }));
  const stored = frames.map(({ index }, i) => {
    const [positions, touching, touching_end] = packed.slice(columns.length + 3 * i);
    return { index, captured_s: index / 100, measured: 10, positions, touching, touching_end };
  });
  return new Run({ haptic_rate_hz: rateHz, contact_radius_m: 0.005, columns, frames: stored, events, corner_m: [0, 0, 0], step_m: 1 }, buffer);
}
const all = (count) => Array.from({ length: count }, (_, i) => i);
const moves = (tick) => 0.3 * (tick / rateHz); // 0.3 m/s

test("a run that left out ticks has each row at its time", () => {
  const whole = runOf(all(50), moves, [{ tick: 12, kind: "task", text: "x" }]);
  assert.equal(whole.ticks, 50);
  assert.deepEqual(whole.events.map(({ tick }) => tick), [12]);
  assert.ok(all(50).every((tick) => whole.has(tick) && whole.known(tick) === tick));

  const made = all(50).filter((tick) => tick > 2 && (tick < 10 || tick > 14) && tick % 7 !== 0);
  const run = runOf(made, moves, [{ tick: 12, kind: "task", text: "x" }]);
  assert.equal(run.ticks, 49);
  for (const tick of all(49)) {
    const isMade = made.includes(tick), before = made.findLast((one) => one <= tick) ?? made[0];
    assert.equal(run.has(tick), isMade);
    assert.equal(run.known(tick), before);
    assert.equal(run.column("time").value(tick), isMade ? tick / rateHz : Number.NaN);
    assert.equal(run.vector("hip_position", tick)[0], isMade ? moves(tick) : Number.NaN);
    assert.equal(run.frameAt(before).index, Math.floor(before / 10));
    // Each row of a frame touches one point, whose number is that of the row in the frame.
    const rows = made.filter((one) => Math.floor(one / 10) === Math.floor(before / 10));
    assert.deepEqual(run.touching(run.frameAt(before), before), [rows.indexOf(before)], `tick ${tick}`);
  }
  assert.equal(run.has(49), false);
  assert.deepEqual(run.events.map(({ tick }) => tick), [made[12]]);
});

test("two runs are compared at the same time", () => {
  const made = all(200).filter((tick) => tick % 5 !== 3), apart = differenceOf([runOf(all(200), moves), runOf(made, moves)], "hip_position");
  for (const tick of all(200)) assert.equal(apart.value(tick), made.includes(tick) ? 0 : Number.NaN, `tick ${tick}`);
});

test("the path of the proxy joins the places that are known", () => {
  for (const every of [1, 2, 3]) {
    const made = all(400).filter((tick) => tick % every === 0), way = wayTo(runOf(made, moves), 399);
    assert.deepEqual(way.map(([x]) => x), made.filter((tick) => tick >= 99).map(moves), `one tick of ${every}`);
  }
});

// A live run of these columns, whose ticks have arrived.
function liveOf(ticks, intervalOf) {
  const infos = ["time", "tick_interval"].map((name) => ({ name, unit: "s", meaning: name, width: 1, names: [] }));
  const run = new LiveRun({ haptic_rate_hz: rateHz, contact_radius_m: 0.005, touch_radius_m: 0.005, near_m: 0.02, start_m: [0, 0, 0] }, new ArrayBuffer(0), infos);
  const numbers = Float64Array.from([...ticks.map((tick) => tick / rateHz), ...ticks.map(intervalOf)]), view = new DataView(new ArrayBuffer(16 + numbers.byteLength));
  view.setUint32(8, ticks.length, true);
  new Float64Array(view.buffer, 16).set(numbers);
  run.takeTicks(view);
  return run;
}

test("missed deadlines are counted once, of the ticks that arrived", () => {
  const second = all(20000).filter((tick) => tick % 2 === 0);
  assert.match(missedText(liveOf(second, () => 0.002), 19998, 5), /: 2500 of 5000 ticks missed .* 5 s, with a pause of up to 2 ms/);
  // The page was opened 1 s ago; 4 % were missed since.
  const since = all(1000).map((tick) => 100000 + tick).filter((tick) => tick % 25 !== 0);
  assert.match(missedText(liveOf(since, (tick) => (tick % 25 === 1 ? 0.002 : 0.001)), 100999, 5), /: 40 of 1000 ticks/);
  assert.equal(missedText(liveOf(all(6000), () => 0.001), 5999, 5), "");
});

test("regions of other radii or at other places are drawn", () => {
  const keys = new Set([[0.01, 0.005], [0.02, 0.01], [0.02, 0.005], [0.01, 0.01]].map(([x, radius]) => regionKey([x, x, x], radius)));
  assert.equal(keys.size, 4);
  assert.equal(regionKey([0.01055, 0, 0], 0.005), regionKey([0.01065, 0, 0], 0.005001), "nearly the same");
});

test("each tick has its own time in the texts", () => {
  for (const hz of [1000, 3000]) {
    const texts = all(5000).map((tick) => timeDigits((123 * hz + tick) / hz));
    assert.equal(new Set(texts).size, texts.length, `${hz} Hz`);
  }
  assert.equal(new Column("time", "s", "", 1, [], Float64Array.of(123.456)).text(0), "123.456");
  assert.equal(timeDigits(Number.NaN), digits(Number.NaN));
});

test("a value that only rounding has left is shown as 0", () => {
  const force = new Column("force", "N", "", 3, [], Float64Array.of(2.5, 1e-17, -3e-33, 1e-9, 0, 2.4e-12));
  assert.deepEqual([0, 1].map((tick) => force.text(tick)), ["2.5  0  0", "1e-9  0  0"]);
  const small = new Column("energy", "J", "", 1, [], Float64Array.of(1e-13, 2e-14));
  assert.deepEqual([0, 1].map((tick) => small.text(tick)), ["1e-13", "2e-14"], "a column of small numbers keeps them");
});

test("parameters have words and the units that people read", () => {
  const texts = ["scenario.noise_sigma_m", "renderer.stiffness_N_per_m", "scenario.acceleration_m_per_s2", "frame_rate_hz", "renderer.gamma"]
    .map((name) => { const { words, name: unit, factor } = named(name); return `${words}: ${factor * 0.5} ${unit}`.trimEnd(); });
  assert.deepEqual(texts, ["noise sigma: 500 mm", "stiffness: 0.5 N/m", "acceleration: 0.5 m/s\u00b2", "frame rate: 0.5 Hz", "gamma: 0.5"]);
});
