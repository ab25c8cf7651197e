use super::*;
use crate::stone::tests::ball;
use geom::mesh::cuboid;

const PLAIN: CleanSettings = CleanSettings { faces: None, cells: None };

fn both(a: &TriMesh, b: &TriMesh) -> TriMesh {
    joined([a, b])
}

fn close(found: f64, wanted: f64, tolerance: f64) {
    assert!((found / wanted - 1.0).abs() < tolerance, "{found}, not {wanted}");
}

#[test]
fn a_closed_mesh_stays_and_loses_islands_and_inward_faces() {
    let stone = ball(0.05, 4);
    let mut mesh = both(&stone, &cuboid(Vec3::repeat(0.2), Vec3::repeat(0.201)));
    mesh.faces.iter_mut().step_by(3).for_each(|f| f.swap(1, 2));
    let (found, changes) = clean_mesh(&mesh, &PLAIN).unwrap();
    close(found.moments.volume, stone.volume(), 1e-12);
    assert_eq!(
        (changes.islands, changes.rebuilt.clone(), changes.faces),
        (1, None, stone.faces.len()),
        "{changes:?}"
    );
    assert!(changes.turned > 600 && changes.islands_area < 0.01, "{changes:?}");
}

#[test]
fn holes_close_and_volume_stays() {
    let mut stone = ball(0.05, 4);
    let volume = stone.volume();
    // A hole of 3 % of the area, and a face doubled.
    stone.faces.retain(|f| f.iter().any(|v| stone.vertices[*v as usize].z < 0.047));
    stone.faces.push(stone.faces[7]);
    let (found, changes) = clean_mesh(&stone, &CleanSettings { faces: Some(1000), cells: Some(60) }).unwrap();
    close(found.moments.volume, volume, 0.015);
    close(changes.volume, changes.volume_before, 0.001);
    assert!(changes.open_edges > 0 && changes.faces <= 1000 && changes.faces > 990, "{changes:?}");
    let closed = changes.closed_area.unwrap();
    assert!((0.01..0.04).contains(&closed), "{closed}");
    assert!(changes.rebuilt.unwrap().contains("do not join two faces"));
}

#[test]
fn bodies_that_cross_become_one() {
    let mesh =
        both(&cuboid(Vec3::zeros(), Vec3::repeat(0.1)), &cuboid(Vec3::repeat(0.05), Vec3::repeat(0.15)));
    let (found, changes) = clean_mesh(&mesh, &CleanSettings { cells: Some(45), ..PLAIN }).unwrap();
    close(found.moments.volume, 2.0 * 0.001 - 0.05f64.powi(3), 0.01);
    assert_eq!(changes.islands, 0);
}

/// Faces of one body lie inside the other, on nodes of the samples: they are no surface.
#[test]
fn a_post_that_stands_in_a_slab_stays() {
    let slab = cuboid(Vec3::zeros(), Vec3::new(0.04, 0.03, 0.01));
    let post = cuboid(Vec3::new(0.01, 0.01, 0.008), Vec3::new(0.021, 0.019, 0.028));
    for cells in [Some(40), Some(80), None] {
        let (found, changes) = clean_mesh(&both(&slab, &post), &CleanSettings { cells, ..PLAIN }).unwrap();
        close(found.moments.volume, 1.3782e-5, if cells == Some(40) { 0.05 } else { 0.025 });
        assert_eq!(changes.islands, 0);
    }
}

#[test]
fn a_cloud_with_and_without_normals_becomes_a_stone() {
    let stone = ball(0.05, 4);
    let mut points = stone.vertices.clone();
    points.iter_mut().for_each(|p| p.z *= 0.6);
    let normals: Vec<Vec3> = points.iter().map(|p| Vec3::new(p.x, p.y, p.z / 0.36)).collect();
    for given in [None, Some(&normals[..])] {
        let (found, changes) = clean_cloud(&points, given, &PLAIN).unwrap();
        close(found.moments.volume, 0.6 * 4.0 / 3.0 * std::f64::consts::PI * 0.05f64.powi(3), 0.02);
        assert!(changes.faces > 500, "{changes:?}");
    }
    assert_eq!(clean_cloud(&points[..50], None, &PLAIN).err(), Some(CleanError::Points(50)));
}

#[test]
fn what_encloses_nothing_is_refused() {
    let sheet = TriMesh { vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y()], faces: vec![[0, 1, 2]] };
    assert_eq!(
        clean_mesh(&sheet, &CleanSettings { cells: Some(40), ..PLAIN }).err(),
        Some(CleanError::Nothing)
    );
    assert!(clean_mesh(&TriMesh::default(), &PLAIN).is_err());
}

/// As written by programs that round the corners of each face by itself.
#[test]
fn corners_that_rounding_has_parted_are_joined() {
    let stone = ball(0.05, 3);
    for apart in [1e-9, 1e-8, 4e-6] {
        let mut soup = TriMesh::default();
        for (k, face) in (0u32..).zip(stone.triangles()) {
            let noise = |c: u32| f64::from((7919 * (3 * k + c) + 13) % 101) / 100.0 - 0.5;
            let corner = |c: u32| face[c as usize] + Vec3::new(noise(c), noise(c + 1), noise(c + 2)) * apart;
            soup.vertices.extend([0, 1, 2].map(corner));
            soup.faces.push([3 * k, 3 * k + 1, 3 * k + 2]);
        }
        let (found, changes) = clean_mesh(&soup, &PLAIN).unwrap();
        close(found.moments.volume, stone.volume(), 1e-3);
        assert_eq!((changes.open_edges, &changes.rebuilt, changes.faces), (0, &None, stone.faces.len()));
        assert!(changes.welded > 0 && changes.welded_within.is_some_and(|d| d < 1e-4), "{changes:?}");
    }
    assert_eq!(clean_mesh(&stone, &PLAIN).unwrap().1.welded, 0);
}

#[test]
fn normals_of_random_sign_are_turned_and_a_thin_plate_keeps_its_own() {
    let stone = ball(0.05, 4);
    let sign = |k: usize| if (k * 7919 + 13) % 97 < 48 { -1.0 } else { 1.0 };
    let normals: Vec<Vec3> =
        stone.vertices.iter().enumerate().map(|(k, p)| p.normalize() * sign(k)).collect();
    let (found, changes) = clean_cloud(&stone.vertices, Some(&normals), &PLAIN).unwrap();
    close(found.moments.volume, stone.volume(), 0.02);
    assert!(changes.normals_turned > stone.vertices.len() / 3, "{changes:?}");
    let outwards: Vec<Vec3> = stone.vertices.iter().map(|p| p.normalize()).collect();
    assert_eq!(clean_cloud(&stone.vertices, Some(&outwards), &PLAIN).unwrap().1.normals_turned, 0);
    // All inwards is one side, too.
    let inwards: Vec<Vec3> = outwards.iter().map(|n| -n).collect();
    let (found, changes) = clean_cloud(&stone.vertices, Some(&inwards), &PLAIN).unwrap();
    close(found.moments.volume, stone.volume(), 0.02);
    assert_eq!(changes.normals_turned, 0);
}

#[test]
fn a_hollow_inside_is_counted() {
    let mut hollow = cuboid(Vec3::repeat(0.02), Vec3::repeat(0.05));
    let solid = cuboid(Vec3::zeros(), Vec3::repeat(0.1));
    for inwards in [false, true] {
        if inwards {
            hollow.faces.iter_mut().for_each(|f| f.swap(1, 2));
        }
        let (found, changes) = clean_mesh(&both(&solid, &hollow), &PLAIN).unwrap();
        close(found.moments.volume, 1e-3, 1e-9);
        assert_eq!(changes.hollows, 1);
        close(changes.hollow_volume, 0.03f64.powi(3), 1e-9);
    }
    let beside = cuboid(Vec3::repeat(0.2), Vec3::repeat(0.25));
    assert_eq!(clean_mesh(&both(&solid, &beside), &PLAIN).unwrap().1.hollows, 0);
}
