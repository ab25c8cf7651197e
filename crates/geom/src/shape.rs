//! Shapes that keep or remove points, as the command line and region files write them.
//!
//! ```text
//! box:x0,y0,z0,x1,y1,z1 | sphere:x,y,z,r | cylinder:x0,y0,z0,x1,y1,z1,r
//! cone:x0,y0,z0,x1,y1,z1,r0,r1 | halfspace:px,py,pz,nx,ny,nz | prism:FILE.json | mesh:FILE        ! in front: outside
//! ```

use crate::Vec3;
use crate::mesh::{Inside, MeshError, TriMesh};
use crate::numbers::{NumbersError, numbers};
use crate::plane::{Plane, PlaneError};
use crate::prism::{Prism, PrismError};
use std::str::FromStr;
use thiserror::Error;

/// A part of space: a solid, or all that is outside of it. Its surface belongs to the solid.
#[derive(Debug, Clone)]
pub struct Shape {
    /// The solid.
    pub solid: Solid,
    /// Whether the outside is meant.
    pub outside: bool,
}

/// The solids.
#[derive(Debug, Clone)]
pub enum Solid {
    /// Between two corners, the lower first [m].
    Box(Vec3, Vec3),
    /// Centre [m] and radius [m].
    Sphere(Vec3, f64),
    /// Both ends of the axis [m] and radius [m].
    Cylinder(Vec3, Vec3, f64),
    /// Both ends of the axis [m] and the radius at each [m]; one of them may be 0.
    Cone(Vec3, Vec3, [f64; 2]),
    /// The side that the normal points to.
    Halfspace(Plane),
    /// A polygon and its extrusion.
    Prism(Prism),
    /// A closed mesh.
    Mesh(Inside),
}

/// Why a text is no shape.
#[derive(Debug, Error)]
#[allow(missing_docs)]
pub enum ShapeError {
    #[error(
        "'{0}' is not a shape: use box:x0,y0,z0,x1,y1,z1, sphere:x,y,z,r, cylinder:x0,y0,z0,x1,y1,z1,r, \
         cone:x0,y0,z0,x1,y1,z1,r0,r1, halfspace:px,py,pz,nx,ny,nz, prism:FILE.json or mesh:FILE, with ! in front for its outside"
    )]
    Kind(String),
    #[error("shape '{text}': {source}")]
    Numbers { text: String, source: NumbersError },
    #[error("shape '{text}': {source}")]
    Plane { text: String, source: PlaneError },
    #[error("shape '{text}': radius {radius} m must be positive")]
    Radius { text: String, radius: f64 },
    #[error("shape '{text}': both ends of the axis are the same point")]
    NoAxis { text: String },
    #[error("shape '{text}': cannot read the file: {source}")]
    Read { text: String, source: std::io::Error },
    #[error("shape '{text}': {source}")]
    Prism { text: String, source: PrismError },
    #[error("shape '{text}': {why}")]
    Load { text: String, why: String },
    #[error("shape '{text}': {source}")]
    Mesh { text: String, source: MeshError },
}

impl Shape {
    /// Whether `p` [m] belongs to the shape; a place that is not finite belongs to none.
    #[inline]
    pub fn contains(&self, p: &Vec3) -> bool {
        p.x.is_finite() && p.y.is_finite() && p.z.is_finite() && self.solid.contains(p) != self.outside
    }

    /// Reads a shape; `load` reads the file of a `mesh:`.
    ///
    /// # Errors
    /// Anything that is no shape, with the place in the text; files that cannot be read.
    pub fn parse(text: &str, load: &dyn Fn(&str) -> Result<TriMesh, String>) -> Result<Shape, ShapeError> {
        let (outside, body) = match text.strip_prefix('!') {
            Some(rest) => (true, rest),
            None => (false, text),
        };
        let Some((kind, rest)) = body.split_once(':') else { return Err(ShapeError::Kind(text.to_owned())) };
        let offset = text.chars().count() - rest.chars().count();
        let solid = Solid::parse(kind, rest, text, offset, load)?;
        Ok(Shape { solid, outside })
    }
}

impl FromStr for Shape {
    type Err = ShapeError;

    /// As [`Shape::parse`], but without meshes.
    fn from_str(text: &str) -> Result<Shape, ShapeError> {
        Shape::parse(text, &|_| Err("meshes cannot be read here: use another shape".into()))
    }
}

impl Solid {
    fn parse(
        kind: &str,
        rest: &str,
        whole: &str,
        offset: usize,
        load: &dyn Fn(&str) -> Result<TriMesh, String>,
    ) -> Result<Solid, ShapeError> {
        let text = || whole.to_owned();
        let wrong = |source| ShapeError::Numbers { text: text(), source };
        Ok(match kind {
            "box" => {
                let [x0, y0, z0, x1, y1, z1] = numbers(rest, offset).map_err(wrong)?;
                let (a, b) = (Vec3::new(x0, y0, z0), Vec3::new(x1, y1, z1));
                Solid::Box(a.inf(&b), a.sup(&b))
            }
            "sphere" => {
                let [x, y, z, r] = numbers(rest, offset).map_err(wrong)?;
                Solid::Sphere(Vec3::new(x, y, z), positive(r, whole)?)
            }
            "cylinder" => {
                let [x0, y0, z0, x1, y1, z1, r] = numbers(rest, offset).map_err(wrong)?;
                if [x0, y0, z0] == [x1, y1, z1] {
                    return Err(ShapeError::NoAxis { text: text() });
                }
                Solid::Cylinder(Vec3::new(x0, y0, z0), Vec3::new(x1, y1, z1), positive(r, whole)?)
            }
            "cone" => {
                let [x0, y0, z0, x1, y1, z1, r0, r1] = numbers(rest, offset).map_err(wrong)?;
                if [x0, y0, z0] == [x1, y1, z1] {
                    return Err(ShapeError::NoAxis { text: text() });
                }
                // A cone may end in a point, but not in two.
                positive(r0.max(r1), whole)?;
                for radius in [r0, r1].into_iter().filter(|r| *r != 0.0) {
                    positive(radius, whole)?;
                }
                Solid::Cone(Vec3::new(x0, y0, z0), Vec3::new(x1, y1, z1), [r0, r1])
            }
            "halfspace" => {
                let [px, py, pz, nx, ny, nz] = numbers(rest, offset).map_err(wrong)?;
                let plane = Plane::new(Vec3::new(px, py, pz), Vec3::new(nx, ny, nz));
                Solid::Halfspace(plane.map_err(|source| ShapeError::Plane { text: text(), source })?)
            }
            "prism" => {
                let json = std::fs::read_to_string(rest)
                    .map_err(|source| ShapeError::Read { text: text(), source })?;
                let prism = Prism::from_json(&json);
                Solid::Prism(prism.map_err(|source| ShapeError::Prism { text: text(), source })?)
            }
            "mesh" => {
                let mesh = load(rest).map_err(|why| ShapeError::Load { text: text(), why })?;
                let inside = Inside::new(&mesh);
                Solid::Mesh(inside.map_err(|source| ShapeError::Mesh { text: text(), source })?)
            }
            _ => return Err(ShapeError::Kind(text())),
        })
    }

    /// Whether `p` [m] is in the solid or on its surface.
    #[inline]
    pub fn contains(&self, p: &Vec3) -> bool {
        match self {
            Solid::Box(lo, hi) => (0..3).all(|a| lo[a] <= p[a] && p[a] <= hi[a]),
            Solid::Sphere(centre, radius) => (p - centre).norm_squared() <= radius * radius,
            Solid::Cylinder(start, end, radius) => is_in_cone(p, start, end, [*radius; 2]),
            Solid::Cone(start, end, radii) => is_in_cone(p, start, end, *radii),
            Solid::Halfspace(plane) => plane.signed_distance(p) >= 0.0,
            Solid::Prism(prism) => prism.contains(p),
            Solid::Mesh(inside) => inside.contains(p),
        }
    }
}

/// Both ends of the axis [m] and the radius at each [m].
fn is_in_cone(p: &Vec3, start: &Vec3, end: &Vec3, [r0, r1]: [f64; 2]) -> bool {
    let (axis, from) = (end - start, p - start);
    let share = from.dot(&axis) / axis.norm_squared();
    let radius = r0 + (r1 - r0) * share;
    (0.0..=1.0).contains(&share) && (from - axis * share).norm_squared() <= radius * radius
}

fn positive(radius: f64, text: &str) -> Result<f64, ShapeError> {
    if radius > 0.0 { Ok(radius) } else { Err(ShapeError::Radius { text: text.to_owned(), radius }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cuboid;

    fn has(shape: &str, x: f64, y: f64, z: f64) -> bool {
        shape.parse::<Shape>().unwrap().contains(&Vec3::new(x, y, z))
    }

    #[test]
    fn every_shape_has_an_inside_and_an_outside() {
        for (shape, inside, outside) in [
            ("box:0,0,0,1,1,1", [0.5, 0.5, 1.0], [0.5, 0.5, 1.1]),
            ("box:1,1,1,0,0,0", [0.5, 0.5, 1.0], [0.5, 0.5, 1.1]),
            ("sphere:1,0,0,0.5", [1.3, 0.3, 0.0], [1.4, 0.4, 0.0]),
            ("cylinder:0,0,0,0,0,2,1", [0.6, 0.6, 1.9], [0.6, 0.6, 2.1]),
            ("cone:0,0,0,0,0,2,1,0", [0.45, 0.0, 1.0], [0.45, 0.0, 1.2]),
            ("halfspace:0,0,1,0,0,-2", [9.0, 9.0, 0.5], [0.0, 0.0, 1.5]),
        ] {
            for (place, expected) in [(inside, true), (outside, false)] {
                let [x, y, z] = place;
                assert_eq!(has(shape, x, y, z), expected, "{shape}");
                assert_eq!(has(&format!("!{shape}"), x, y, z), !expected, "!{shape}");
            }
        }
        assert!(!has("!sphere:0,0,0,1", f64::NAN, 0.0, 0.0), "a place that is nowhere is in no shape");
    }

    #[test]
    fn a_mesh_comes_from_the_loader() {
        let load = |_: &str| Ok(cuboid(Vec3::zeros(), Vec3::repeat(1.0)));
        let shape = Shape::parse("!mesh:x.ply", &load).unwrap();
        assert!(shape.contains(&Vec3::repeat(2.0)) && !shape.contains(&Vec3::repeat(0.5)));
        assert!("mesh:x.ply".parse::<Shape>().is_err());
    }

    #[test]
    fn wrong_texts_say_what_and_where() {
        for (text, part) in [
            ("ball:1", "sphere:x,y,z,r"),
            ("box", "is not a shape"),
            ("box:0,0,0,1,1", "6 numbers wanted, separated by commas, and 5 found"),
            ("sphere:0,0,zero,1", "'zero' at character 12"),
            ("!sphere:0,0,nan,1", "'nan' at character 13"),
            ("sphere:0,0,0,-1", "radius -1 m must be positive"),
            ("cylinder:1,1,1,1,1,1,1", "same point"),
            ("cone:0,0,0,0,0,1,0,0", "radius 0 m must be positive"),
            ("cone:0,0,0,0,0,1,1,-1", "radius -1 m must be positive"),
            ("halfspace:0,0,0,0,0,0", "no length"),
            ("prism:/nowhere.json", "cannot read"),
        ] {
            let message = text.parse::<Shape>().unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
