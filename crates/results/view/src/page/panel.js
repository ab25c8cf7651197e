// The settings.
function setField(name) {
  state.field = name;
  const about = describe(name);
  if (about) state.shown = state.ranges[name] || (name === run.colour && run.range) || about.shown;
  byId("ends").hidden = !about || about.kinds || Boolean(about.classes);
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
  const last = (name) => Number(/^([vwf]?[xyz]|id)$/.test(name));
  names.sort((a, b) => last(a) - last(b));
  if (run.sizes) names.splice(Math.max(0, names.indexOf("radius")), 0, "size");
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
    const box_ = Object.assign(element("input"), { type: "checkbox", checked: !state.hidden.has(layer) });
    box_.onchange = () => { state.hidden[box_.checked ? "delete" : "add"](layer); changed(); };
    layer.box = box_;
    label.append(box_, element("span", layer.name));
    byId("layers").append(label);
  });
  byId("glass").hidden = !run.surfaces.length && (mainRole === "walls" || !run.layers.some((l) => l.role === "walls"));
  wornChoices();
  byId("opacity").value = state.opacity;
  byId("colours").hidden = byId("details").hidden = !run.layers.length;
  byId("sizes").hidden = !run.layers.some(isRods);
  byId("shrink").value = state.grains;
  byId("dots").hidden = !run.layers.some((l) => l.pointRadius);
  const preferred = mainLayers.some(hasColours) ? "rgb" : names.includes("speed") ? "speed" : "z";
  byId("map").value = state.map;
  setField(run.colour && names.includes(run.colour) ? run.colour : preferred);
}

function lookFrom(name) {
  if (run.pick && regions.drawing) regions.aim(name); else camera.look(VIEWS[name]);
  fitView();
}

// Everything but the few grains that are far from all others; once more: those too.
function fitView() {
  camera.wide = camera.fitted && !camera.wide;
  refit();
}

function refit() {
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
  redraw(2, painter.dots);
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
  on("fit", "click", fitView);
  on("theme", "click", toggleTheme);
  on("graphs", "click", () => plots.toggle());
  on("save", "click", savePicture);
  on("ask", "click", () => byId("help").showModal());
  on("play", "click", () => play(!state.playing));
  on("scrub", "input", (e) => { play(false); show(Number(e.target.value)); });
  on("speed", "change", (e) => { state.speed = Number(e.target.value); });
  on("field", "change", (e) => setField(e.target.value));
  on("map", "change", (e) => { state.map = e.target.value; showLegend(); changed(); });
  ["lo", "hi"].forEach((id) => on(id, "change", setEnds));
  on("flat", "change", (e) => { camera.flat = e.target.checked = e.target.checked || camera.rests; changed(); });
  on("opacity", "input", (e) => { state.opacity = Number(e.target.value); worn.asked = true; changed(); });
  on("shrink", "input", (e) => { state.grains = Number(e.target.value); changed(); });
  on("dot", "input", (e) => { state.dot = 2 ** Number(e.target.value); changed(); });
  on("detail", "change", (e) => { state.detail = e.target.value; changed(); });
  on("across", "change", (e) => { state.cutAxis = -1; sliceAcross(e.target.value === "" ? -1 : Number(e.target.value)); });
  on("where", "input", (e) => { state.cutAt = Number(e.target.value); showCut(); });
  on("slab", "input", (e) => { state.cutThick = Number(e.target.value) ** 2; showCut(); });
  on("flip", "click", () => { state.cutSide = -state.cutSide; showCut(); });
  on("both", "change", (e) => { state.cutGrains = e.target.checked; showCut(); });
  on("follow", "click", () => follow(!picked.follows));
  on("close", "click", () => pick(null));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  addEventListener("resize", () => { if (camera.fitted) refit(); changed(); });
  addEventListener("keydown", key);
  gestures();
}
