//! Rigid stones: a `[[clump]]` of the grains of each stone, with the mass of its mesh, and its `[[body]]`.

use crate::inputs::Grains;
use std::fmt::Write;
use std::path::Path;
use stones::{Library, Packing};

/// Writes the entries, to be added to a scene.
pub fn write(
    path: &Path,
    material: &str,
    grains: &Grains,
    library: &Library,
    packing: &Packing,
) -> anyhow::Result<()> {
    let mut text = String::new();
    let material = record::name::toml(material);
    for (k, p) in packing.placed.iter().enumerate() {
        let of = &library.stones[p.stone];
        // In the frame of the placed stone, about its centre of mass: a body at rest in it has no rotation.
        let (turn, s) = (p.orientation.to_rotation_matrix().into_inner(), p.scale);
        let j = turn * of.stone.moments.inertia * turn.transpose() * s.powi(5);
        let terms = [j.m11, j.m22, j.m33, j.m12, j.m13, j.m23].map(|x| format!("{x:e}")).join(", ");
        let _ = write!(
            text,
            "[[clump]]\nname = \"stone {n}\"\nmaterial = {material}\n\
             moments = {{ volume = {volume:e}, centre = [0, 0, 0], inertia = [{terms}] }}\nspheres = [\n",
            n = k + 1,
            volume = p.volume(of)
        );
        for &grain in &p.grains {
            let (at, r) =
                (grains.particles[grain as usize].position - p.centre, grains.radii[grain as usize]);
            let _ = writeln!(text, "  [{}, {}, {}, {r}],", at.x, at.y, at.z);
        }
        let c = p.centre;
        let _ = writeln!(
            text,
            "]\n[[body]]\nclump = \"stone {}\"\nposition = [{}, {}, {}]\n",
            k + 1,
            c.x,
            c.y,
            c.z
        );
    }
    cli::OutputStream::write_file(path, text.as_bytes())
}
