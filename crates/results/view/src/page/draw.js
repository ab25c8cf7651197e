// Drawing: spheres, or dots where they are too many, into a buffer of colour, normal and depth; then light, walls and
// smoothing in one pass.
const FEW = 4e5;    // up to here all is drawn as spheres
const MANY = 2e6;   // beyond, always as points

const painter = {
  solid: null, glass: null, drawn: 0, dots: false,

  start() {
    this.balls = program("ball", "ball");
    this.points = program("ball", "dot");
    this.light = program("light", "light");
    this.most = Math.min(256, gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1]);
    this.solid = new Target();
    this.glass = new Target();
    this.empty = gl.createVertexArray();
    this.layers = run.layers.filter((l) => !isRods(l)).map((layer) => new Buffers(layer));
    this.map = texture(256, 1, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.LINEAR);
    this.mapShown = null;
    setWallMap();
  },

  setMap() {
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.map);
    const classes = state.field === "size";
    const wanted = `${state.map} ${classes}`;
    if (this.mapShown === wanted) return;
    const texels = new Uint8Array(1024);
    const colour = (share) => (classes ? mapAt(state.map, classShare(share)) : mapAt(state.map, share));
    for (let i = 0; i < 256; i++) texels.set([...colour(i / 255), 255], 4 * i);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 256, 1, gl.RGBA, gl.UNSIGNED_BYTE, texels);
    this.mapShown = wanted;
  },

  total() {
    const shown = run.layers.filter((l) => !isRods(l) && !state.hidden.has(l));
    return shown.reduce((sum, l) => sum + frameAt(l, clock[state.frame]).count, 0);
  },

  // Level of detail: points where spheres would be too many for the picture to follow the hand.
  asDots(moving, slow) {
    if (state.detail !== "auto") return state.detail === "points";
    const total = this.total();
    return total > MANY || (total > FEW && (moving || slow > 3)) || (total > 5e4 && moving && slow > 6);
  },

  // Draws the scene as `state` and `camera` say; `quality` samples along each side of a pixel.
  draw(quality, dots) {
    this.dots = dots;
    this.ball = dots ? this.points : this.balls;
    const [width, height] = [canvas.width, canvas.height];
    const size = [width * quality, height * quality];
    const view = this.view(size);
    const all = this.layers.filter((b) => !state.hidden.has(b.layer));
    const isGlass = (b) => mainRole !== "walls" && b.layer.role === "walls" && opacityOf(b.layer) < 0.999;
    this.drawn = 0;
    this.smooth = false;
    const glass = all.filter((b) => isGlass(b) && state.opacity > 0);
    this.solid.resize(...size);
    this.glass.resize(...(glass.length ? size : [1, 1]));
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(this.ball.made);
    this.setMap();
    this.setView(view, size);
    this.solid.begin();
    this.widen(size);
    for (const b of all) if (!isGlass(b)) this.spheres(b, view);
    rods.draw(view, size);
    solids.draw(view, size);
    gl.viewport(0, 0, ...size);
    sheets.drawSolid(view);
    gl.useProgram(this.ball.made);
    this.glass.begin();
    this.widen(size);
    for (const b of glass) this.spheres(b, view);
    sheets.draw(view, size, glass.length > 0);
    this.compose(view, quality, glass.length > 0);
  },

  view([width, height]) {
    const short = Math.min(width, height);
    const eye = camera.eye();
    const centre = Math.hypot(...eye);
    const reach = Math.max(4 * halfDiagonal, 1.01 * reachOfAll);
    const near = camera.flat ? centre - reach - camera.distance : Math.max(1e-4 * camera.distance, centre - reach);
    const focal = camera.flat ? short / (2 * halfView * camera.distance) : short / (2 * halfView);
    return { eye, focal, nearFar: [near, centre + reach], clip: [2 * focal / width, 2 * focal / height] };
  },

  // A point whose centre is outside of the picture is not drawn at all: the picture is made wider than its buffer.
  widen([width, height]) {
    const edge = 0.5 * this.most;
    gl.viewport(-edge, -edge, width + 2 * edge, height + 2 * edge);
  },

  setEye({ at }, view) {
    const [r, u, f] = camera.axes();
    gl.uniformMatrix3fv(at("turn"), false, [r[0], u[0], f[0], r[1], u[1], f[1], r[2], u[2], f[2]]);
    gl.uniform3fv(at("eye"), view.eye);
    gl.uniform2fv(at("focal"), view.clip);
    gl.uniform2fv(at("nearFar"), view.nearFar);
    gl.uniform1f(at("flatView"), camera.flat ? 1 : 0);
  },

  setView(view, size) {
    const { at } = this.ball;
    this.setEye(this.ball, view);
    gl.uniform2fv(at("focal"), view.clip.map((c, k) => c * size[k] / (size[k] + this.most)));
    gl.uniform2fv(at("lens"), view.clip);
    gl.uniform2fv(at("picture"), size);
    gl.uniform1f(at("most"), this.most);
    gl.uniform1f(at("pixel"), 1 / view.focal);
    gl.uniform3fv(at("markColour"), [0.9, 0.22, 0.18]);
    this.setColours(this.ball);
  },

  spheres(buffers, view) {
    const { at } = this.ball;
    const layer = buffers.layer;
    const frame = frameAt(layer, clock[state.frame]);
    const pose = poseOf(layer.motion, middle, clock[state.frame]);
    const scale = sizeOf(layer);
    this.smooth ||= frame.clumps > 0 && !this.dots;
    gl.bindVertexArray(buffers.array);
    gl.uniform3fv(at("boxLo"), frame.lo.map((lo, k) => lo - middle[k]));
    gl.uniform3fv(at("boxSize"), frame.hi.map((hi, k) => hi - frame.lo[k]));
    gl.uniformMatrix3fv(at("pose"), false, pose.turn);
    gl.uniform3fv(at("poseShift"), pose.shift);
    gl.uniform3f(at("radiusOf"), frame.radius[1], frame.radius[2] - frame.radius[1], scale);
    setCut(this.ball, layer.role === "grains" && !state.cutGrains ? null : cutOf());
    this.columns(buffers, frame, 0);
    gl.uniform1i(at("asPoints"), this.dots ? 2 : 1);
    gl.drawArrays(gl.POINTS, 0, frame.count);
    if (!this.dots && this.mayBeLarge(frame, pose, scale, view)) {
      this.columns(buffers, frame, 1);
      gl.uniform1i(at("asPoints"), 0);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, frame.count);
    }
    this.drawn += frame.count;
  },

  // Whether any sphere of a frame may be seen larger than points can be: the nearest corner of its box decides.
  mayBeLarge(frame, pose, scale, view) {
    const radius = Math.max(frame.radius[2] * scale, 1e-30);
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((n) => [0, 1, 2].map((k) => (n >> k & 1 ? frame.hi[k] : frame.lo[k]) - middle[k]));
    const forward = camera.axes()[2];
    const depth = (c) => dot3(forward, minus3([0, 1, 2].map((k) => dot3([pose.turn[k], pose.turn[3 + k], pose.turn[6 + k]], c) + pose.shift[k]), view.eye));
    const nearest = camera.flat ? 1 : Math.min(...corners.map(depth)) - radius;
    return nearest <= 0 || 3 * radius / nearest * view.focal + 2 > this.most;
  },

  columns(buffers, frame, each) {
    buffers.column(0, frame.position, 3, 2, each);
    buffers.column(1, frame.radius[0], 1, 2, each);
    buffers.marks(each);
    buffers.tags(frame, each);
    this.colours(buffers, frame, each);
  },

  colours(buffers, frame, each) {
    const paint = this.paint(buffers.layer, frame);
    paint.columns.forEach((column, n) => buffers.column(2 + n, column ? column[0] : null, 1, column ? column[3] : 1, each));
    this.setPaint(this.ball, paint);
  },

  // What a layer is coloured by in a frame: up to three columns, and how a program reads them.
  paint(layer, frame) {
    const axis = ["x", "y", "z"].indexOf(state.field);
    const main = layer.role === mainRole;
    // A scan beside grains keeps the colours it came with.
    const own = hasColours(layer) && (main ? state.field === "rgb" : layer.role === "cloud");
    const names = own ? ["red", "green", "blue"] : [state.field];
    const sizes = state.field === "size" && !layer.pointRadius;
    const coloured = own || (main && (sizes || fieldOf(layer, state.field) >= 0));
    const diameter = frame.radius.map((v, k) => (k === 1 || k === 2 ? 2 * v : v));
    const column = (name) => (sizes && !own ? diameter : frame.fields[fieldOf(layer, name)]);
    const columns = [0, 1, 2].map((n) => (coloured && (own || axis < 0) && names[n] ? column(names[n]) : null));
    const about = own || !coloured ? null : describe(state.field);
    const kinds = about?.name === "body" && about.all[1] >= run.kinds.length ? 4 : 2;
    return { columns, mode: !coloured ? 0 : own ? 3 : about.kinds ? kinds : 1, axis: own ? -1 : axis };
  },

  setPaint({ at }, { columns, mode, axis }) {
    columns.forEach((column, n) => gl.uniform2f(at(`valueOf[${n}]`), column ? column[1] : 0, column ? column[2] - column[1] : 0));
    gl.uniform1i(at("mode"), mode);
    gl.uniform1i(at("axis"), axis);
    const shift = middle[["x", "y", "z"].indexOf(state.field)] ?? 0;
    gl.uniform2f(at("shown"), state.shown[0] - shift, state.shown[1] - shift);
  },

  setColours({ at }) {
    gl.uniform3fv(at("kinds[0]"), run.kinds.flat().map((c) => c / 255));
    gl.uniform3fv(at("plain"), run.wall.map((c) => c / 255));
    gl.uniform1i(at("map"), 0);
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
    gl.uniform1f(at("dark"), paper()[0] < 0.5 ? 1 : 0);
    gl.uniform1f(at("flatView"), camera.flat ? 1 : 0);
    gl.uniform1f(at("opacity"), glass ? state.opacity : 0);
    gl.uniform1i(at("sheets"), sheets.glass().length ? 1 : 0);
    gl.uniform1f(at("reach"), 4 * typicalRadius());
    gl.uniform1i(at("samples"), quality);
    gl.uniform1i(at("smoothed"), this.smooth ? 1 : 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  },
};

function typicalRadius() {
  const layer = mainLayers[0];
  if (!layer) return 0.01 * halfDiagonal;
  const radius = frameAt(layer, clock[state.frame]).radius;
  return 0.5 * (radius[1] + radius[2]) * sizeOf(layer);
}

// The page's background, 0 to 1.
function paper() {
  const text = getComputedStyle(document.documentElement).getPropertyValue("--paper").trim();
  return [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16) / 255);
}
