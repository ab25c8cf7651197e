"use strict";
// The run as packed in this page.
const byId = (id) => document.getElementById(id);
const run = JSON.parse(byId("header").textContent);

// The bytes of a packed column, unpacked when asked for: a long run need not fit in memory twice. The last few stay.
const unpacked = new Map();
function bytes(number) {
  const out = unpacked.get(number) || fromBase64(byId("b" + number).textContent);
  unpacked.delete(number);
  unpacked.set(number, out);
  if (unpacked.size > 16) unpacked.delete(unpacked.keys().next().value);
  return out;
}

function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const out = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) out[i] = letters.charCodeAt(i);
  return out;
}

// The packed numbers of a column.
const NUMBERS = { 1: Uint8Array, 2: Uint16Array, 4: Uint32Array };
const numbersOf = (number, width) => new NUMBERS[width](bytes(number).buffer);

// The value of one row of a column [blob, lo, hi, bytes of a number], and the bound on its error.
function valueAt([number, lo, hi, width], row) {
  return number === null ? lo : lo + numbersOf(number, width)[row] / (256 ** width - 1) * (hi - lo);
}
const errorOf = ([number, lo, hi, width]) => (number === null ? 0 : (hi - lo) / (2 * (256 ** width - 1)));

// The place of one row of a frame [m], before the layer is moved.
function placeAt(frame, row) {
  const q = numbersOf(frame.position, 2);
  return [0, 1, 2].map((k) => frame.lo[k] + q[3 * row + k] / 65535 * (frame.hi[k] - frame.lo[k]));
}

// The layer that colours are about: grains, else a cloud, else walls.
const order = ["grains", "cloud", "walls"];
const mainRole = order.find((role) => run.layers.some((l) => l.role === role)) || "walls";
const mainLayers = run.layers.filter((l) => l.role === mainRole);
const isRods = (l) => ["bonds", "arrows", "force-chains", "outlines"].includes(l.role);
const hasColours = (l) => ["red", "green", "blue"].every((c) => l.fields.some((f) => f.name === c));

// Times at which anything changes, in order.
const clock = run.clock;

// The frame of a layer at a time: the last one that is not later, else its first.
function frameAt(layer, time) {
  let lo = 0, hi = layer.frames.length - 1;
  while (lo < hi) {
    const mid = (lo + hi + 1) >> 1;
    if (layer.frames[mid].time <= time) lo = mid; else hi = mid - 1;
  }
  return layer.frames[lo];
}

// The box that is looked at, and its middle: all coordinates on the graphics card are relative to it.
const box = { lo: run.lo, hi: run.hi };
const middle = box.lo.map((lo, k) => 0.5 * (lo + box.hi[k]));
const halfDiagonal = Math.max(1e-9, Math.hypot(...box.lo.map((lo, k) => 0.5 * (box.hi[k] - lo))));
// The same with the grains that are far from all others.
const reachOfAll = run.layers.flatMap((l) => l.strays).reduce((most, p) => Math.max(most, Math.hypot(...p.map((x, k) => x - middle[k]))), halfDiagonal);

// Colours by a name: what to show, in which range.
const state = {
  frame: 0, playing: false, speed: 1, field: null, map: run.map, shown: [0, 1], ranges: {},
  grains: run.layers.some(isRods) ? run.rods.grains : 1, opacity: mainRole === "walls" ? 1 : 0.2, dot: 1, detail: "auto", hidden: new Set(), dirty: true,
  cutAxis: -1, cutNormal: [0, 0, 1], cutAt: 0.5, cutSide: 1, cutThick: 0, cutGrains: true,
};

for (const l of [...run.layers, ...run.surfaces]) if (l.hidden) state.hidden.add(l);

function fieldOf(layer, name) { return layer.fields.findIndex((f) => f.name === name); }

// The size of spheres as drawn, over their own.
const sizeOf = (layer) => (layer.pointRadius ? state.dot : layer.role === "grains" ? state.grains : 1);

function describe(name) {
  if (name === "size") {
    const { lo, hi, names } = run.sizes;
    return { name, unit: "", factor: 1, all: [lo, hi], shown: [lo, hi], kinds: false, classes: names };
  }
  const all = mainLayers.map((l) => l.fields.find((f) => f.name === name)).filter(Boolean);
  if (!all.length) return null;
  const joined = (key) => [Math.min(...all.map((f) => f[key][0])), Math.max(...all.map((f) => f[key][1]))];
  const range = joined("all");
  const kinds = all[0].whole && range[0] >= 0 && (range[1] < run.kinds.length || all[0].things);
  return { ...all[0], all: range, shown: joined("shown"), kinds };
}
