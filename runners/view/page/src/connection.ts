// The channel to a live run: its ticks and frames come, the hand's pose goes. runners/live/view has the other end.
import type { Vector } from "./data";
import type { ColumnInfo } from "./live_run";
import type { Change } from "./sliders";

export interface HandPose { position: Vector; orientation: [number, number, number, number]; buttons: number }

export interface Listener {
  columns(infos: ColumnInfo[]): void;
  parameters(values: number[], refused: string): void;
  ticks(view: DataView): void;
  frame(view: DataView): void;
  ended(why: string): void;
}

export class Connection {
  bytes = 0;
  private newest = 0;
  private acknowledged = 0;
  readonly socket: WebSocket;

  constructor(listener: Listener) {
    const place = new URL("channel", location.href);
    place.protocol = "ws:";
    this.socket = new WebSocket(place);
    this.socket.binaryType = "arraybuffer";
    let opened = false;
    this.socket.addEventListener("open", () => { opened = true; });
    this.socket.addEventListener("close", () => {
      listener.ended(opened ? "The run has ended." : "Not connected: another page has the hand, or the run has ended.");
    });
    this.socket.addEventListener("message", (event: MessageEvent<string | ArrayBuffer>) => {
      if (typeof event.data === "string") {
        const text = JSON.parse(event.data) as { columns: ColumnInfo[] } | { values: number[]; refused: string };
        if ("columns" in text) listener.columns(text.columns);
        else listener.parameters(text.values, text.refused);
        return;
      }
      const view = new DataView(event.data);
      this.bytes += event.data.byteLength;
      if (view.getUint32(0, true) === 1) listener.ticks(view);
      else listener.frame(view);
      this.newest = view.getUint32(4, true);
    });
  }

  close(): void {
    this.socket.close();
  }
  move(pose: HandPose): void {
    const view = new DataView(new ArrayBuffer(64));
    view.setUint8(0, 1);
    view.setUint32(4, pose.buttons, true);
    [...pose.position, ...pose.orientation].forEach((x, i) => { view.setFloat64(8 + 8 * i, x, true); });
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(view);
  }
  change(changes: Change[]): void {
    const view = new DataView(new ArrayBuffer(8 + 16 * changes.length));
    view.setUint8(0, 3);
    view.setUint32(4, changes.length, true);
    changes.forEach(({ parameter, value }, i) => {
      view.setInt32(8 + 16 * i, parameter, true);
      view.setFloat64(16 + 16 * i, value, true);
    });
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(view);
  }
  // What came is shown: the run may send more.
  acknowledge(): void {
    if (this.newest === this.acknowledged) return;
    this.acknowledged = this.newest;
    const view = new DataView(new ArrayBuffer(8));
    view.setUint8(0, 2);
    view.setUint32(4, this.newest, true);
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(view);
  }
}
