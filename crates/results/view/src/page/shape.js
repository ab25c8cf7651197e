// Shapes as `cloud-crop` has them (crates/base/geom, shape.rs and prism.rs): the same operations in the same order, so that a point
// is inside here exactly when it is inside there.
const norm3 = (a) => Math.sqrt(dot3(a, a));
const unit3 = (a) => { const n = norm3(a); return [a[0] / n, a[1] / n, a[2] / n]; };

// Between two corners, the lower first; the surface is inside.
function boxShape(lo, hi) {
  return (x, y, z) => lo[0] <= x && x <= hi[0] && lo[1] <= y && y <= hi[1] && lo[2] <= z && z <= hi[2];
}

// All places q + t e with q in the polygon and 0 <= t <= 1; null where polygon and extrusion make no prism.
function prismShape(polygon, extrusion) {
  const origin = polygon[0];
  let [sum, size] = [[0, 0, 0], 0];
  polygon.forEach((a, n) => {
    const b = polygon[(n + 1) % polygon.length];
    const c = cross3(minus3(a, origin), minus3(b, origin));
    sum = [sum[0] + c[0], sum[1] + c[1], sum[2] + c[2]];
    const d = minus3(a, origin);
    size = Math.max(size, dot3(d, d));
  });
  if (!(norm3(sum) > 1e-12 * size)) return null;
  const normal = unit3(sum);
  if (!(Math.abs(dot3(normal, extrusion)) > 1e-9 * norm3(extrusion))) return null;
  const least = [0, 1, 2].reduce((m, k) => (Math.abs(normal[k]) < Math.abs(normal[m]) ? k : m), 0);
  const u = unit3(cross3(normal, [0, 1, 2].map((k) => (k === least ? 1 : 0))));
  const v = cross3(normal, u);
  const flat = polygon.map((p) => [dot3(u, minus3(p, origin)), dot3(v, minus3(p, origin))]);
  const rise = dot3(extrusion, normal);
  return (px, py, pz) => {
    const from = [px - origin[0], py - origin[1], pz - origin[2]];
    const t = dot3(from, normal) / rise;
    if (!(t >= 0 && t <= 1)) return false;
    const w = [from[0] - extrusion[0] * t, from[1] - extrusion[1] * t, from[2] - extrusion[2] * t];
    const [x, y] = [dot3(u, w), dot3(v, w)];
    let inside = false;
    for (let n = 0; n < flat.length; n++) {
      const a = flat[n], b = flat[n + 1 === flat.length ? 0 : n + 1];
      if ((a[1] > y) !== (b[1] > y) && x < a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]))) inside = !inside;
    }
    return inside;
  };
}
