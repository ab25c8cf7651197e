//! `[[wall]] solid`: the surface of a solid, as a mesh or a sphere. Both sides act.

use dem::setup::WallShape;
use geom::mesh::{TriMesh, cuboid};
use geom::shape::Solid;
use geom::{Shape, Vec3};
use std::f64::consts::TAU;

/// Facets around a cylinder or a cone: its surface is at most 1.2e-3 of the radius inside of the round one.
const FACETS: u32 = 64;

/// The wall that a shape describes, or why it is none and what to do.
///
/// # Errors
/// A shape that is unbounded, has no inside, or comes from a file.
pub fn wall(shape: &Shape) -> Result<WallShape, (&'static str, &'static str)> {
    if shape.outside {
        return Err((
            "both sides of a solid act, for grains outside of it as for grains in it",
            "take the ! out",
        ));
    }
    match &shape.solid {
        Solid::Box(low, high) if (0..3).any(|a| low[a] >= high[a]) => {
            Err(("has no inside", "give a plate a thickness, such as 2 mm"))
        }
        Solid::Box(low, high) => Ok(WallShape::Mesh(cuboid(*low, *high))),
        Solid::Sphere(centre, radius) => Ok(WallShape::Spheres(vec![(*centre, *radius)])),
        Solid::Cylinder(start, end, radius) => frustum(start, end, [*radius; 2]),
        Solid::Cone(start, end, radii) => frustum(start, end, *radii),
        Solid::Halfspace(_) => Err(("is unbounded", "give it as plane")),
        Solid::Mesh(_) => Err(("is a file", "give it as mesh")),
        Solid::Prism(_) => Err(("is not among the solids", "give box, cylinder, cone or sphere, or a mesh")),
    }
}

/// A cylinder or a cone with its ends closed; its corners are on the round surface.
fn frustum(start: &Vec3, end: &Vec3, radii: [f64; 2]) -> Result<WallShape, (&'static str, &'static str)> {
    let axis = (end - start).normalize();
    let across = axis.cross(&Vec3::ith(axis.iamin(), 1.0)).normalize();
    let up = axis.cross(&across);
    let mut vertices = vec![*start, *end];
    let mut faces = Vec::new();
    let ring = |vertices: &mut Vec<Vec3>, centre: &Vec3, radius: f64| {
        let first = vertices.len() as u32;
        let corner = |k: u32| {
            let angle = TAU * f64::from(k) / f64::from(FACETS);
            centre + (across * libm::cos(angle) + up * libm::sin(angle)) * radius
        };
        vertices.extend((0..FACETS).map(corner));
        first
    };
    // A tip is the end of the axis itself.
    let rings = [(start, radii[0]), (end, radii[1])]
        .map(|(centre, radius)| if radius > 0.0 { Some(ring(&mut vertices, centre, radius)) } else { None });
    for k in 0..FACETS {
        let next = (k + 1) % FACETS;
        match rings {
            [Some(a), Some(b)] => {
                faces.push([a + k, a + next, b + next]);
                faces.push([a + k, b + next, b + k]);
            }
            [Some(a), None] => faces.push([a + k, a + next, 1]),
            [None, Some(b)] => faces.push([0, b + next, b + k]),
            [None, None] => {}
        }
        if let Some(a) = rings[0] {
            faces.push([0, a + next, a + k]);
        }
        if let Some(b) = rings[1] {
            faces.push([1, b + k, b + next]);
        }
    }
    let mesh = TriMesh::new(vertices, faces).map_err(|_| ("is no solid", "give other numbers"))?;
    Ok(WallShape::Mesh(mesh))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Moments;

    fn volume(text: &str) -> f64 {
        let WallShape::Mesh(mesh) = wall(&text.parse().unwrap()).unwrap() else { panic!("{text}: no mesh") };
        Moments::of_mesh(&mesh.welded()).unwrap().volume
    }

    #[test]
    fn solids_are_closed_and_have_their_volume() {
        let pi = std::f64::consts::PI;
        for (text, exact) in [
            ("box:0,0,0,1,2,3", 6.0),
            ("cylinder:0,0,0,0,0,2,0.5", 0.5 * pi),
            ("cylinder:1,2,3,2,3,4,0.5", 0.25 * pi * 3_f64.sqrt()),
            ("cone:0,0,0,0,3,0,1,0", pi),
            ("cone:0,0,0,-3,0,0,0,1", pi),
            ("cone:0,0,0,0,0,3,1,2", 7.0 * pi),
        ] {
            let found = volume(text);
            assert!((found - exact).abs() < 2e-3 * exact, "{text}: {found} m³, not {exact}");
        }
    }

    #[test]
    fn what_is_no_solid_says_what_to_give() {
        for (text, part) in [
            ("!box:0,0,0,1,1,1", "take the ! out"),
            ("box:0,0,0,1,1,0", "thickness"),
            ("halfspace:0,0,0,0,0,1", "plane"),
        ] {
            let (_, cure) = wall(&text.parse().unwrap()).unwrap_err();
            assert!(cure.contains(part), "{text}: {cure}");
        }
    }
}
