//! From a scene to a plan: the engine's setup, and what comes in later.
//!
//! [`Scene::plan_with`] reads as the order of the steps: shapes of [`clumps`]; [`grains`]; [`walls`], and fills again where they lie in one;
//! inlets ([`zones`]); [`insertions`]; outlets and what takes grains out; an outlet for what falls past all walls; then the [`setup`] with the [`laws`] and the time step.
//! Each step adds to the [`builder`]. [`warnings`] about implausible values come last.

mod builder;
mod clumps;
mod domain;
mod grains;
mod insertions;
mod laws;
mod setup;
mod walls;
mod warnings;
mod zones;

pub use builder::PlannedInlet;
pub use grains::packing::bounds;
pub use insertions::insertion::{Insertion, Planned};
pub use laws::accuracy::{ImpactError, impact_error, smallest_accuracies};
pub use laws::contacts::{dropped, most_specific};
pub use walls::below::Below;
pub use walls::solids::wall as solid;
pub use warnings::implausible::{SOFT, density as implausible_density};
pub use zones::SCALE_SLACK;

use crate::error::{Result, SceneError};
use crate::input::{InletSource, Input, WallFile};
use crate::scene::Scene;
use builder::PlanBuilder;
use dem::setup::{ClumpShape, Setup};
use record::{Map, Sizes};

/// Everything that a run needs.
pub struct Plan {
    /// For the engine.
    pub setup: Setup,
    /// Which measured curve the time step relies on, when the scene asks for an accuracy.
    pub step: Option<String>,
    /// Insertions; their zones follow those of the inlets.
    pub insertions: Vec<Insertion>,
    /// Inlet streams.
    pub inlets: Vec<PlannedInlet>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// Role and SHA-256 of what was read.
    pub inputs: Vec<(String, String)>,
    /// Radii of all particles of the run; `None` when there are none.
    pub sizes: Option<Sizes>,
    /// The record [`record::metadata::PLACES`]: walls of spheres that are elsewhere than their file has them.
    pub places: Map,
    /// How far walls reach along gravity, where particles can fall past them and no outlet is there to take them out.
    pub below: Option<Below>,
}

/// How far a `[[fill]]` is.
#[derive(Debug, Clone, Copy)]
pub struct Placing {
    /// Its index in the scene.
    pub fill: usize,
    /// Spheres that have a place.
    pub placed: usize,
    /// Spheres that it has in all.
    pub of: usize,
}

/// Density of materials that no particle is made of [kg/m³].
pub const NO_DENSITY: f64 = f64::MIN_POSITIVE;

impl Scene {
    /// Reads what the scene names, places its particles, and makes everything ready to run.
    /// `given` are the streams of the command line.
    ///
    /// # Errors
    /// Whatever does not fit together, with key, value and cure.
    pub fn plan(&self, given: Vec<Input>) -> Result<Plan> {
        self.plan_with(given, &|_| ())
    }

    /// The same; `hear` gets how far a `[[fill]]` is.
    ///
    /// # Errors
    /// As [`Scene::plan`].
    pub fn plan_with(&self, given: Vec<Input>, hear: &dyn Fn(Placing)) -> Result<Plan> {
        let mut builder = PlanBuilder { hear, ..PlanBuilder::new(self) };
        let (mut wall_files, mut streams): (Vec<WallFile>, Vec<InletSource>) = (Vec::new(), Vec::new());
        for input in given {
            match input {
                Input::Walls(file) => {
                    if let Some(other) = wall_files.iter().find(|w| w.hash == file.hash) {
                        let why = format!("holds the same spheres as {}", other.name);
                        return Err(SceneError::file(&file.name, why, "leave one out"));
                    }
                    wall_files.push(file);
                }
                Input::Inlet(stream) => streams.push(*stream),
            }
        }
        builder.clump_shapes()?;
        builder.particles()?;
        builder.walls(wall_files)?;
        builder.free_of_walls()?;
        builder.inlets(streams)?;
        builder.insertions()?;
        builder.outlets()?;
        builder.removals()?;
        builder.outside()?;
        builder.finish()
    }

    /// Largest diameter of each `[[fill]]` and `[[insert]]` without clumps [m].
    ///
    /// # Errors
    /// Sizes that are wrong.
    pub fn largest_diameters(&self) -> Result<Vec<f64>> {
        let builder = PlanBuilder::new(self);
        let fills =
            self.keys.fill.iter().enumerate().filter(|(_, f)| f.clump.is_none()).map(|(i, f)| f.sized(i));
        let insertions =
            self.keys.insert.iter().enumerate().filter(|(_, f)| f.clump.is_none()).map(|(i, f)| f.sized(i));
        fills.chain(insertions).map(|sized| sized.largest(&builder)).collect()
    }

    /// Radius of the sphere that holds each clump at scale 1 [m], in the order of the scene.
    ///
    /// # Errors
    /// A shape that cannot be built.
    pub fn clump_reaches(&self) -> Result<Vec<f64>> {
        let mut builder = PlanBuilder::new(self);
        builder.clump_shapes()?;
        Ok(builder.clumps.shapes.iter().map(ClumpShape::reach).collect())
    }
}
