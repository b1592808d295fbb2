// Names of parameters and axes as people say them: "scenario.noise_sigma_m" is the noise sigma, in mm.

interface Unit { name: string; factor: number }

// The units that names of parameters end with, the longest first, as they are shown.
const units: [string, Unit][] = [
  ["N_per_m", { name: "N/m", factor: 1 }], ["Ns_per_m", { name: "N s/m", factor: 1 }], ["m_per_s2", { name: "m/s\u00b2", factor: 1 }],
  ["m_per_s", { name: "mm/s", factor: 1000 }], ["Nm_per_rad", { name: "N m/rad", factor: 1 }], ["deg_per_s", { name: "deg/s", factor: 1 }],
  ["Nm", { name: "N m", factor: 1 }], ["hz", { name: "Hz", factor: 1 }], ["deg", { name: "deg", factor: 1 }], ["rad", { name: "rad", factor: 1 }],
  ["kg", { name: "kg", factor: 1 }], ["px", { name: "px", factor: 1 }], ["N", { name: "N", factor: 1 }], ["s", { name: "ms", factor: 1000 }],
  ["m", { name: "mm", factor: 1000 }],
];

// words: without the section and the unit. A value times the factor is in the unit of that name, which is empty for pure numbers.
export interface Named extends Unit { words: string }

export function named(parameter: string): Named {
  const name = parameter.slice(parameter.lastIndexOf(".") + 1), found = units.find(([ending]) => name.endsWith(`_${ending}`));
  const words = (found ? name.slice(0, -found[0].length - 1) : name).replaceAll("_", " ");
  return { words, ...(found?.[1] ?? { name: "", factor: 1 }) };
}
