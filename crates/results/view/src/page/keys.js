// Keys, and the list of them that the page shows.
const KEYS = [
  ["Space", "play, pause", " ", () => play(!state.playing)],
  ["Home  End", "first, last frame", "Home", () => { play(false); show(0); }],
  [null, null, "End", () => { play(false); show(clock.length - 1); }],
  ["+  −", "nearer, farther", "+", () => camera.zoom(0.85)],
  [null, null, "=", () => camera.zoom(0.85)],
  [null, null, "-", () => camera.zoom(1 / 0.85)],
  ["F", "show everything", "f", () => fitView()],
  ["O", "parallel projection", "o", () => byId("flat").click()],
  ["W", "hide or show walls", "w", () => toggleWalls()],
  ["C", "colour by the next field", "c", () => nextField(1)],
  ["X  Y  Z", "slice across an axis", "x", () => sliceAcross(0)],
  [null, null, "y", () => sliceAcross(1)],
  [null, null, "z", () => sliceAcross(2)],
  ["V", "slice as seen from here", "v", () => sliceAcross(state.cutAxis === 3 ? -1 : 3)],
  ["[  ]", "move the slice", "[", () => moveSlice(-0.01)],
  [null, null, "]", () => moveSlice(0.01)],
  ["L", "follow what was picked", "l", () => follow(!picked.follows)],
  ["Esc", "let it go", "Escape", () => pick(null)],
  ["G", "diagrams", "g", () => plots.toggle()],
  ["T", "light or dark", "t", () => toggleTheme()],
  ["S", "save this view as PNG", "s", () => savePicture()],
  ["M", "settings", "m", () => byId("more").click()],
  ["?", "this list", "?", () => byId("help").showModal()],
];
const MOUSE = [
  ["Drag", "turn"], ["Right drag, Shift + drag", "move"], ["Wheel, pinch", "nearer, farther"],
  ["Two fingers", "move"], ["Click, tap", "pick: read all its fields"], ["Double click", "show everything"],
];

function nextField(step) {
  const options = [...byId("field").options].map((o) => o.value);
  if (options.length) setField(options[(options.indexOf(state.field) + step + options.length) % options.length]);
}

function listKeys() {
  const moving = clock.length > 1;
  const rows = [
    ["←  →" + (moving ? "" : "  ↑  ↓"), moving ? "frame back, on" : "turn"],
    ...(moving ? [["Shift + arrows", "turn"]] : []),
    ["1 – 7", `view from ${Object.keys(VIEWS).join(", ")}`],
    ...KEYS.filter(([name, , pressed]) => name && (moving || ![" ", "Home", "l"].includes(pressed)) && (pressed !== "g" || run.plots.length)),
    ...(run.pick ? [["P  B", "draw a polygon, a box"]] : []),
  ];
  const fill = (id, list) => byId(id).append(...list.flatMap(([name, what]) => [element("dt", name), element("dd", what)]));
  fill("keys", rows);
  fill("mouse", MOUSE);
}

function key(e) {
  const { tagName, type } = e.target;
  const toggles = tagName === "BUTTON" || type === "checkbox";
  const typing = /^(INPUT|SELECT|TEXTAREA)$/.test(tagName) && !toggles && !(type === "range" && !e.key.startsWith("Arrow"));
  if (typing || (toggles && [" ", "Enter"].includes(e.key)) || e.ctrlKey || e.metaKey || e.altKey || byId("help").open) return;
  const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key];
  const view = Object.keys(VIEWS)[Number(e.key) - 1];
  const name = e.key.length === 1 ? e.key.toLowerCase() : e.key;
  const action = KEYS.find(([, , of]) => of === name);
  if (run.pick && regions.key(name)) { /* done */ }
  else if (arrow && (e.shiftKey || clock.length < 2 || arrow[1])) camera.turn(-0.12 * arrow[0], 0.12 * arrow[1]);
  else if (arrow) { play(false); show(state.frame + arrow[0]); }
  else if (view) lookFrom(view);
  else if (action) action[3]();
  else return;
  e.preventDefault();
  changed();
}
