// Text beside the pictures: values at the tick, what the page is of, the legend and the keys.
import { colours, curveColour, heights, rampStyle } from "./colours";
import { type Claim, type Run, digits } from "./data";
import { mmPerMetreASecond } from "./hand";
import { storyOf } from "./story";

function element(name: string, text = "", className = ""): HTMLElement {
  const made = document.createElement(name);
  made.textContent = text;
  if (className) made.className = className;
  return made;
}

export const licence = "This page contains three.js, Copyright 2010-2025 three.js authors, MIT licence: https://threejs.org/license";

const keysOfRuns: [string, string][] = [
  ["space", "play or stop"], [", .", "one tick back or on"], ["left, right", "one frame back or on"], ["e, E", "next or previous event"],
  ["- +", "slower or faster"], ["z x", "plots: more detail, or more time"], ["[ ]", "plots: earlier or later"], ["0", "plots: the whole run"],
  ["f", "plots: the time of one frame"], ["1 2 3 4", "camera: sensor, side, follow, across the force"], ["t", "true surface on or off"],
  ["r", "forbidden regions on or off"], ["s", "spheres of the tool on or off"], ["i", "configuration and command"], ["h, ?", "this help"],
];

// Whether a column has a number other than 0 in any tick; of a live run that has not begun nobody knows.
function isUsed(run: Run, name: string): boolean {
  const column = run.columns.get(name);
  return column !== undefined && (run.ticks === 0 || column.numbers.some((value) => Number.isFinite(value) && value !== 0));
}
// Nobody knows it of a live run that has not begun; then the answer is true if there is a slave.
function slaveDiffers(run: Run): boolean {
  for (let tick = 0; tick < run.ticks; ++tick) {
    const proxy = run.vector("proxy_position", tick);
    if (run.vector("slave_command", tick).some((x, k) => Math.abs(x - proxy[k]) > 0)) return true;
  }
  return run.ticks === 0 && run.slaveRadiusM > 0;
}

// Returns whether some arrow of a column is cut at the longest length. The answer is true for a live run that has not begun.
function isCut(run: Run, name: string, mmPerUnit: number, longestMm: number): boolean {
  const column = run.columns.get(name);
  if (!column || run.ticks === 0) return column !== undefined;
  for (let tick = 0; tick < run.ticks; ++tick) if (mmPerUnit * Math.abs(column.magnitude(tick)) > longestMm) return true;
  return false;
}

// The list of what is in the picture. longestMm: the longest arrow that is drawn.
export function legend(runs: Run[], mmPerN: number, longestMm = Number.POSITIVE_INFINITY): HTMLElement {
  const list = element("ul", "", "legend"), run = runs[0], { tool } = run.stored, frames = [...run.frames.values()];
  const add = (colour: string, text: string) => {
    const item = element("li", text);
    item.style.setProperty("--dot", colour);
    list.append(item);
  };
  const two = (mm: number) => digits(Number(mm.toPrecision(2)));
  const most = (cut: boolean) => (cut ? `, at most ${two(longestMm)} mm` : "");
  add(colours.hip, tool ? "HIP and device's pose" : "HIP: where the hand is");
  add(colours.proxy, tool ? "tool" : `proxy${run.contactRadiusM > 0 ? ", radius r_c" : ""}; path of 0.3 s`);
  const hasSlave = runs.some((one) => one.slaveRadiusM > 0);
  if (runs.length === 2) add(colours.second, `${runs[1].slaveRadiusM > 0 ? "HIP, proxy and slave" : "HIP and proxy"} of run 2`);
  add(colours.force, `${run.forceName === "force" ? "force" : "force of the device"}: ${two(mmPerN)} mm per N${most(runs.some((one) => isCut(one, one.forceName, mmPerN, longestMm) || isCut(one, "slave_force", mmPerN, longestMm)))}`);
  add(colours.normal, "surface normal");
  add(colours.touching, "points that touch");
  if (frames.length === 0 || frames.some((frame) => !frame.colours)) add(rampStyle(heights), frames.length === 0 ? "points: own colours, or dark low" : "points: dark low, light high");
  if (run.stored.truth) add(colours.truth, run.truthName);
  if (run.stored.true_meshes) add(colours.truth, `true surface: ${run.stored.true_meshes.map((mesh) => mesh.name).join(", ")}`);
  if (isUsed(run, "surface_velocity")) add(colours.estimate, `velocity estimate: ${two(mmPerMetreASecond)} mm per m/s${most(isCut(run, "surface_velocity", mmPerMetreASecond, longestMm))}`);
  if (frames.some((frame) => frame.fixtureRadiusM)) add(colours.fixture, "forbidden regions");
  if (isUsed(run, "guidance_goal")) add(colours.guidance, "goal of the guidance");
  if (slaveDiffers(run)) add(colours.slave, "slave command, if not the proxy");
  if (hasSlave) add(colours.robot, `slave: ${tool ? "tool" : "ball"}, force on it, line to the command it received`);
  return list;
}

// "scenario.noise_sigma_m": 0.003 of all settings of a configuration.
function settings(value: unknown, name = ""): Map<string, string> {
  if (value === null || typeof value !== "object") return new Map([[name, String(value)]]);
  return new Map(Object.entries(value).flatMap(([key, part]) => [...settings(part, name ? `${name}.${key}` : key)]));
}

// The story of two runs, and a list of them: the file of each, and the settings in which they differ. The titles say the same
// at greater length.
export function whichIsWhich(runs: Run[]): HTMLElement[] {
  const most = 4, [a, b] = runs.map((run) => settings(run.stored.configuration));
  const names = [...new Set([...a.keys(), ...b.keys()])].filter((name) => name !== "title" && a.get(name) !== b.get(name));
  const list = element("ul", "", "legend which");
  runs.forEach((run, i) => {
    const own = names.slice(0, most).map((name) => `${name} ${(i === 0 ? a : b).get(name) ?? "none"}`);
    const more = names.length > most ? `, and ${names.length - most} more` : "";
    const item = element("li", `run ${i + 1}: ${run.stored.file}${own.length > 0 ? `; ${own.join(", ")}${more}` : ""}`);
    item.style.setProperty("--dot", i === 0 ? curveColour(colours.proxy) : colours.second);
    list.append(item);
  });
  return [element("p", storyOf(runs), "story"), list];
}

// All columns at a tick; "-" where a run has no such tick.
export class Values {
  readonly element = element("table", "", "values");
  private readonly cells: [Run, string, HTMLElement][] = [];

  constructor(runs: Run[]) {
    const names = [...new Set(runs.flatMap((run) => [...run.columns.keys()]))];
    for (const name of names) {
      const row = element("tr"), column = runs[0].columns.get(name) ?? runs[1].column(name);
      const head = element("th", name);
      head.title = column.meaning;
      row.append(head);
      for (const run of runs) {
        const cell = element("td");
        row.append(cell);
        if (run.columns.has(name)) this.cells.push([run, name, cell]);
      }
      row.append(element("td", column.unit === "1" ? "" : column.unit));
      this.element.append(row);
    }
  }
  show(tick: number): void {
    for (const [run, name, cell] of this.cells) cell.textContent = run.has(tick) ? run.column(name).text(tick) : "-";
  }
}

export function helpDialog(): HTMLDialogElement {
  return keysDialog(keysOfRuns, "Scene: drag turns, the right button moves, the wheel zooms. Plots: a click goes to that time, the wheel zooms, a drag moves the time. Touch: two fingers zoom and turn.");
}

export function keysDialog(keys: [string, string][], more: string): HTMLDialogElement {
  const dialog = document.createElement("dialog"), table = element("table");
  for (const [key, meaning] of keys) {
    const row = element("tr");
    row.append(element("th", key), element("td", meaning));
    table.append(row);
  }
  dialog.append(element("h2", "Keys"), table, element("p", more));
  return closing(dialog);
}

export function aboutDialog(runs: Run[], licence: string): HTMLDialogElement {
  const dialog = document.createElement("dialog");
  for (const run of runs) {
    const { file, title, command, version, digest, note, configuration, shown, claims } = run.stored;
    dialog.append(element("h2", title || file));
    const table = element("table");
    const rows = [["file", file], ["command", command], ["version", version], ["digest", digest], ["points", shown], ["note", note]];
    for (const [name, value] of rows.filter((one) => one[1])) {
      const row = element("tr");
      row.append(element("th", name), element("td", value));
      table.append(row);
    }
    dialog.append(table);
    if (claims && claims.length > 0) dialog.append(element("h2", "Claims of this figure"), claimsTable(claims));
    dialog.append(element("h2", "Configuration"), element("pre", JSON.stringify(configuration, null, 1)));
  }
  dialog.append(element("p", "The hand and the force are simulated; no haptic device was used."), element("small", licence));
  return closing(dialog);
}

function claimsTable(claims: Claim[]): HTMLElement {
  const table = element("table"), head = element("tr");
  table.className = "claims";
  head.append(...["claim", "paper", "measured", "criterion", "verdict"].map((name) => element("th", name)));
  table.append(head);
  for (const { claim, paper, measured, unit, criterion, verdict } of claims) {
    const row = element("tr"), number = typeof measured === "number" ? digits(measured) : (measured ?? "");
    row.append(...[claim, paper, unit === "1" ? number : `${number} ${unit}`, criterion, verdict].map((text) => element("td", text)));
    table.append(row);
  }
  return table;
}

function closing(dialog: HTMLDialogElement): HTMLDialogElement {
  const close = element("button", "Close", "close");
  close.addEventListener("click", () => dialog.close());
  dialog.prepend(close);
  return dialog;
}
