//! How small a hole the search can find, by scale and by region.

use super::hole::{Hole, Search, Threshold};
use super::surface::levels::{CELL, EXAMINED, Level};
use geom::{Shape, Vec3};
use serde::Serialize;

/// Width of the smallest hole that is found, in spacings: of wider ones nearly all are (docs/evidence/holes.md has the study).
const SMALLEST: f64 = 8.0;
/// Points that stand for those of a region.
const SOME: usize = 1000;

/// A part of the cloud that was searched at one scale.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ScaleReport {
    /// 1/√density there [m].
    pub spacing: f64,
    /// Smallest hole that is found there [m].
    pub smallest_hole: f64,
    /// Points that were looked at.
    pub points: usize,
}

/// What is in a region.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RegionReport {
    pub points: usize,
    /// 1/√density in it, or at the ends of the surface beside it [m]; none when no surface is near.
    pub spacing: Option<f64>,
    /// Smallest hole that is found there [m].
    pub smallest_hole: Option<f64>,
    /// Holes that were found.
    pub holes: usize,
}

/// What a search found, and what it could find.
#[derive(Default)]
pub(crate) struct FoundHoles {
    pub holes: Vec<Hole>,
    /// The scales that were searched, finest first.
    pub scales: Vec<ScaleReport>,
    /// In the order of the shapes.
    pub regions: Vec<RegionReport>,
}

impl ScaleReport {
    pub(crate) fn of(level: &Level, search: &Search) -> ScaleReport {
        let cell = level.sheet.cell / level.wider;
        let spacing = match search.threshold {
            Threshold::Below(_) => cell / EXAMINED,
            Threshold::Local(_) => cell / CELL,
        };
        ScaleReport { spacing, smallest_hole: SMALLEST * spacing * level.wider, points: level.points.len() }
    }
}

impl RegionReport {
    /// Of a shape in which, or beside which, the surface ends at positions `ends` [m].
    pub(crate) fn of(
        shape: &Shape,
        points: &[Vec3],
        ends: &[Vec3],
        found: &FoundHoles,
        search: &Search,
    ) -> RegionReport {
        let inside: Vec<&Vec3> = points.iter().filter(|p| shape.contains(p)).collect();
        let spacing = match search.threshold {
            Threshold::Below(below) if !inside.is_empty() || !ends.is_empty() => Some(0.5 / below.sqrt()),
            Threshold::Below(_) => None,
            Threshold::Local(field) => {
                let step = inside.len().div_ceil(SOME).max(1);
                let some = inside.iter().step_by(step).copied().chain(ends);
                let mut spacings: Vec<f64> = some.map(|p| field.at(p)).collect();
                spacings.sort_by(f64::total_cmp);
                spacings.get(spacings.len() / 2).copied()
            }
        };
        // The noise that makes cells wider is that of the scale nearest to it.
        let off = |scale: &&ScaleReport, spacing: f64| libm::log(scale.spacing / spacing).abs();
        let smallest = |spacing: f64| {
            let scale = found.scales.iter().min_by(|a, b| off(a, spacing).total_cmp(&off(b, spacing)))?;
            Some(spacing * scale.smallest_hole / scale.spacing)
        };
        let holes = found.holes.iter().filter(|hole| hole.is_in(shape)).count();
        RegionReport { points: inside.len(), spacing, smallest_hole: spacing.and_then(smallest), holes }
    }
}
