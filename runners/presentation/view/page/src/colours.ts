// One colour for each thing, in 3-D, plots and legend. Okabe and Ito's palette: told apart by colour-blind people too.
export const colours = {
  hip: "#e69f00",
  proxy: "#0072b2",
  force: "#d55e00",
  normal: "#009e73",
  slave: "#cc79a7",
  truth: "#56b4e9",
  velocity: "#882255",
  fixture: "#cc3311",
  touching: "#f0e442",
  guidance: "#f4f4f4",
  second: "#8d96a0",
} as const;

// Two of them are too dark for curves on a dark page.
const onDark: Record<string, string> = { [colours.proxy]: "#4a9fd8", [colours.velocity]: "#d67aa0" };

export function curveColour(colour: string): string {
  return window.matchMedia("(prefers-color-scheme: dark)").matches ? (onDark[colour] ?? colour) : colour;
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
