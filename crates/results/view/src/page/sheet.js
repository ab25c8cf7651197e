// Thin walls: planes and meshes, sent to the graphics card once and moved there.

// The progress of a motion at a time, as crates/base/geom/src/motion.rs has it.
// How often it has run before, and its progress in one run and in a whole one.
function progressOf(motion, now) {
  const { from = 0, period } = motion;
  const before = period && now > from ? Math.floor((now - from) / period) : 0;
  const whole = before > 0 ? progressOnce(motion, motion.until) : 0;
  return { before, whole, once: progressOnce(motion, before > 0 ? now - before * period : now) };
}

function progressOnce(motion, now) {
  const [from, until, ramp] = [motion.from ?? 0, motion.until ?? Infinity, motion.ramp ?? 0];
  const time = Math.min(Math.max(now, from), until) - from;
  const left = until - from - time;
  if (ramp === 0) return time;
  if (time < ramp) return (0.5 * time * time) / ramp;
  return left < ramp ? until - from - ramp - (0.5 * left * left) / ramp : time - 0.5 * ramp;
}

// The turn, by columns, about an axis of any length.
function turnBy(axis, angle) {
  const length = Math.hypot(...axis);
  const [x, y, z] = length > 0 ? axis.map((a) => a / length) : [0, 0, 1];
  const [s, c] = [Math.sin(angle), Math.cos(angle)];
  const d = 1 - c;
  return [c + x * x * d, y * x * d + z * s, z * x * d - y * s, x * y * d - z * s, c + y * y * d, z * y * d + x * s,
          x * z * d + y * s, y * z * d - x * s, c + z * z * d];
}

const turned = (turn, v) => [0, 1, 2].map((k) => dot3([turn[k], turn[3 + k], turn[6 + k]], v));
const turnedAll = (outer, turn) => [0, 3, 6].flatMap((k) => turned(outer, turn.slice(k, k + 3)));

// Shift and angle of a table over time.
function rowAt({ rows }, time) {
  const next = rows.findIndex((row) => row[0] > time);
  if (next <= 0) return next === 0 ? rows[0] : rows[rows.length - 1];
  const [before, after] = [rows[next - 1], rows[next]];
  const share = (time - before[0]) / (after[0] - before[0]);
  return before.map((value, k) => value + share * (after[k] - value));
}

// The turn (by columns) and shift that take a point relative to `origin` at t = 0 to one relative to `middle` at `time`: each motion
// of the list acts on what those before it have moved.
// x(t) = c + R(x0 - c) + v p + a sin(2 pi f p) + path(p), p: its progress
function poseOf(motion, origin, now) {
  let turn = [1, 0, 0, 0, 1, 0, 0, 0, 1];
  let place = [...origin];
  for (const part of motion ? [motion, ...(motion.then ?? [])] : []) {
    const { before, whole, once } = progressOf(part, now);
    const time = before * whole + once;
    let own = turnBy(part.turn, Math.hypot(...part.turn) * time);
    if (part.swing) {
      const { amplitude, frequency } = part.swing;
      own = turnedAll(turnBy(amplitude, Math.hypot(...amplitude) * Math.sin(2 * Math.PI * frequency * time)), own);
    }
    const end = part.path && before > 0 ? rowAt(part.path, whole) : [0, 0, 0, 0, 0];
    const row = part.path ? rowAt(part.path, once).map((value, k) => before * end[k] + value) : end;
    if (part.path) own = turnedAll(turnBy(part.path.about, row[4]), own);
    const sway = Math.sin(2 * Math.PI * part.frequency * time);
    const arm = turned(own, place.map((p, k) => p - part.through[k]));
    place = arm.map((p, k) => p + part.through[k] + part.velocity[k] * time + part.amplitude[k] * sway + row[k + 1]);
    turn = turnedAll(own, turn);
  }
  return { turn, shift: place.map((p, k) => p - middle[k]) };
}

// The colour of a mesh, 0 to 1: that of a wall, tinted where there are several to tell apart.
function tintOf(number, count) {
  const tint = run.kinds[number % run.kinds.length];
  return run.wall.map((c, k) => (count < 2 ? c : 0.6 * c + 0.4 * tint[k]) / 255);
}

const sheets = {
  target: null,

  start() {
    this.program = program("sheet", "sheet");
    this.opaque = program("sheet", "mesh");
    this.target = new Target();
    this.parts = run.surfaces.map((surface) => ({ surface, faces: this.faces(surface), lines: this.lines(surface) }));
  },

  faces(surface) {
    const [array, corners] = [gl.createVertexArray(), bytes(surface.faces)];
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, bytes(surface.vertices), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    return { array, count: corners.length / 4 };
  },

  lines(surface) {
    const [array, ends] = [gl.createVertexArray(), bytes(surface.lines)];
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, ends, gl.STATIC_DRAW);
    for (const place of [0, 1]) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 24, 12 * place);
      gl.vertexAttribDivisor(place, 1);
    }
    return { array, count: ends.length / 24 };
  },

  shown() {
    return this.parts.filter((p) => opacityOf(p.surface) > 0 && !state.hidden.has(p.surface));
  },

  // Meshes hide what is behind them when walls are not to be seen through; planes, which go on for ever, never do.
  isSolid: (part) => opacityOf(part.surface) > 0.999 && !part.surface.normal,
  solid() { return this.shown().filter((p) => this.isSolid(p)); },
  glass() { return this.shown().filter((p) => !this.isSolid(p)); },

  drawSolid(view) {
    const parts = this.solid();
    if (!parts.length) return;
    const { made, at } = this.opaque;
    gl.useProgram(made);
    painter.setEye(this.opaque, view);
    setCut(this.opaque, cutOf());
    gl.uniform1f(at("width"), 0);
    const meshes = run.surfaces.filter((s) => !s.normal);
    for (const part of parts) {
      gl.uniform3fv(at("plain"), tintOf(meshes.indexOf(part.surface), meshes.length));
      this.place(part, this.opaque);
      this.drawFaces(part, this.opaque);
    }
  },

  draw(view, size, glass) {
    const shown = this.glass();
    this.target.resize(...(shown.length ? size : [1, 1]));
    if (!shown.length) return;
    this.target.begin();
    gl.useProgram(this.program.made);
    this.setView(view, size, glass);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const rank = (part) => this.rank(part.surface, view.eye);
    const order = [...shown].sort((a, b) => rank(a) - rank(b));
    // Each rank by itself: the grid of a floor does not lie on the meshes that stand on it.
    for (const level of [0, 1, 2]) {
      const same = order.filter((part) => rank(part) === level);
      for (const part of same) this.drawPart(part, 0);
      for (const part of same) this.drawPart(part, 1.3 * size[0] / innerWidth);
    }
    gl.disable(gl.BLEND);
    gl.activeTexture(gl.TEXTURE0);
  },

  // A plane before or behind all grains is before or behind all meshes too: 0 behind, 1 mesh, 2 before.
  rank({ normal, motion, origin }, eye) {
    if (!normal) return 1;
    const { turn, shift } = poseOf(motion, origin, clock[state.frame]);
    const away = eye.map((e, k) => e - shift[k]);
    const turned = [0, 1, 2].map((k) => dot3([turn[k], turn[3 + k], turn[6 + k]], normal));
    return dot3(turned, away) < 0 ? 2 : 0;
  },

  place({ surface }, { at }) {
    const pose = poseOf(surface.motion, surface.origin, clock[state.frame]);
    gl.uniformMatrix3fv(at("pose"), false, pose.turn);
    gl.uniform3fv(at("poseShift"), pose.shift);
  },

  drawPart(part, width) {
    const { surface, lines } = part;
    const { at } = this.program;
    this.place(part, this.program);
    gl.uniform1f(at("width"), width);
    gl.uniform1i(at("plane"), surface.normal ? 1 : 0);
    // On dark paper a face of the same share would be as bright as the walls on it.
    const ground = surface.normal ? (paper()[0] < 0.5 ? 0.1 : 0.3) : 1;
    gl.uniform1f(at("hides"), width ? surface.ink : Math.min(state.opacity, ground));
    if (!width) return this.drawFaces(part);
    gl.bindVertexArray(lines.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.count);
  },

  drawFaces({ faces }) {
    gl.bindVertexArray(faces.array);
    gl.drawElements(gl.TRIANGLES, faces.count, gl.UNSIGNED_INT, 0);
  },

  setView(view, size, glass) {
    const { at } = this.program;
    painter.setEye(this.program, view);
    gl.uniform2fv(at("size"), size);
    gl.uniform3fv(at("plain"), run.wall.map((c) => c / 255));
    setCut(this.program, cutOf());
    gl.uniform1f(at("ink"), paper()[0] < 0.5 ? 1.1 : 0.5);
    gl.uniform1i(at("glass"), glass ? 1 : 0);
    [["solidDepth", painter.solid.depth], ["glassDepth", painter.glass.depth]].forEach(([name, input], n) => {
      gl.activeTexture(gl.TEXTURE1 + n);
      gl.bindTexture(gl.TEXTURE_2D, input);
      gl.uniform1i(at(name), 1 + n);
    });
  },
};
