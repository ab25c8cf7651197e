// Drawing: spheres on squares into a buffer of colour, normal and depth; then light, walls and smoothing in one pass.
const canvas = byId("view");
const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, depth: false, powerPreference: "high-performance" });

function program(name) {
  const made = gl.createProgram();
  for (const [kind, type] of [["vert", gl.VERTEX_SHADER], ["frag", gl.FRAGMENT_SHADER]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, byId(name + "-" + kind).textContent.trim());
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(name + "." + kind + ": " + gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(name + ": " + gl.getProgramInfoLog(made));
  const places = {};
  return { made, at: (u) => (u in places ? places[u] : (places[u] = gl.getUniformLocation(made, u))) };
}

function texture(width, height, inside, format, type) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texImage2D(gl.TEXTURE_2D, 0, inside, width, height, 0, format, type, null);
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
  for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
  return made;
}

class Target {
  resize(width, height) {
    if (this.width === width && this.height === height) return;
    this.free();
    [this.width, this.height] = [width, height];
    this.colour = texture(width, height, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE);
    this.normal = texture(width, height, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE);
    this.depth = texture(width, height, gl.DEPTH_COMPONENT32F, gl.DEPTH_COMPONENT, gl.FLOAT);
    this.buffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffer);
    const parts = [[gl.COLOR_ATTACHMENT0, this.colour], [gl.COLOR_ATTACHMENT1, this.normal], [gl.DEPTH_ATTACHMENT, this.depth]];
    for (const [place, part] of parts) gl.framebufferTexture2D(gl.FRAMEBUFFER, place, gl.TEXTURE_2D, part, 0);
    gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
  }
  free() {
    for (const t of [this.colour, this.normal, this.depth]) if (t) gl.deleteTexture(t);
    if (this.buffer) gl.deleteFramebuffer(this.buffer);
  }
  begin() {
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffer);
    gl.viewport(0, 0, this.width, this.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clearDepth(1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }
}

// The columns of a layer on the graphics card; a column that is there already is not sent again.
class Buffers {
  constructor(layer) {
    this.layer = layer;
    this.array = gl.createVertexArray();
    this.columns = [0, 1, 2, 3, 4].map(() => ({ buffer: gl.createBuffer(), number: null }));
  }
  column(place, number, size, width) {
    const column = this.columns[place];
    if (number === null) { gl.disableVertexAttribArray(place); gl.vertexAttrib1f(place, 0); return; }
    gl.bindBuffer(gl.ARRAY_BUFFER, column.buffer);
    if (column.number !== number) {
      gl.bufferData(gl.ARRAY_BUFFER, bytes(number), gl.DYNAMIC_DRAW);
      column.number = number;
    }
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, width === 1 ? gl.UNSIGNED_BYTE : gl.UNSIGNED_SHORT, true, 0, 0);
    gl.vertexAttribDivisor(place, 1);
  }
}

const painter = {
  solid: null, glass: null, quality: 2, drawn: 0,

  start() {
    this.ball = program("ball");
    this.light = program("light");
    this.solid = new Target();
    this.glass = new Target();
    this.empty = gl.createVertexArray();
    this.layers = run.layers.map((layer) => new Buffers(layer));
    this.map = texture(256, 1, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.LINEAR);
    this.mapShown = null;
  },

  setMap() {
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.map);
    if (this.mapShown === state.map) return;
    const texels = new Uint8Array(1024);
    for (let i = 0; i < 256; i++) texels.set([...mapAt(state.map, i / 255), 255], 4 * i);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 256, 1, gl.RGBA, gl.UNSIGNED_BYTE, texels);
    this.mapShown = state.map;
  },

  // Draws the scene as `state` and `camera` say; `quality` samples along each side of a pixel.
  draw(quality) {
    const [width, height] = [canvas.width, canvas.height];
    const size = [width * quality, height * quality];
    const walls = mainRole !== "walls" && state.opacity < 0.999;
    const view = this.view(size);
    const all = this.layers.filter((b) => !state.hidden.has(b.layer));
    const isGlass = (b) => walls && b.layer.role === "walls";
    this.drawn = 0;
    const glass = all.filter((b) => isGlass(b) && state.opacity > 0);
    this.solid.resize(...size);
    this.glass.resize(...(glass.length ? size : [1, 1]));
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(this.ball.made);
    this.setMap();
    this.setView(view);
    this.solid.begin();
    for (const b of all) if (!isGlass(b)) this.spheres(b);
    this.glass.begin();
    for (const b of glass) this.spheres(b);
    sheets.draw(view, size, glass.length > 0);
    this.compose(view, quality, glass.length > 0);
  },

  view([width, height]) {
    const short = Math.min(width, height);
    const eye = camera.eye();
    const centre = Math.hypot(...eye);
    const near = camera.flat ? centre - 4 * halfDiagonal - camera.distance : Math.max(1e-4 * camera.distance, centre - 4 * halfDiagonal);
    const focal = camera.flat ? short / (2 * halfView * camera.distance) : short / (2 * halfView);
    return { eye, focal, nearFar: [near, centre + 4 * halfDiagonal], clip: [2 * focal / width, 2 * focal / height] };
  },

  setEye({ at }, view) {
    const [r, u, f] = camera.axes();
    gl.uniformMatrix3fv(at("turn"), false, [r[0], u[0], f[0], r[1], u[1], f[1], r[2], u[2], f[2]]);
    gl.uniform3fv(at("eye"), view.eye);
    gl.uniform2fv(at("focal"), view.clip);
    gl.uniform2fv(at("nearFar"), view.nearFar);
    gl.uniform1f(at("flatView"), camera.flat ? 1 : 0);
  },

  setView(view) {
    const { at } = this.ball;
    this.setEye(this.ball, view);
    gl.uniform1f(at("pixel"), 1 / view.focal);
    gl.uniform3fv(at("kinds[0]"), run.kinds.flat().map((c) => c / 255));
    gl.uniform3fv(at("plain"), run.wall.map((c) => c / 255));
    gl.uniform1i(at("map"), 0);
  },

  spheres(buffers) {
    const { at } = this.ball;
    const layer = buffers.layer;
    const frame = frameAt(layer, clock[state.frame]);
    gl.bindVertexArray(buffers.array);
    buffers.column(0, frame.position, 3, 2);
    buffers.column(1, frame.radius[0], 1, 2);
    gl.uniform3fv(at("boxLo"), frame.lo.map((lo, k) => lo - middle[k]));
    gl.uniform3fv(at("boxSize"), frame.hi.map((hi, k) => hi - frame.lo[k]));
    const pose = poseOf(layer.motion, middle, clock[state.frame]);
    gl.uniformMatrix3fv(at("pose"), false, pose.turn);
    gl.uniform3fv(at("poseShift"), pose.shift);
    gl.uniform3f(at("radiusOf"), frame.radius[1], frame.radius[2] - frame.radius[1], layer.pointRadius ? state.dot : 1);
    this.colours(buffers, frame);
    this.cut(layer);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, frame.count);
    this.drawn += frame.count;
  },

  colours(buffers, frame) {
    const { at } = this.ball;
    const layer = buffers.layer;
    const axis = ["x", "y", "z"].indexOf(state.field);
    const own = state.field === "rgb" && hasColours(layer);
    const names = own ? ["red", "green", "blue"] : [state.field];
    const coloured = layer.role === mainRole && (own || fieldOf(layer, state.field) >= 0);
    for (let n = 0; n < 3; n++) {
      const column = coloured && axis < 0 && names[n] ? frame.fields[fieldOf(layer, names[n])] : null;
      buffers.column(2 + n, column ? column[0] : null, 1, column ? column[3] : 1);
      gl.uniform2f(at(`valueOf[${n}]`), column ? column[1] : 0, column ? column[2] - column[1] : 0);
    }
    const about = own || !coloured ? null : describe(state.field);
    gl.uniform1i(at("mode"), !coloured ? 0 : own ? 3 : about.kinds ? 2 : 1);
    gl.uniform1i(at("axis"), axis);
    const shift = axis < 0 ? 0 : middle[axis];
    gl.uniform2f(at("shown"), state.shown[0] - shift, state.shown[1] - shift);
  },

  cut(layer) {
    gl.uniform4fv(this.ball.at("cut"), layer.role === "grains" && !state.cutGrains ? [0, 0, 0, 1] : cutPlane());
  },

  compose(view, quality, glass) {
    const { at } = this.light;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.disable(gl.DEPTH_TEST);
    gl.useProgram(this.light.made);
    gl.bindVertexArray(this.empty);
    const inputs = [["solidColour", this.solid.colour], ["solidNormal", this.solid.normal], ["solidDepth", this.solid.depth],
                    ["glassColour", this.glass.colour], ["glassNormal", this.glass.normal], ["glassDepth", this.glass.depth],
                    ["sheetBehind", sheets.target.colour], ["sheetBefore", sheets.target.normal]];
    inputs.forEach(([name, input], n) => {
      gl.activeTexture(gl.TEXTURE0 + n);
      gl.bindTexture(gl.TEXTURE_2D, input);
      gl.uniform1i(at(name), n);
    });
    gl.uniform3fv(at("paper"), paper());
    gl.uniform2fv(at("nearFar"), view.nearFar);
    gl.uniform2f(at("focal"), view.focal, view.focal);
    gl.uniform1f(at("flatView"), camera.flat ? 1 : 0);
    gl.uniform1f(at("opacity"), glass ? state.opacity : 0);
    gl.uniform1i(at("sheets"), sheets.shown().length ? 1 : 0);
    gl.uniform1f(at("reach"), 4 * typicalRadius());
    gl.uniform1i(at("samples"), quality);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  },
};

// What is shown: normal . place <= limit.
function cutPlane() {
  const k = state.cutAxis;
  if (k < 0) return [0, 0, 0, 1];
  const place = box.lo[k] + state.cutAt * (box.hi[k] - box.lo[k]) - middle[k];
  return [...[0, 1, 2].map((n) => (n === k ? state.cutSide : 0)), state.cutSide * place];
}

function typicalRadius() {
  const layer = mainLayers[0];
  if (!layer) return 0.01 * halfDiagonal;
  const radius = frameAt(layer, clock[state.frame]).radius;
  return 0.5 * (radius[1] + radius[2]) * (layer.pointRadius ? state.dot : 1);
}

// The page's background, 0 to 1.
function paper() {
  const text = getComputedStyle(document.documentElement).getPropertyValue("--paper").trim();
  return [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16) / 255);
}
