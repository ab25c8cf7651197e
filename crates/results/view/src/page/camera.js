// Where the eye stands. Angles in radians; z is up; lengths in metres from the middle of everything.
const dot3 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus3 = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross3 = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const halfView = 0.2679;  // tangent of half the angle of view, along the shorter side

const VIEWS = { iso: [0.62, -0.94, 0.62], front: [0, -1, 0], right: [1, 0, 0], top: [0, 0, 1],
                back: [0, 1, 0], left: [-1, 0, 0], bottom: [0, 0, -1] };

const camera = {
  yaw: 0, pitch: 0, distance: 1, target: [0, 0, 0], flat: false, rests: false,
  fitted: false,  // whether it stands where everything is seen, and has not been moved since
  wide: false,    // whether everything includes the few grains that are far from all others

  look(direction) {
    this.fitted = false;
    const [x, y, z] = direction;
    const level = Math.hypot(x, y);
    this.pitch = Math.atan2(z, level);
    this.yaw = level > 1e-9 ? Math.atan2(y, x) : -Math.PI / 2;
  },

  // Right, up, forward.
  axes() {
    const [cy, sy, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    return [[-sy, cy, 0], [-sp * cy, -sp * sy, cp], [-cp * cy, -cp * sy, -sp]];
  },

  eye() {
    const forward = this.axes()[2];
    return this.target.map((t, k) => t - this.distance * forward[k]);
  },

  // The point to look at and the least distance from which everything that stands out is seen in the part of the
  // window that nothing covers: -hl (z + d) <= x - tx <= hr (z + d) for all places, as far as it reaches left and right of
  // the middle, and the same with y.
  fit(width, height) {
    const everything = [...run.layers, ...run.surfaces];
    const shown = everything.filter((l) => !state.hidden.has(l) && l.outline.length);
    const axes = this.axes();
    const places = (l) => (this.wide && l.strays?.length ? l.strays : l.outline);
    const seen = (shown.length ? shown : everything).flatMap(places).map((p) => axes.map((a) => dot3(a, minus3(p, middle))));
    const ways = covered(width, height).map((edges) => ({ edges, ...this.within(edges, seen, width, height) }));
    const best = ways.reduce((a, b) => (b.distance < a.distance ? b : a));
    this.target = [0, 1, 2].map((k) => axes.reduce((sum, a, n) => sum + a[k] * best.aim[n], 0));
    this.distance = best.distance;
    this.fitted = true;
  },

  // Whether shown grains are far from all others.
  leaves() { return run.layers.some((l) => l.strays.length && !state.hidden.has(l)); },

  within([top, right, bottom, left], seen, width, height) {
    const short = Math.min(width, height);
    // Room before and behind the middle along x and y, less a margin of 3 % of what is free at each end.
    const room = (size, before, behind) => {
      const margin = 0.03 * (size - before - behind);
      return [before, behind].map((edge) => 2 * halfView * (0.5 * size - edge - margin) / short);
    };
    const [[lowX, highX], [highY, lowY]] = [room(width, left, right), room(height, top, bottom)];
    const [high, low] = [[highX, highY], [lowX, lowY]];
    const most = (of) => seen.reduce((m, p) => Math.max(m, of(p)), -Infinity);
    const lean = this.flat ? 0 : 1;
    const far = [0, 1].map((k) => most((p) => p[k] - lean * high[k] * p[2]));
    const near = [0, 1].map((k) => -most((p) => -p[k] - lean * low[k] * p[2]));
    const back = Math.max(...[0, 1].map((k) => (far[k] - near[k]) / (high[k] + low[k])));
    const depth = 0.5 * (most((p) => p[2]) - most((p) => -p[2]));
    // Between both ends of what the eye may be at.
    const [x, y] = [0, 1].map((k) => 0.5 * (far[k] - high[k] * back + near[k] + low[k] * back));
    return { aim: [x, y, depth], distance: Math.max(1e-9, back + (this.flat ? 0 : depth)) };
  },

  turn(right, up) {
    if (this.rests) return;
    this.fitted = false;
    this.yaw -= right;
    this.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.pitch + up));
  },

  zoom(factor) {
    this.fitted = false;
    this.distance = Math.max(1e-4 * halfDiagonal, Math.min(60 * reachOfAll, this.distance * factor));
  },

  // Moves what is looked at by so many pixels of a window whose shorter side has `short`.
  shift(right, down, short) {
    this.fitted = false;
    const [r, u] = this.axes();
    const metres = 2 * halfView * this.distance / short;
    this.target = this.target.map((t, k) => t + metres * (-right * r[k] + down * u[k]));
  },

  start(width, height) {
    const { eye, target, towards } = run.camera;
    this.look(towards);
    const aim = target ? target.map((t, k) => t - middle[k]) : [0, 0, 0];
    if (eye) {
      const away = eye.map((e, k) => e - middle[k] - aim[k]);
      this.look(away);
      this.target = aim;
      this.distance = Math.hypot(...away) || halfDiagonal;
    } else {
      this.fit(width, height);
    }
  },
};

// Pixels at the top, right, bottom and left of the window where text and controls stand: below the head, or beside it.
function covered(width, height) {
  const edge = (id, side, without) => (byId(id) && !byId(id).hidden ? byId(id).getBoundingClientRect()[side] : without);
  const narrow = width <= 560 && height >= width;
  const lowest = Math.min(...(narrow ? ["legend", "player", "region"] : ["player"]).map((id) => edge(id, "top", height)));
  const right = Math.min(0.3 * width, narrow ? 0 : width - edge("legend", "left", width));
  const bottom = Math.min(0.5 * height, Math.max(12, height - lowest));
  const left = Math.min(0.5 * width, narrow ? 0 : Math.max(edge("region", "right", 0), edge("plots", "right", 0)));
  const below = [Math.min(0.35 * height, edge("head", "bottom", 0) + 6), right, bottom, left];
  const beside = [12, right, bottom, Math.min(0.5 * width, Math.max(left, edge("head", "right", 0) + 12))];
  return [below, beside];
}

// The ray from the eye through a pixel of the window, and where a place is seen; relative to the middle.
function rayAt(x, y) {
  const [r, u, f] = camera.axes();
  const pixel = 2 * halfView / Math.min(innerWidth, innerHeight);
  const [a, b] = [pixel * (x - innerWidth / 2), pixel * (innerHeight / 2 - y)];
  const eye = camera.eye();
  if (camera.flat) return { from: eye.map((e, k) => e + camera.distance * (a * r[k] + b * u[k])), along: f, pixel };
  const along = [0, 1, 2].map((k) => f[k] + a * r[k] + b * u[k]);
  const length = Math.hypot(...along);
  return { from: eye, along: along.map((c) => c / length), pixel };
}

function seenAt(place) {
  const seen = camera.axes().map((a) => dot3(a, minus3(place, camera.eye())));
  const depth = camera.flat ? camera.distance : seen[2];
  const scale = Math.min(innerWidth, innerHeight) / (2 * halfView * depth);
  return { x: innerWidth / 2 + seen[0] * scale, y: innerHeight / 2 - seen[1] * scale, scale, before: depth > 0 };
}
