// One finger or the left button turns; two fingers, or the right button or Shift, move; pinch and wheel zoom.
// A press that does not move picks.
const STILL = 5;  // pixels

function gestures() {
  const down = new Map();
  let press = null;
  const centre = () => [...down.values()].reduce((s, p) => [s[0] + p[0] / down.size, s[1] + p[1] / down.size], [0, 0]);
  const spread = () => { const [a, b] = [...down.values()]; return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0; };
  const short = () => Math.min(innerWidth, innerHeight);
  canvas.addEventListener("pointerdown", (e) => {
    if (run.pick && regions.down(e)) return;
    canvas.setPointerCapture(e.pointerId);
    down.set(e.pointerId, [e.clientX, e.clientY]);
    press = down.size === 1 && e.button === 0 ? { x: e.clientX, y: e.clientY } : null;
  });
  canvas.addEventListener("pointerup", (e) => {
    down.delete(e.pointerId);
    if (press) pick(findAt(e.clientX, e.clientY));
    press = null;
  });
  canvas.addEventListener("pointercancel", (e) => { down.delete(e.pointerId); press = null; });
  canvas.addEventListener("pointermove", (e) => {
    if (!down.has(e.pointerId)) return;
    if (press && Math.hypot(e.clientX - press.x, e.clientY - press.y) <= STILL) return;
    press = null;
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
  canvas.addEventListener("dblclick", (e) => { if (!(run.pick && regions.drawing) && !findAt(e.clientX, e.clientY)) fitView(); });
  canvas.addEventListener("wheel", (e) => {
    e.preventDefault();
    const lines = e.deltaMode === 1 ? 30 : 1;
    camera.zoom(Math.exp(Math.max(-120, Math.min(120, e.deltaY * lines)) * 0.0022));
    changed();
  }, { passive: false });
}
