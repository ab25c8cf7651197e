//! What a crop did: how many points went, and why.

use super::rule::ground::Raster;
use super::rule::outer::Outside;
use super::rules::{Action, Region, Rules};
use crate::points::places::Crowd;
use serde::Serialize;

/// What was kept and why not.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Cropped {
    /// Points that came in.
    pub points_in: usize,
    /// Points without finite coordinates.
    pub not_finite: usize,
    /// Points that the shapes took away.
    pub outside_shapes: usize,
    /// Points of each named region, whatever the other rules make of them.
    pub regions: Vec<RegionCount>,
    /// Points beyond the outer shape.
    pub beyond_outer: usize,
    /// The parts that they make up, when an outer shape is described.
    pub beyond: Option<Outside>,
    /// Points that were marked before.
    pub marked_before: usize,
    /// Points that do not fulfil the condition.
    pub unfulfilled: usize,
    /// Points as near to another one as the rule for distinct points says.
    pub repeated: usize,
    /// Where many points lie in one place, when a rule looked at points together.
    pub crowd: Option<Crowd>,
    /// Points far from their neighbours.
    pub outliers: usize,
    /// Points whose surface lies along the line of sight.
    pub grazing: usize,
    /// Where scanners stood [m], when they were asked for.
    pub viewpoints: Vec<[f64; 3]>,
    /// Points of the ground.
    pub ground: usize,
    /// How it was found.
    pub ground_raster: Option<Raster>,
    /// Points on no surface.
    pub scattered: usize,
    /// Points of smaller parts.
    pub smaller_parts: usize,
    /// Points of these, and of those that were marked before, that were restored.
    pub restored: usize,
    /// Rules that could not judge the cloud, and why.
    pub idle: Vec<String>,
    /// Points that stay, or would where they are marked.
    pub points_out: usize,
}

/// Points of a named region.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RegionCount {
    /// Name of the region.
    pub name: String,
    /// What is done with them.
    pub action: Action,
    /// Points inside it.
    pub points: usize,
}

impl Cropped {
    /// A report in which nothing is counted yet.
    pub(crate) fn of(rules: &Rules) -> Cropped {
        let none = |r: &Region| RegionCount { name: r.name.clone(), action: r.action, points: 0 };
        Cropped { regions: rules.regions.iter().map(none).collect(), ..Cropped::default() }
    }

    /// Adds what shapes alone count in a part of the cloud.
    pub(crate) fn add(&mut self, part: &Cropped) {
        self.not_finite += part.not_finite;
        self.regions.iter_mut().zip(&part.regions).for_each(|(all, part)| all.points += part.points);
    }
}
