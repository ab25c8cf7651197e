// Bonds, cracks and arrows: rods between places of a frame.
const rods = {
  layers: [],

  start() {
    const own = run.layers.filter(isRods);
    if (!own.length) return;
    this.program = program("rod", "rod");
    this.layers = own.map((layer) => new Buffers(layer));
  },

  shown() { return this.layers.filter((b) => !state.hidden.has(b.layer)); },

  draw(view, size) {
    const shown = this.shown();
    if (!shown.length) return;
    const { made, at } = this.program;
    gl.useProgram(made);
    gl.viewport(0, 0, ...size);
    painter.setEye(this.program, view);
    gl.uniform2fv(at("lens"), view.clip);
    gl.uniform2fv(at("picture"), size);
    setCut(this.program, state.cutGrains ? cutOf() : null);
    const dark = paper()[0] < 0.5;
    gl.uniform3fv(at("breakColour"), BREAK.map((c) => c / 255));
    gl.uniform3fv(at("arrowColour"), dark ? [0.92, 0.93, 0.95] : [0.13, 0.15, 0.17]);
    for (const buffers of shown) this.drawLayer(buffers);
  },

  drawLayer(buffers) {
    const { at } = this.program;
    const { layer } = buffers;
    const frame = frameAt(layer, clock[state.frame]);
    if (!frame.count) return;
    gl.bindVertexArray(buffers.array);
    gl.uniform3fv(at("boxLo"), frame.lo.map((lo, k) => lo - middle[k]));
    gl.uniform3fv(at("boxSize"), frame.hi.map((hi, k) => hi - frame.lo[k]));
    gl.uniform2f(at("radiusOf"), frame.radius[1], frame.radius[2] - frame.radius[1]);
    buffers.column(0, frame.position, 3, 2, 1);
    buffers.column(1, frame.radius[0], 1, 2, 1);
    ["dx", "dy", "dz", layer.chains ? "normal_force" : "broken"].forEach((name, n) => {
      const column = frame.fields[fieldOf(layer, name)];
      buffers.column(2 + n, column ? column[0] : null, 1, column ? column[3] : 1, 1);
      gl.uniform2f(at(`valueOf[${n}]`), column ? column[1] : 0, column ? column[2] - column[1] : 0);
    });
    const { arrows, chains } = layer;
    gl.uniform1f(at("usual"), arrows ? arrows.radius : 0);
    gl.uniform3f(at("shape"), ...(arrows ? [...run.rods.head, arrows.scale] : chains ? [chains.radius, ...chains.shown] : layer.colour ? [1, 1, 0] : [run.rods.bond, run.rods.crack, 0]));
    gl.uniform3fv(at("wholeColour"), (layer.colour ?? WHOLE).map((c) => c / 255));
    if (chains) {
      const stops = run.maps[chains.map];
      gl.uniform1i(at("stopCount"), stops.length);
      gl.uniform3fv(at("stops"), stops.flat().map((c) => c / 255));
      gl.uniform3fv(at("breakColour"), chains.pull.map((c) => c / 255));
    }
    for (const part of arrows ? [1, 2] : [chains ? 3 : 0]) {
      gl.uniform1i(at("part"), part);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, frame.count);
    }
  },
};

const WHOLE = [107, 117, 133];
const BREAK = [219, 41, 31];

// Bonds of the frame shown: whole, broken; null where none are shown.
function bondCounts() {
  const shown = rods.shown().filter((b) => b.layer.role === "bonds");
  if (!shown.length) return null;
  let [whole, broken] = [0, 0];
  for (const { layer } of shown) {
    const frame = frameAt(layer, clock[state.frame]);
    const column = frame.fields[fieldOf(layer, "broken")];
    for (let row = 0; row < frame.count; row++) if (valueAt(column, row) > 0.5) broken++; else whole++;
  }
  return { whole, broken };
}

// What of the contacts is drawn.
function chainWords() {
  const layer = rods.shown().find((b) => b.layer.chains)?.layer;
  if (!layer) return [];
  const frame = frameAt(layer, clock[state.frame]);
  const of = (name) => (frame.count ? valueAt(frame.fields[fieldOf(layer, name)], 0) : 0);
  const [drawn, all] = [of("drawn"), of("contacts")].map(Math.round);
  if (drawn === all) return [`${grouped(all)} contacts`];
  return [`the ${grouped(drawn)} strongest of ${grouped(all)} contacts: ${Math.floor(100 * of("force_drawn") / of("force_of_all"))} % of the force`];
}

function showRodLegend(legend) {
  const chains = rods.shown().find((b) => b.layer.chains)?.layer.chains;
  const outlines = rods.shown().map((b) => b.layer).filter((l) => l.colour);
  if (outlines.length) {
    legend.append(swatches(outlines.map((l) => [l.colour, l.name])));
    legend.hidden = false;
  }
  if (!chains) return;
  legend.append(element("h2", `normal force [${chains.unit}]`));
  // Contacts that pull are not below the scale: they have a colour of their own.
  showBar(legend, { ...chains, all: chains.all.map((v) => Math.max(0, v)) });
  if (chains.all[0] < 0) legend.append(swatches([[chains.pull, "contacts that pull"]]));
  legend.hidden = false;
}

// An arrow of a round value, as long as one at the distance of the point looked at.
function showArrow() {
  const shown = rods.shown().find((b) => b.layer.arrows);
  byId("arrow").hidden = !shown;
  if (!shown) return;
  const { word, unit, factor, example, scale } = shown.layer.arrows;
  const length = example * scale * Math.min(innerWidth, innerHeight) / (2 * halfView * camera.distance);
  byId("arrow").querySelector("span").textContent = `${word} ${Number((example * factor).toPrecision(6))} ${unit}`;
  const wide = Math.max(8, Math.min(0.5 * innerWidth, length));
  byId("arrow").querySelector("svg").setAttribute("width", wide + 2);
  byId("arrow").querySelector("path").setAttribute("d", `M1 6H${wide}m-6-5l6 5l-6 5`);
}
