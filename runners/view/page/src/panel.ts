// Text beside the pictures: values at the tick, what the page is of, the legend and the keys.
import { colours } from "./colours";
import { type Claim, type Run, digits } from "./data";

function element(name: string, text = "", className = ""): HTMLElement {
  const made = document.createElement(name);
  made.textContent = text;
  if (className) made.className = className;
  return made;
}

export const licence = "This page contains three.js, Copyright 2010-2025 three.js authors, MIT licence: https://threejs.org/license";

const keysOfRuns: [string, string][] = [
  ["space", "play or stop"], [", .", "one tick back or on"], ["left, right", "one frame back or on"], ["e", "next event"],
  ["- +", "slower or faster"], ["1 2 3", "camera: sensor, side, follow"], ["t", "true surface on or off"],
  ["r", "forbidden regions on or off"], ["s", "spheres of the tool on or off"], ["i", "what this is of"], ["h, ?", "this help"],
];

export function legend(run: Run, mmPerN: number): HTMLElement {
  const list = element("ul", "", "legend");
  const add = (colour: string, text: string) => {
    const item = element("li", text);
    item.style.setProperty("--dot", colour);
    list.append(item);
  };
  add(colours.hip, run.stored.tool ? "HIP, and the tool at the device's pose" : "HIP: where the hand is");
  add(colours.proxy, run.stored.tool ? "tool" : "proxy, as large as r_c; its way of the last 0.3 s");
  add(colours.force, `force on the hand, 1 N is ${digits(Number(mmPerN.toPrecision(2)))} mm long`);
  add(colours.normal, "normal");
  add(colours.touching, "points that touch");
  if (run.stored.truth) add(colours.truth, "true surface");
  add(colours.velocity, "velocity estimate: how far the surface moves in 1/15 s");
  if ([...run.frames.values()].some((frame) => frame.fixtureRadiusM)) add(colours.fixture, "forbidden regions");
  add(colours.slave, "slave command, where it is not the proxy");
  return list;
}

// All columns at a tick.
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
    for (const [run, name, cell] of this.cells) cell.textContent = run.column(name).text(Math.min(tick, run.ticks - 1));
  }
}

export function helpDialog(): HTMLDialogElement {
  return keysDialog(keysOfRuns, "Mouse: drag turns, the right button moves, the wheel zooms. A click on a plot goes to that time.");
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
