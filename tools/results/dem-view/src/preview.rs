//! A scene before it runs: what is there at the start, and outlines of what will be.

mod drawing;
mod grains;

use crate::args::Args;
use crate::formats::Format;
use anyhow::Context;
use cli::Source;
use drawing::Drawing;
use scene::{Input, Plan, Scene};
use serde_json::{Value, json};
use std::path::Path;
use view::{Arrows, LayerHead, Role, Show, WallSurface};

/// A scene that was read and planned.
pub struct Planned {
    /// As given.
    name: String,
    scene: Scene,
    plan: Plan,
}

/// Whether this is a scene by its name.
pub fn is_scene(source: &Source) -> bool {
    source.path().is_some_and(|path| path.extension().is_some_and(|ending| ending == "toml"))
}

/// The scene among the inputs; the others go with it, as `dem-run` takes them.
pub fn plan(args: &Args, format: Format) -> anyhow::Result<Option<Planned>> {
    let Some(at) = args.inputs.iter().position(is_scene) else { return Ok(None) };
    check(args, format)?;
    let (source, mut given) = (&args.inputs[at], Vec::new());
    for (_, other) in args.inputs.iter().enumerate().filter(|(n, _)| *n != at) {
        given.push(Input::open(&other.to_string(), other.open()?).with_context(|| {
            format!("{source} is a scene, and what goes with it are its walls and inlets (MCAP), as dem-run takes them")
        })?);
    }
    let folder = source.path().and_then(Path::parent).unwrap_or(Path::new(""));
    let name = source.to_string();
    let scene = Scene::new(&name, source.read_text()?, &[], folder)?;
    cli::also_reads(scene.files())?;
    let plan = scene.plan(given)?;
    plan.warnings.iter().for_each(|note| cli::warn(note));
    Ok(Some(Planned { name: crate::inputs::short_name(source), scene, plan }))
}

/// Refuses what a scene does not have before it runs.
fn check(args: &Args, format: Format) -> anyhow::Result<()> {
    if !matches!(format, Format::Html | Format::Png) {
        let ending = format.ending();
        return Err(cli::usage(format!(
            "-o: a scene is shown as it starts, which is one moment, and .{ending} needs a run: give .html or .png, or run it: dem-run SCENE -o RUN.mcap"
        )));
    }
    let of_runs = [
        ("--time", args.time.is_some()),
        ("--bonds", args.bonds),
        ("--vectors", args.vectors.is_some()),
        ("--force-chains", args.force_chains),
        ("--walls-colour", args.walls_colour.is_some()),
        ("--pick", args.pick),
    ];
    match of_runs.iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(cli::usage(format!(
            "{option}: a scene has not run: leave it out, or show its run: dem-run SCENE -o RUN.mcap"
        ))),
        None => Ok(()),
    }
}

impl Planned {
    /// What to colour by where no field is given: grains at rest have all the same speed.
    pub fn colour(&self) -> Option<String> {
        let setup = &self.plan.setup;
        let grains = !setup.particles.is_empty() || !setup.clumps.placed.is_empty();
        let field = if self.kinds_of_grains() > 1 { "material" } else { "size" };
        grains.then(|| field.to_owned())
    }

    fn kinds_of_grains(&self) -> usize {
        let setup = &self.plan.setup;
        let alone = setup.particles.iter().map(|p| p.material);
        let clumps = setup.clumps.placed.iter().map(|b| setup.clumps.shapes[b.shape as usize].material);
        alone.chain(clumps).collect::<std::collections::BTreeSet<u16>>().len()
    }

    /// Shows walls and grains as they start, and what will be.
    pub fn show(&self, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
        let setup = &self.plan.setup;
        let of_file = |word: &str| format!("{word} ({})", self.name);
        for wall in &setup.walls {
            self.show_wall(wall, show)?;
        }
        let kinds = setup.materials.iter().map(|m| m.name.clone()).collect();
        let head = LayerHead { kinds, ..LayerHead::new(Role::Grains, &of_file("grains")) };
        let (grains, layer) = (grains::table(setup)?, show.layer(head));
        let count = grains.rows();
        show.push(layer, 0.0, grains)?;
        let drawing = Drawing::of(&self.scene, &self.plan)?;
        let mut found = vec![json!({ "input": self.name, "spheres": count, "walls": setup.walls.len() })];
        for (kind, name, lines) in drawing.outlines() {
            let layer = show.layer(LayerHead::new(Role::Outline(kind), &name));
            show.push(layer, 0.0, view::outline_table(&lines, drawing.line_radius(kind))?)?;
            found.push(json!({ "outline": kind.word(), "name": name, "lines": lines.len() }));
        }
        let arrows = drawing.arrows();
        if !arrows.is_empty() {
            let layer = show.layer(LayerHead::new(Role::Arrows(Arrows::Planned), "velocities"));
            show.push(layer, 0.0, view::arrow_table(&arrows, drawing.arrow_radius())?)?;
            found.push(json!({ "arrows": arrows.len() }));
        }
        Ok(found)
    }

    fn show_wall(&self, wall: &dem::setup::Wall, show: &mut impl Show) -> anyhow::Result<()> {
        let (name, motion) = (wall.name.clone(), wall.motion.clone());
        match drawing::surface(wall) {
            Some(shape) => {
                show.surface(WallSurface { name, shape, motion });
            }
            None => {
                let layer = show.layer(LayerHead { motion, ..LayerHead::new(Role::Walls, &name) });
                show.push(layer, 0.0, grains::wall_table(wall)?)?;
            }
        }
        Ok(())
    }
}
