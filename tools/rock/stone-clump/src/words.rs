//! The outputs of a clump and of the measures.

use geom::{Moments, Shown};
use std::fmt::Write;
use stones::{Clump, ShapeMeasures};
use stream::ply::{Element, Encoding, Ply};
use stream::{Table, Values};

/// The `[[clump]]` of a scene.
pub fn toml(name: &str, material: &str, clump: &Clump, moments: &Moments) -> String {
    let [name, material] = [name, material].map(record::name::toml);
    let mut out = format!("[[clump]]\nname = {name}\nmaterial = {material}\n");
    let (c, j) = (moments.centre, moments.inertia);
    // Six terms of the tensor, as [[clump]] takes them.
    let terms = [j.m11, j.m22, j.m33, j.m12, j.m13, j.m23].map(|x| format!("{x:e}")).join(", ");
    let _ = writeln!(
        out,
        "moments = {{ volume = {:e}, centre = [{:e}, {:e}, {:e}], inertia = [{terms}] }}\nspheres = [",
        moments.volume, c.x, c.y, c.z
    );
    for (p, r) in &clump.spheres {
        let _ = writeln!(out, "  [{}, {}, {}, {}],", p.x, p.y, p.z, r);
    }
    out + "]\n"
}

/// Columns x, y, z, radius [m].
pub fn csv(clump: &Clump) -> String {
    let row = |(p, r): &(geom::Vec3, f64)| format!("{},{},{},{}\n", p.x, p.y, p.z, r);
    "x,y,z,radius\n".to_owned() + &clump.spheres.iter().map(row).collect::<String>()
}

pub fn ply(clump: &Clump) -> anyhow::Result<Vec<u8>> {
    let mut table = Table::with_rows(clump.spheres.len());
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        table.push(name, Values::F64(clump.spheres.iter().map(|s| s.0[axis]).collect()))?;
    }
    table.push("radius", Values::F64(clump.spheres.iter().map(|s| s.1).collect()))?;
    let vertex = Element { name: "vertex".to_owned(), table, lists: Vec::new() };
    let mut bytes = Vec::new();
    stream::ply::write(
        &mut bytes,
        &Ply { elements: vec![vertex], ..Ply::default() },
        Encoding::BinaryLittleEndian,
    )?;
    Ok(bytes)
}

/// The measures as an object.
pub fn json(shape: &ShapeMeasures) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(shape)? + "\n")
}

/// One line on the fit.
pub fn summary(clump: &Clump) -> String {
    let share = |x: f64| format!("{} %", Shown((1e4 * x).round() / 100.0));
    let fit = clump.fit;
    format!(
        "{}; of the volume {} is in none, the surface is {} of the diameter away on average and {} at most, moments of inertia of their union differ \
         by {}",
        geom::counted(clump.spheres.len(), "sphere"),
        share(fit.volume),
        share(fit.mean_distance),
        share(fit.most_distance),
        share(fit.inertia)
    )
}

/// One line on the shape.
pub fn shape(shape: &ShapeMeasures) -> String {
    let of = [
        shape.sieve_size,
        shape.elongation,
        shape.flatness,
        shape.convexity,
        shape.sphericity,
        (1e3 * shape.roundness).round() / 1e3,
    ];
    let [d, e, f, c, s, r] = of.map(Shown);
    format!("sieve size {d} m, elongation {e}, flatness {f}, convexity {c}, sphericity {s}, roundness {r}")
}
