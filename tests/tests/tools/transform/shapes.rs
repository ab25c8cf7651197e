//! A matrix in the text of a SHAPE.

use super::{QUARTER, inputs, numbers, read, rotation};
use geom::{Transform, Vec3};
use grainpipe_tests::tools::{line, succeed, tool};
use std::fs;

/// A shape of a mesh that a matrix moves is the shape of the moved mesh: points in it, porosity, residence, flow; beside a file of regions, in a scene.
#[test]
fn a_shape_with_a_matrix_is_the_shape_of_the_moved_mesh() {
    let folder = inputs();
    let f = folder.path();
    let by = Transform::parse(QUARTER).unwrap();
    let mut mesh = geom::mesh::cuboid(Vec3::repeat(-0.0051), Vec3::new(0.1051, 0.2051, 0.3));
    let write = |name: &str, mesh: &geom::mesh::TriMesh| {
        let mut bytes = Vec::new();
        cloud::write_mesh(&mut bytes, mesh, stream::ply::Encoding::Ascii).unwrap();
        fs::write(f.join(name), bytes).unwrap();
    };
    write("block.ply", &mesh);
    mesh.scale(1000.0);
    write("millimetres.ply", &mesh);
    mesh.scale(0.001);
    mesh.transform(&by);
    write("there.ply", &mesh);
    succeed(f, "cloud-crop", &["sheet.xyz", "--transform", "quarter.txt", "-o", "far.ply"]);
    let crop = |shape: &str| {
        succeed(f, "cloud-crop", &["far.ply", "--keep", shape, "-o", "kept.ply"]);
        read(f, "kept.ply").points
    };
    let wanted = crop("mesh:there.ply");
    assert_eq!(wanted.len(), 11 * 21);
    assert_eq!(crop("mesh:block.ply,transform=quarter.txt"), wanted);
    assert_eq!(crop("mesh:millimetres.ply,units=mm,transform=quarter.txt"), wanted);
    assert_eq!(crop("!mesh:block.ply,transform=quarter.txt").len(), 41 * 41 - wanted.len());
    fs::create_dir(f.join("plant")).unwrap();
    for name in ["block.ply", "quarter.txt"] {
        fs::copy(f.join(name), f.join("plant").join(name)).unwrap();
    }
    let regions =
        "[[region]]\nname = \"a\"\nshape = \"mesh:block.ply,transform=quarter.txt\"\naction = \"keep\"\n";
    fs::write(f.join("plant/regions.toml"), regions).unwrap();
    fs::remove_file(f.join("block.ply")).unwrap();
    succeed(f, "cloud-crop", &["far.ply", "--regions", "plant/regions.toml", "-o", "kept.ply"]);
    assert_eq!(read(f, "kept.ply").points, wanted);
    let scene = "[time]\nuntil = 0.02\n[output]\nevery = 0.01\n[[material]]\nname = \"m\"\ndensity = 1000\nyoung = 1e6\n\
        poisson = 0.3\n[[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\n[[fill]]\nmaterial = \"m\"\ndiameter = 0.02\ncount = 80\n\
        velocity = [0.5, 0, 0]\n";
    fs::write(f.join("plant/s.toml"), format!("{scene}shape = \"mesh:block.ply,transform=quarter.txt\"\n"))
        .unwrap();
    fs::write(f.join("s.toml"), format!("{scene}shape = \"mesh:there.ply\"\n")).unwrap();
    let particles = |scene: &str| {
        succeed(f, "dem-run", &[scene, "-q", "-o", "run.mcap"]);
        line(f, "dem-measure run.mcap --track 0,1,2,79 --all").stdout
    };
    assert!(particles("plant/s.toml") == particles("s.toml"), "a fill of the moved mesh");
    for words in [
        "--porosity SHAPE",
        "--residence SHAPE",
        "--flow 9.9,20,30,1,0,0 --within SHAPE",
        "--strain --within SHAPE",
    ] {
        let of = |shape: &str| line(f, &format!("dem-measure run.mcap {}", words.replace("SHAPE", shape)));
        let (found, wanted) = (of("mesh:plant/block.ply,transform=quarter.txt"), of("mesh:there.ply"));
        assert!(found.code == 0 && !found.stdout.is_empty(), "{words}: {}", found.stderr);
        assert!(found.stdout == wanted.stdout, "{words}");
        assert!(of("mesh:plant/block.ply").stdout != wanted.stdout, "{words}: it is there, not here");
    }
}

/// At map coordinates, turned about a slanting axis, a shape holds the same points.
#[test]
fn a_shape_at_map_coordinates_holds_the_same_points() {
    let folder = inputs();
    let f = folder.path();
    let mesh = geom::mesh::cuboid(Vec3::repeat(-0.0051), Vec3::new(0.1051, 0.2051, 0.3));
    let mut bytes = Vec::new();
    cloud::write_mesh(&mut bytes, &mesh, stream::ply::Encoding::Ascii).unwrap();
    fs::write(f.join("block.ply"), bytes).unwrap();
    fs::write(f.join("there.txt"), numbers(&rotation(), " ")).unwrap();
    succeed(f, "cloud-crop", &["sheet.xyz", "--transform", "there.txt", "-o", "far.ply"]);
    let shape = "mesh:block.ply,transform=there.txt";
    succeed(f, "cloud-crop", &["far.ply", "--keep", shape, "-o", "there.ply"]);
    succeed(f, "cloud-crop", &["sheet.xyz", "--keep", "mesh:block.ply", "-o", "here.ply"]);
    let [there, here] = ["there.ply", "here.ply"].map(|name| read(f, name));
    assert_eq!((here.points.len(), there.points.len()), (11 * 21, 11 * 21));
    let by = Transform::of_rows(&rotation()).unwrap();
    assert!(there.points.iter().zip(&here.points).all(|(p, q)| (p - by.point(q)).norm() < 1e-8));
    for (matrix, part) in [
        ("nowhere.txt", "cannot read nowhere.txt"),
        ("1,0,0,0,0,1,0,0,0,0,1,0,0,0,0", "15 numbers where a matrix has 16"),
    ] {
        let shape = format!("mesh:block.ply,transform={matrix}");
        let done = tool(f, "cloud-crop", &["sheet.xyz", "--keep", &shape, "-o", "no.ply"]);
        assert!(done.code == 2 && done.stderr.contains(part), "{matrix}: {}", done.stderr);
    }
    let done = tool(f, "cloud-crop", &["far.ply", "--keep", shape, "-o", "there.txt"]);
    assert!(done.code == 2 && done.stderr.contains("is also an input"), "{}", done.stderr);
}
