// The banner over the picture of a live page has one line for each state that the user must know.
import type { Run } from "./data";
import type { LinkState } from "./link_state";
import { type Limit, missedDeadlines, type Trouble } from "./live_run";

export interface Notice { kind: string; text: string }

// The state of the page. silentS: time since the newest tick came. whoActs: a statement if another page has the hand.
export interface LiveState { link: LinkState; trouble: Trouble; silentS: number; whoActs: string; limit: Limit | null; missed: string }

// A notice of the kind `held` stays for heldMs, so that a limit of a few ticks can be read.
const heldMs = 1500, held = "limited";

function sentence(text: string): string {
  return text && `${text[0].toUpperCase()}${text.slice(1)}.`;
}

export function noticesOf({ link, trouble, silentS, whoActs, limit, missed }: LiveState): Notice[] {
  if (link.kind !== "open") return [{ kind: link.kind, text: `${link.text}${link.kind === "ended" ? " The picture is its last one." : ""}` }];
  const all: Notice[] = [
    { kind: "ticks", text: silentS > 1 ? `No tick has arrived for ${silentS.toFixed(0)} s: the picture is the last one.` : "" },
    { kind: "camera", text: sentence(trouble.camera) },
    { kind: "gate", text: sentence(trouble.force && `force is off: ${trouble.force}`) },
    ...(limit && !trouble.force ? [limit] : []),
    { kind: "deadlines", text: missed },
    { kind: "watches", text: whoActs },
  ];
  return all.filter(({ text }) => text !== "");
}

// Returns a sentence about missed deadlines in the newest `seconds`; empty if at most 1 % of the ticks missed theirs.
export function missedText(run: Run, tick: number, seconds: number): string {
  const { missed, ticks, longestS } = missedDeadlines(run, tick, seconds);
  if (missed <= 0.01 * (ticks + missed)) return "";
  return `This machine is too busy: ${missed} of ${ticks + missed} ticks missed their deadline in the last ${seconds} s, `
    + `with a pause of up to ${(1000 * longestS).toFixed(0)} ms. The force may feel rough.`;
}

export class Banner {
  readonly element = document.createElement("div");
  private last: { notice: Notice; ms: number } | null = null; // the newest of the kind that is held
  private readonly lines = new Map<string, HTMLElement>();

  // act: what the user can do while another page has the hand.
  constructor(private readonly act: HTMLButtonElement) {
    this.element.className = "banner";
    this.element.setAttribute("role", "status");
  }

  // isLive: the run continues as far as the page knows.
  show(notices: Notice[], isLive: boolean): void {
    const now = performance.now(), limited = notices.find(({ kind }) => kind === held);
    if (limited) this.last = { notice: limited, ms: now };
    const isHeld = !limited && isLive && this.last !== null && now - this.last.ms < heldMs;
    this.showAll(isHeld && this.last ? [this.last.notice, ...notices] : notices);
  }

  // A line stays the same element as long as it is shown, or its button could not be clicked while texts change.
  private showAll(notices: Notice[]): void {
    for (const [kind, line] of this.lines) if (notices.every((notice) => notice.kind !== kind)) line.remove();
    for (const { kind, text } of notices) {
      const line = this.lines.get(kind) ?? this.line(kind), said = line.firstChild;
      if (said && said.textContent !== text) said.textContent = text;
      if (!line.isConnected) this.element.append(line);
    }
  }
  private line(kind: string): HTMLElement {
    const line = document.createElement("p");
    line.dataset.kind = kind;
    line.append(document.createElement("span"));
    if (kind === "watches") line.append(" ", this.act);
    this.lines.set(kind, line);
    return line;
  }
}
