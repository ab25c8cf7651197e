// What the graphics card holds: programs, pictures in the making, and the columns of layers.
const canvas = byId("view");
const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, depth: false, powerPreference: "high-performance" });

// What is behind is left out before its depth is computed, where the driver can.
gl?.getExtension("EXT_conservative_depth");

function program(vert, frag) {
  const made = gl.createProgram();
  const name = `${vert} + ${frag}`;
  for (const [id, type] of [[`${vert}-vert`, gl.VERTEX_SHADER], [`${frag}-frag`, gl.FRAGMENT_SHADER]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, byId(id).textContent.trim());
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(id + ": " + gl.getShaderInfoLog(shader));
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

// A number for a clump, to tell it from its neighbours; 255 is none.
const tagOf = (body) => 1 + (Math.imul(body, 0x9e3779b9) >>> 24) % 254;

// The columns of a layer on the graphics card; a column that is there already is not sent again.
class Buffers {
  constructor(layer) {
    this.layer = layer;
    this.array = gl.createVertexArray();
    this.columns = [0, 1, 2, 3, 4, 5, 6].map(() => ({ buffer: gl.createBuffer(), number: null }));
    this.marked = false;
  }
  // `each` says what a row is: 1, an instance (a square), or 0, a vertex (a point).
  column(place, number, size, width, each) {
    const column = this.columns[place];
    if (number === null) { gl.disableVertexAttribArray(place); gl.vertexAttrib1f(place, 0); return; }
    gl.bindBuffer(gl.ARRAY_BUFFER, column.buffer);
    if (column.number !== number) {
      gl.bufferData(gl.ARRAY_BUFFER, bytes(number), gl.DYNAMIC_DRAW);
      column.number = number;
    }
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, { 1: gl.UNSIGNED_BYTE, 2: gl.UNSIGNED_SHORT, 4: gl.UNSIGNED_INT }[width], true, 0, 0);
    gl.vertexAttribDivisor(place, each);
  }
  // Rows that stand out: 255, else 0.
  mark(rows) {
    gl.bindBuffer(gl.ARRAY_BUFFER, this.columns[5].buffer);
    gl.bufferData(gl.ARRAY_BUFFER, rows, gl.DYNAMIC_DRAW);
    this.marked = true;
  }
  marks(each) {
    if (!this.marked) { gl.disableVertexAttribArray(5); gl.vertexAttrib1f(5, 0); return; }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.columns[5].buffer);
    gl.enableVertexAttribArray(5);
    gl.vertexAttribPointer(5, 1, gl.UNSIGNED_BYTE, true, 0, 0);
    gl.vertexAttribDivisor(5, each);
  }
  // Which clump each row is a part of; 255: none. Rows are in the order of ids, in which those of a clump are neighbours.
  tags(frame, each) {
    const body = frame.clumps ? frame.fields[fieldOf(this.layer, "body")] : null;
    if (!body || body[0] === null) { gl.disableVertexAttribArray(6); gl.vertexAttrib1f(6, 1); return; }
    const column = this.columns[6];
    gl.bindBuffer(gl.ARRAY_BUFFER, column.buffer);
    if (column.number !== body[0]) {
      const of = numbersOf(body[0], body[3]);
      const tag = (v, i) => (v === of[i - 1] || v === of[i + 1] ? tagOf(v) : 255);
      gl.bufferData(gl.ARRAY_BUFFER, Uint8Array.from(of, tag), gl.DYNAMIC_DRAW);
      column.number = body[0];
    }
    gl.enableVertexAttribArray(6);
    gl.vertexAttribPointer(6, 1, gl.UNSIGNED_BYTE, true, 0, 0);
    gl.vertexAttribDivisor(6, each);
  }
}
