// The statements of the page about its connection to the run. Each is true for all that the page knows.

// Answer to a request for the server's state; nothing: the connection was refused; late: there was no answer in time.
export type Answer = { status: number; protocol?: number; ended?: string; full?: boolean } | "nothing" | "late";

export type LinkKind =
  | "connecting" // for the first time
  | "open" // messages come
  | "silent" // connected, but nothing comes
  | "lost" // the run goes on, the connection does not
  | "gone" // nothing answers at the address
  | "full" // as many pages as can be are connected
  | "other" // another run is under the same address
  | "version" // a server that this page does not understand
  | "copy" // the page was opened from a file
  | "ended"; // the server has said so

// final: connecting again cannot help.
export interface LinkState { kind: LinkKind; text: string; final?: boolean }

export function stateOf(answer: Answer, protocol: number): LinkState {
  const host = location.host;
  if (answer === "nothing")
    return { kind: "gone", text: `Nothing answers at ${host}: the program was ended or killed, or a tunnel to it is closed.` };
  if (answer === "late") return { kind: "lost", text: `The connection is lost: ${host} does not answer.` };
  if (answer.status !== 200)
    return { kind: "other", final: true, text: `Another run or program is at ${host} now, and the run of this page has ended. Open the address that the terminal prints.` };
  if (answer.protocol !== protocol)
    return { kind: "version", final: true, text: `The program at ${host} has another version than this page (protocol ${answer.protocol ?? "unknown"}, here ${protocol}). Load the page again.` };
  if (answer.ended) return { kind: "ended", final: true, text: `The run has ended: ${answer.ended}.` };
  if (answer.full) return { kind: "full", text: "This run is already shown by the maximum number of pages. This page connects when one of them is closed." };
  return { kind: "lost", text: "The connection was lost; the run continues." };
}

// Seconds before that attempt, which are counted from 0.
export function waitS(attempt: number): number {
  return Math.min(0.5 * 2 ** attempt, 15);
}
