// The events of a run: as a list in words, and which of them is the most important one.
import { eventColours } from "./colours";
import type { Run, RunEvent } from "./data";

const byImportance = ["divergence", "pop-through", "slave contact", "hardest hit", "force jump", "largest force", "first contact", "task", "not converged"];

// Returns the events of one run, or of both runs with the number of the run in the text.
export function eventsOf(runs: Run[]): RunEvent[] {
  if (runs.length === 1) return runs[0].events;
  return runs.flatMap((run, i) => run.events.map((event) =>
    event.kind === "divergence" ? event : { ...event, text: `Run ${i + 1}: ${event.text}` })).sort((a, b) => a.tick - b.tick);
}

// Returns the tick at which a page opens: the first event of the most important kind, or 0 without events.
export function mostImportantTick(events: RunEvent[]): number {
  for (const kind of byImportance) {
    const first = events.find((event) => event.kind === kind);
    if (first) return first.tick;
  }
  return 0;
}

// Returns the events in the order in which their marks are drawn: the most important one is drawn last, above the others.
export function leastImportantFirst(events: RunEvent[]): RunEvent[] {
  const rank = (event: RunEvent) => byImportance.indexOf(event.kind);
  return [...events].sort((a, b) => rank(b) - rank(a));
}

export class EventList {
  readonly element = document.createElement("section");
  private readonly list = document.createElement("ol");
  private readonly rows: HTMLButtonElement[];

  constructor(private readonly events: RunEvent[], goTo: (tick: number) => void) {
    this.element.className = "events";
    this.element.ariaLabel = "events";
    this.rows = events.map((event) => {
      const row = document.createElement("button"), item = document.createElement("li");
      row.type = "button";
      row.textContent = `tick ${event.tick}: ${event.text}`;
      row.style.setProperty("--dot", eventColours[event.kind] ?? "grey");
      row.addEventListener("click", () => goTo(event.tick));
      item.append(row);
      this.list.append(item);
      return row;
    });
    this.element.append(this.list);
    this.element.hidden = events.length === 0;
  }
  show(tick: number): void {
    let seen: HTMLButtonElement | null = null;
    this.events.forEach((event, i) => {
      this.rows[i].ariaCurrent = event.tick === tick ? "time" : null;
      if (event.tick === tick) seen ??= this.rows[i];
    });
    if (seen) this.scrollTo(seen);
  }
  private scrollTo(row: HTMLElement): void {
    const { list } = this, top = row.offsetTop - list.offsetTop;
    if (top < list.scrollTop || top + row.offsetHeight > list.scrollTop + list.clientHeight) list.scrollTop = top;
  }
}
