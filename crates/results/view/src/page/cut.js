// The slice: what is shown lies between two parallel planes, or on one side of one. Places are relative to the middle.
const EVERYWHERE = { normal: [0, 0, 0], most: 1, least: -1e30 };

// Ends of the box along a direction.
function boxAlong(normal) {
  const half = normal.reduce((sum, n, k) => sum + 0.5 * Math.abs(n) * (box.hi[k] - box.lo[k]), 0);
  return [-half, half];
}

const cutDirection = () => (state.cutAxis < 3 ? [0, 1, 2].map((k) => (k === state.cutAxis ? 1 : 0)) : state.cutNormal);

// Shown: least <= normal . place <= most; none without a slice.
function cutOf() {
  if (state.cutAxis < 0) return null;
  const direction = cutDirection();
  const [lo, hi] = boxAlong(direction);
  const at = state.cutSide * (lo + state.cutAt * (hi - lo));
  const thick = state.cutThick > 0 ? state.cutThick * (hi - lo) : Infinity;
  return { normal: direction.map((n) => n * state.cutSide), most: at, least: Math.max(-1e30, at - thick) };
}

function setCut({ at }, cut) {
  const { normal, most, least } = cut || EVERYWHERE;
  gl.uniform4f(at("cut"), ...normal, most);
  gl.uniform1f(at("cutLeast"), least);
  gl.uniform3fv(at("cutSeen"), camera.axes().map((a) => dot3(a, normal)));
  gl.uniform1f(at("cutEye"), dot3(normal, camera.eye()));
}

function sliceAcross(axis) {
  state.cutAxis = state.cutAxis === axis && axis < 3 ? -1 : axis;
  if (axis === 3) state.cutNormal = camera.axes()[2].map((f) => -f);
  // Through what was picked, else through the middle of the grains; what is nearer to the eye goes.
  const at = axis >= 0 && dot3(cutDirection(), minus3(pickedPlace()?.place || midst(), middle));
  const [lo, hi] = axis >= 0 ? boxAlong(cutDirection()) : [0, 1];
  state.cutAt = Math.max(0, Math.min(1, (at - lo) / (hi - lo)));
  if (axis >= 0) state.cutSide = axis === 3 || dot3(cutDirection(), camera.axes()[2]) <= 0 ? 1 : -1;
  showCut();
}

// The mean place of what is looked at [m], of some of it.
function midst() {
  const layer = mainLayers.find((l) => frameAt(l, clock[state.frame]).count);
  if (!layer) return middle;
  const frame = frameAt(layer, clock[state.frame]);
  const step = Math.ceil(frame.count / 1000);
  let [sum, count] = [[0, 0, 0], 0];
  for (let row = 0; row < frame.count; row += step, count++) sum = placeAt(frame, row).map((c, k) => sum[k] + c);
  return sum.map((c) => c / count);
}

function moveSlice(share) {
  state.cutAt = Math.max(0, Math.min(1, state.cutAt + share));
  showCut();
}

function showCut() {
  const on = state.cutAxis >= 0;
  for (const id of ["depth", "thick", "flip"]) byId(id).hidden = !on;
  byId("whole").hidden = !on || !run.layers.some((l) => l.role === "grains");
  byId("across").value = on ? state.cutAxis : "";
  byId("where").value = state.cutAt;
  byId("slab").value = Math.sqrt(state.cutThick);
  if (on) {
    const [lo, hi] = boxAlong(cutDirection());
    const at = lo + state.cutAt * (hi - lo);
    const oblique = state.cutAxis > 2;
    const place = signedLength(oblique ? at : at + middle[state.cutAxis]);
    byId("depth").querySelector("output").textContent = oblique ? place : `${"xyz"[state.cutAxis]} = ${place}`;
    byId("thick").querySelector("output").textContent = state.cutThick > 0 ? signedLength(state.cutThick * (hi - lo)) : "all behind";
  }
  changed();
}

function signedLength(metres) {
  const factor = halfDiagonal < 1 ? 1e3 : 1;
  return `${number(metres * factor, factor === 1 ? 3 : 1)} ${factor === 1 ? "m" : "mm"}`;
}
