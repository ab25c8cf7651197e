// Time: playing, stepping, and drawing only when something has changed.
const SPEEDS = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
let playTime = clock[0];
let lastTick = 0;
let slow = 0;
let lastChange = 0;

function show(frame) {
  state.frame = Math.max(0, Math.min(clock.length - 1, frame));
  playTime = clock[state.frame];
  keepUp();
  changed();
}

function changed() {
  state.dirty = true;
  lastChange = performance.now();
}

function play(on) {
  state.playing = on && clock.length > 1;
  if (state.playing && state.frame === clock.length - 1) show(0);
  lastTick = performance.now();
  byId("play").classList.toggle("playing", state.playing);
  byId("play").setAttribute("aria-label", state.playing ? "Pause" : "Play");
}

// The speed at which frames follow each other fast enough to be seen as motion, and slowly enough to be followed:
// real time where that takes 3 to 30 seconds.
function naturalSpeed() {
  const length = clock[clock.length - 1] - clock[0];
  if (length >= 3 && length <= 30) return 1;
  const wanted = Math.max(3, Math.min(12, clock.length / 15));
  return SPEEDS.find((s) => length / s <= wanted) || SPEEDS[SPEEDS.length - 1];
}

function advance(now) {
  const passed = Math.min(0.25, (now - lastTick) / 1000);
  lastTick = now;
  playTime += passed * state.speed;
  const end = clock[clock.length - 1];
  if (playTime > end + 0.8 * state.speed) playTime = clock[0];
  let frame = state.frame;
  if (clock[frame] > playTime) frame = 0;
  while (frame + 1 < clock.length && clock[frame + 1] <= playTime) frame++;
  if (frame !== state.frame) { state.frame = frame; keepUp(); changed(); }
}

// Moving pictures are drawn plainly where the machine is slow, and again in full once they rest: samples along each
// side of a pixel, and whether spheres become points.
function fineness() {
  const moving = state.playing || performance.now() - lastChange < 150;
  const samples = (moving && slow > 3) || devicePixelRatio >= 1.5 ? 1 : 2;
  return [samples, painter.asDots(moving, slow)];
}

let drawn = [0, false];
function tick(now) {
  if (state.playing) advance(now);
  const [samples, dots] = fineness();
  if (state.dirty || samples > drawn[0] || dots !== drawn[1]) {
    const gap = now - tick.last;
    if (state.dirty && gap < 1000) slow = Math.max(0, Math.min(8, slow + (gap > 45 ? 1 : -0.25)));
    redraw(samples, dots);
  }
  tick.last = now;
  requestAnimationFrame(tick);
}
tick.last = 0;

function redraw(samples, dots) {
  fitCanvas();
  painter.draw(samples, dots);
  drawn = [samples, dots];
  state.dirty = false;
  showRuler();
  showArrow();
  plots.mark();
  showGnomon();
  showCounts();
  showRing();
  if (picked.hit) showCard();
  if (run.pick) regions.outline();
  byId("scrub").value = state.frame;
  byId("time").textContent = `${state.frame + 1} / ${clock.length}`;
}

function fitCanvas() {
  const ratio = Math.min(2, devicePixelRatio || 1);
  const size = [Math.max(1, Math.round(innerWidth * ratio)), Math.max(1, Math.round(innerHeight * ratio))];
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
}
