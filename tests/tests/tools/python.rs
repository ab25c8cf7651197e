//! A run in Python, by the lines of the documentation; files for ParaView, read by VTK itself.

use grainpipe_tests::tree::root;
use grainpipe_tests::{skip, tools::succeed};
use std::{
    fs,
    path::Path,
    process::{Command, Output},
};
use tempfile::{TempDir, tempdir};

/// Two grains that fall side by side, onto a plane and a mesh.
const SCENE: &str = r#"
gravity = [0, 0, -10]
[time]
until = 0.1
dt = 1e-4
[output]
every = 0.05
[[material]]
name = "glass"
density = 2500
young = 1e7
poisson = 0.25
[[contact]]
between = ["glass", "glass"]
law = "hertz"
restitution = 0.9
[[particles]]
source = "two.csv"
material = "glass"
[[wall]]
name = "floor"
plane = "0,0,0,0,0,1"
material = "glass"
[[wall]]
name = "bin"
mesh = "bin.ply"
material = "glass"
"#;

const BIN: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                   element face 1\nproperty list uchar int vertex_indices\nend_header\n-1 0 0\n-2 0 0\n-1 1 0\n3 0 1 2\n";

fn run() -> TempDir {
    let folder = tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("two.toml", SCENE);
    write("bin.ply", BIN);
    write("two.csv", "x,y,z,radius,vx\n0,0,1,0.01,0.5\n0,1,2,0.02,0\n");
    succeed(folder.path(), "dem-run", &["two.toml", "-o", "run.mcap"]);
    folder
}

fn python(folder: &Path, script: &str) -> Option<Output> {
    let mut command = Command::new("python3");
    command.current_dir(folder).args(["-c", script]).output().ok()
}

/// What the script says; none when Python or one of the modules is missing.
fn said(folder: &Path, modules: &str, script: &str) -> Option<String> {
    if !python(folder, &format!("import {modules}")).is_some_and(|o| o.status.success()) {
        skip(&format!("python3 with {modules}"));
        return None;
    }
    let done = python(folder, script).unwrap();
    let words = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success(), "{script}\n{words}");
    Some(String::from_utf8_lossy(&done.stdout).into_owned())
}

/// The Python lines of the documentation.
fn documented() -> String {
    let path = root().join("docs/how-to/python.md");
    let text = fs::read_to_string(path).unwrap();
    let blocks = text.split("```python\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.collect::<Vec<_>>().concat()
}

/// z = z₀ − g t²/2 = 0.95 m after 0.1 s, and the speed √(0.5² + 1²) m/s.
#[test]
fn the_lines_of_the_documentation_reach_the_grains() {
    let folder = run();
    let Some(said) = said(folder.path(), "mcap, mcap_protobuf, numpy", &documented()) else { return };
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines.len(), 3, "{said}");
    assert!(lines[0].starts_with("t = 0.000 s: 2 grains, fastest 0.5000 m/s, lowest 1.000000 m"), "{said}");
    assert!(lines[2].starts_with("t = 0.100 s: 2 grains, fastest 1.1180 m/s, lowest 0.950000 m"), "{said}");
}

const MOMENT: &str = r#"
import vtk
from vtk.util.numpy_support import vtk_to_numpy
import xml.etree.ElementTree as xml
def read(name):
    reader = vtk.vtkXMLPolyDataReader(); reader.SetFileName(name); reader.Update()
    assert reader.GetErrorCode() == 0, name
    return reader.GetOutput()
def field(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))
data = read("one.vtp")
print(data.GetNumberOfPoints(), data.GetNumberOfVerts(), data.GetNumberOfPolys(), field(data, "role").tolist())
print(field(data, "radius")[:2].tolist(), field(data, "velocity")[:2].round(6).tolist())
print(vtk_to_numpy(data.GetFieldData().GetArray("TimeValue")).round(6).tolist())
for item in xml.parse("all.pvd").iter("DataSet"):
    data = read(item.get("file"))
    print(round(float(item.get("timestep")), 6), item.get("part"), data.GetNumberOfPoints(), round(data.GetBounds()[5], 6))
"#;

#[test]
fn vtk_reads_a_moment_and_a_series() {
    let folder = run();
    succeed(folder.path(), "dem-view", &["run.mcap", "-o", "one.vtp"]);
    succeed(folder.path(), "dem-view", &["run.mcap", "-o", "all.pvd"]);
    let Some(said) = said(folder.path(), "vtk", MOMENT) else { return };
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines[0], "9 2 3 [0, 0, 3, 3, 3, 3, 3, 3, 3]", "{said}");
    assert_eq!(lines[1], "[0.01, 0.02] [[0.5, 0.0, -1.0], [0.0, 0.0, -1.0]]", "{said}");
    assert_eq!(lines[2], "[0.1]", "{said}");
    assert_eq!(lines.len(), 3 + 3 + 3, "grains and surfaces at three times: {said}");
    assert_eq!([lines[3], lines[5]], ["0.0 0 2 2.0", "0.1 0 2 1.95"], "{said}");
}

const PROBE: &str = r#"
import json, subprocess
asked = ["ffprobe", "-v", "error", "-of", "json", "-count_frames", "-show_streams", "run.mp4"]
stream = json.loads(subprocess.run(asked, capture_output=True, check=True).stdout)["streams"][0]
print(stream["codec_name"], stream["width"], stream["height"], stream["nb_read_frames"], stream["r_frame_rate"])
"#;

/// ffmpeg comes with ffprobe; sides are made even.
#[test]
fn a_film_as_mp4_has_every_picture_and_the_same_bytes_again() {
    let folder = run();
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        return skip("ffmpeg");
    }
    for name in ["run.mp4", "again.mp4"] {
        let film = ["run.mcap", "-o", name, "--size", "161x121", "--fps", "10"];
        succeed(folder.path(), "dem-view", &film);
    }
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("run.mp4") == bytes("again.mp4"), "other bytes");
    let Some(said) = said(folder.path(), "json", PROBE) else { return };
    assert_eq!(said.trim(), "h264 162 122 3 10/1");
}
