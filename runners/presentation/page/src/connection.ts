// The channel to a live run: its ticks and frames come, the hand's pose goes. runners/live/loop has the other end.
import type { Vector } from "./data";
import { type Answer, type LinkState, stateOf, waitS } from "./link_state";
import type { ColumnInfo, Trouble } from "./live_run";
import type { Change } from "./sliders";

export interface HandPose { position: Vector; orientation: [number, number, number, number]; buttons: number }

// columns: at the start of each connection. hand: whether this page moves the hand and has the sliders.
export interface Listener {
  columns(infos: ColumnInfo[]): void;
  parameters(values: number[], refused: string): void;
  ticks(view: DataView): void;
  frame(view: DataView): void;
  hand(has: boolean): void;
  trouble(trouble: Trouble): void;
  state(state: LinkState): void;
}

type Text = { columns: ColumnInfo[] } | { values: number[]; refused: string } | { hand: boolean } | { trouble: Trouble } | { ended: string } | { alive: true };

const answerMs = 5000; // for the server to say why there is no channel
const silentMs = 4000, cutMs = 20000; // without a message, of which the server sends one a second

function randomName(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(8)), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

// Connects, and connects again with growing waits when the connection is lost.
export class Connection {
  bytes = 0;
  socket: WebSocket | null = null;
  private readonly name = randomName();
  private newest = 0;
  private acknowledged = 0;
  private attempt = 0; // since the last message
  private timer = 0;
  private heardMs = 0;
  private lookedMs = 0;
  private isOver = false;

  constructor(private readonly listener: Listener, private readonly protocol: number) {
    window.setInterval(() => this.look(), 500);
    for (const event of ["online", "focus"]) window.addEventListener(event, () => this.tryNow());
    if (location.protocol === "http:") this.open();
    else this.finish({ kind: "copy", text: "This is a copy of a live run's page, which cannot show the run. Open the address that the terminal prints." });
  }

  // Ends the connection; it does not connect again.
  close(): void {
    this.isOver = true;
    window.clearTimeout(this.timer);
    this.socket?.close();
  }
  private finish(state: LinkState): void {
    this.close();
    this.listener.state(state);
  }

  private open(): void {
    const place = new URL(`channel?${this.name}`, location.href);
    place.protocol = "ws:";
    const socket = new WebSocket(place);
    this.socket = socket;
    this.timer = 0;
    this.newest = this.acknowledged = 0;
    this.heardMs = performance.now();
    if (this.attempt === 0) this.listener.state({ kind: "connecting", text: `Connecting to the run at ${location.host}.` });
    socket.binaryType = "arraybuffer";
    socket.addEventListener("message", (event: MessageEvent<string | ArrayBuffer>) => {
      if (socket === this.socket) this.hear(event.data);
    });
    socket.addEventListener("close", () => {
      if (socket === this.socket) void this.lost();
    });
  }
  private hear(data: string | ArrayBuffer): void {
    this.heardMs = performance.now();
    this.attempt = 0;
    if (!this.isOver) this.listener.state({ kind: "open", text: "" });
    if (typeof data === "string") {
      this.hearText(JSON.parse(data) as Text);
      return;
    }
    const view = new DataView(data);
    this.bytes += data.byteLength;
    if (view.getUint32(0, true) === 1) this.listener.ticks(view);
    else this.listener.frame(view);
    this.newest = view.getUint32(4, true);
  }
  private hearText(text: Text): void {
    if ("columns" in text) this.listener.columns(text.columns);
    else if ("values" in text) this.listener.parameters(text.values, text.refused);
    else if ("hand" in text) this.listener.hand(text.hand);
    else if ("trouble" in text) this.listener.trouble(text.trouble);
    else if ("ended" in text) this.finish(stateOf({ status: 200, protocol: this.protocol, ended: text.ended }, this.protocol));
  }

  // The connection is closed, and only the server knows why.
  private async lost(): Promise<void> {
    if (this.isOver) return;
    this.socket = null;
    this.listener.state({ kind: "lost", text: "The connection is lost." });
    const state = stateOf(await ask(this.name), this.protocol);
    if (this.isOver) return;
    if (state.final) {
      this.finish(state);
      return;
    }
    const againMs = performance.now() + 1000 * waitS(this.attempt++);
    const wait = () => {
      const leftS = Math.ceil((againMs - performance.now()) / 1000);
      this.listener.state({ ...state, text: `${state.text} ${leftS > 0 ? `Trying again in ${leftS} s` : "Trying again"} (attempt ${this.attempt}).` });
      this.timer = window.setTimeout(leftS > 0 ? wait : () => this.open(), leftS > 0 ? Math.min(500, againMs - performance.now()) : 0);
    };
    wait();
  }
  private tryNow(): void {
    if (this.timer === 0 || this.isOver) return;
    window.clearTimeout(this.timer);
    this.open();
  }
  // A program or a network that hangs closes nothing. After a sleep of this page the time counts anew.
  private look(): void {
    const now = performance.now(), slept = now - this.lookedMs > 3000;
    this.lookedMs = now;
    if (slept) this.heardMs = now;
    const silentS = Math.round((now - this.heardMs) / 1000);
    if (this.isOver || !this.socket || now - this.heardMs < silentMs) return;
    this.listener.state({ kind: "silent", text: `No data has arrived for ${silentS} s: the program or the connection to it hangs.` });
    if (now - this.heardMs < cutMs) return;
    this.socket.close(); // its event comes only when the other end answers
    void this.lost();
  }

  move(pose: HandPose): void {
    const view = new DataView(new ArrayBuffer(64));
    view.setUint8(0, 1);
    view.setUint32(4, pose.buttons, true);
    [...pose.position, ...pose.orientation].forEach((x, i) => { view.setFloat64(8 + 8 * i, x, true); });
    this.send(view);
  }
  change(changes: Change[]): void {
    const view = new DataView(new ArrayBuffer(8 + 16 * changes.length));
    view.setUint8(0, 3);
    view.setUint32(4, changes.length, true);
    changes.forEach(({ parameter, value }, i) => {
      view.setInt32(8 + 16 * i, parameter, true);
      view.setFloat64(16 + 16 * i, value, true);
    });
    this.send(view);
  }
  // Asks for the hand and the sliders of another page.
  takeHand(): void {
    const view = new DataView(new ArrayBuffer(8));
    view.setUint8(0, 4);
    this.send(view);
  }
  // What came is shown: the run may send more.
  acknowledge(): void {
    if (this.newest === this.acknowledged) return;
    this.acknowledged = this.newest;
    const view = new DataView(new ArrayBuffer(8));
    view.setUint8(0, 2);
    view.setUint32(4, this.newest, true);
    this.send(view);
  }
  private send(view: DataView<ArrayBuffer>): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(view);
  }
}

async function ask(name: string): Promise<Answer> {
  try {
    const response = await fetch(new URL(`state?${name}`, location.href), { cache: "no-store", signal: AbortSignal.timeout(answerMs) });
    return response.ok ? { status: response.status, ...((await response.json()) as object) } : { status: response.status };
  } catch (error) {
    if (error instanceof SyntaxError) return { status: 200 };
    return (error as Error).name === "TimeoutError" ? "late" : "nothing";
  }
}
