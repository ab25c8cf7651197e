//! Files for ParaView, read back by their own head: the XML says where each block of numbers is.

use geom::{Plane, Vec3, mesh::TriMesh};
use stream::{Table, Values};
use view::{
    DrawnTable, LayerHead, Motion, Role, Series, Show, Span, SurfaceShape, WallSurface,
    vtk::{self, PolyData},
};

/// Grains with a velocity, or wall spheres without.
fn table(rows: usize, moves: bool) -> Table {
    let mut table = Table::default();
    let column = |k: f32| Values::F32((0..rows).map(|i| k + i as f32).collect());
    for (k, name) in ["x", "y", "z", "radius"].into_iter().enumerate() {
        table.push(name, column(10.0 * k as f32)).expect("fits");
    }
    for (k, name) in ["vx", "vy", "vz"].into_iter().enumerate().filter(|_| moves) {
        table.push(name, column(0.25 + k as f32)).expect("fits");
    }
    if moves {
        table.push("id", Values::U32((0..rows as u32).collect())).expect("fits");
    }
    table
}

fn everything() -> PolyData {
    let (grains, walls) = (table(3, true), table(2, false));
    let part = |role, table| DrawnTable { role, name: "test".into(), table, kinds: vec![], clumps: vec![] };
    let plane = Plane::new(Vec3::zeros(), Vec3::z()).expect("a direction");
    let corners = vec![Vec3::zeros(), Vec3::x(), Vec3::y()];
    let mesh = TriMesh::new(corners, vec![[0, 1, 2]]).expect("whole");
    let moves = Motion { velocity: Vec3::new(0.0, 0.0, 2.0), ..Motion::default() };
    let surfaces = [
        WallSurface { name: "floor".into(), shape: SurfaceShape::Plane(plane), motion: Motion::default() },
        WallSurface { name: "lid".into(), shape: SurfaceShape::Mesh(mesh), motion: moves },
    ];
    vtk::moment(&[part(Role::Grains, &grains), part(Role::Walls, &walls)], &surfaces, Some(0.5))
        .expect("made")
}

/// A file: its head with an empty block of numbers, and the numbers.
struct File {
    head: String,
    numbers: Vec<u8>,
}

impl File {
    fn of(data: &PolyData) -> File {
        let mut bytes = Vec::new();
        data.write(&mut bytes).expect("written");
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let start = bytes.windows(mark.len()).position(|w| w == mark).expect("numbers follow") + mark.len();
        let end = bytes.len() - "\n</AppendedData>\n</VTKFile>\n".len();
        let head = [&bytes[..start], &bytes[end..]].concat();
        File { head: String::from_utf8(head).expect("text"), numbers: bytes[start..end].to_vec() }
    }

    /// The bytes, the type and the components of each block, by group and name.
    fn blocks(&self) -> Vec<(String, String, usize, Vec<u8>)> {
        let xml = roxmltree::Document::parse(&self.head).expect("XML");
        let arrays = xml.descendants().filter(|n| n.attribute("format") == Some("appended"));
        let blocks: Vec<_> = arrays
            .map(|array| {
                let of = |name| array.attribute(name).expect("there").to_owned();
                let group = array.parent_element().expect("one").tag_name().name();
                let offset: usize = of("offset").parse().expect("a number");
                let (length, rest) = self.numbers[offset..].split_at(8);
                let length = u64::from_le_bytes(length.try_into().expect("eight")) as usize;
                let components = of("NumberOfComponents").parse().expect("a number");
                (format!("{group}/{}", of("Name")), of("type"), components, rest[..length].to_vec())
            })
            .collect();
        let all: usize = blocks.iter().map(|(_, _, _, bytes)| 8 + bytes.len()).sum();
        assert_eq!(all, self.numbers.len(), "every byte belongs to a block");
        blocks
    }

    fn block(&self, name: &str) -> (String, usize, Vec<u8>) {
        let found = self.blocks().into_iter().find(|(n, ..)| n == name);
        let (_, kind, components, bytes) = found.unwrap_or_else(|| panic!("{name} in {}", self.head));
        (kind, components, bytes)
    }
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().expect("four"))).collect()
}

fn numbers(bytes: &[u8]) -> Vec<i32> {
    bytes.chunks_exact(4).map(|b| i32::from_le_bytes(b.try_into().expect("four"))).collect()
}

#[test]
fn the_head_says_where_every_number_is() {
    let data = everything();
    let file = File::of(&data);
    assert!(file.head.contains("Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">0.5<"));
    let (kind, components, velocity) = file.block("PointData/velocity");
    assert_eq!((kind.as_str(), components), ("Float32", 3));
    let velocity = floats(&velocity);
    assert_eq!(velocity[..9], [0.25, 1.25, 2.25, 1.25, 2.25, 3.25, 2.25, 3.25, 4.25]);
    assert!(velocity.len() == 3 * data.len() && velocity[9..].iter().all(|v| v.is_nan()), "walls have none");
    assert_eq!(file.block("PointData/role").2, [0, 0, 0, 2, 2, 3, 3, 3, 3, 3, 3, 3]);
    assert_eq!(numbers(&file.block("Verts/connectivity").2), [0, 1, 2, 3, 4]);
    assert_eq!(numbers(&file.block("Polys/offsets").2), [3, 6, 9]);
    assert_eq!(numbers(&file.block("Polys/connectivity").2)[6..], [9, 10, 11]);
}

#[test]
fn a_mesh_that_moves_is_where_it_is_at_the_time() {
    let data = everything();
    assert!(data.points[3 * 9..].chunks_exact(3).all(|p| p[2] == 1.0), "{:?}", data.points);
}

#[test]
fn names_that_xml_does_not_allow_are_written_so_that_it_does() {
    let mut table = table(2, false);
    table.push("a<\"b\"&c", Values::U8(vec![1, 2])).expect("fits");
    let file = File::of(&vtk::points(Role::Cloud, &table));
    assert_eq!(file.block("PointData/a<\"b\"&c").2, [1, 2]);
}

#[test]
fn a_collection_names_each_file_with_its_time() {
    let entry = |time, file: &str| vtk::Entry { time, part: 1, name: "a & b".into(), file: file.into() };
    let mut text = Vec::new();
    vtk::write_collection(&[entry(0.0, "run/a_00000.vtp"), entry(0.02, "run/a_00001.vtp")], &mut text)
        .expect("written");
    let text = String::from_utf8(text).expect("text");
    let xml = roxmltree::Document::parse(&text).expect("XML");
    let sets: Vec<_> = xml.descendants().filter(|n| n.has_tag_name("DataSet")).collect();
    assert_eq!(sets.iter().map(|s| s.attribute("timestep")).collect::<Vec<_>>(), [Some("0"), Some("0.02")]);
    assert!(sets.iter().all(|s| s.attribute("name") == Some("a & b") && s.attribute("part") == Some("1")));
}

/// Files of the user beside the series stay, and so does a link to a folder; a series is replaced by the next one.
#[test]
fn a_series_replaces_the_files_of_its_collection_and_no_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let (list, files) = (folder.path().join("run & more.pvd"), folder.path().join("run & more"));
    let write_series = || -> Result<usize, view::ViewError> {
        let folder = vtk::SeriesFolder::beside(&list)?;
        let span = Span { from: 0.0, to: 1.0, every: None };
        let mut series = Series::new(span, folder.keeper());
        let layer = series.layer(LayerHead::new(Role::Grains, "grains"));
        series.push(layer, 0.5, table(2, true))?;
        let entries = folder.entries(&series, &[0.5])?;
        let count = folder.commit()?;
        vtk::write_collection(&entries, &mut std::fs::File::create(&list).expect("created"))
            .expect("written");
        Ok(count)
    };
    assert_eq!(write_series().expect("new"), 1);
    assert_eq!(write_series().expect("replaced"), 1);
    std::fs::write(files.join("mymesh.vtp"), "mine").expect("written");
    let message = write_series().expect_err("a file of the user").to_string();
    assert!(message.contains("run & more: exists") && message.contains("'mymesh.vtp'"), "{message}");
    assert_eq!(std::fs::read(files.join("mymesh.vtp")).expect("kept"), b"mine");
    std::fs::remove_file(files.join("mymesh.vtp")).expect("removed");
    let elsewhere = folder.path().join("elsewhere");
    std::fs::rename(&files, &elsewhere).expect("moved");
    std::os::unix::fs::symlink("elsewhere", &files).expect("linked");
    assert_eq!(write_series().expect("through the link"), 1);
    assert!(files.is_symlink() && elsewhere.is_dir());
}
