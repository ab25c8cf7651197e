// Start, and what a test or a script may ask for.
const megabytes = (n) => (n < 1e6 ? `${Math.max(1, Math.round(n / 1e3))} kB` : `${(n / 1e6).toFixed(n < 1e7 ? 1 : 0)} MB`);

// A length to two digits.
function short(metres) {
  const [unit, factor] = [["m", 1], ["mm", 1e3], ["µm", 1e6], ["nm", 1e9]].find(([, f]) => metres * f >= 1) || ["nm", 1e9];
  return `${Number((metres * factor).toPrecision(2))} ${unit}`;
}

// What the page is and is not: size, frames, and what packing costs.
function notes() {
  const lines = [`Page of ${megabytes(run.bytes)}; limit ${megabytes(run.mostBytes)}.`];
  if (run.given) lines.push(run.stride > 1 ? `${clock.length} of ${run.given} frames are in it: one of ${run.stride}, and the last.` : `All ${run.given} frames are in it.`);
  if (run.lengthsOnly) lines.push("Components of vectors are left out.");
  if (run.onePointOf > 1) lines.push(`One point of ${run.onePointOf} is in it.`);
  const error = Math.max(run.positionError, run.radiusError);
  if (run.layers.length) lines.push(`Positions and radii are within ${short(error)}, fields within 1/131 070 of their range in a frame; whole numbers are exact.`);
  byId("note").textContent = lines.join(" ");
}

function fail(message) {
  byId("missing").textContent = message;
  byId("missing").hidden = false;
  window.grainpipe = { ready: false, error: message };
}

// The picture as last drawn: how many pixels are not background, and a sum that changes when the picture does.
function pixels() {
  redraw(1, painter.asDots(false, 0));
  const [w, h] = [canvas.width, canvas.height];
  const data = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, data);
  const back = paper().map((c) => Math.round(255 * c));
  let [covered, sum] = [0, 0];
  for (let i = 0; i < data.length; i += 4) {
    if ([0, 1, 2].some((k) => Math.abs(data[i + k] - back[k]) > 3)) covered++;
    sum = (Math.imul(sum, 31) + data[i] + 3 * data[i + 1] + 7 * data[i + 2]) | 0;
  }
  state.dirty = true;
  return { width: w, height: h, covered, sum };
}

// Milliseconds that a frame takes, drawn `count` times one after the other while the eye turns.
function measure(count, samples, dots) {
  const one = new Uint8Array(4);
  const wait = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, one);
  redraw(samples, dots);
  wait();
  const start = performance.now();
  for (let n = 0; n < count; n++) { camera.turn(0.01, 0); redraw(samples, dots); wait(); }
  return (performance.now() - start) / count;
}

// What was marked, in the words of `cloud-crop`.
function drawnRegions() {
  const files = regions.list.filter((r) => r.file).map((r) => [r.file, regions.json(r)]);
  return { dropped: [...regions.marks.keys()].filter((i) => regions.marks[i]), options: regions.options(), files: Object.fromEntries(files) };
}

function expose() {
  window.grainpipe = {
    ready: true, error: null, show, pixels, frames: clock.length,
    play: () => play(true), pause: () => play(false), colour: setField, look: lookFrom, measure, follow, slice: sliceAcross,
    pickAt: (x, y) => { pick(findAt(x, y)); return window.grainpipe.picked; },
    get picked() { return picked.hit && { id: picked.id, row: pickedRow(), place: pickedPlace()?.place, values: pickedValues() }; },
    get points() { return painter.dots; },
    get regions() { return run.pick ? drawnRegions() : null; },
    get frame() { return state.frame; },
    get playing() { return state.playing; },
    get drawn() { return painter.drawn; },
    get time() { return clock[state.frame]; },
    get field() { return state.field; },
    get glError() { return gl.getError(); },
  };
}

function start() {
  if (!gl) return fail("This view needs WebGL 2, which this browser does not offer. Try a current Firefox, Chrome, Edge or Safari, with graphics acceleration on.");
  try {
    fitCanvas();
    painter.start();
    sheets.start();
    rods.start();
    solids.start();
  } catch (problem) {
    return fail(`The graphics driver refused this page's drawing program: ${problem.message}`);
  }
  const moving = clock.length > 1;
  byId("player").hidden = !moving;
  document.body.classList.toggle("still", !moving);
  choices();
  plots.start();
  if (run.pick) regions.start();
  wire();
  notes();
  listKeys();
  showCounts();
  camera.start(innerWidth, innerHeight);
  byId("scrub").max = clock.length - 1;
  state.speed = naturalSpeed();
  byId("speed").value = state.speed;
  // The nearest frame: one is written at the end of the step in which its time comes, and so a little late.
  const off = (n) => Math.abs(clock[n] - run.time);
  show(run.time === null ? 0 : clock.reduce((best, _, n) => (off(n) < off(best) ? n : best), 0));
  expose();
  canvas.addEventListener("webglcontextlost", () => fail("The graphics card dropped this page: load it again."));
  redraw(1, painter.asDots(moving, 0));
  if (run.time === null && !matchMedia("(prefers-reduced-motion: reduce)").matches) play(moving);
  requestAnimationFrame(tick);
}

start();
