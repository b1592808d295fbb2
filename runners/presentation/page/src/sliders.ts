// Sliders for the parameters that may change during a live run.
import { button } from "./button";
import { digits, type LiveParameter } from "./data";
import { named } from "./words";

export interface Change { parameter: number; value: number }

const steps = 100;
const radii = ["renderer.r1_m", "renderer.r2_m", "renderer.r3_m"];

// Positions from -steps to steps. The first value lies in the middle, and 1/8 of it and 8 times it at the ends; the left
// end is 0 where 0 is allowed. A parameter that begins with 0 goes up to its maximum.
export function valueAt(position: number, p: LiveParameter): number {
  if (position <= -steps && p.low === 0) return 0;
  const value = p.value > 0 ? p.value * 8 ** (position / steps) : p.high * 10 ** ((2 * (position - steps)) / steps);
  return Math.min(p.high, Math.max(p.low, value));
}
export function positionOf(value: number, p: LiveParameter): number {
  if (!(value > 0)) return -steps;
  const position = p.value > 0 ? (steps * Math.log(value / p.value)) / Math.log(8) : steps + (steps * Math.log10(value / p.high)) / 2;
  return Math.min(steps, Math.max(-steps, position));
}

// The radii of a proxy change together: r1 < r2 < r3 stays true.
function together(parameters: LiveParameter[]): number[][] {
  const of = parameters.map((p, i) => ({ name: p.name, i })).filter(({ name }) => radii.includes(name)).map(({ i }) => i);
  const others = parameters.map((_, i) => [i]).filter(([i]) => !of.includes(i));
  return of.length === radii.length ? [of, ...others] : parameters.map((_, i) => [i]);
}

export class Sliders {
  readonly element = document.createElement("fieldset");
  private readonly refused = document.createElement("p");
  private readonly shows: ((values: number[]) => void)[] = [];
  private dragged: HTMLInputElement | null = null;
  private asked = false; // and not answered
  private readonly next = new Map<number, Change[]>(); // the newest of each slider

  constructor(private readonly parameters: LiveParameter[], private readonly send: (changes: Change[]) => void) {
    const legend = document.createElement("legend");
    legend.append("Parameters ", button("Reset", "values at the start of the run", () => {
      for (const group of together(parameters)) this.ask(group.map((i) => ({ parameter: i, value: parameters[i].value })));
    }));
    this.refused.className = "warning";
    this.refused.hidden = true;
    this.element.className = "sliders";
    this.element.append(legend, ...together(parameters).map((group) => this.row(group)), this.refused);
    this.show(parameters.map((p) => p.value), "");
  }

  // What the run has now, and why it did not make the newest changes.
  show(values: number[], refused: string): void {
    for (const one of this.shows) one(values);
    this.refused.hidden = refused === "";
    this.refused.textContent = refused;
    this.asked = false;
    const [waiting] = this.next;
    if (!waiting) return;
    this.next.delete(waiting[0]);
    this.ask(waiting[1]);
  }

  // An answer that was awaited may never come after a lost connection.
  enable(on: boolean): void {
    this.element.disabled = !on;
    if (on) return;
    this.asked = false;
    this.next.clear();
  }

  // One at a time: each is checked with the whole experiment.
  private ask(changes: Change[]): void {
    if (this.asked) {
      this.next.set(changes[0].parameter, changes);
      return;
    }
    this.asked = true;
    this.send(changes);
  }

  private row(group: number[]): HTMLLabelElement {
    const label = document.createElement("label"), name = document.createElement("span"), value = document.createElement("output");
    const input = document.createElement("input"), first = this.parameters[group[0]], { words, factor, name: unit } = named(first.name);
    label.title = group.map((i) => `${this.parameters[i].name}: ${this.parameters[i].meaning}`).join("\n");
    name.textContent = group.length > 1 ? "radii r1, r2, r3 of the proxy" : words;
    if (first.is_switch) {
      input.type = "checkbox";
      label.className = "switch";
      input.addEventListener("change", () => {
        this.ask([{ parameter: group[0], value: input.checked ? 1 : 0 }]);
        input.blur(); // keys are for the hand
      });
      this.shows.push((values) => {
        input.checked = values[group[0]] === 1;
        value.textContent = input.checked ? "on" : "off";
      });
    } else {
      Object.assign(input, { type: "range", min: String(-steps), max: String(steps), step: "1" });
      input.addEventListener("input", () => this.ask(this.changes(group, Number(input.value))));
      input.addEventListener("pointerdown", () => { this.dragged = input; });
      for (const end of ["pointerup", "pointercancel"])
        input.addEventListener(end, () => {
          this.dragged = null;
          input.blur();
        });
      this.shows.push((values) => {
        if (this.dragged !== input) input.value = String(positionOf(values[group[0]], first));
        value.textContent = `${group.map((i) => digits(Number((factor * values[i]).toPrecision(4)))).join(", ")} ${unit}`.trimEnd();
      });
    }
    label.append(input, name, value);
    return label;
  }
  private changes(group: number[], position: number): Change[] {
    const first = this.parameters[group[0]];
    if (group.length === 1) return [{ parameter: group[0], value: valueAt(position, first) }];
    const factor = valueAt(position, { ...first, low: Number.MIN_VALUE, high: Number.MAX_VALUE }) / first.value;
    return group.map((i) => ({ parameter: i, value: factor * this.parameters[i].value }));
  }
}
