// The events of a run: as a list in words, and which of them is the most important one.
import { eventColour, type Meaning, pageColour } from "./colours";
import { differenceOf, digits, type Run, type RunEvent } from "./data";

const byImportance: Meaning[] = ["divergence", "pop-through", "slave contact", "hardest hit", "force jump", "largest force", "first contact", "task", "not converged"];

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
  const rank = (event: RunEvent) => (byImportance as string[]).indexOf(event.kind);
  return [...events].sort((a, b) => rank(b) - rank(a));
}

// The difference between two runs in one sentence, such as "Run 2 pops through at 0.567 s, run 1 does not.": the most
// important event that only one of them has, or that they have at different times.
export function storyOf(runs: Run[]): string {
  const acts: [string, string][] = [["pop-through", "pops through"], ["slave contact", "touches the scene with its slave"], ["first contact", "first touches"]];
  for (const [kind, act] of acts) {
    const [a, b] = runs.map((run) => {
      const first = run.events.find((event) => event.kind === kind);
      return first && first.tick / run.stored.haptic_rate_hz;
    });
    if (a === b) continue; // both at the same time, or neither
    if (a === undefined || b === undefined) return `Run ${a === undefined ? 2 : 1} ${act} at ${(a ?? b ?? 0).toFixed(3)} s, run ${a === undefined ? 1 : 2} does not.`;
    return `Run 1 ${act} at ${a.toFixed(3)} s, run 2 at ${b.toFixed(3)} s.`;
  }
  const apart = differenceOf(runs, "proxy_position"), numbers = apart ? [...apart.numbers].filter(Number.isFinite) : [];
  const mostMm = 1000 * numbers.reduce((most, value) => Math.max(most, value), 0);
  return mostMm > 0 ? `The proxies are at most ${digits(Number(mostMm.toPrecision(2)))} mm apart.` : "The proxies move alike in both runs.";
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
      row.style.setProperty("--dot", pageColour(eventColour(event.kind)));
      row.tabIndex = -1; // the list is one stop of the keyboard; arrows move in it
      row.addEventListener("click", () => goTo(event.tick));
      item.append(row);
      this.list.append(item);
      return row;
    });
    if (this.rows.length > 0) this.rows[0].tabIndex = 0;
    this.list.addEventListener("keydown", (event) => this.move(event));
    this.element.append(this.list);
    this.element.hidden = events.length === 0;
  }
  show(tick: number): void {
    let seen: HTMLButtonElement | null = null;
    this.events.forEach((event, i) => {
      this.rows[i].ariaCurrent = event.tick === tick ? "time" : null;
      if (event.tick === tick) seen ??= this.rows[i];
    });
    if (!seen) return;
    this.scrollTo(seen);
    if (!this.list.contains(document.activeElement)) this.makeStop(seen);
  }
  private makeStop(row: HTMLButtonElement): void {
    for (const other of this.rows) other.tabIndex = other === row ? 0 : -1;
  }
  private move(event: KeyboardEvent): void {
    const at = this.rows.indexOf(document.activeElement as HTMLButtonElement), last = this.rows.length - 1;
    const to = ({ ArrowUp: Math.max(at - 1, 0), ArrowDown: Math.min(at + 1, last), Home: 0, End: last } as Record<string, number>)[event.key];
    if (to === undefined) return;
    event.preventDefault();
    this.makeStop(this.rows[to]);
    this.rows[to].focus();
  }
  private scrollTo(row: HTMLElement): void {
    const { list } = this, top = row.offsetTop; // from the list, which is positioned
    if (top < list.scrollTop || top + row.offsetHeight > list.scrollTop + list.clientHeight) list.scrollTop = top;
  }
}
