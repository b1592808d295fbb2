// One colour for each thing, in 3-D, plots and legend: on a dark ground, and where curves are drawn on a light one. Any two
// colours for one ground differ also for colour-blind eyes, and each has a contrast of at least 3:1 to the ground:
// tests/system/viewer/colours.mjs.
export const table = {
  hip: ["#e9a200", "#c08800"],
  proxy: ["#5590ee", "#146bab"],
  force: ["#f57a3a", "#b34c00"],
  normal: ["#2ba46f", "#00a67c"],
  slave: ["#f399c4", "#9c3c52"], // its command
  robot: ["#8b50ff", "#5b3fd6"], // the slave itself
  truth: ["#59b4eb", "#3691ba"],
  velocity: ["#bb70b2", "#822055"],
  second: ["#8a8a8e", "#81939f"],
  fixture: ["#cd4021"], // those of the 3-D view only
  touching: ["#f0e949"],
  guidance: ["#f4f4f4"],
} as const;

type Thing = keyof typeof table;
export const colours = Object.fromEntries(Object.entries(table).map(([thing, [dark]]) => [thing, dark])) as Record<Thing, string>;

// Components along x, y and z, which are curves only.
export const components = [["#e0525f", "#a81e3c"], ["#7fd06a", "#4f9a2a"], ["#7f8cf7", "#4a55d8"]] as const;

// Kinds of events, on both grounds.
export const eventColours: Record<string, string> = {
  "pop-through": "#df225d", divergence: "#7b5bf0", "force jump": "#bf7c00", "largest force": "#c86034", "first contact": "#228f6b",
  "not converged": "#7f8291", task: "#0088bd", "slave contact": "#ff2dcd", "hardest hit": "#7830f8",
};

const onLight = new Map<string, string>([...Object.values(table), ...components].map(([dark, light]) => [dark, light ?? dark]));

export const darkPage = window.matchMedia("(prefers-color-scheme: dark)");

// colour: one for dark grounds.
export function curveColour(colour: string, isDark = darkPage.matches): string {
  return isDark ? colour : (onLight.get(colour) ?? colour);
}

// The colour of the thing that a column of a trace belongs to.
export function columnColour(name: string): string {
  const things: [RegExp, Thing][] = [[/^slave_(?!command|distance)/, "robot"], [/^hip/, "hip"], [/force|torque/, "force"],
    [/normal|contact/, "normal"], [/slave|received_command/, "slave"], [/signed_distance/, "truth"], [/velocity/, "velocity"],
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
