// What is under the pointer: the ray of a pixel against every sphere shown, and every solid face.
const NEARBY = 7;  // pixels by which a small sphere may be missed

// The nearest thing at a pixel of the window: grains before what only veils them; none where there is nothing.
function findAt(x, y) {
  const ray = rayAt(x, y);
  const veil = (l) => mainRole !== "walls" && l.role === "walls" && opacityOf(l) < 0.999;
  const shown = run.layers.filter((l) => !isRods(l) && !state.hidden.has(l) && !(l.role === "walls" && opacityOf(l) === 0));
  const nearest = (hits) => hits.filter(Boolean).sort((a, b) => a.miss - b.miss || a.depth - b.depth)[0] || null;
  const solid = nearest([...shown.filter((l) => !veil(l)).map((l) => sphereOn(ray, l)), ...solids.shown().map((p) => solidOn(ray, p)), ...sheets.solid().map((p) => faceOn(ray, p))]);
  // A plane is ground: a click on it lets go.
  const glass = sheets.glass().filter((p) => !p.surface.normal);
  return solid || nearest([...shown.filter(veil).map((l) => sphereOn(ray, l)), ...glass.map((p) => faceOn(ray, p))]);
}

// The ray and the slice as they are before the layer is moved.
function homeOf({ from, along, pixel }, pose, cut) {
  const column = (k) => [pose.turn[3 * k], pose.turn[3 * k + 1], pose.turn[3 * k + 2]];
  const back = (v) => [0, 1, 2].map((k) => dot3(column(k), v));
  const home = { from: back(from.map((f, k) => f - pose.shift[k])), along: back(along), pixel, cut: null };
  if (cut) {
    const shift = dot3(cut.normal, pose.shift);
    home.cut = { normal: back(cut.normal), most: cut.most - shift, least: cut.least - shift };
  }
  return home;
}

// Where along a ray the slice lets one see: [from, to].
function openPart({ from, along, cut }) {
  if (!cut) return [0, Infinity];
  const [rate, start] = [dot3(cut.normal, along), dot3(cut.normal, from)];
  if (Math.abs(rate) < 1e-12) return start <= cut.most && start >= cut.least ? [0, Infinity] : [1, 0];
  const ends = [(cut.most - start) / rate, (cut.least - start) / rate].sort((a, b) => a - b);
  return [Math.max(0, ends[0]), ends[1]];
}

function sphereOn(ray, layer) {
  const frame = frameAt(layer, clock[state.frame]);
  if (!frame.count) return null;
  const pose = poseOf(layer.motion, middle, clock[state.frame]);
  const cut = layer.role === "grains" && !state.cutGrains ? null : cutOf();
  const home = homeOf(ray, pose, cut);
  const [open, shut] = openPart(home);
  const { from, along } = home;
  const q = numbersOf(frame.position, 2);
  const [blob, low, high, width] = frame.radius;
  const sizes = blob === null ? null : numbersOf(blob, width);
  const size = [0, 1, 2].map((k) => (frame.hi[k] - frame.lo[k]) / 65535);
  const start = [0, 1, 2].map((k) => frame.lo[k] - middle[k] - from[k]);
  const scale = sizeOf(layer);
  const step = (high - low) / (256 ** width - 1);
  let best = null;
  for (let i = 0; i < frame.count; i++) {
    const x = start[0] + q[3 * i] * size[0], y = start[1] + q[3 * i + 1] * size[1], z = start[2] + q[3 * i + 2] * size[2];
    const depth = x * along[0] + y * along[1] + z * along[2];
    const aside = x * x + y * y + z * z - depth * depth;
    const radius = scale * (sizes ? low + sizes[i] * step : low);
    const pixel = ray.pixel * (camera.flat ? camera.distance : depth);
    const reach = radius + NEARBY * pixel;
    if (depth <= 0 || aside > reach * reach) continue;
    const half = Math.sqrt(Math.max(0, radius * radius - aside));
    const [first, last] = [Math.max(depth - half, open), Math.min(depth + half, shut)];
    if (first > last) continue;
    const miss = aside <= radius * radius ? 0 : (Math.sqrt(aside) - radius) / pixel;
    if (!best || miss < best.miss || (miss === best.miss && first < best.depth)) best = { layer, row: i, depth: first, miss };
  }
  return best;
}

// Moeller & Trumbore (1997), Journal of Graphics Tools 2(1): the ray against each triangle.
function faceOn(ray, part) {
  const { surface } = part;
  const home = homeOf(ray, poseOf(surface.motion, surface.origin, clock[state.frame]), cutOf());
  const [open, shut] = openPart(home);
  const vertices = new Float32Array(bytes(surface.vertices).buffer);
  const faces = new Uint32Array(bytes(surface.faces).buffer);
  const corner = (n) => [vertices[3 * n], vertices[3 * n + 1], vertices[3 * n + 2]];
  let best = null;
  for (let f = 0; f < faces.length; f += 3) {
    const a = corner(faces[f]);
    const [u, v] = [minus3(corner(faces[f + 1]), a), minus3(corner(faces[f + 2]), a)];
    const p = cross3(home.along, v);
    const size = dot3(u, p);
    if (size === 0) continue;
    const s = minus3(home.from, a);
    const b = dot3(s, p) / size;
    const q = cross3(s, u);
    const c = dot3(home.along, q) / size;
    const depth = dot3(v, q) / size;
    if (b < 0 || c < 0 || b + c > 1 || depth < open || depth > shut || (best && depth >= best.depth)) continue;
    best = { surface, row: f / 3, depth, miss: 0, place: ray.from.map((e, k) => e + depth * ray.along[k] + middle[k]) };
  }
  return best;
}
