// The moment in the page's address: "#tick=534", in the page of a sweep "#run=2&tick=534".

// A whole number in the address, or null. problem: what is wrong with it, and what is expected; empty: nothing.
export function numberIn(hash: string, name: string, low: number, high: number): { value: number | null; problem: string } {
  const text = new URLSearchParams(hash.replace(/^#/, "")).get(name);
  if (text === null) return { value: null, problem: "" };
  const value = /^\d+$/.test(text) ? Number(text) : Number.NaN;
  if (value >= low && value <= high) return { value, problem: "" };
  return { value: null, problem: `address: ${name}=${text.slice(0, 20)}: expected ${low} to ${high}` };
}

// One of several runs of a page, counted from 1.
export interface RunPlace { run: number; runs: number }

// Returns the run of a sweep that the address names; the first run if it names none.
export function runIn(hash: string, runs: number): RunPlace {
  return { run: numberIn(hash, "run", 1, runs).value ?? 1, runs };
}

// Replaces the address, so that "back" still leaves the page. A browser allows about a hundred changes in 30 s.
export class Address {
  private timer = 0;

  constructor(private readonly place: RunPlace | null) {}

  show(tick: number): void {
    clearTimeout(this.timer);
    const run = this.place ? `run=${this.place.run}&` : "";
    this.timer = setTimeout(() => history.replaceState(null, "", `#${run}tick=${tick}`), 400);
  }
  // The tick that the address names, and what is wrong with it.
  read(ticks: number): { tick: number | null; problem: string } {
    const { value, problem } = numberIn(location.hash, "tick", 0, ticks - 1);
    const run = this.place ? numberIn(location.hash, "run", 1, this.place.runs).problem : "";
    return { tick: value, problem: [run, problem].filter(Boolean).join("; ") };
  }
  end(): void {
    clearTimeout(this.timer);
  }
}
