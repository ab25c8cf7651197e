// Start, and what a test or a script may ask for.
function notes() {
  const kept = clock.length;
  const parts = [];
  if (run.stride > 1) parts.push(`To keep the page small, ${kept} of ${run.given} frames are in it: one of ${run.stride}, and the last.`);
  const error = Math.max(run.positionError, run.radiusError);
  parts.push(`Positions in this page are exact to ${Number((error * 1e6).toPrecision(2))} µm.`);
  byId("note").textContent = parts.join(" ");
}

function fail(message) {
  byId("missing").textContent = message;
  byId("missing").hidden = false;
  window.grainpipe = { ready: false, error: message };
}

// The picture as last drawn: how many pixels are not background, and a sum that changes when the picture does.
function pixels() {
  redraw(1);
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

function expose() {
  window.grainpipe = {
    ready: true, error: null, show, pixels, frames: clock.length,
    play: () => play(true), pause: () => play(false), colour: setField, look: lookFrom,
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
    camera.start(innerWidth, innerHeight);
    painter.start();
    sheets.start();
  } catch (problem) {
    return fail(`The graphics driver refused this page's drawing program: ${problem.message}`);
  }
  choices();
  wire();
  notes();
  const moving = clock.length > 1;
  byId("player").hidden = !moving;
  byId("ruler").style.bottom = moving ? "" : "24px";
  byId("scrub").max = clock.length - 1;
  state.speed = naturalSpeed();
  byId("speed").value = state.speed;
  const asked = run.time === null ? -1 : clock.findLastIndex((t) => t <= run.time + 1e-12);
  show(Math.max(0, asked));
  expose();
  canvas.addEventListener("webglcontextlost", () => fail("The graphics card dropped this page: load it again."));
  redraw(1);
  if (run.time === null && !matchMedia("(prefers-reduced-motion: reduce)").matches) play(moving);
  requestAnimationFrame(tick);
}

start();
