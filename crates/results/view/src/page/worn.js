// Walls coloured by what was done to them: a column of values for each layer of wall spheres and each mesh, over time.
// Until the reader asks for another opacity, coloured walls hide what is behind them: a colour that is seen through is another one.
const opacityOf = (thing) => (isWorn(thing) && !worn.asked ? 1 : state.opacity);

const worn = { asked: false, on: true, shown: run.walls.shown, log: run.walls.log };

const isWorn = (thing) => worn.on && Boolean(thing.wear?.length);

// The column at the time shown: the last one that is not later. Times of messages are in nanoseconds.
function wornAt(thing) {
  const now = clock[state.frame] + 1e-9;
  let found = thing.wear[0];
  for (const entry of thing.wear) if (entry[0] <= now) found = entry;
  return found[1];
}

// The value of a part: a sphere by its row, a triangle by its place in the mesh.
function wornValue(thing, row) {
  const part = thing.parts == null ? row : new Uint32Array(bytes(thing.parts).buffer)[row];
  return valueAt(wornAt(thing), part);
}

// How far a value is along the scale, 0 to 1.
function wornShare(value) {
  const [lo, hi] = worn.shown;
  const share = worn.log ? Math.log(Math.max(value, 1e-30) / lo) / Math.log(hi / lo) : (value - lo) / (hi - lo);
  return Math.max(0, Math.min(1, share));
}

// The map of walls on the graphics card, which stays where it is bound.
const WALL_UNIT = 8;
function setWallMap() {
  const texels = new Uint8Array(1024);
  for (let i = 0; i < 256; i++) texels.set([...mapAt(run.walls.map, i / 255), 255], 4 * i);
  gl.activeTexture(gl.TEXTURE0 + WALL_UNIT);
  const made = texture(256, 1, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE);
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.LINEAR);
  gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 256, 1, gl.RGBA, gl.UNSIGNED_BYTE, texels);
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.activeTexture(gl.TEXTURE0);
}

// How a program reads the colours of walls.
function setWorn({ at }, column) {
  gl.uniform1i(at("wallMap"), WALL_UNIT);
  gl.uniform2f(at("wornOf"), column ? column[1] : 0, column ? column[2] - column[1] : 0);
  gl.uniform2fv(at("wornShown"), worn.shown ?? [0, 1]);
  gl.uniform1i(at("wornMode"), column ? (worn.log ? 2 : 1) : 0);
}

// The corners of a mesh, three for each triangle, with a value for each: neighbours have colours of their own.
const wornMesh = {
  make(surface) {
    const corners = new Uint32Array(bytes(surface.faces).buffer);
    const places = new Float32Array(bytes(surface.vertices).buffer);
    const spread = new Float32Array(3 * corners.length);
    corners.forEach((corner, n) => spread.set(places.subarray(3 * corner, 3 * corner + 3), 3 * n));
    const made = { array: gl.createVertexArray(), values: gl.createBuffer(), count: corners.length, number: null };
    gl.bindVertexArray(made.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, spread, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, made.values);
    gl.enableVertexAttribArray(2);
    gl.vertexAttribPointer(2, 1, gl.UNSIGNED_SHORT, true, 0, 0);
    return made;
  },

  draw(part) {
    const { surface } = part;
    part.worn ??= this.make(surface);
    gl.bindVertexArray(part.worn.array);
    const [number] = wornAt(surface);
    if (part.worn.number !== number) {
      const of = number === null ? null : numbersOf(number, 2);
      const parts = surface.parts == null ? null : new Uint32Array(bytes(surface.parts).buffer);
      const values = new Uint16Array(part.worn.count);
      for (let n = 0; of && n < values.length; n++) { const face = Math.floor(n / 3); values[n] = of[parts ? parts[face] : face]; }
      gl.bindBuffer(gl.ARRAY_BUFFER, part.worn.values);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
      part.worn.number = number;
    }
    gl.drawArrays(gl.TRIANGLES, 0, part.worn.count);
  },
};

// What is drawn without colours of walls, and the colours besides.
{
  const [paint, setPaint, drawFaces] = [painter.paint, painter.setPaint, sheets.drawFaces];
  painter.paint = (layer, frame) => (isWorn(layer) ? { columns: [wornAt(layer), null, null], mode: 0, axis: -1, worn: wornAt(layer) } : paint.call(painter, layer, frame));
  painter.setPaint = (program, about) => { setWorn(program, about.worn); setPaint.call(painter, program, about); };
  sheets.drawFaces = (part, program = sheets.program) => {
    const coloured = isWorn(part.surface);
    setWorn(program, coloured ? wornAt(part.surface) : null);
    if (coloured) wornMesh.draw(part); else drawFaces.call(sheets, part);
    // Lines have no values.
    setWorn(program, null);
  };
}

// What the card of a picked part shows.
function wornRows(thing, row) {
  if (!isWorn(thing)) return [];
  const value = wornValue(thing, row);
  return [{ name: run.walls.name, value, text: significant(value * run.walls.factor), unit: run.walls.unit }];
}

// Powers of ten between the ends; where they are few, 2 and 5 times them, too.
function decades([lo, hi]) {
  const [first, last] = [Math.floor(Math.log10(lo)), Math.ceil(Math.log10(hi))];
  const steps = last - first <= 2 ? [1, 2, 5] : [1];
  const ticks = Array.from({ length: last - first + 1 }, (_, n) => steps.map((step) => step * 10 ** (first + n))).flat();
  const inner = ticks.map((v) => [Math.log(v / lo) / Math.log(hi / lo), significant(v)]).filter(([at]) => at >= 0.06 && at <= 0.94);
  return [[0, significant(lo)], ...inner, [1, significant(hi)]];
}

// The part of the legend that is about walls.
function showWornLegend(legend) {
  if (!worn.on) return;
  const { name, unit, factor, map, all } = run.walls;
  legend.append(element("h2", `walls: ${name} [${unit}]`));
  showBar(legend, { name: `walls: ${name}`, unit, factor, all, shown: worn.shown, map }, worn.log ? decades : marksOf);
}

// Settings.
function wornChoices() {
  byId("worn-name").textContent = `Walls by ${run.walls.name}`;
  const fill = () => ["lo", "hi"].forEach((end, k) => { byId(`worn-${end}`).value = Number((worn.shown[k] * run.walls.factor).toPrecision(4)); });
  const show = () => { fill(); showLegend(); changed(); };
  const ends = () => {
    const given = ["lo", "hi"].map((end) => parseFloat(byId(`worn-${end}`).value.replace(",", ".")) / run.walls.factor);
    worn.shown = given.every(Number.isFinite) && given[0] < given[1] ? given : run.walls.shown;
    logFits();
    show();
  };
  // A logarithm needs a lower end above 0.
  const logFits = () => { if (worn.log && worn.shown[0] <= 0) worn.shown = [worn.shown[1] / 1000, worn.shown[1]]; };
  byId("worn-on").onchange = (e) => { worn.on = e.target.checked; show(); };
  byId("worn-log").onchange = (e) => { worn.log = e.target.checked; if (!worn.log && run.walls.shown[0] === 0) worn.shown = [0, worn.shown[1]]; logFits(); show(); };
  ["lo", "hi"].forEach((end) => { byId(`worn-${end}`).onchange = ends; });
  [byId("worn-on").checked, byId("worn-log").checked] = [worn.on, worn.log];
  fill();
}
