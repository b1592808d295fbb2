// The colours of the viewer: contrast to their ground, and distance for three kinds of eyes. Usage: node colours.mjs COLOURS.ts
import assert from "node:assert/strict";
import { test } from "node:test";
import { buildSync } from "esbuild";

globalThis.window = { matchMedia: () => ({ matches: false }) };
const built = buildSync({ entryPoints: [process.argv[2]], format: "esm", write: false }).outputFiles[0].text;
const { table, components, eventColours } = await import(`data:text/javascript,${encodeURIComponent(built)}`);

const light = "#ffffff", scene = "#23272e", dark = "#16181b"; // grounds: see style.css
// From linear RGB to linear RGB as such eyes see it: Machado, Oliveira and Fernandes 2009, severity 1.
const eyes = {
  usual: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  protan: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  deutan: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
};
const times = (matrix, v) => matrix.map((row) => row.reduce((sum, m, k) => sum + m * v[k], 0));
const linear = (colour) => [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16) / 255)
  .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
const luminance = (colour) => times([[0.2126, 0.7152, 0.0722]], linear(colour))[0];

function contrast(a, b) {
  const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (high + 0.05) / (low + 0.05);
}
function lab(colour, eye) {
  const seen = times(eyes[eye], linear(colour)).map((c) => Math.min(Math.max(c, 0), 1));
  const xyz = times([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.072175], [0.0193339, 0.119192, 0.9503041]], seen);
  const [x, y, z] = [xyz[0] / 0.95047, xyz[1], xyz[2] / 1.08883].map((t) => (t > 0.008856 ? Math.cbrt(t) : 7.787 * t + 16 / 116));
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}
function hasContrast(colours, ground) {
  for (const [name, colour] of colours) assert.ok(contrast(colour, ground) >= 3, `${name} on ${ground}: ${contrast(colour, ground)}`);
}
function differ(colours) {
  colours.forEach(([a, first], i) => {
    for (const [b, second] of colours.slice(i + 1))
      for (const eye of Object.keys(eyes)) {
        const from = lab(first, eye), distance = Math.hypot(...lab(second, eye).map((c, k) => c - from[k]));
        assert.ok(distance >= 15, `${a} and ${b} for ${eye} eyes: ${distance}`);
      }
  });
}

test("the colours of things differ and have contrast on dark and light grounds", () => {
  const things = Object.entries(table), onDark = things.map(([name, [colour]]) => [name, colour]);
  const onLight = things.filter(([, pair]) => pair.length > 1).map(([name, pair]) => [name, pair[1]]);
  assert.ok(onLight.length >= 8);
  for (const ground of [scene, dark]) hasContrast(onDark, ground);
  hasContrast(onLight, light);
  differ(onDark);
  differ(onLight);
});

test("the colours of events differ and have contrast on dark and light grounds", () => {
  const events = Object.entries(eventColours);
  for (const ground of [light, dark]) hasContrast(events, ground);
  differ(events);
});

test("the colours of components differ and have contrast", () => {
  [dark, light].forEach((ground, which) => {
    const three = components.map((pair, k) => ["xyz"[k], pair[which]]);
    hasContrast(three, ground);
    differ(three);
  });
});
