// What the colours, lengths and directions mean.
function mapAt(name, share) {
  const anchors = run.maps[name];
  const place = Math.max(0, Math.min(1, share)) * (anchors.length - 1);
  const below = Math.min(Math.floor(place), anchors.length - 2);
  return anchors[below].map((a, k) => Math.round(a + (place - below) * (anchors[below + 1][k] - a)));
}

// The place in the map of the class of sizes that a share of the range of diameters is in.
function classShare(share) {
  const { lo, hi, edges, names } = run.sizes;
  const diameter = lo + share * (hi - lo);
  return edges.filter((edge) => edge <= diameter).length / Math.max(1, names.length - 1);
}

const css = (colour) => `rgb(${colour.join(",")})`;
const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, "\u202f");
const number = (v, decimals) => { const t = v.toFixed(decimals); return Number(t) === 0 ? t.replace("-", "") : t.replace("-", "−"); };

function roundBelow(limit) {
  const ten = 10 ** Math.floor(Math.log10(limit));
  return [5, 2, 1].map((m) => m * ten).find((v) => v <= limit * (1 + 1e-9)) || ten;
}

function element(tag, text, style) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (style) Object.assign(made.style, style);
  return made;
}

function showLegend() {
  const legend = byId("legend");
  legend.replaceChildren();
  // Walls that are coloured by what was done to them are not coloured by a field.
  const about = mainRole === "walls" && worn.on ? null : describe(state.field);
  const bonds = run.layers.some((l) => l.role === "bonds");
  legend.hidden = !about && !bonds && !worn.on;
  if (about) legend.append(element("h2", about.unit ? `${about.name} [${about.unit}]` : about.name));
  if (about?.kinds && about.all[1] >= Math.max(run.kinds.length, about.codes?.length ?? 0)) {
    legend.append(element("p", "colours repeat"));
  } else if (about?.kinds) {
    const names = mainLayers[0].kinds;
    const kinds = Array.from({ length: about.all[1] + 1 }, (_, k) => [run.kinds[k % run.kinds.length], (about.name === "material" && names[k]) || about.codes?.[k] || String(k)]);
    legend.append(swatches(kinds.slice(about.all[0])));
  } else if (about?.classes) {
    const last = Math.max(1, about.classes.length - 1);
    legend.append(swatches(about.classes.map((name, k) => [mapAt(state.map, k / last), name])));
  } else if (about) {
    showBar(legend, { ...about, shown: state.shown, map: state.map });
  }
  showWornLegend(legend);
  showRodLegend(legend);
  legend.classList.toggle("two", legend.querySelectorAll("h2").length > 1);
  if (bonds) legend.append(swatches([[WHOLE, "bond"], [BREAK, "crack"]]));
}

// A colour and a name in each line.
function swatches(rows) {
  const list = element("ul");
  for (const [colour, name] of rows) {
    const item = element("li");
    item.append(element("i", "", { background: css(colour) }), name);
    list.append(item);
  }
  return list;
}

// The marks of a bar: its ends, which are always labelled, and round values between that are not too near to them.
function marksOf([lo, hi]) {
  const step = roundBelow((hi - lo) / 4);
  const decimals = Math.max(0, Math.min(9, -Math.floor(Math.log10(step))));
  const marks = [];
  for (let k = Math.ceil(lo / step); k * step <= hi; k++) marks.push([(k * step - lo) / (hi - lo), number(k * step, decimals)]);
  const end = (v) => (Math.abs(Number(v.toFixed(decimals)) - v) <= 1e-3 * (hi - lo) ? number(v, decimals) : significant(v));
  return [[0, end(lo)], ...marks.filter(([at]) => at >= 0.06 && at <= 0.94), [1, end(hi)]];
}

// A number to three digits.
const significant = (v) => String(Number(v.toPrecision(3))).replace("-", "−");

function showBar(legend, about, marksAt = marksOf) {
  const bar = element("div");
  bar.className = "bar";
  const stops = run.maps[about.map].map(css);
  bar.style.setProperty("--stops", stops.join(","));
  const marks = marksAt(about.shown.map((v) => v * about.factor));
  for (const [at, text] of marks) {
    const tick = element("span", text);
    tick.style.setProperty("--at", `${100 * at}%`);
    bar.append(tick);
  }
  // A bar ends in a point where some values lie beyond it.
  const slack = 1e-6 * (about.shown[1] - about.shown[0]);
  const beyond = [about.all[0] < about.shown[0] - slack, about.all[1] > about.shown[1] + slack];
  beyond.forEach((on, end) => { if (on) bar.append(Object.assign(element("b", undefined, { background: stops[end ? stops.length - 1 : 0] }), { className: end ? "above" : "below" })); });
  legend.append(bar);
  legend.setAttribute("aria-label", `Colour scale: ${about.name} from ${marks[0][1]} to ${marks.at(-1)[1]} ${about.unit}`);
}

function readableLength(metres) {
  const [unit, factor] = metres >= 0.5 ? ["m", 1] : metres >= 5e-4 ? ["mm", 1e3] : ["µm", 1e6];
  return `${Number((metres * factor).toPrecision(6))} ${unit}`;
}

function showRuler() {
  const short = Math.min(innerWidth, innerHeight);
  const pixels = short / (2 * halfView * camera.distance);
  const metres = roundBelow(Math.min(180, 0.3 * innerWidth) / pixels);
  byId("ruler").querySelector("span").textContent = readableLength(metres);
  byId("ruler").querySelector("i").style.width = `${metres * pixels}px`;
}

function showGnomon() {
  const [right, up, forward] = camera.axes();
  const dark = paper()[0] < 0.5;
  const colours = dark ? ["#ff7b6b", "#5fd394", "#7fb2f0"] : ["#c0392b", "#2e8b57", "#2c5fb3"];
  const far = [0, 1, 2].sort((a, b) => forward[b] - forward[a]);
  byId("gnomon").innerHTML = far.map((k) => {
    const [x, y] = [25 * right[k], -25 * up[k]];
    const seen = Math.hypot(x, y) > 4;
    return `<line x1="0" y1="0" x2="${x}" y2="${y}" stroke="${colours[k]}"/>` +
      (seen ? `<text x="${x * 1.38}" y="${y * 1.38}" fill="${colours[k]}">${"xyz"[k]}</text>` : "");
  }).join("");
}

// "50 000 grains", or with clumps "120 clumps of 840 spheres, 30 spheres".
function grainWords(layers) {
  const sum = (of) => layers.map((l) => of(frameAt(l, clock[state.frame]))).reduce((a, b) => a + b, 0);
  const [count, clumps, members] = [sum((f) => f.count), sum((f) => f.clumps || 0), sum((f) => f.members || 0)];
  const words = (n, word) => `${grouped(n)} ${n === 1 ? word : `${word}s`}`;
  if (!clumps) return count ? words(count, "grain") : "";
  const alone = count > members ? `, ${words(count - members, "sphere")}` : "";
  return `${words(clumps, "clump")} of ${words(members, "sphere")}${alone}`;
}

function showCounts() {
  const count = (role) => run.layers.filter((l) => l.role === role && !state.hidden.has(l))
    .reduce((sum, l) => sum + frameAt(l, clock[state.frame]).count, 0);
  const grains = grainWords(run.layers.filter((l) => l.role === "grains" && !state.hidden.has(l)));
  const words = [["walls", "wall spheres"], ["cloud", "points"]];
  const faces = run.surfaces.filter((s) => !s.normal && !state.hidden.has(s)).reduce((sum, s) => sum + s.faceCount, 0);
  const meshes = faces ? [`${grouped(faces)} faces`] : [];
  const bonds = bondCounts();
  const bonded = bonds ? [`${grouped(bonds.whole)} bonds, ${grouped(bonds.broken)} broken`] : [];
  const share = state.grains < 1 && count("grains") ? [`grains drawn at ${Math.round(100 * state.grains)} % of their size`] : [];
  byId("count").textContent = [...(grains ? [grains] : []), ...words.filter(([role]) => count(role)).map(([role, word]) => `${grouped(count(role))} ${count(role) === 1 ? word.slice(0, -1) : word}`), ...meshes, ...bonded, ...chainWords(), ...share].join(" · ");
  const far = camera.fitted && !camera.wide && camera.leaves() ? ["some grains are far from all others: F shows them"] : [];
  byId("drawn").textContent = [...(painter.dots ? ["drawn as points"] : []), ...far].join(" · ");
  byId("clock").textContent = clock.length > 1 || clock[0] > 0 ? `t = ${clock[state.frame].toFixed(timeDecimals)} s` : "";
}

const timeDecimals = (() => {
  const gap = clock.length > 1 ? (clock[clock.length - 1] - clock[0]) / (clock.length - 1) : 1e-3;
  return Math.max(2, Math.min(9, 1 - Math.floor(Math.log10(gap))));
})();
