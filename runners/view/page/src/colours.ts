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
  guidance: "#009e73",
} as const;

// Heights without measured colours: dark below, light above (viridis, five of its colours).
const ramp = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

export function rampColour(fraction: number, out: Uint8Array, at: number): void {
  const place = Math.min(Math.max(fraction, 0), 1) * (ramp.length - 1);
  const low = Math.min(Math.floor(place), ramp.length - 2), part = place - low;
  for (let k = 0; k < 3; ++k) out[at + k] = Math.round(ramp[low][k] * (1 - part) + ramp[low + 1][k] * part);
}
