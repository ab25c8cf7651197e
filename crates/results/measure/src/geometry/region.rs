//! A shape with a volume, and how much of a ball lies in it.
//!
//! Exact for boxes, spheres and half spaces, to 1e-9 of the ball for cylinders. For cones, prisms and meshes: 1000 points
//! that fill the ball evenly, where 64 points on its surface are not all on one side; the reported error is
//! that of random points, V √(p (1 − p)/1000); evenly spread points stay below it.

use super::{ball, chord, cylinder};
use crate::MeasureError;
use crate::periodic::{MOST_IMAGES, PeriodicBox};
use geom::{Shape, Vec3, shape::Solid};
use std::borrow::Cow;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// A half space that begins below this [m] along each axis of its normal is everything: the SHAPE `all`.
const EVERYWHERE: f64 = -1e99;
const INNER: usize = 1000;
const OUTER: usize = 64;

/// A shape and its volume.
#[derive(Debug, Clone)]
pub struct Region {
    pub shape: Shape,
    /// Its volume [m³]; infinite for one without end.
    pub volume: f64,
}

/// Volume of a part, and its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PartialVolume {
    /// Volume [m³].
    pub volume: f64,
    /// Standard error [m³].
    pub error: f64,
}

impl Region {
    /// A region; `volume` [m³] is needed for prisms and meshes and not looked at for others.
    pub fn new(shape: Shape, volume: f64) -> Region {
        let own = match &shape.solid {
            _ if shape.outside => f64::INFINITY,
            Solid::Box(low, high) => (high - low).product(),
            Solid::Sphere(_, r) => ball::volume(*r),
            Solid::Cylinder(a, b, r) => PI * r * r * (b - a).norm(),
            Solid::Cone(a, b, [ra, rb]) => PI / 3.0 * (ra * ra + ra * rb + rb * rb) * (b - a).norm(),
            Solid::Halfspace(_) => f64::INFINITY,
            Solid::Prism(_) | Solid::Mesh(_) => volume,
        };
        Region { shape, volume: own }
    }

    /// The volume [m³] of a region that has an end and room inside.
    ///
    /// # Errors
    /// No end, no room.
    pub fn room(&self) -> Result<f64, MeasureError> {
        match self.volume {
            v if v.is_infinite() => Err(MeasureError::EndlessShape),
            v if v > 0.0 => Ok(v),
            volume => Err(MeasureError::EmptyShape { volume }),
        }
    }

    /// Whether it is everything.
    fn is_everything(&self) -> bool {
        match &self.shape.solid {
            Solid::Halfspace(plane) => !self.shape.outside && plane.point.dot(&plane.normal) < EVERYWHERE,
            _ => false,
        }
    }

    /// Refuses a region that has no volume in any run.
    ///
    /// # Errors
    /// No end, no room. Everything may have a volume: that of a periodic domain.
    pub fn may_have_room(&self) -> Result<(), MeasureError> {
        if self.is_everything() { Ok(()) } else { self.room().map(|_| ()) }
    }

    /// The region in a frame: of everything the whole domain, which is periodic along all axes.
    ///
    /// # Errors
    /// Everything in a domain that has no end along an axis.
    pub fn within(&self, periodic: &PeriodicBox) -> Result<Cow<'_, Region>, MeasureError> {
        if !self.is_everything() {
            return Ok(Cow::Borrowed(self));
        }
        if let Some(axis) = periodic.range.iter().position(Option::is_none) {
            return Err(MeasureError::EndlessDomain { axis: ["x", "y", "z"][axis] });
        }
        let (low, high) = periodic.corners();
        Ok(Cow::Owned(Region::new(Shape { solid: Solid::Box(low, high), ..self.shape.clone() }, f64::NAN)))
    }

    /// How much of a ball and its images in a periodic box lies in the region, which has an end.
    pub fn part_of_images(&self, periodic: &PeriodicBox, centre: &Vec3, radius: f64) -> PartialVolume {
        if periodic.is_open() {
            return self.part(centre, radius);
        }
        let ball = (centre.add_scalar(-radius), centre.add_scalar(radius));
        let parts = periodic.shifts(ball, self.shape.solid.bounds());
        let parts = parts.into_iter().map(|shift| self.part(&(centre + shift), radius));
        parts.fold(PartialVolume::default(), |sum, part| PartialVolume {
            volume: sum.volume + part.volume,
            error: sum.error.hypot(part.error),
        })
    }

    /// How many images of a point [m] lie in the region, which has an end.
    pub fn images(&self, periodic: &PeriodicBox, point: &Vec3) -> usize {
        let shifts = periodic.shifts((*point, *point), self.shape.solid.bounds());
        shifts.iter().filter(|shift| self.shape.contains(&(point + *shift))).count()
    }

    /// The share of a way and its images that lies in the region, which has an end [–].
    pub fn share(&self, periodic: &PeriodicBox, from: &Vec3, way: &Vec3) -> f64 {
        let (to, bounds) = (from + way, self.shape.solid.bounds());
        let shifts = periodic.shifts((from.inf(&to), from.sup(&to)), bounds);
        let pieces = shifts.iter().flat_map(|shift| chord::inside(&self.shape.solid, &(from + shift), way));
        pieces.map(|[a, b]| b - a).sum()
    }

    /// Refuses a region that is far larger than the periodic box: each image of each grain is looked at.
    ///
    /// # Errors
    /// More than [`MOST_IMAGES`] periods.
    pub fn fits(&self, periodic: &PeriodicBox) -> Result<(), MeasureError> {
        let (low, high) = self.shape.solid.bounds();
        let lengths = periodic.lengths();
        let count = |k: usize| if lengths[k] > 0.0 { (high[k] - low[k]) / lengths[k] + 1.0 } else { 1.0 };
        let periods: f64 = (0..3).map(count).product();
        if periods <= MOST_IMAGES as f64 {
            return Ok(());
        }
        let cure = "give a smaller SHAPE: one period along each periodic axis holds every grain once";
        Err(MeasureError::Setting {
            what: "periods of the domain that SHAPE spans",
            value: periods,
            unit: "of 1000 at most",
            cure,
        })
    }

    /// How much of a ball lies in the region.
    pub fn part(&self, centre: &Vec3, radius: f64) -> PartialVolume {
        let inside = match &self.shape.solid {
            Solid::Box(low, high) => exact(ball::in_box(centre, radius, low, high)),
            Solid::Sphere(middle, r) => exact(ball::lens((centre - middle).norm(), radius, *r)),
            Solid::Cylinder(a, b, r) => exact(cylinder::in_cylinder(centre, radius, a, b, *r)),
            Solid::Halfspace(plane) => exact(ball::behind(centre, radius, plane)),
            solid @ (Solid::Cone(..) | Solid::Prism(_) | Solid::Mesh(_)) => counted(solid, centre, radius),
        };
        let whole = ball::volume(radius);
        if self.shape.outside { PartialVolume { volume: whole - inside.volume, ..inside } } else { inside }
    }
}

fn exact(volume: f64) -> PartialVolume {
    PartialVolume { volume, error: 0.0 }
}

fn counted(solid: &Solid, centre: &Vec3, radius: f64) -> PartialVolume {
    let (outer, inner) = points();
    let count = |points: &[Vec3]| points.iter().filter(|p| solid.contains(&(centre + *p * radius))).count();
    let whole = ball::volume(radius);
    match count(outer) {
        0 if !solid.contains(centre) => PartialVolume::default(),
        OUTER => exact(whole),
        _ => {
            let share = count(inner) as f64 / INNER as f64;
            PartialVolume {
                volume: whole * share,
                error: whole * (share * (1.0 - share) / INNER as f64).sqrt(),
            }
        }
    }
}

/// Points on the unit sphere, and in it: Roberts' R₃ sequence, radius from the cube root of one coordinate.
fn points() -> &'static (Vec<Vec3>, Vec<Vec3>) {
    static POINTS: OnceLock<(Vec<Vec3>, Vec<Vec3>)> = OnceLock::new();
    let position = |k: usize, radius: &dyn Fn(f64) -> f64| {
        let [a, b, c] = geom::random::even(k);
        let (z, turn) = (2.0 * a - 1.0, 2.0 * PI * b);
        let flat = (1.0 - z * z).sqrt();
        Vec3::new(flat * libm::cos(turn), flat * libm::sin(turn), z) * radius(c)
    };
    POINTS.get_or_init(|| {
        let outer = (0..OUTER).map(|k| position(k, &|_| 1.0)).collect();
        (outer, (0..INNER).map(|k| position(k, &|c| libm::cbrt(c))).collect())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::mesh::cuboid;

    #[test]
    fn a_mesh_of_a_box_holds_what_the_box_holds_within_the_error() {
        let (low, high) = (Vec3::new(-0.2, -0.3, 0.0), Vec3::new(0.4, 0.5, 0.6));
        let load = |_: &str| Ok(cuboid(low, high));
        let mesh = Region::new(Shape::parse("mesh:x", &load).unwrap(), 1.0);
        let shape: Shape = "box:-0.2,-0.3,0,0.4,0.5,0.6".parse().unwrap();
        let exact = Region::new(shape, 0.0);
        for (x, y, z) in
            [(0.0, 0.0, 0.0), (0.35, 0.4, 0.5), (-0.2, 0.0, 0.3), (0.1, 0.1, 0.3), (2.0, 0.0, 0.0)]
        {
            let centre = Vec3::new(x, y, z);
            let (a, b) = (mesh.part(&centre, 0.15), exact.part(&centre, 0.15));
            assert!((a.volume - b.volume).abs() <= 3.0 * a.error + 1e-15, "{centre}: {a:?} {b:?}");
        }
    }

    #[test]
    fn inside_and_outside_make_a_whole() {
        for shape in ["sphere:0,0,0,0.3", "halfspace:0,0,0.1,1,0,1", "cylinder:0,0,0,0,1,0,0.2"] {
            let both = [shape.to_owned(), format!("!{shape}")].map(|text| {
                Region::new(text.parse().unwrap(), 0.0).part(&Vec3::new(0.1, 0.05, 0.1), 0.2).volume
            });
            assert!((both[0] + both[1] - ball::volume(0.2)).abs() < 1e-15 && both[0] > 0.0, "{shape}");
        }
    }

    #[test]
    fn regions_without_room_or_end_are_refused() {
        let room = |text: &str| Region::new(text.parse().unwrap(), 0.0).room();
        assert_eq!(room("box:0,0,0,1,1,0"), Err(MeasureError::EmptyShape { volume: 0.0 }));
        assert_eq!(room("halfspace:0,0,0,0,0,1"), Err(MeasureError::EndlessShape));
        assert_eq!(room("!box:0,0,0,1,1,1"), Err(MeasureError::EndlessShape));
        assert_eq!(room("box:0,0,0,1,2,3"), Ok(6.0));
    }
}
