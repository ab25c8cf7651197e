//! Outlines of what a scene will do, as thin rods: where grains start and come in, where they leave, where walls will be.

use super::extras::rods;
use super::sheet;
use crate::appearance::colour::Rgb;
use crate::appearance::scale::Range;
use crate::{SurfaceShape, ViewError, WallSurface};
use geom::shape::{Shape, Solid};
use geom::{Plane, Vec3};
use std::f64::consts::TAU;
use stream::Table;

/// A straight line [m].
pub type Line = [Vec3; 2];

/// What outlines show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum OutlineKind {
    /// Where grains are at the start.
    Fill,
    /// Where grains come in.
    Insert,
    /// Where grains of another stage come in.
    Inlet,
    /// Where grains leave.
    Outlet,
    /// Where grains are taken out.
    Remove,
    /// The box at whose faces the world begins again.
    Periodic,
    /// Where walls will be.
    Later,
}

impl OutlineKind {
    /// All there are, with their colours on any paper.
    pub(crate) const ALL: [(OutlineKind, &'static str, Rgb); 7] = [
        (OutlineKind::Fill, "fill", [0x2b, 0x8c, 0xd6]),
        (OutlineKind::Insert, "insert", [0x00, 0x9e, 0x73]),
        (OutlineKind::Inlet, "inlet", [0x8f, 0x5c, 0xc8]),
        (OutlineKind::Outlet, "outlet", [0xd5, 0x3e, 0x2a]),
        (OutlineKind::Remove, "remove", [0xb3, 0x6b, 0x00]),
        (OutlineKind::Periodic, "periodic box", [0x80, 0x84, 0x8c]),
        (OutlineKind::Later, "later positions", [0xc8, 0x4f, 0xa8]),
    ];

    /// Its name.
    pub fn word(self) -> &'static str {
        OutlineKind::ALL[self as usize].1
    }

    pub(crate) fn colour(self) -> Rgb {
        OutlineKind::ALL[self as usize].2
    }
}

/// Sides of a circle.
const SIDES: usize = 36;

/// The edges of a box [m].
pub fn box_lines(low: Vec3, high: Vec3) -> Vec<Line> {
    let corner = |n: usize| Vec3::from_fn(|k, _| if n >> k & 1 == 0 { low[k] } else { high[k] });
    let edges = (0..8).flat_map(|n| (0..3).filter(move |k| n >> k & 1 == 0).map(move |k| [n, n | 1 << k]));
    edges.map(|[a, b]| [corner(a), corner(b)]).collect()
}

/// The edges and rims of a shape; none of one without an end. Of a mesh or a prism, those of the box around it, unless
/// `mesh` is it.
pub fn shape_lines(shape: &Shape) -> Vec<Line> {
    match &shape.solid {
        _ if shape.outside => Vec::new(),
        Solid::Box(low, high) => box_lines(*low, *high),
        Solid::Sphere(centre, radius) => {
            [Vec3::x(), Vec3::y(), Vec3::z()].iter().flat_map(|n| circle(*centre, *n, *radius)).collect()
        }
        Solid::Cylinder(a, b, radius) => cone([*a, *b], [*radius; 2]),
        Solid::Cone(a, b, radii) => cone([*a, *b], *radii),
        Solid::Mesh(mesh) => {
            let (low, high) = mesh.bounds();
            box_lines(low, high)
        }
        Solid::Halfspace(_) | Solid::Prism(_) => Vec::new(),
    }
}

/// A square of a plane, `half` its side, and a short line along its normal.
pub fn plane_lines(plane: &Plane, half: f64) -> Vec<Line> {
    let [u, v] = across(plane.normal);
    let corner = |[a, b]: [f64; 2]| plane.point + (u * a + v * b) * half;
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner);
    let mut lines: Vec<Line> = (0..4).map(|n| [corners[n], corners[(n + 1) % 4]]).collect();
    lines.extend([[corners[0], corners[2]], [corners[1], corners[3]]]);
    lines.push([plane.point, plane.point + plane.normal * (0.5 * half)]);
    lines
}

/// The edges of a wall as it is at a time [s]; a plane reaches as far as the box `low` to `high`.
pub fn wall_lines(surface: &WallSurface, [low, high]: [Vec3; 2], time: f64) -> Vec<Line> {
    let extent = std::array::from_fn(|k| Range { lo: low[k], hi: high[k] });
    let surfaces = std::slice::from_ref(surface);
    let pose = surface.motion.pose(time);
    let is_plane = matches!(surface.shape, SurfaceShape::Plane(_));
    // The last lines of a plane are its rim, the others its grid.
    let lines = sheet::sheets(surfaces, extent).into_iter().flat_map(|sheet| {
        let first = if is_plane { sheet.lines.len() - sheet.vertices.len() } else { 0 };
        sheet.lines[first..].to_vec()
    });
    lines.map(|line| line.map(|end| pose.position(&end))).collect()
}

/// Lines as a table of rods, of this radius [m].
///
/// # Errors
/// None that is known.
pub fn outline_table(lines: &[Line], radius: f64) -> Result<Table, ViewError> {
    let middles: Vec<[f64; 3]> = lines.iter().map(|[a, b]| (0.5 * (a + b)).into()).collect();
    let along: Vec<[f64; 3]> = lines.iter().map(|[a, b]| (0.5 * (b - a)).into()).collect();
    rods(&middles, &along, vec![radius; lines.len()])
}

/// Arrows of velocities [m/s] at points [m], as a table; the longest is five of `radius` [m].
///
/// # Errors
/// None that is known.
pub fn arrow_table(arrows: &[(Vec3, Vec3)], radius: f64) -> Result<Table, ViewError> {
    let points: Vec<[f64; 3]> = arrows.iter().map(|(point, _)| (*point).into()).collect();
    let along: Vec<[f64; 3]> = arrows.iter().map(|(_, velocity)| (*velocity).into()).collect();
    rods(&points, &along, vec![radius; arrows.len()])
}

/// Two directions across another.
fn across(normal: Vec3) -> [Vec3; 2] {
    let least = if normal.z.abs() < 0.9 { Vec3::z() } else { Vec3::x() };
    let u = least.cross(&normal).normalize();
    [u, normal.cross(&u)]
}

fn around(centre: Vec3, normal: Vec3, radius: f64, n: usize) -> Vec3 {
    let [u, v] = across(normal);
    let (sin, cos) = libm::sincos(TAU * n as f64 / SIDES as f64);
    centre + (u * cos + v * sin) * radius
}

fn circle(centre: Vec3, normal: Vec3, radius: f64) -> Vec<Line> {
    let count = if radius > 0.0 { SIDES } else { 0 };
    (0..count).map(|n| [n, n + 1].map(|n| around(centre, normal, radius, n))).collect()
}

fn cone(ends: [Vec3; 2], radii: [f64; 2]) -> Vec<Line> {
    let normal = (ends[1] - ends[0]).normalize();
    let rims = (0..2).flat_map(|k| circle(ends[k], normal, radii[k]));
    let side = |n: usize| [0, 1].map(|k| around(ends[k], normal, radii[k], n * SIDES / 4));
    rims.chain((0..4).map(side)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<Line> {
        shape_lines(&text.parse().expect("a shape"))
    }

    #[test]
    fn a_box_has_twelve_edges_along_the_axes_between_its_corners() {
        let edges = lines("box:0,0,0,1,2,3");
        let length: f64 = edges.iter().map(|[a, b]| (b - a).norm()).sum();
        assert!(edges.len() == 12 && (length - 4.0 * 6.0).abs() < 1e-12, "{length}");
    }

    /// Every end of a line lies on the surface: within a hair both inside and outside of it.
    #[test]
    fn lines_lie_on_their_shape() {
        for text in ["sphere:1,2,3,0.5", "cylinder:0,0,0,1,1,0,0.3", "cone:0,0,0,0,0,2,0.5,0"] {
            let shape: Shape = text.parse().expect("a shape");
            for place in lines(text).into_iter().flatten() {
                let near = (0..64).map(|n| {
                    let way = |k: usize| {
                        if n >> (2 * k) & 3 == 3 { 0.0 } else { f64::from(n >> (2 * k) & 3) - 1.0 }
                    };
                    place + Vec3::new(way(0), way(1), way(2)) * 1e-6
                });
                let inside: Vec<bool> = near.map(|p| shape.contains(&p)).collect();
                assert!(inside.contains(&true) && inside.contains(&false), "{text}: {place:?}");
            }
        }
        assert!(lines("!box:0,0,0,1,1,1").is_empty() && lines("halfspace:0,0,0,0,0,1").is_empty());
    }

    #[test]
    fn each_kind_has_a_name_and_a_colour_of_its_own() {
        for (n, (kind, word, colour)) in OutlineKind::ALL.into_iter().enumerate() {
            assert_eq!((kind as usize, kind.word(), kind.colour()), (n, word, colour));
            assert!(OutlineKind::ALL[..n].iter().all(|other| other.2 != colour && other.1 != word));
        }
    }
}
