//! Fill: finds the holes of a cloud and puts points on the surface that spans them.

use super::darts::{Method, PACKING, throw};
use super::mesh::cover::{Cover, FallsThrough, Mesher};
use super::settings::{FillError, MOST, Settings};
use super::sight::{Seen, SightReport};
use super::sparse::{self, Added, SparseReport, SparseSearch};
use crate::holes::hole::{Hole, Search, Threshold};
use crate::holes::report::{FoundHoles, RegionReport, ScaleReport};
use crate::holes::{search::find, step};
use crate::neighbours::density;
use crate::neighbours::spacing::LocalSpacing;
use crate::points::Cloud;
use geom::Vec3;
use geom::mesh::TriMesh;
use rayon::prelude::*;
use serde::Serialize;
use stream::Values;

/// Share of the surface whose density sets the threshold, and the part of that density which is the threshold.
const SPARSEST: (f64, f64) = (0.05, 0.25);
/// Widest hole, as a share of the cloud's diagonal: a blind spot is small, the mouth of a pipe is not.
const WIDEST: f64 = 1.0 / 5.0;

/// A cloud with its holes filled.
#[derive(Debug, Clone)]
pub struct Filled {
    /// The points that came in, then the added ones; `filled` is 1 for the latter.
    pub cloud: Cloud,
    /// What was meshed [m].
    pub mesh: TriMesh,
    /// What was done.
    pub report: Report,
}

/// What was found and added.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Report {
    /// Points that came in.
    pub points_in: usize,
    /// Points without finite coordinates, dropped.
    pub not_finite: usize,
    /// Density at or below which a position is part of a hole [1/m²]; chosen from the cloud, that of the sparsest 20th: elsewhere it is a
    /// quarter of the density around.
    pub below: Option<f64>,
    /// Whether it was chosen from the cloud.
    pub below_is_automatic: bool,
    /// Widest hole that is filled [m].
    pub max_hole: f64,
    /// How points were spread.
    pub method: Method,
    /// How holes were meshed.
    pub mesher: Mesher,
    /// Viewpoints that points were checked from.
    pub viewpoints: usize,
    /// The scales of the search, finest first, and the smallest hole that each finds.
    pub scales: Vec<ScaleReport>,
    /// The regions that were given.
    pub regions: Vec<RegionReport>,
    /// The holes that were found, filled or not.
    pub holes: Vec<HoleReport>,
    /// What was added where the surface is too sparse for a spacing; `None` when none was given.
    pub sparse: Option<SparseReport>,
    /// Points added.
    pub added: usize,
    /// Points that go out.
    pub points_out: usize,
}

/// What was found at one hole, and what was added to it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HoleReport {
    /// Middle of its open cells [m].
    pub centre: [f64; 3],
    /// Greatest width [m].
    pub width: f64,
    /// Density of its surroundings [1/m²].
    pub density: f64,
    /// Least distance of the added points [m].
    pub spacing: f64,
    /// Largest ball that was rolled over it [m].
    pub ball: f64,
    /// Triangles of its mesh.
    pub faces: usize,
    /// Points added.
    pub added: usize,
    /// Distance of the surfaces on two sides of it over its width [–], where no viewpoint is known: 0 of a smooth surface or an edge.
    pub step: Option<f64>,
    /// Whether that is so much that they are two surfaces.
    pub between: bool,
    /// How the points of the fill look from the viewpoints; none without any.
    pub sight: Option<SightReport>,
    /// Whether the largest ball fell through, so that some of it stays open.
    pub open: bool,
}

/// Fills the holes of a cloud.
///
/// # Errors
/// A spacing so small that memory would not hold the points; a point that is too far away.
pub fn fill(cloud: Cloud, settings: &Settings) -> Result<Filled, FillError> {
    let points_in = cloud.points.len();
    let (cloud, not_finite) = cloud.finite();
    cloud.check_reach()?;
    let automatic = || density::sparse(&cloud.points, SPARSEST.0).map(|d| d * SPARSEST.1);
    let below = settings.below.or_else(automatic);
    let max_hole = settings.max_hole.unwrap_or_else(|| WIDEST * diagonal(&cloud.points));
    let mut report =
        Report { points_in, not_finite, below, max_hole, method: settings.method, ..Report::default() };
    report.mesher = settings.mesher;
    report.below_is_automatic = settings.below.is_none();
    let field = if settings.below.is_none() { LocalSpacing::new(&cloud.points) } else { None };
    let threshold = match settings.below {
        Some(below) if cloud.points.len() >= density::FEWEST => Some(Threshold::Below(below)),
        _ => field.as_ref().map(Threshold::Local),
    };
    let search = |threshold| Search { threshold, widest: max_hole, regions: &settings.regions };
    let found = threshold.map_or(FoundHoles::default(), |threshold| find(&cloud.points, &search(threshold)));
    (report.scales, report.regions) = (found.scales, found.regions);
    let holes = found.holes;
    let area: f64 = holes.iter().map(Hole::area).sum();
    if let Some(spacing) = settings.spacing
        && area / (spacing * spacing) > MOST
    {
        return Err(FillError::TooMany { spacing, points: area / (spacing * spacing) });
    }
    let eyes: Vec<Vec3> = settings.seen_from.iter().copied().chain(cloud.viewpoints()).collect();
    report.viewpoints = eyes.len();
    let seen = (!eyes.is_empty() && !holes.is_empty()).then(|| Seen::new(&cloud.points, &eyes));
    let filling = |(i, hole)| Filling::new(hole, settings, seen.as_ref(), i as u64);
    let fillings: Vec<Filling> = holes.par_iter().enumerate().map(filling).collect();
    let mut mesh = TriMesh::default();
    for filling in &fillings {
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(&filling.vertices);
        mesh.faces.extend(filling.faces.iter().map(|face| face.map(|i| i + first)));
    }
    let (points, like): (Vec<_>, Vec<_>) = fillings
        .into_iter()
        .map(|p| {
            report.holes.push(p.report);
            (p.points, p.like)
        })
        .unzip();
    let mut cloud = extended(cloud, Added { points: points.concat(), like: like.concat() });
    if let (Some(spacing), Some(below)) = (settings.for_spacing, below) {
        let search = SparseSearch { spacing, scale: 1.0 / below.sqrt(), regions: &settings.regions };
        let (added, sparse) = sparse::fill(&cloud.points, &search)?;
        report.sparse = Some(sparse);
        cloud = extended(cloud, added);
    }
    report.added = cloud.points.len() + report.not_finite - points_in;
    report.points_out = cloud.points.len();
    Ok(Filled { cloud, mesh, report })
}

/// What one hole adds.
struct Filling {
    points: Vec<Vec3>,
    /// A row near each point, for the other properties.
    like: Vec<u32>,
    /// Vertices of the mesh [m].
    vertices: Vec<Vec3>,
    faces: Vec<[u32; 3]>,
    report: HoleReport,
}

impl Filling {
    /// Nothing is added to a hole.
    fn left_open(report: HoleReport) -> Filling {
        Filling { points: vec![], like: vec![], vertices: vec![], faces: vec![], report }
    }

    fn new(hole: &Hole, settings: &Settings, seen: Option<&Seen>, number: u64) -> Filling {
        let mut report = HoleReport {
            centre: hole.centre.into(),
            width: hole.width,
            density: 0.0,
            spacing: 0.0,
            ball: 0.0,
            faces: 0,
            added: 0,
            step: seen.is_none().then(|| step::step(hole)),
            between: false,
            sight: None,
            open: true,
        };
        report.between = report.step.is_some_and(|step| step > step::MOST);
        if report.between && !settings.bridge {
            return Filling::left_open(report);
        }
        let Ok(mut cover) = Cover::new(hole, settings.mesher, &settings.balls).map_err(|FallsThrough| ())
        else {
            return Filling::left_open(report);
        };
        // Dense enough to be as dense as the surroundings: a grid fills its plane, a Poisson disk less of it.
        let packing = if settings.method == Method::Grid { 1.0 } else { PACKING };
        let spacing = settings.spacing.unwrap_or((packing / cover.density).sqrt());
        let seed = settings.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(number);
        let mut local = throw(hole, &cover, settings.method, spacing, seed);
        if !settings.regions.is_empty() {
            local.retain(|p| settings.regions.iter().any(|shape| shape.contains(&hole.frame.world(p))));
        }
        let sight = seen.map(|seen| seen.drop_free(hole, &mut cover, &mut local));
        report = HoleReport {
            sight,
            density: cover.density,
            spacing,
            ball: cover.ball,
            faces: cover.faces.len(),
            added: local.len(),
            open: !cover.is_closed(),
            ..report
        };
        Filling {
            like: local.iter().map(|p| nearest(p, &cover.corners)).collect(),
            points: local.iter().map(|p| hole.frame.world(p)).collect(),
            vertices: cover.positions.iter().map(|p| hole.frame.world(p)).collect(),
            faces: cover.faces,
            report,
        }
    }
}

/// Row of the corner nearest to a local position.
fn nearest(p: &Vec3, corners: &[(u32, Vec3)]) -> u32 {
    let far = |c: &&(u32, Vec3)| (c.1 - p).norm_squared();
    corners.iter().min_by(|a, b| far(a).total_cmp(&far(b))).map_or(0, |c| c.0)
}

/// The cloud with the added points at its end, and the column `filled`.
fn extended(mut cloud: Cloud, added: Added) -> Cloud {
    let count = cloud.points.len();
    let mut filled = match cloud.attributes.get("filled") {
        Some(before) => (0..count).map(|i| u8::from(before.get(i) != 0.0)).collect(),
        None => vec![0u8; count],
    };
    filled.resize(count + added.points.len(), 1);
    if !added.points.is_empty() {
        let rows: Vec<u32> = (0..count as u32).chain(added.like).collect();
        cloud.attributes = cloud.attributes.select(&rows);
        cloud.points.extend(added.points);
    }
    // As many rows as points: `replace` has nothing to refuse.
    let replaced = cloud.attributes.replace("filled", Values::U8(filled));
    debug_assert!(replaced.is_ok(), "{replaced:?}");
    cloud
}

/// Diagonal of the box that holds nearly all points [m]: a hundredth may lie outside along each axis.
fn diagonal(points: &[Vec3]) -> f64 {
    let step = points.len().div_ceil(2000).max(1);
    let extent = |a: usize| {
        let mut some: Vec<f64> = points.iter().step_by(step).map(|p| p[a]).collect();
        some.sort_by(f64::total_cmp);
        let cut = some.len() / 200;
        if some.is_empty() { 0.0 } else { some[some.len() - 1 - cut] - some[cut] }
    };
    Vec3::new(extent(0), extent(1), extent(2)).norm()
}
