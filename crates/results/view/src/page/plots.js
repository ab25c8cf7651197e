// Diagrams beside the picture: curves over time, with a mark at the time shown.
const plots = {
  list: [],

  start() {
    const box_ = byId("plots");
    byId("graphs").hidden = !run.plots.length;
    if (!run.plots.length) return;
    this.list = run.plots.map((plot) => this.diagram(plot, box_));
    this.show(innerWidth >= 900 && innerHeight >= 480);
  },

  show(on) {
    byId("plots").hidden = !on || !run.plots.length;
    byId("graphs").setAttribute("aria-pressed", !byId("plots").hidden);
  },

  toggle() {
    this.show(byId("plots").hidden);
    if (camera.fitted) refit();
    changed();
  },

  colour: (n) => css(run.kinds[n % run.kinds.length]),

  diagram(plot, box_) {
    const all = plot.curves.flatMap((c) => c.points);
    const range = (k) => [Math.min(...all.map((p) => p[k])), Math.max(...all.map((p) => p[k]))];
    const [t0, t1] = [Math.min(clock[0], range(0)[0]), Math.max(clock[clock.length - 1], range(0)[1])];
    let [lo, hi] = range(1);
    if (lo > 0 && lo < 0.5 * hi) lo = 0;
    const step = roundBelow((hi - lo) / 2);
    const decimals = Math.max(0, Math.min(9, -Math.floor(Math.log10(step))));
    const [left, right, top, bottom] = [44, 252, 6, 84];
    const x = (t) => left + (t - t0) / Math.max(1e-30, t1 - t0) * (right - left);
    const y = (v) => bottom - (v - lo) / Math.max(1e-30, hi - lo) * (bottom - top);
    const small = Math.max(Math.abs(lo), Math.abs(hi)) < 1e-3 || Math.max(Math.abs(lo), Math.abs(hi)) >= 1e5;
    const text = (v) => (small && v !== 0 ? v.toExponential(1).replace("-", "−") : number(v, decimals));
    const lines = [];
    for (let k = Math.ceil((lo - 1e-6 * step) / step); k * step <= hi + 1e-6 * step; k++) {
      lines.push(`<line class="grid" x1="${left}" x2="${right}" y1="${y(k * step)}" y2="${y(k * step)}"/>`,
                 `<text class="tick" x="${left - 5}" y="${y(k * step) + 3.5}" text-anchor="end">${text(k * step)}</text>`);
    }
    for (const [t, anchor] of [[t0, "start"], [t1, "end"]]) lines.push(`<text class="tick" x="${x(t)}" y="97" text-anchor="${anchor}">${Number(t.toPrecision(4))} s</text>`);
    const path = ({ points }) => points.map(([t, v], n) => `${n ? "L" : "M"}${x(t).toFixed(1)} ${y(v).toFixed(1)}`).join("");
    const curves = plot.curves.map((c, n) => `<path d="${path(c)}" stroke="${this.colour(n)}"/>`);
    const figure = element("figure");
    figure.append(element("figcaption", plot.label));
    const holder = element("div");
    holder.innerHTML = `<svg viewBox="0 0 258 100">${lines.join("")}${curves.join("")}<line class="now" y1="${top}" y2="${bottom}"/></svg>`;
    const svg = holder.firstChild;
    const values = element("p");
    figure.append(svg, values);
    box_.append(figure);
    const at = (e) => {
      const area = svg.getBoundingClientRect();
      const time = t0 + ((e.clientX - area.left) / area.width * 258 - left) / (right - left) * (t1 - t0);
      play(false);
      show(Math.max(0, clock.findLastIndex((t) => t <= time)));
    };
    svg.addEventListener("pointerdown", (e) => { svg.setPointerCapture(e.pointerId); at(e); });
    svg.addEventListener("pointermove", (e) => { if (e.buttons & 1) at(e); });
    return { plot, svg, values, x };
  },

  // The last value that is not later than the time shown.
  valueAt(points, time) {
    const at = points.findLastIndex((p) => p[0] <= time + 1e-9);
    return at < 0 ? null : points[at][1];
  },

  mark() {
    if (byId("plots").hidden) return;
    const time = clock[state.frame];
    for (const { plot, svg, values, x } of this.list) {
      const line = svg.querySelector(".now");
      line.setAttribute("x1", x(time));
      line.setAttribute("x2", x(time));
      values.replaceChildren(...plot.curves.flatMap((curve, n) => {
        const value = this.valueAt(curve.points, time);
        const shown = value === null ? "–" : String(Number(value.toPrecision(4))).replace("-", "−");
        const name = element("span");
        if (plot.curves.length > 1) name.append(element("i", "", { background: this.colour(n) }));
        name.append(`${curve.name} ${shown}`.trim());
        return [name, " "];
      }));
    }
  },
};
