// What was picked: all its fields, a ring around it, and the camera that follows it.
const picked = { hit: null, id: null, follows: false, last: null };

// The column that tells one grain from another in every frame.
const idOf = (layer) => (layer.fields[fieldOf(layer, "id")]?.whole ? fieldOf(layer, "id") : -1);

function pick(hit) {
  picked.hit = hit;
  picked.follows = false;
  picked.id = null;
  if (hit?.layer) {
    const column = idOf(hit.layer);
    const frame = frameAt(hit.layer, clock[state.frame]);
    if (column >= 0) picked.id = Math.round(valueAt(frame.fields[column], hit.row));
  }
  showCard();
  changed();
}

// The row of what was picked in the frame shown, or -1: rows are in the order of their id.
function pickedRow() {
  const { hit, id } = picked;
  if (!hit?.layer) return -1;
  const frame = frameAt(hit.layer, clock[state.frame]);
  if (id === null) return hit.row < frame.count ? hit.row : -1;
  const [number, lo, , width] = frame.fields[idOf(hit.layer)];
  if (number === null) return frame.count > 0 && Math.round(lo) === id ? 0 : -1;
  const ids = numbersOf(number, width);
  let [from, to] = [0, frame.count];
  while (from < to) {
    const mid = (from + to) >> 1;
    if (Math.round(lo + ids[mid]) < id) from = mid + 1; else to = mid;
  }
  return from < frame.count && Math.round(lo + ids[from]) === id ? from : -1;
}

// Where it is now [m], and its radius.
function pickedPlace() {
  if (picked.hit?.surface) return { place: picked.hit.place, radius: 0 };
  const row = pickedRow();
  if (row < 0) return null;
  const { layer } = picked.hit;
  const frame = frameAt(layer, clock[state.frame]);
  const pose = poseOf(layer.motion, middle, clock[state.frame]);
  const home = placeAt(frame, row).map((p, k) => p - middle[k]);
  const place = [0, 1, 2].map((k) => dot3([pose.turn[k], pose.turn[3 + k], pose.turn[6 + k]], home) + pose.shift[k] + middle[k]);
  return { place, radius: valueAt(frame.radius, row) * sizeOf(layer), row, frame };
}

// Decimals that a value with that error deserves.
const digitsOf = (error, factor) => Math.max(0, Math.min(9, Math.ceil(-Math.log10(Math.max(1e-12, 2 * error * factor)) - 1e-9)));

// Name, value and unit of everything known of it.
function pickedValues() {
  const at = pickedPlace();
  if (!at) return null;
  const { layer, surface } = picked.hit;
  const error = surface ? 1e-6 * halfDiagonal : run.positionError;
  const rows = at.place.map((v, k) => ({ name: "xyz"[k], value: v, text: number(v, digitsOf(error, 1)), unit: "m" }));
  rows.push(...wornRows(surface ?? layer, surface ? picked.hit.row : at.row));
  if (surface) return rows;
  for (const [n, field] of layer.fields.entries()) {
    if (["x", "y", "z", "id"].includes(field.name) || !at.frame.fields[n]) continue;
    const value = valueAt(at.frame.fields[n], at.row);
    const kind = (field.name === "material" && layer.kinds[Math.round(value)]) || field.codes?.[Math.round(value)];
    const text = field.whole ? kind || String(Math.round(value)) : number(value * field.factor, digitsOf(errorOf(at.frame.fields[n]), field.factor));
    rows.push({ name: field.name, value: field.whole ? Math.round(value) : value, text, unit: field.unit });
  }
  return rows;
}

const WORDS = { grains: "Grain", walls: "Wall sphere", cloud: "Point" };

function showCard() {
  byId("card").hidden = !picked.hit;
  if (!picked.hit) return;
  const { layer, surface, row } = picked.hit;
  byId("picked-name").textContent = surface ? surface.name : `${WORDS[layer.role]} ${picked.id ?? row}`;
  byId("whose").textContent = surface ? `face ${row}` : picked.id !== null ? layer.name : `row of ${layer.name}`;
  byId("follow").hidden = Boolean(surface) || clock.length < 2;
  byId("follow").setAttribute("aria-pressed", picked.follows);
  const values = pickedValues();
  byId("gone").hidden = values !== null;
  byId("values").replaceChildren(...(values || []).flatMap(({ name, text, unit }) => [element("dt", name), element("dd", text), element("dd", unit)]));
}

function follow(on) {
  const at = on ? pickedPlace() : null;
  picked.follows = at !== null;
  picked.last = at && at.place;
  showCard();
  changed();
}

// Takes the camera along by as far as the grain has moved.
function keepUp() {
  const at = picked.follows ? pickedPlace() : null;
  if (!at) return;
  camera.target = camera.target.map((t, k) => t + at.place[k] - picked.last[k]);
  picked.last = at.place;
}

function showRing() {
  const at = picked.hit ? pickedPlace() : null;
  const seen = at && seenAt(at.place.map((p, k) => p - middle[k]));
  const ring = byId("ring");
  ring.style.display = seen?.before ? "" : "none";
  if (!seen?.before) return;
  const radius = Math.max(6, at.radius * seen.scale + 3);
  ring.innerHTML = ["halo", "line"].map((c) => `<circle class="${c}" cx="${seen.x.toFixed(1)}" cy="${seen.y.toFixed(1)}" r="${radius.toFixed(1)}"/>`).join("");
}
