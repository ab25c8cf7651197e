"use strict";
// The run as packed in this page.
const byId = (id) => document.getElementById(id);
const run = JSON.parse(byId("header").textContent);

// The bytes of a packed column, unpacked when asked for: a long run need not fit in memory twice.
function bytes(number) {
  const text = byId("b" + number).textContent;
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const out = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) out[i] = letters.charCodeAt(i);
  return out;
}

// The layer that colours are about: grains, else a cloud, else walls.
const order = ["grains", "cloud", "walls"];
const mainRole = order.find((role) => run.layers.some((l) => l.role === role)) || "walls";
const mainLayers = run.layers.filter((l) => l.role === mainRole);
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

// Colours by a name: what to show, in which range.
const state = {
  frame: 0, playing: false, speed: 1, field: null, map: run.map, shown: [0, 1], ranges: {},
  opacity: 0.2, cutAxis: -1, cutAt: 0.5, cutSide: 1, cutGrains: true, dot: 1, hidden: new Set(), dirty: true,
};

function fieldOf(layer, name) { return layer.fields.findIndex((f) => f.name === name); }

function describe(name) {
  const all = mainLayers.map((l) => l.fields.find((f) => f.name === name)).filter(Boolean);
  if (!all.length) return null;
  const joined = (key) => [Math.min(...all.map((f) => f[key][0])), Math.max(...all.map((f) => f[key][1]))];
  const range = joined("all");
  const kinds = all[0].whole && range[0] >= 0 && range[1] < run.kinds.length;
  return { ...all[0], all: range, shown: joined("shown"), kinds };
}
