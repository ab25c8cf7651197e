// Regions that the operator draws over a cloud in a view along an axis, and the options of `cloud-crop` that drop what they
// mark. A box is two corners; a polygon becomes a prism along the view, in a file. Points that `cloud-crop --mark` has marked are dropped, too,
// unless a region restores them.
const regions = {
  list: [], drawing: null, count: 0, dropped: 0,

  start() {
    this.layer = run.layers.findIndex((l) => l.exact);
    const [number, width] = run.layers[this.layer].exact;
    const raw = fromBase64(byId("b" + number).textContent);
    this.points = width === 4 ? new Float32Array(raw.buffer) : new Float64Array(raw.buffer);
    this.marks = new Uint8Array(this.points.length / 3);
    const before = run.layers[this.layer].marks;
    this.before = before === null ? null : fromBase64(byId("b" + before).textContent);
    [this.lo, this.hi] = this.extent();
    const size = Math.max(1e-9, ...this.hi.map((h, k) => h - this.lo[k]));
    // Corners in round numbers: a ten-thousandth of the size is finer than a hand can point.
    this.decimals = Math.max(0, Math.min(12, 4 - Math.floor(Math.log10(size))));
    this.margin = 0.01 * size;
    const on = (id, what) => byId(id).addEventListener("click", what);
    on("polygon", () => this.draw("polygon"));
    on("box", () => this.draw("box"));
    on("copy", () => this.copy());
    on("files", () => this.list.filter((r) => r.kind === "prism").forEach((r) => this.save(r)));
    for (const name of Object.keys(VIEWS).filter((n) => n !== "iso")) {
      const button = Object.assign(element("button", name), { type: "button", onclick: () => lookFrom(name) });
      byId("sides").append(button);
    }
    canvas.addEventListener("pointermove", (e) => this.move(e));
    canvas.addEventListener("pointerup", (e) => this.up(e));
    this.changed();
  },

  extent() {
    const [lo, hi] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let i = 0; i < this.points.length; i++) {
      const k = i % 3;
      if (this.points[i] < lo[k]) lo[k] = this.points[i];
      if (this.points[i] > hi[k]) hi[k] = this.points[i];
    }
    return [lo, hi];
  },

  round(metres) { return Number(metres.toFixed(this.decimals)) + 0; },

  // Turns to the nearest view along an axis, in parallel projection, and waits for corners.
  draw(tool) {
    if (this.drawing?.tool === tool) return this.stop();
    const forward = camera.axes()[2];
    const along = (name) => -dot3(VIEWS[name], forward);
    const name = Object.keys(VIEWS).filter((n) => n !== "iso").reduce((best, n) => (along(n) > along(best) + 1e-9 ? n : best));
    camera.flat = true;
    byId("flat").checked = true;
    pick(null);
    this.drawing = { tool };
    this.aim(name);
  },

  // Draws from that side; what was drawn from another is forgotten. The view rests until it is done.
  aim(name) {
    if (name === "iso") return;
    camera.rests = false;
    camera.look(VIEWS[name]);
    Object.assign(this.drawing, { name, axis: VIEWS[name].findIndex((c) => c !== 0), corners: [], to: null });
    this.changed();
  },

  stop() {
    this.drawing = null;
    this.changed();
  },

  // The place of a pixel [m], rounded; its coordinate along the view means nothing.
  placeOf(e) {
    return rayAt(e.clientX, e.clientY).from.map((c, k) => this.round(c + middle[k]));
  },

  down(e) {
    const { drawing } = this;
    if (!drawing || e.button !== 0 || e.shiftKey) return false;
    const place = this.placeOf(e);
    if (drawing.tool === "box") drawing.corners = [place];
    else if (this.closes(e)) this.finish();
    else drawing.corners.push(place);
    if (this.drawing) this.drawing.to = place;
    canvas.setPointerCapture(e.pointerId);
    changed();
    return true;
  },

  closes(e) {
    const { corners } = this.drawing;
    if (corners.length < 3) return false;
    const first = seenAt(minus3(corners[0], middle));
    return Math.hypot(first.x - e.clientX, first.y - e.clientY) < 10;
  },

  move(e) {
    if (!this.drawing?.corners.length) return;
    this.drawing.to = this.placeOf(e);
    changed();
  },

  up(e) {
    const { drawing } = this;
    if (drawing?.tool !== "box" || !drawing.corners.length) return;
    drawing.to = this.placeOf(e);
    this.finish();
  },

  // Whether a key was meant for drawing.
  key(name) {
    if (!this.drawing && name === "p") this.draw("polygon");
    else if (!this.drawing && name === "b") this.draw("box");
    else if (!this.drawing) return false;
    else if (name === "Enter") this.finish();
    else if (name === "Backspace") this.drawing.corners.pop();
    else if (name === "Escape") this.stop();
    else return false;
    changed();
    return true;
  },

  // Makes a region of what was drawn, through all of the cloud along the view.
  finish() {
    const { tool, axis, corners, to } = this.drawing;
    const across = [0, 1, 2].filter((k) => k !== axis);
    const large = tool === "box" ? to && across.every((k) => corners[0][k] !== to[k]) : corners.length > 2;
    const region = {
      kind: tool === "box" ? "box" : "prism", action: this.before ? "restore" : "remove", axis, inside: 0, ends: [corners[0], to], corners,
      from: this.round(this.lo[axis] - this.margin), until: this.round(this.hi[axis] + this.margin),
    };
    if (!large || !this.shape(region)) {
      this.drawing.corners = [];
      return this.changed("That has no area: draw it again, larger.");
    }
    const stem = run.pick.replace(/^.*[\\/]/, "").replace(/\.[^.]*$/, "");
    if (region.kind === "prism") region.file = `${stem}-region-${++this.count}.json`;
    this.list.push(region);
    this.drawing = null;
    this.changed();
  },

  // Gives the region its test; whether it has one.
  shape(region) {
    const { axis, from, until } = region;
    if (region.kind === "box") {
      const end = (of) => [0, 1, 2].map((k) => (k === axis ? of(from, until) : of(region.ends[0][k], region.ends[1][k])));
      [region.lo, region.hi] = [end(Math.min), end(Math.max)];
      region.has = boxShape(region.lo, region.hi);
    } else {
      region.polygon = region.corners.map((c) => c.map((v, k) => (k === axis ? from : v)));
      region.extrusion = [0, 1, 2].map((k) => (k === axis ? this.round(until - from) : 0));
      region.has = prismShape(region.polygon, region.extrusion);
    }
    return region.has !== null;
  },

  // Marks what `cloud-crop` will drop: what is in no region to keep, where there are any, or in one to remove, or was marked and is in none to
  // restore.
  mark() {
    const keeping = this.list.some((r) => r.action === "keep");
    this.list.forEach((r) => { r.inside = 0; });
    this.dropped = 0;
    const p = this.points;
    for (let i = 0; i < this.marks.length; i++) {
      let [kept, gone, marked] = [!keeping, false, this.before !== null && this.before[i] > 0];
      for (const region of this.list) {
        if (!region.has(p[3 * i], p[3 * i + 1], p[3 * i + 2])) continue;
        region.inside++;
        if (region.action === "keep") kept = true;
        else if (region.action === "restore") marked = false;
        else gone = true;
      }
      this.marks[i] = gone || marked || !kept ? 255 : 0;
      this.dropped += this.marks[i] > 0;
    }
    painter.layers[this.layer].mark(this.marks);
  },

  json(region) {
    return `${JSON.stringify({ polygon: region.polygon, extrusion: region.extrusion })}\n`;
  },

  options() {
    const quoted = (text) => (/^[\w.,:+@%\/-]+$/.test(text) ? text : `'${text.replace(/'/g, "'\\''")}'`);
    const shape = (r) => (r.kind === "box" ? `box:${[...r.lo, ...r.hi].join(",")}` : `prism:${r.file}`);
    return this.list.map((r) => `--${r.action} ${quoted(shape(r))}`).join(" ");
  },

  save(region) {
    const link = Object.assign(element("a"), { href: URL.createObjectURL(new Blob([this.json(region)], { type: "application/json" })), download: region.file });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    region.saved = true;
    this.show();
  },

  copy() {
    const done = () => this.show("", "Copied.");
    byId("options").select();
    const older = () => { if (document.execCommand("copy")) done(); };
    if (navigator.clipboard) navigator.clipboard.writeText(this.options()).then(done, older);
    else older();
  },

  changed(hint) {
    this.mark();
    this.show(hint);
    changed();
  },

  show(hint, copied) {
    const { drawing } = this;
    const hints = { polygon: "click the corners; close with Enter or at the first one. Backspace takes one back,", box: "drag from corner to corner." };
    const still = this.before ? "Red points are marked: cloud-crop drops them, also without options. Choose a side, then draw what to restore." : "Choose a side, then draw. What will be dropped is red.";
    byId("hint").textContent = hint || (drawing ? `Seen from the ${drawing.name}: ${hints[drawing.tool]} Esc stops.` : this.list.length ? "" : still);
    for (const tool of ["polygon", "box"]) byId(tool).setAttribute("aria-pressed", drawing?.tool === tool);
    camera.rests = drawing !== null;
    for (const side of byId("sides").children) side.setAttribute("aria-pressed", drawing?.name === side.textContent);
    canvas.style.cursor = drawing ? "crosshair" : "";
    byId("regions").replaceChildren(...this.list.map((r) => this.row(r)));
    const part = run.onePointOf > 1 ? ` on this page, which has one of ${run.onePointOf},` : "";
    byId("sum").textContent = `${grouped(this.dropped)} of ${grouped(this.marks.length)} points${part} will be dropped.`;
    byId("command").hidden = !this.list.length;
    byId("options").value = this.options();
    const files = this.list.filter((r) => r.kind === "prism");
    const unsaved = files.some((r) => !r.saved);
    byId("files").hidden = !files.length;
    byId("files").textContent = files.length > 1 ? "Save files" : "Save file";
    byId("copied").textContent = copied || (unsaved ? "Save the polygon's file to where you run cloud-crop." : "");
  },

  row(region) {
    const item = element("li");
    const action = element("select");
    action.append(...["remove", "keep", ...(this.before ? ["restore"] : [])].map((name) => new Option(name)));
    action.value = region.action;
    action.setAttribute("aria-label", "What to do with it");
    action.onchange = () => { region.action = action.value; this.changed(); };
    const inside = element("span", `${grouped(region.inside)} inside`);
    inside.className = "inside";
    const gone = Object.assign(element("button"), { type: "button", title: "Delete", innerHTML: byId("close").innerHTML });
    gone.setAttribute("aria-label", "Delete");
    gone.onclick = () => { this.list.splice(this.list.indexOf(region), 1); this.changed(); };
    const depth = element("div");
    depth.className = "depth";
    depth.append(element("span", `${"xyz"[region.axis]} from`), this.end(region, "from"), element("span", "to"), this.end(region, "until"), element("span", "m"));
    item.append(action, element("span", region.kind === "box" ? "box" : "polygon"), inside, gone, depth);
    return item;
  },

  // An end of the region along the view, to be typed.
  end(region, which) {
    const input = Object.assign(element("input"), { value: region[which], inputMode: "decimal" });
    input.setAttribute("aria-label", `${which === "from" ? "From" : "To"}, in metres`);
    input.onchange = () => {
      const before = region[which];
      const value = this.round(parseFloat(input.value.replace(",", ".")));
      if (Number.isFinite(value)) region[which] = value;
      if (region.from === region.until || !this.shape(region)) { region[which] = before; this.shape(region); }
      region.saved = false;
      this.changed();
    };
    return input;
  },

  // Edges of every region, and of the one that is being drawn.
  outline() {
    const seen = (place) => { const s = seenAt(minus3(place, middle)); return `${s.x.toFixed(1)},${s.y.toFixed(1)}`; };
    const ring = (places, kind) => `<polygon class="${kind}" points="${places.map(seen).join(" ")}"/>`;
    const drawn = this.list.map((r) => {
      const at = (edge) => (r.kind === "box" ? this.rectangle(r.lo, r.hi, r.axis, edge[r.axis]) : r.polygon.map((p) => p.map((c, k) => c + edge[k])));
      const [near, far] = r.kind === "box" ? [at(r.lo), at(r.hi)] : [at([0, 0, 0]), at(r.extrusion)];
      const sides = near.map((p, n) => `<polyline class="${r.action} side" points="${seen(p)} ${seen(far[n])}"/>`);
      return [ring(near, r.action), ring(far, r.action), ...sides].join("");
    });
    const { drawing } = this;
    if (drawing?.corners.length) {
      const { tool, corners, axis } = drawing;
      const to = drawing.to || corners[0];
      const corner = (c) => { const [x, y] = seen(c).split(","); return `<circle class="drawing" cx="${x}" cy="${y}" r="3.5"/>`; };
      if (tool === "box") drawn.push(ring(this.rectangle(corners[0], to, axis, to[axis]), "drawing"));
      else drawn.push(`<polyline class="drawing" points="${[...corners, to].map(seen).join(" ")}"/>`, ...corners.map(corner));
    }
    byId("lines").innerHTML = drawn.join("");
  },

  rectangle(a, b, axis, at) {
    const [u, v] = [0, 1, 2].filter((k) => k !== axis);
    const corner = (p, q) => [0, 1, 2].map((k) => (k === axis ? at : k === u ? p[u] : q[v]));
    return [corner(a, a), corner(b, a), corner(b, b), corner(a, b)];
  },
};
