//! Places stones of real shape in settled soil.

mod args;
mod bodies;
mod inputs;
mod lines;
mod outputs;

use anyhow::Context;
use args::Args;
use cli::Report;
use geom::Shown;
use std::process::ExitCode;
use stones::Packing;

fn main() -> ExitCode {
    cli::run("stone-pack", stone_pack)
}

fn stone_pack(args: Args) -> anyhow::Result<Report> {
    args.check_used()?;
    let grains = inputs::grains(&args)?;
    let library = inputs::library(&args)?;
    let classes = inputs::classes(&args, &library)?;
    let soil = grains.soil();
    let settings = args.settings(&grains)?;
    let progress = cli::Progress::new("stones", 1000);
    let packing =
        stones::pack(&library, &classes, &soil, &settings, |done| progress.set((1000.0 * done) as u64))
            .with_context(|| args.soil.display().to_string())?;
    drop(progress);
    for missed in packing.classes.iter().filter(|c| c.missed.is_some()) {
        let words = missed.missed.as_deref().unwrap_or_default();
        cli::warn(&format!(
            "class {}: content {} instead of {}: {words}",
            missed.class,
            Shown(missed.content),
            Shown(missed.content_wanted)
        ));
    }
    if args.crowd.is_some() && packing.classes.iter().all(|c| c.crowded == 0 && c.undone.no_room == 0) {
        cli::warn("--crowd changed nothing: no class lacked room when its tries had run out");
    }
    // The bodies first: the soil alone, with holes where they are, would look whole.
    if let Some(path) = &args.bodies {
        bodies::write(path, args.material(), &grains, &library, &packing)?;
    }
    outputs::write(&args, &grains, &library, &packing)?;
    let grain_density = grain_density(&grains, &packing);
    if let Some(path) = &args.scene {
        lines::write(path, &args, &grains, grain_density)?;
    }
    let summary = summary(&packing, &settings, grain_density);
    let names: Vec<String> =
        grains.materials.iter().map(|m| m.0.clone()).chain([args.material().to_owned()]).collect();
    let report = Report::new(summary)
        .with("stones", packing.placed.len())
        .with("content_wanted", settings.content)
        .with("content", packing.content)
        .with("tolerance", settings.tolerance)
        .with("mass", packing.mass)
        .with("stone_mass", packing.stone_mass)
        .with("grains_of_stones", packing.clusters.iter().filter(|c| **c > 0).count())
        .with("grain_density", grain_density)
        .with("materials", names)
        .with("seed", settings.seed)
        .with("classes", &packing.classes);
    Ok(args.placing.report(report))
}

/// The density at which the grains of all stones weigh what the stones do [kg/m³]; none without stones.
fn grain_density(grains: &inputs::Grains, packing: &Packing) -> Option<f64> {
    let of_stones = grains.radii.iter().zip(&packing.clusters).filter(|(_, c)| **c > 0);
    let volume: f64 = of_stones.map(|(r, _)| geom::sphere::volume(*r)).sum();
    (volume > 0.0).then(|| packing.stone_mass / volume)
}

fn summary(packing: &Packing, settings: &stones::PackSettings, grain_density: Option<f64>) -> String {
    let tries: u64 = packing.classes.iter().map(|c| c.tries).sum();
    let density = grain_density.map_or(String::new(), |d| {
        format!("; their grains weigh as much with a density of {} kg/m³", Shown(d))
    });
    format!(
        "{}, content {} of {} requested, {tries} tries{density}",
        geom::counted(packing.placed.len(), "stone"),
        Shown(packing.content),
        Shown(settings.content)
    )
}
