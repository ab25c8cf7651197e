//! Lines of a scene that reads the packed grains: `[[particles]]`, and the `[[material]]` of the stones with the density of their grains.

use crate::args::Args;
use crate::inputs::Grains;
use std::fmt::Write;
use std::path::Path;

/// Writes them beside the grains; `density` [kg/m³] is that of the grains of stones.
pub fn write(path: &Path, args: &Args, grains: &Grains, density: Option<f64>) -> anyhow::Result<()> {
    let Some(output) = args.output.path() else {
        return Err(cli::usage("--scene: its lines name the file of the grains: give -o FILE.ply"));
    };
    let Some(density) = density else {
        return Err(cli::usage("--scene: no stone has grains: give a higher --content, or smaller stones"));
    };
    let names = grains.materials.iter().map(|m| m.0.as_str()).chain([args.material()]);
    let names: Vec<String> = names.map(record::name::toml).collect();
    let mut text = format!(
        "[[particles]]\nsource = {}\nmaterials = [{}]\n\n",
        record::name::toml(&seen_from(path, output)?),
        names.join(", ")
    );
    let _ = write!(
        text,
        "# The grains of a stone leave gaps: with this density they weigh what stones of {} kg/m³ do.\n\
         # Young's modulus and Poisson's ratio are for you to give.\n\
         [[material]]\nname = {}\ndensity = {}\n",
        geom::Shown(args.stone_density),
        record::name::toml(args.material()),
        geom::Shown(density)
    );
    cli::OutputStream::write_file(path, text.as_bytes())
}

/// The grains' file as the scene names it: relative to the scene where it lies below its folder.
fn seen_from(scene: &Path, output: &Path) -> anyhow::Result<String> {
    let [scene, output] = [std::path::absolute(scene)?, std::path::absolute(output)?];
    let near = scene.parent().and_then(|folder| output.strip_prefix(folder).ok());
    Ok(near.unwrap_or(&output).display().to_string())
}
