//! The box around a solid.

use crate::Vec3;
use crate::shape::Solid;

impl Solid {
    /// Lowest and highest corner of a box around the solid [m]; infinite for a half space.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        match self {
            Solid::Box(low, high) => (*low, *high),
            Solid::Sphere(centre, radius) => (centre.add_scalar(-radius), centre.add_scalar(*radius)),
            Solid::Cylinder(a, b, radius) => (a.inf(b).add_scalar(-radius), a.sup(b).add_scalar(*radius)),
            Solid::Cone(a, b, radii) => {
                let [low, high] = [-1.0, 1.0].map(|side| [side * radii[0], side * radii[1]]);
                let ends = |[ra, rb]: [f64; 2]| (a.add_scalar(ra), b.add_scalar(rb));
                let ((a_low, b_low), (a_high, b_high)) = (ends(low), ends(high));
                (a_low.inf(&b_low), a_high.sup(&b_high))
            }
            Solid::Halfspace(_) => (Vec3::repeat(f64::NEG_INFINITY), Vec3::repeat(f64::INFINITY)),
            Solid::Prism(prism) => prism.bounds(),
            Solid::Mesh(inside) => inside.bounds(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prism::Prism;
    use crate::shape::Shape;

    #[test]
    fn the_box_around_a_solid_holds_its_surface() {
        for (shape, low, high) in [
            ("box:1,1,1,0,0,0", [0.0, 0.0, 0.0], [1.0, 1.0, 1.0]),
            ("sphere:1,0,0,0.5", [0.5, -0.5, -0.5], [1.5, 0.5, 0.5]),
            ("cylinder:0,0,0,0,0,2,1", [-1.0, -1.0, -1.0], [1.0, 1.0, 3.0]),
            ("cone:0,0,0,0,0,2,1,0", [-1.0, -1.0, -1.0], [1.0, 1.0, 2.0]),
        ] {
            let bounds = shape.parse::<Shape>().unwrap().solid.bounds();
            assert_eq!(bounds, (low.into(), high.into()), "{shape}");
        }
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
        let prism = Prism::new(&square, Vec3::new(0.5, 0.0, -3.0)).unwrap();
        let (low, high) = Solid::Prism(prism).bounds();
        assert!((low - Vec3::new(0.0, 0.0, -3.0)).norm() < 1e-12, "{low}");
        assert!((high - Vec3::new(1.5, 2.0, 0.0)).norm() < 1e-12, "{high}");
        assert!("halfspace:0,0,1,0,0,-2".parse::<Shape>().unwrap().solid.bounds().0.x.is_infinite());
    }
}
