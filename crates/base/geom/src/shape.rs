//! Shapes that keep or remove points, as the command line and region files write them.
//!
//! ```text
//! box:x0,y0,z0,x1,y1,z1 | sphere:x,y,z,r | cylinder:x0,y0,z0,x1,y1,z1,r
//! cone:x0,y0,z0,x1,y1,z1,r0,r1 | halfspace:px,py,pz,nx,ny,nz | prism:FILE.json        ! in front: outside
//! mesh:FILE | mesh:FILE,units=mm | mesh:FILE,scale=0.001 | mesh:FILE,transform=MATRIX.txt
//! ```

use crate::Vec3;
use crate::mesh::{Inside, MeshError};
use crate::numbers::{NumbersError, numbers};
use crate::plane::{Plane, PlaneError};
use crate::prism::{Prism, PrismError};
use crate::transform::TransformError;
use std::str::FromStr;
use thiserror::Error;

mod files;

pub use files::{ShapeFiles, files_of, with_files};

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
         cone:x0,y0,z0,x1,y1,z1,r0,r1, halfspace:px,py,pz,nx,ny,nz, prism:FILE.json or mesh:FILE (with its unit or a matrix: mesh:FILE,units=mm,transform=MATRIX.txt); a ! before a shape means its outside"
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
    #[error("shape '{text}': {source}")]
    Prism { text: String, source: PrismError },
    #[error("shape '{text}': {why}: write units=mm, cm, m, in or ft, or scale=FACTOR")]
    Lengths { text: String, why: String },
    #[error("shape '{text}': transform: {source}")]
    Transform { text: String, source: TransformError },
    #[error(
        "shape '{text}': {name}= is given a second time, or beside what does the same: give units= or scale=, and transform=, each once"
    )]
    Twice { text: String, name: String },
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

    /// Reads a shape; `files` reads those that it names.
    ///
    /// # Errors
    /// Anything that is no shape, with the place in the text; files that cannot be read.
    pub fn parse(text: &str, files: &dyn ShapeFiles) -> Result<Shape, ShapeError> {
        let (outside, body) = match text.strip_prefix('!') {
            Some(rest) => (true, rest),
            None => (false, text),
        };
        let Some((kind, rest)) = body.split_once(':') else { return Err(ShapeError::Kind(text.to_owned())) };
        let solid = Solid::parse(&ShapeText { whole: text, kind, rest }, files)?;
        Ok(Shape { solid, outside })
    }
}

impl FromStr for Shape {
    type Err = ShapeError;

    /// As [`Shape::parse`], but without meshes.
    fn from_str(text: &str) -> Result<Shape, ShapeError> {
        Shape::parse(text, &|_: &str| Err("meshes cannot be read here: use another shape".into()))
    }
}

/// A shape as the user wrote it; its errors name the whole of it.
struct ShapeText<'a> {
    whole: &'a str,
    /// What stands before the colon, without a `!`.
    kind: &'a str,
    /// What stands behind the colon.
    rest: &'a str,
}

impl ShapeText<'_> {
    fn owned(&self) -> String {
        self.whole.to_owned()
    }

    fn numbers<const N: usize>(&self) -> Result<[f64; N], ShapeError> {
        let offset = self.whole.chars().count() - self.rest.chars().count();
        numbers(self.rest, offset).map_err(|source| ShapeError::Numbers { text: self.owned(), source })
    }

    fn positive(&self, radius: f64) -> Result<f64, ShapeError> {
        if radius > 0.0 { Ok(radius) } else { Err(ShapeError::Radius { text: self.owned(), radius }) }
    }

    /// The radii at both ends of a cone: it may end in a point, but not in two.
    fn cone_radii(&self, radii: [f64; 2]) -> Result<[f64; 2], ShapeError> {
        self.positive(radii[0].max(radii[1]))?;
        for radius in radii.into_iter().filter(|r| *r != 0.0) {
            self.positive(radius)?;
        }
        Ok(radii)
    }

    /// The ends of an axis, which must be apart.
    fn axis(&self, a: [f64; 3], b: [f64; 3]) -> Result<[Vec3; 2], ShapeError> {
        if a == b { Err(ShapeError::NoAxis { text: self.owned() }) } else { Ok([a.into(), b.into()]) }
    }
}

impl Solid {
    fn parse(text: &ShapeText<'_>, files: &dyn ShapeFiles) -> Result<Solid, ShapeError> {
        Ok(match text.kind {
            "box" => {
                let [x0, y0, z0, x1, y1, z1] = text.numbers()?;
                let (a, b) = (Vec3::new(x0, y0, z0), Vec3::new(x1, y1, z1));
                Solid::Box(a.inf(&b), a.sup(&b))
            }
            "sphere" => {
                let [x, y, z, r] = text.numbers()?;
                Solid::Sphere(Vec3::new(x, y, z), text.positive(r)?)
            }
            "cylinder" => {
                let [x0, y0, z0, x1, y1, z1, r] = text.numbers()?;
                let [a, b] = text.axis([x0, y0, z0], [x1, y1, z1])?;
                Solid::Cylinder(a, b, text.positive(r)?)
            }
            "cone" => {
                let [x0, y0, z0, x1, y1, z1, r0, r1] = text.numbers()?;
                let [a, b] = text.axis([x0, y0, z0], [x1, y1, z1])?;
                Solid::Cone(a, b, text.cone_radii([r0, r1])?)
            }
            "halfspace" => {
                let [px, py, pz, nx, ny, nz] = text.numbers()?;
                let plane = Plane::new(Vec3::new(px, py, pz), Vec3::new(nx, ny, nz));
                Solid::Halfspace(plane.map_err(|source| ShapeError::Plane { text: text.owned(), source })?)
            }
            "prism" => Solid::Prism(read_prism(text, files)?),
            "mesh" => Solid::Mesh(load_mesh(text, files)?),
            _ => return Err(ShapeError::Kind(text.owned())),
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

fn read_prism(text: &ShapeText<'_>, files: &dyn ShapeFiles) -> Result<Prism, ShapeError> {
    let load = |why| ShapeError::Load { text: text.owned(), why };
    let json = String::from_utf8(files::bytes(text.rest, files).map_err(load)?)
        .map_err(|_| load(format!("{} is no text: give the JSON of a prism", text.rest)))?;
    Prism::from_json(&json).map_err(|source| ShapeError::Prism { text: text.owned(), source })
}

fn load_mesh(text: &ShapeText<'_>, files: &dyn ShapeFiles) -> Result<Inside, ShapeError> {
    let mesh = files::mesh(text, files)?;
    Inside::new(&mesh).map_err(|source| ShapeError::Mesh { text: text.owned(), source })
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
        let load = |_: &str| Ok::<_, String>(cuboid(Vec3::zeros(), Vec3::repeat(1.0)));
        let shape = Shape::parse("!mesh:x.ply", &load).unwrap();
        assert!(shape.contains(&Vec3::repeat(2.0)) && !shape.contains(&Vec3::repeat(0.5)));
        assert!("mesh:x.ply".parse::<Shape>().is_err());
        for (text, size) in [("units=mm", 1e-3), ("units=cm", 1e-2), ("scale=2", 2.0)] {
            let shape = Shape::parse(&format!("mesh:a,b.stl,{text}"), &load).unwrap();
            assert!(shape.contains(&Vec3::repeat(0.9 * size)) && !shape.contains(&Vec3::repeat(1.1 * size)));
        }
        for text in ["units=kg", "scale=0", "scale=x"] {
            let message = Shape::parse(&format!("mesh:a.stl,{text}"), &load).unwrap_err().to_string();
            assert!(message.contains("write units=mm"), "{message}");
        }
    }

    #[test]
    fn the_files_of_a_shape_are_known_and_can_be_renamed() {
        for (text, files, renamed) in [
            ("!mesh:x.ply", vec!["x.ply"], "!mesh:in/x.ply"),
            ("mesh:a,b.stl,units=mm", vec!["a,b.stl"], "mesh:in/a,b.stl,units=mm"),
            (
                "mesh:x,transform=a,b.txt,scale=2",
                vec!["x", "a,b.txt"],
                "mesh:in/x,transform=in/a,b.txt,scale=2",
            ),
            ("mesh:x,transform=1,0,0,0,0,1", vec!["x"], "mesh:in/x,transform=1,0,0,0,0,1"),
            ("prism:p.json", vec!["p.json"], "prism:in/p.json"),
            ("box:0,0,0,1,1,1", vec![], "box:0,0,0,1,1,1"),
            ("C:x", vec![], "C:x"),
        ] {
            assert_eq!(files_of(text), files, "{text}");
            assert_eq!(with_files(text, |file| format!("in/{file}")), renamed);
        }
    }

    /// First the unit, then the matrix: x̂ ↦ ŷ ↦ −x̂, then (5 849 000, 20, 30).
    #[test]
    fn a_matrix_puts_a_mesh_elsewhere() {
        let load = |_: &str| Ok::<_, String>(cuboid(Vec3::zeros(), Vec3::new(1000.0, 2000.0, 3000.0)));
        let matrix = "0,-1,0,5849000,1,0,0,20,0,0,1,30,0,0,0,1";
        for text in [
            format!("mesh:a.stl,units=mm,transform={matrix}"),
            format!("mesh:a.stl,transform={matrix},scale=0.001"),
            format!("mesh:a.stl,transform={},units=mm", matrix.replace(',', " ")),
        ] {
            let shape = Shape::parse(&text, &load).unwrap();
            for (at, inside) in [
                ([-1.9999, 0.0001, 0.0001], true),
                ([-0.0001, 0.9999, 2.9999], true),
                ([-2.0001, 0.5, 1.0], false),
                ([-1.0, 1.0001, 1.0], false),
                ([0.5, 0.5, 1.0], false),
            ] {
                let p = Vec3::new(5_849_000.0, 20.0, 30.0) + Vec3::from(at);
                assert_eq!(shape.contains(&p), inside, "{text}: {p}");
            }
        }
        for (options, part) in [
            ("transform=1,0,0", "3 numbers where a matrix has 16"),
            ("transform=/nowhere.txt", "cannot read /nowhere.txt"),
            ("transform=-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1", "the matrix mirrors"),
            ("units=mm,scale=2", "scale= is given a second time"),
            ("units=mm,units=mm", "units= is given a second time"),
        ] {
            let message = Shape::parse(&format!("mesh:a.stl,{options}"), &load).unwrap_err().to_string();
            assert!(message.contains(part), "{options}: {message}");
        }
    }

    #[test]
    fn wrong_texts_say_what_and_where() {
        for (text, part) in [
            ("ball:1", "sphere:x,y,z,r"),
            ("box", "is not a shape"),
            ("box:0,0,0,1,1", "expected 6 numbers, separated by commas, and found 5"),
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
