// One colour for each meaning, in 3-D, plots and legend: those of colours.json, which scripts/plot reads too.
import { colours as table } from "./colours.json";

export type Meaning = keyof typeof table;
const pairs = Object.entries<{ dark?: string; light?: string }>(table);
export const colours = Object.fromEntries(pairs.map(([name, { dark }]) => [name, dark])) as Record<Meaning, string>; // on a dark ground
const onLight = new Map(pairs.map(([, { dark, light }]) => [dark, light]));

export const darkPage = window.matchMedia("(prefers-color-scheme: dark)");

// colour: one for dark grounds.
export function curveColour(colour: string, isDark = darkPage.matches): string {
  return isDark ? colour : (onLight.get(colour) ?? colour);
}

export function eventColour(kind: string): string {
  return colours[kind as Meaning] ?? "grey";
}

// A colour of a style sheet, which follows the ground of the page.
export function pageColour(colour: string): string {
  return `light-dark(${curveColour(colour, false)}, ${colour})`;
}

// The colour of the thing that a column of a trace belongs to.
export function columnColour(name: string): string {
  const things: [RegExp, Meaning][] = [[/^slave_(?!command|distance)/, "robot"], [/^hip/, "hip"], [/force|torque/, "force"],
    [/normal|contact/, "normal"], [/slave|received_command/, "slave"], [/signed_distance/, "truth"], [/velocity/, "estimate"],
    [/proxy|tool|nearest/, "proxy"]];
  return colours[things.find(([pattern]) => pattern.test(name))?.[1] ?? "second"];
}

type Ramp = number[][];

// Heights without measured colours: dark below, light above, and never the colour of points that touch.
export const heights: Ramp = [[62, 86, 150], [74, 118, 172], [104, 152, 196], [152, 190, 216], [222, 234, 242]];
// Measures on the map of a sweep: five colours of viridis.
export const measures: Ramp = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

export function rampStyle(ramp: Ramp): string {
  return `linear-gradient(90deg, ${ramp.map((colour) => `rgb(${colour.join(" ")})`).join()})`;
}

export function rampColour(ramp: Ramp, fraction: number, out: Uint8Array, at: number): void {
  const place = Math.min(Math.max(fraction, 0), 1) * (ramp.length - 1);
  const low = Math.min(Math.floor(place), ramp.length - 2), part = place - low;
  for (let k = 0; k < 3; ++k) out[at + k] = Math.round(ramp[low][k] * (1 - part) + ramp[low + 1][k] * part);
}
