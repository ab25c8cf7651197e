//! A turntable whose numbers are a little wrong: changed until the silhouettes of its photographs agree.
//!
//! The camera's focal length and where it looks, the tilt and step of each ring, and the start of all rings but the first are found from the
//! residuals of [`crate::coherence`]. Each change adds a small residual, so that what silhouettes do not tell stays as it was. The distance
//! stays, which gives the scale.

use crate::coherence::{Ball, refine, residuals, rms};
use crate::field::Field;
use crate::hull::{HullError, View, carve, region};
use crate::turntable::{Place, Turntable};
use geom::Vec3;
use std::sync::Arc;

/// Photographs that are compared, and rays of each, at most.
const VIEWS: usize = 48;
const RAYS: usize = 16;
/// Cells of the hull that gives the ball.
const CELLS: usize = 48;
/// Residual of a change by its usual error, as a share of the stone's radius.
const PRIOR: f64 = 1e-4;
/// Usual errors: of the logarithm of the focal length, of the place that the camera looks at as a share of the focal length, and of angles [°].
const FOCAL: f64 = 0.02;
const LOOKS: f64 = 0.005;
const ANGLE_DEG: f64 = 0.5;
const STEP_DEG: f64 = 0.05;

/// A photograph of a turntable.
#[derive(Debug, Clone)]
pub struct Turned {
    /// Its ring and angle.
    pub place: Place,
    /// Signed distance to the edge of its mask.
    pub field: Arc<Field>,
    /// Width and height of its mask [px].
    pub size: [usize; 2],
}

impl Turned {
    /// The view by a turntable.
    pub fn view(&self, table: &Turntable) -> View {
        let camera = table.camera(&self.place, self.size[0], self.size[1]);
        View { camera, field: self.field.clone() }
    }

    /// The same photograph on another turntable.
    pub fn on(&self, table: &Turntable, other: &Turntable) -> Turned {
        Turned { place: table.place_on(other, &self.place), ..self.clone() }
    }
}

/// What was done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adjustment {
    /// Root mean square of the residuals before [m].
    pub before: f64,
    /// The same after [m].
    pub after: f64,
}

/// Changes a turntable until the silhouettes agree; the stone lies on one side on all photographs. `camera`: whether the camera changes, too.
/// [`Turntable::place_on`] gives the photographs' places on the new turntable.
///
/// # Errors
/// Photographs that have no hull.
pub fn adjust(table: &Turntable, all: &[Turned], camera: bool) -> Result<(Turntable, Adjustment), HullError> {
    let views: Vec<View> = all.iter().map(|t| t.view(table)).collect();
    let ball = ball(&views)?;
    let size = all[0].size;
    let count = VIEWS.min(all.len());
    let some: Vec<Turned> = (0..count).map(|k| all[k * all.len() / count].clone()).collect();
    let mut rings: Vec<usize> = all.iter().map(|t| t.place.ring).collect();
    rings.sort_unstable();
    rings.dedup();
    let changes = Changes { start: table.clone(), rings, camera, size };
    let usual = changes.usual();
    let of = |p: &[f64]| {
        let next = changes.table(p);
        let views: Vec<View> = some.iter().map(|t| t.on(table, &next).view(&next)).collect();
        let mut found = residuals(&views, &ball, RAYS);
        found.extend(p.iter().zip(&usual).map(|(p, usual)| PRIOR * ball.radius * (p / usual).abs()));
        found
    };
    let none = vec![0.0; usual.len()];
    let before = rms(&of(&none));
    let steps: Vec<f64> = usual.iter().map(|u| u / 10.0).collect();
    let (found, after) = refine(&none, &steps, of);
    Ok((changes.table(&found), Adjustment { before, after }))
}

/// A ball around the hull.
fn ball(views: &[View]) -> Result<Ball, HullError> {
    let around = region(views)?;
    let [lo, hi] = carve(views, &around, CELLS).bounds().unwrap_or(around);
    let centre: Vec3 = (lo + hi) / 2.0;
    Ok(Ball { centre, radius: 0.55 * (hi - lo).norm() })
}

/// Which numbers change, and from where.
struct Changes {
    start: Turntable,
    rings: Vec<usize>,
    camera: bool,
    size: [usize; 2],
}

impl Changes {
    /// Usual errors of all numbers, in their order.
    fn usual(&self) -> Vec<f64> {
        let focal = self.start.camera.focal_px;
        let camera = if self.camera { vec![FOCAL, LOOKS * focal, LOOKS * focal] } else { Vec::new() };
        let rings = self.rings.iter().flat_map(|_| [ANGLE_DEG, STEP_DEG]);
        camera.into_iter().chain(rings).chain(self.rings.iter().skip(1).map(|_| ANGLE_DEG)).collect()
    }

    fn table(&self, changes: &[f64]) -> Turntable {
        let mut table = self.start.clone();
        let mut next = changes.iter();
        let mut change = || next.next().copied().unwrap_or(0.0);
        if self.camera {
            let (size, [x, y]) = table.frame(self.size);
            table.camera.focal_px *= libm::exp(change());
            table.camera.centre_px = Some([x + change(), y + change()]);
            table.camera.size_px = Some(size);
        }
        for ring in &self.rings {
            table.ring[*ring].tilt_deg += change();
            table.ring[*ring].step_deg += change();
        }
        for ring in self.rings.iter().skip(1) {
            table.ring[*ring].start_deg += change();
        }
        table
    }
}
