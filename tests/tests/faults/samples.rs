//! Small whole files of every format that a tool reads: what faults are put into, and what fuzzing begins with.

use grainpipe_tests::scenes::{Head, RUBS};
use std::io::Cursor;
use std::path::Path;
use stream::mcap::{Compression, Provenance};
use stream::{Table, Values};

/// A name and its bytes.
pub type Sample = (&'static str, Vec<u8>);

/// A scene with everything that a run can write, small: friction, an outlet, energy, contacts.
pub fn scene() -> String {
    let head = Head {
        time: "until = 0.012",
        output: "every = 0.004\ncheckpoint = 0.004\nenergy = true\ncontacts = true",
        material: "sinter",
        density: 3300.0,
        young: 2e6,
        contact: RUBS,
    };
    head.toml() + FALLING
}

/// The same with bonded grains.
fn bonded() -> String {
    let bond = "[[bond]]\nbetween = [\"sinter\", \"sinter\"]\ngap = 0.015\nyoung = 1e6\npoisson = 0.25\n";
    scene().replace("\"auto\"", "0.03") + bond
}

/// Three grains fall towards a floor, through a storage plane.
const FALLING: &str = r#"[[fill]]
material = "sinter"
shape = "box:0,0,0.0205,0.03,0.03,0.035"
diameter = 0.01
count = 3
velocity = [0, 0, -1]
[[wall]]
plane = "0,0,-1,0,0,1"
material = "sinter"
[[outlet]]
plane = "0,0,0.02,0,0,-1"
length = "auto"
"#;

/// The grid of points that clouds are made of.
fn grid() -> impl Iterator<Item = [f64; 3]> {
    (0..12u8).map(|k| [0.01 * f64::from(k % 4), 0.01 * f64::from(k / 4), 0.001 * f64::from(k)])
}

/// PLY: a cloud in each encoding, and a mesh.
pub fn ply() -> Vec<Sample> {
    let text: String = grid().map(|[x, y, z]| format!("{x} {y} {z} 7\n")).collect();
    let head = "ply\nformat ascii 1.0\ncomment made\nelement vertex 12\nproperty float x\nproperty double y\n\
                property float z\nproperty uchar red\nend_header\n";
    let ascii = format!("{head}{text}");
    let cloud = cloud::from_bytes(ascii.clone().into_bytes()).expect("a cloud");
    let mut binary = Vec::new();
    let little = stream::ply::Encoding::BinaryLittleEndian;
    cloud::write_ply(&mut binary, &cloud, little).expect("written");
    let mut big =
        b"ply\nformat binary_big_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
                    property float z\nend_header\n"
            .to_vec();
    [1f32, 2.0, 3.0, 4.0, 5.0, 6.0].iter().for_each(|c| big.extend(c.to_be_bytes()));
    let mesh = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
                element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n\
                3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    let surface = cloud::read_mesh(&mut mesh.as_bytes()).expect("a mesh");
    let mut packed = Vec::new();
    cloud::write_mesh(&mut packed, &surface, little).expect("written");
    vec![
        ("ascii.ply", ascii.into_bytes()),
        ("binary.ply", binary),
        ("big.ply", big),
        ("mesh.ply", mesh.into()),
        ("mesh-binary.ply", packed),
    ]
}

/// LAS and LAZ.
pub fn las() -> Vec<Sample> {
    let one = |compressed: bool, format: u8| {
        let mut builder = las::Builder::from((1, if format > 5 { 4 } else { 2 }));
        builder.point_format = las::point::Format::new(format).expect("known");
        builder.point_format.is_compressed = compressed;
        let header = builder.into_header().expect("sound");
        let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).expect("opened");
        for (k, [x, y, z]) in (0u16..).zip(grid()) {
            let color = Some(las::Color::new(k, 2 * k, 3 * k));
            let point = las::Point {
                x,
                y,
                z,
                intensity: k,
                gps_time: Some(f64::from(k)),
                color,
                ..las::Point::default()
            };
            writer.write_point(point).expect("written");
        }
        writer.into_inner().expect("whole").into_inner()
    };
    vec![("3.las", one(false, 3)), ("3.laz", one(true, 3)), ("7.las", one(false, 7)), ("7.laz", one(true, 7))]
}

/// E57 with two scans.
pub fn e57() -> Vec<Sample> {
    use ::e57::{E57Writer, Record, RecordValue as Value};
    let mut file = Cursor::new(Vec::new());
    let mut writer = E57Writer::new(&mut file, "file").expect("opened");
    for scan in 0..2 {
        let prototype = vec![
            Record::CARTESIAN_X_F64,
            Record::CARTESIAN_Y_F64,
            Record::CARTESIAN_Z_F64,
            Record::COLOR_RED_U8,
            Record::COLOR_GREEN_U8,
            Record::COLOR_BLUE_U8,
        ];
        let mut points = writer.add_pointcloud(&format!("scan {scan}"), prototype).expect("added");
        for (k, [x, y, z]) in (0..).zip(grid()) {
            let mut values: Vec<Value> = [x, y, z].into_iter().map(Value::Double).collect();
            values.extend([k, 1, 255].map(Value::Integer));
            points.add_point(values).expect("written");
        }
        points.finalize().expect("whole");
    }
    writer.finalize().expect("whole");
    drop(writer);
    vec![("two.e57", file.into_inner())]
}

/// PCD as text, binary and packed (by literal runs, which LZF allows).
pub fn pcd() -> Vec<Sample> {
    let head = |data: &str| {
        format!(
            "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\n\
             HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA {data}\n"
        )
    };
    let rows = [[1f32, 2.0, 3.0], [4.0, f32::NAN, 6.0]];
    let mut binary = head("binary").into_bytes();
    for row in rows {
        row.iter().for_each(|c| binary.extend(c.to_le_bytes()));
        binary.extend(16_711_935u32.to_le_bytes());
    }
    let mut columns = Vec::new();
    (0..3).for_each(|a| rows.iter().for_each(|row| columns.extend(row[a].to_le_bytes())));
    columns.extend([16_711_935u32, 255].iter().flat_map(|c| c.to_le_bytes()));
    let runs: Vec<u8> = columns.chunks(32).flat_map(|run| [&[run.len() as u8 - 1], run].concat()).collect();
    let mut packed = head("binary_compressed").into_bytes();
    packed.extend((runs.len() as u32).to_le_bytes());
    packed.extend((columns.len() as u32).to_le_bytes());
    packed.extend(runs);
    let ascii = head("ascii") + "1 2 3 16711935\n4 nan 6 255\n";
    vec![("ascii.pcd", ascii.into_bytes()), ("binary.pcd", binary), ("packed.pcd", packed)]
}

/// XYZ and PTS.
pub fn xyz() -> Vec<Sample> {
    vec![
        ("plain.xyz", b"1 2 3\n4\t5\t6\r\n\n7, 8, 9\n1e1;11;12\n".to_vec()),
        ("named.xyz", b"//X Y Z Intensity R\n# a comment\n1 2 3 0.25 200\n4 5 6 nan 100\n".to_vec()),
        ("two.pts", b"2\n1 2 3 -500 10 20 30\n4 5 6 -400 40 50 60\n".to_vec()),
    ]
}

/// Walls, a run with crossings and checkpoints, packed and not, and the inlet that is made of it.
pub fn mcap() -> Vec<Sample> {
    let run = |how| run(how, &scene());
    let (plain, bonded) = (run(Compression::None), self::run(Compression::None, &bonded()));
    let mut walls = stream::mcap::Writer::new(Vec::new(), &Provenance::default()).expect("opened");
    walls.points("/walls", 0, "world", spheres()).expect("written");
    vec![
        ("walls.mcap", walls.finish().expect("whole")),
        ("inlet.mcap", inlet(&plain)),
        ("run.mcap", plain),
        ("bonded-inlet.mcap", inlet(&bonded)),
        ("bonded.mcap", bonded),
        ("packed.mcap", run(Compression::Zstd)),
    ]
}

/// A run, in memory.
pub fn run(how: Compression, scene: &str) -> Vec<u8> {
    let scene = scene::Scene::new("s.toml", scene.to_owned(), &[], Path::new("")).expect("sound");
    let plan = scene.plan(Vec::new()).expect("whole");
    let settings = run::Settings {
        provenance: Provenance::default(),
        how: how.into(),
        resume: None,
        earlier: None,
        watched: false,
        stop: || false,
        device: None,
    };
    run::run(&scene, plan, Vec::new(), settings, &mut |_| ()).expect("it runs").1
}

/// The inlet of a run.
pub fn inlet(run: &[u8]) -> Vec<u8> {
    let what = stages::replay::Replay::default();
    let (source, how) =
        (Box::new(Cursor::new(run.to_vec())), (Provenance::default(), Compression::None.into()));
    stages::replay::replay(vec![("run".into(), source)], &what, Vec::new(), how)
        .expect("a run with an outlet")
        .1
}

fn spheres() -> Table {
    let column = |a: usize| Values::F32(grid().map(|p| p[a] as f32).collect());
    let mut table = Table::with_rows(12);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        table.push(name, column(axis)).expect("as long as the others");
    }
    table.push("radius", Values::F32(vec![0.006; 12])).expect("as long as the others");
    table
}

/// Texts: scenes, regions, prisms, options, particles.
pub fn texts() -> Vec<Sample> {
    let regions = "[[region]]\nname = \"chute\"\nshape = \"box:0,0,0,1,1,1\"\naction = \"keep\"\n\
                   [[region]]\nname = \"bolt\"\nshape = \"!sphere:0,0,0,0.1\"\naction = \"remove\"\n";
    let rough = "roughness = 0.0005\n[[region]]\nname = \"worn\"\nshape = \"cylinder:0,0,0,0,0,1,1\"\nroughness = 0.002\n\
                 material = \"liner\"\nfriction = 0.4\nvelocity = [0.1, 0, 0]\n";
    let prism = r#"{"polygon": [[0,0,0],[1,0,0],[0,1,0]], "extrusion": [0,0,2]}"#;
    vec![
        ("scene.toml", format!("contact.0.restitution=0.3\n{}", scene()).into_bytes()),
        ("regions.toml", regions.into()),
        ("roughness.toml", rough.into()),
        ("prism.json", prism.into()),
        ("box.txt", b"!box:0,0,0,1,1,1".to_vec()),
        ("halfspace.txt", b"halfspace:0,0,1,0,0,-2".to_vec()),
        ("plane.txt", b"0,0,0.6,0,0,-1".to_vec()),
        ("grains.csv", b"# pile\nid,x,y,z,radius,vx,vy,vz\n4,0,1,2,0.5,1,0,0\n5,0,1,4,0.5,1,0,0\n".to_vec()),
    ]
}
