// Clumps that are polyhedra: crates/results/view/src/page/solids.rs says how a mesh is placed.
const PER_SOLID = 16;  // three columns of the matrix and the shift, with a colour and the tag of the clump

const solids = {
  parts: [],

  start() {
    const layers = run.layers.filter((l) => l.solids.length);
    if (!layers.length) return;
    this.program = program("solid", "solid");
    this.parts = layers.map((layer) => ({ layer, frame: null, shapes: layer.solids.map((s) => this.shape(s)) }));
  },

  shape(about) {
    const [array, poses] = [gl.createVertexArray(), gl.createBuffer()];
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, bytes(about.mesh), gl.STATIC_DRAW);
    for (const place of [0, 1]) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 24, 12 * place);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, poses);
    for (const place of [2, 3, 4, 5]) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 4, gl.FLOAT, false, 4 * PER_SOLID, 16 * (place - 2));
      gl.vertexAttribDivisor(place, 1);
    }
    return { about, array, poses, rows: [], numbers: null };
  },

  // Only at their own size: smaller spheres are apart.
  shown() {
    return painter.dots ? [] : this.parts.filter((p) => !state.hidden.has(p.layer) && sizeOf(p.layer) === 1);
  },

  draw(view, size) {
    const shown = this.shown();
    if (!shown.length) return;
    gl.useProgram(this.program.made);
    gl.viewport(0, 0, ...size);
    painter.setEye(this.program, view);
    painter.setColours(this.program);
    setCut(this.program, state.cutGrains ? cutOf() : null);
    for (const part of shown) {
      const frame = this.place(part);
      painter.setPaint(this.program, painter.paint(part.layer, frame));
      for (const { about, array, rows } of part.shapes) {
        gl.bindVertexArray(array);
        if (rows.length) gl.drawArraysInstanced(gl.TRIANGLES, 0, about.corners, rows.length);
      }
    }
  },

  // Computes the columns of the frame shown, unless they are there.
  place(part) {
    const { layer, shapes } = part;
    const frame = frameAt(layer, clock[state.frame]);
    if (part.frame === frame && part.field === state.field) return frame;
    [part.frame, part.field] = [frame, state.field];
    shapes.forEach((s) => { s.rows = []; });
    const found = frame.solids === undefined ? [] : numbersOf(frame.solids, 4);
    for (let k = 0; k < found.length; k += 2) shapes[found[k + 1]].rows.push(found[k]);
    const shares = painter.paint(layer, frame).columns.map(sharesOf);
    for (const shape of shapes) {
      shape.numbers = new Float32Array(PER_SOLID * shape.rows.length);
      shape.rows.forEach((row, n) => shape.numbers.set(poseOfSolid(layer, frame, shape.about, row, shares), PER_SOLID * n));
      gl.bindBuffer(gl.ARRAY_BUFFER, shape.poses);
      gl.bufferData(gl.ARRAY_BUFFER, shape.numbers, gl.DYNAMIC_DRAW);
    }
    return frame;
  },
};

// The numbers of a column as shares of its range.
function sharesOf(column) {
  if (!column || column[0] === null) return () => 0;
  const [all, most] = [numbersOf(column[0], column[3]), 256 ** column[3] - 1];
  return (row) => all[row] / most;
}

// The columns of one clump, whose spheres begin at `row`; places are relative to the middle.
function poseOfSolid(layer, frame, about, row, shares) {
  const places = about.frame.map((k) => placeAt(frame, row + k).map((p, n) => p - middle[n]));
  const sides = [1, 2, 3].map((k) => minus3(places[k], places[0]));
  const turn = [0, 1, 2].map((column) => [0, 1, 2].map((n) => [0, 1, 2].reduce((sum, k) => sum + sides[k][n] * about.inverse[3 * k + column], 0)));
  const shift = [0, 1, 2].map((n) => places[0][n] - about.origin.reduce((sum, o, column) => sum + turn[column][n] * o, 0));
  const body = frame.fields[fieldOf(layer, "body")];
  const tag = tagOf(body[0] === null ? 0 : numbersOf(body[0], body[3])[row]) / 255;
  return [...turn.flatMap((column, k) => [...column, shares[k](row)]), ...shift, tag];
}

// The nearest clump that a ray meets, by the planes of its faces.
function solidOn(ray, part) {
  const { from, along } = ray;
  const [open, shut] = openPart({ from, along, cut: state.cutGrains ? cutOf() : null });
  let best = null;
  for (const { about, rows, numbers } of part.shapes) {
    for (let n = 0; n < rows.length; n++) {
      const at = PER_SOLID * n;
      const back = (v) => [0, 4, 8].map((c) => numbers[at + c] * v[0] + numbers[at + c + 1] * v[1] + numbers[at + c + 2] * v[2]);
      const size = numbers[at] ** 2 + numbers[at + 1] ** 2 + numbers[at + 2] ** 2;
      const [start, rate] = [back(from.map((f, k) => f - numbers[at + 12 + k])), back(along)];
      let [first, last] = [open, shut];
      for (const plane of about.planes) {
        const [above, speed] = [dot3(plane, start) / size - plane[3], dot3(plane, rate) / size];
        if (speed < 0) first = Math.max(first, -above / speed);
        else if (speed > 0) last = Math.min(last, -above / speed);
        else if (above > 0) last = -1;
        if (first > last) break;
      }
      if (first <= last && (!best || first < best.depth)) best = { layer: part.layer, row: rows[n], depth: first, miss: 0 };
    }
  }
  return best;
}
