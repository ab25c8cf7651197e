// Where the eye stands. Angles in radians; z is up; lengths in metres from the middle of everything.
const dot3 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const halfView = 0.2679;  // tangent of half the angle of view, along the shorter side

const VIEWS = { iso: [0.62, -0.94, 0.62], front: [0, -1, 0], right: [1, 0, 0], top: [0, 0, 1],
                back: [0, 1, 0], left: [-1, 0, 0], bottom: [0, 0, -1] };

const camera = {
  yaw: 0, pitch: 0, distance: 1, target: [0, 0, 0], flat: false,

  look(direction) {
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

  // The point to look at and the least distance from which everything that stands out is seen in a window of this
  // shape: |x - tx| <= hx (z + d) for all places.
  fit(width, height) {
    const short = Math.min(width, height);
    const bar = clock.length > 1 ? 54 : 0;  // the player covers so many pixels at the bottom
    const half = [0.86 * halfView * width / short, 0.88 * halfView * (height - bar) / short];
    const axes = this.axes();
    const seen = run.outline.map((p) => axes.map((a) => dot3(a, p.map((c, k) => c - middle[k]))));
    const most = (of) => seen.reduce((m, p) => Math.max(m, of(p)), -Infinity);
    const lean = this.flat ? [0, 0] : half;
    const far = [0, 1].map((k) => most((p) => p[k] - lean[k] * p[2]));
    const low = [0, 1].map((k) => -most((p) => -p[k] - lean[k] * p[2]));
    const back = Math.max(...[0, 1].map((k) => (far[k] - low[k]) / (2 * half[k])));
    const depth = 0.5 * (most((p) => p[2]) - most((p) => -p[2]));
    const aim = [0.5 * (far[0] + low[0]), 0.5 * (far[1] + low[1]), depth];
    this.target = [0, 1, 2].map((k) => axes.reduce((sum, a, n) => sum + a[k] * aim[n], 0));
    this.distance = Math.max(1e-9, back + (this.flat ? 0 : depth));
    this.shift(0, -0.5 * bar, short);
  },

  turn(right, up) {
    this.yaw -= right;
    this.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.pitch + up));
  },

  zoom(factor) {
    this.distance = Math.max(1e-4 * halfDiagonal, Math.min(60 * halfDiagonal, this.distance * factor));
  },

  // Moves what is looked at by so many pixels of a window whose shorter side has `short`.
  shift(right, down, short) {
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
