//! Walls by themselves.

use super::*;
use laws::simd::number::Layout;
use laws::space::sphere::away;

/// A particle that is out of the calculation touches no shape of wall, whichever way it faces.
#[test]
fn no_wall_is_met_far_away() {
    let plane = |normal: Vec3| {
        WallShape::Plane(Plane { point: Vec3::new(0.1, 0.2, 0.3), normal: normal.normalize() })
    };
    let corners = [Vec3::zeros(), Vec3::x(), Vec3::y()];
    let mesh = geom::mesh::TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).expect("sound");
    let shapes = [
        plane(Vec3::new(-1.0, 0.0, 1.0)),
        plane(Vec3::new(1.0, -1.0, 0.0)),
        plane(Vec3::new(1.0, 1.0, -2.0)),
        plane(Vec3::new(1.0, 1.0, 1.0)),
        WallShape::Mesh(mesh),
        WallShape::Spheres(vec![(Vec3::zeros(), 1.0)]),
    ];
    for shape in shapes {
        let wall = Wall::new("w", 0, shape);
        let body = WallBody::new(&wall, 0.0, 0.0);
        for k in [0, 1, 2, 1_000_000] {
            let [x, y, z] = away(k);
            let row = Row([x, y, z, 0.01, 0.0, 0.0, 0.0, 1.0]);
            let mut found = [Row::default()];
            let history = &mut [];
            let active = &mut [];
            let (layout, ledger) = (Layout::default(), &mut [][..]);
            let slots = HistorySlots { history, active, layout, first: 0, columns: 0, ledger };
            let pose = body.pose(&wall.motion.pose(0.0));
            let walls = (&[][..], 0);
            body.contact_points(
                walls,
                (&pose, &Vec3::zeros()),
                &row,
                &[0],
                (&mut found, &mut []),
                (slots, &mut Nearby::default()),
            );
            let square: f64 = (0..3).map(|a| (found[0][a] - row[a]).powi(2)).sum();
            assert!(square.is_finite() && square > 1e200, "{:?}, row {k}: {square}", wall.shape);
        }
    }
}
