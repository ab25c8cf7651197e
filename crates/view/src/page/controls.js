// Mouse, touch, keys, and the settings.
function setField(name) {
  state.field = name;
  const about = describe(name);
  if (about) state.shown = state.ranges[name] || (name === run.colour && run.range) || about.shown;
  byId("ends").hidden = !about || about.kinds;
  if (about) [byId("lo").value, byId("hi").value] = state.shown.map((v) => Number((v * about.factor).toPrecision(4)));
  byId("field").value = name;
  showLegend();
  changed();
}

function setEnds() {
  const about = describe(state.field);
  const ends = ["lo", "hi"].map((id) => parseFloat(byId(id).value.replace(",", ".")) / about.factor);
  if (ends.every(Number.isFinite) && ends[0] < ends[1]) state.ranges[state.field] = ends;
  else delete state.ranges[state.field];
  setField(state.field);
}

function choices() {
  const names = [...new Set(mainLayers.flatMap((l) => l.fields.map((f) => f.name)))];
  if (mainLayers.some(hasColours)) names.unshift("rgb");
  names.forEach((name) => byId("field").append(new Option(name)));
  Object.keys(run.maps).forEach((name) => byId("map").append(new Option(name)));
  SPEEDS.forEach((s) => byId("speed").append(new Option(s < 1 ? `1/${Math.round(1 / s)}×` : `${s}×`, s)));
  Object.keys(VIEWS).forEach((name) => {
    const button = element("button", name);
    button.type = "button";
    button.onclick = () => lookFrom(name);
    byId("views").append(button);
  });
  [...run.layers, ...run.surfaces].forEach((layer) => {
    const label = element("label");
    label.className = "check";
    const box_ = Object.assign(element("input"), { type: "checkbox", checked: true });
    box_.onchange = () => { state.hidden[box_.checked ? "delete" : "add"](layer); changed(); };
    layer.box = box_;
    label.append(box_, ` ${layer.name}`);
    byId("layers").append(label);
  });
  byId("glass").hidden = !run.surfaces.length && (mainRole === "walls" || !run.layers.some((l) => l.role === "walls"));
  byId("dots").hidden = !run.layers.some((l) => l.pointRadius);
  const preferred = mainLayers.some(hasColours) ? "rgb" : names.includes("speed") ? "speed" : "z";
  byId("map").value = state.map;
  setField(run.colour && names.includes(run.colour) ? run.colour : preferred);
}

function lookFrom(name) {
  camera.look(VIEWS[name]);
  camera.fit(innerWidth, innerHeight);
  changed();
}

function toggleWalls() {
  const walls = [...run.layers.filter((l) => l.role === "walls"), ...run.surfaces];
  const on = walls.some((l) => state.hidden.has(l));
  walls.forEach((l) => { state.hidden[on ? "delete" : "add"](l); l.box.checked = on; });
  changed();
}

function toggleTheme() {
  document.documentElement.dataset.theme = paper()[0] < 0.5 ? "light" : "dark";
  changed();
}

function savePicture() {
  redraw(2);
  canvas.toBlob((blob) => {
    const link = Object.assign(element("a"), { href: URL.createObjectURL(blob), download: `frame-${state.frame + 1}.png` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
}

function wire() {
  const on = (id, event, what) => byId(id).addEventListener(event, what);
  on("panel", "submit", (e) => e.preventDefault());
  on("more", "click", () => { const p = byId("panel"); p.hidden = !p.hidden; byId("more").setAttribute("aria-expanded", !p.hidden); });
  on("fit", "click", () => { camera.fit(innerWidth, innerHeight); changed(); });
  on("theme", "click", toggleTheme);
  on("save", "click", savePicture);
  on("play", "click", () => play(!state.playing));
  on("scrub", "input", (e) => { play(false); show(Number(e.target.value)); });
  on("speed", "change", (e) => { state.speed = Number(e.target.value); });
  on("field", "change", (e) => setField(e.target.value));
  on("map", "change", (e) => { state.map = e.target.value; showLegend(); changed(); });
  ["lo", "hi"].forEach((id) => on(id, "change", setEnds));
  on("flat", "change", (e) => { camera.flat = e.target.checked; changed(); });
  on("opacity", "input", (e) => { state.opacity = Number(e.target.value); changed(); });
  on("dot", "input", (e) => { state.dot = 2 ** Number(e.target.value); changed(); });
  on("across", "change", (e) => { state.cutAxis = e.target.value === "" ? -1 : Number(e.target.value); showCut(); });
  on("where", "input", (e) => { state.cutAt = Number(e.target.value); showCut(); });
  on("flip", "click", () => { state.cutSide = -state.cutSide; showCut(); });
  on("both", "change", (e) => { state.cutGrains = e.target.checked; showCut(); });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  addEventListener("resize", changed);
  addEventListener("keydown", key);
  gestures();
}

function showCut() {
  const k = state.cutAxis;
  for (const id of ["depth", "whole", "flip"]) byId(id).hidden = k < 0;
  if (k >= 0) byId("depth").querySelector("output").textContent = `${"xyz"[k]} = ${readableLengthSigned(box.lo[k] + state.cutAt * (box.hi[k] - box.lo[k]))}`;
  changed();
}

function readableLengthSigned(metres) {
  const factor = halfDiagonal < 1 ? 1e3 : 1;
  return `${number(metres * factor, factor === 1 ? 3 : 1)} ${factor === 1 ? "m" : "mm"}`;
}

const KEYS = {
  " ": () => play(!state.playing), Home: () => { play(false); show(0); }, End: () => { play(false); show(clock.length - 1); },
  "+": () => camera.zoom(0.85), "=": () => camera.zoom(0.85), "-": () => camera.zoom(1 / 0.85),
  f: () => camera.fit(innerWidth, innerHeight), w: toggleWalls, t: toggleTheme, s: savePicture, m: () => byId("more").click(),
  o: () => byId("flat").click(),
};

function key(e) {
  const typing = /^(INPUT|SELECT|TEXTAREA)$/.test(e.target.tagName) && !(e.target.type === "range" && e.key === " ");
  const pressed = e.target.tagName === "BUTTON" && e.key === " ";
  if (typing || pressed || e.ctrlKey || e.metaKey || e.altKey) return;
  const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key];
  const view = Object.keys(VIEWS)[Number(e.key) - 1];
  const name = e.key.length === 1 ? e.key.toLowerCase() : e.key;
  if (arrow && (e.shiftKey || clock.length < 2 || arrow[1])) camera.turn(-0.12 * arrow[0], 0.12 * arrow[1]);
  else if (arrow) { play(false); show(state.frame + arrow[0]); }
  else if (view) lookFrom(view);
  else if (KEYS[name]) KEYS[name]();
  else return;
  e.preventDefault();
  changed();
}

// One finger or the left button turns; two fingers, or the right button or Shift, move; pinch and wheel zoom.
function gestures() {
  const down = new Map();
  const centre = () => [...down.values()].reduce((s, p) => [s[0] + p[0] / down.size, s[1] + p[1] / down.size], [0, 0]);
  const spread = () => { const [a, b] = [...down.values()]; return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0; };
  const short = () => Math.min(innerWidth, innerHeight);
  canvas.addEventListener("pointerdown", (e) => { canvas.setPointerCapture(e.pointerId); down.set(e.pointerId, [e.clientX, e.clientY]); });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (e) => down.delete(e.pointerId));
  canvas.addEventListener("pointermove", (e) => {
    if (!down.has(e.pointerId)) return;
    const [before, wide] = [centre(), spread()];
    down.set(e.pointerId, [e.clientX, e.clientY]);
    const after = centre();
    const [dx, dy] = [after[0] - before[0], after[1] - before[1]];
    if (down.size > 1 || e.buttons & 6 || e.shiftKey) camera.shift(dx, dy, short());
    else camera.turn(5 * dx / short(), 5 * dy / short());
    if (wide > 0 && spread() > 0) camera.zoom(wide / spread());
    changed();
  });
  canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  canvas.addEventListener("dblclick", () => { camera.fit(innerWidth, innerHeight); changed(); });
  canvas.addEventListener("wheel", (e) => {
    e.preventDefault();
    const lines = e.deltaMode === 1 ? 30 : 1;
    camera.zoom(Math.exp(Math.max(-120, Math.min(120, e.deltaY * lines)) * 0.0022));
    changed();
  }, { passive: false });
}
