//! Keys that a table of a scene lacks: which table, and what to write.

/// Keys that tables need, as they may be written.
const EXAMPLES: [(&str, &str); 29] = [
    ("about", "about = [0, 0, 1] (the axis)"),
    ("amplitude", "amplitude = [0, 0, 0.001] (m)"),
    ("between", "between = [\"*\", \"*\"] (names of materials)"),
    ("clump", "clump = \"…\" (the name of a [[clump]])"),
    ("direction", "direction = [0, 0, -1]"),
    ("dynamic", "dynamic = 0.4"),
    ("frequency", "frequency = 50 (Hz)"),
    ("gap", "gap = 1e-4 (m)"),
    ("law", "law = \"stokes\""),
    ("material", "material = \"…\" (the name of a [[material]])"),
    ("name", "name = \"…\""),
    ("plane", "plane = \"0,0,0,0,0,1\" (a point [m] and the normal)"),
    ("poisson", "poisson = 0.25"),
    ("position", "position = [0, 0, 0.1] (m)"),
    ("restitution", "restitution = 0.5"),
    ("rpm", "rpm = 8 (turns per minute)"),
    ("shape", "shape = \"box:0,0,0,0.1,0.1,0.1\" (m)"),
    ("source", "source = \"FILE\""),
    ("speed", "speed = 0.01 (m/s)"),
    ("speed_limit", "speed_limit = 0.1 (m/s)"),
    ("static", "static = 0.6"),
    ("through", "through = [0, 0, 0] (m)"),
    ("time", "time = 0.02 (s)"),
    ("until", "until = 1 (s)"),
    ("velocity", "velocity = [0, 0, -1] (m/s)"),
    ("viscosity", "viscosity = 1.8e-5 (Pa·s, air)"),
    ("wake", "wake = 0.1 (share of the weight)"),
    ("young", "young = 1e7 (Pa)"),
    ("density", "density = 2500 (kg/m³)"),
];

/// The message for a key that the table at a dotted path lacks.
pub(super) fn missing(table: &str, key: &str) -> String {
    let place = if table.is_empty() { String::new() } else { format!("{table}: ") };
    let example = EXAMPLES.iter().find(|e| e.0 == key).map_or(key, |e| e.1);
    format!("{place}'{key}' is missing: add it, such as {example}")
}
