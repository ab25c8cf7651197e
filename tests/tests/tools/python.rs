//! A run in Python, by the lines of the documentation; files for ParaView, read by VTK itself.

use grainpipe_tests::skip;
use grainpipe_tests::tools::{program, succeed};
use grainpipe_tests::tree::root;
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
    let tools = program("dem-run").parent().expect("a folder").to_owned();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths([tools].into_iter().chain(std::env::split_paths(&path))).expect("a path");
    let mut command = Command::new("python3");
    command.env("PATH", path).env("PYTHONPATH", root().join("python")).env("PYTHONDONTWRITEBYTECODE", "1");
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

/// The Python lines of the documentation: those of the package, or the others.
fn documented(package: bool) -> String {
    let path = root().join("docs/how-to/python.md");
    let text = fs::read_to_string(path).unwrap();
    let blocks = text.split("```python\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.filter(|block| block.contains("import grainpipe") == package).collect::<Vec<_>>().concat()
}

/// z = z₀ − g t²/2 = 0.95 m after 0.1 s, and the speed √(0.5² + 1²) m/s.
#[test]
fn the_lines_of_the_documentation_reach_the_grains() {
    let folder = run();
    let Some(said) = said(folder.path(), "mcap, mcap_protobuf, numpy", &documented(false)) else { return };
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines.len(), 3, "{said}");
    assert!(lines[0].starts_with("t = 0.000 s: 2 grains, fastest 0.5000 m/s, lowest 1.000000 m"), "{said}");
    assert!(lines[2].starts_with("t = 0.100 s: 2 grains, fastest 1.1180 m/s, lowest 0.950000 m"), "{said}");
}

/// After 0.5 s one has fallen from 1 m onto the floor and bounced as its restitution says: z = r + v t − g t²/2.
#[test]
fn the_lines_of_the_package_read_and_make_runs() {
    let folder = run();
    let stiff = SCENE.replace("dt = 1e-4\n", "").replace("1e7", "1e8");
    fs::write(folder.path().join("two.toml"), stiff).unwrap();
    let Some(said) = said(folder.path(), "mcap, numpy, grainpipe", &documented(true)) else { return };
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines.len(), 5, "{said}");
    assert_eq!(lines[0], "t = 0.000 s: 2 grains, fastest 0.5000 m/s", "{said}");
    assert_eq!(lines[2], "t = 0.100 s: 2 grains, fastest 1.1180 m/s", "{said}");
    for (line, restitution) in lines[3..].iter().zip([0.2, 0.9_f64]) {
        assert!(line.starts_with(&format!("restitution {restitution}: grains at ")), "{said}");
        let number = |text: &str| text.trim().trim_end_matches(" m").parse::<f64>().expect("a number");
        let (_, found) = line.split_once(" grains at ").expect("heights");
        let (low, high) = found.split_once(" and ").expect("two");
        // z = 0.75 m of the one that has not landed.
        assert!((number(high) - 0.75).abs() < 2e-3 || (number(low) - 0.75).abs() < 2e-3, "{said}");
    }
}

const PACKAGE: &str = r#"
import grainpipe, numpy
run = grainpipe.run("two.toml", {"output.energy": True, "output.contacts": True, "output.wear": True, "time.until": 1.0, "time.dt": 2e-5, "contact.0.restitution": 0.3, "particles.0.source": "low.csv"}, output="more.mcap")
assert run.is_complete and run.stopped is None and run.materials[0]["name"] == "glass" and "two.csv" not in run.scene
every = run.table()
assert len(every) == sum(len(rows) for _, rows in run.frames()) == 2 * len(run.times()), len(every)
assert (every["time"][::2] == run.times()).all() and every.dtype.names[:4] == ("time", "x", "y", "z")
energy, floor = run.energy(), run.wall_forces("floor")
assert abs(energy["balance"] - energy["balance"][0]).max() < 1e-3 * energy["balance"][0], energy["balance"]
assert abs(floor["interval"].sum() - run.times()[-1]) < 1e-8 and numpy.isnan(floor["mean_force"][0]).all()
impulse = (floor["mean_force"] * floor["interval"][:, None])[1:].sum(axis=0)
grains = lambda k: run.at(run.times()[k])
momentum = lambda rows: sum(r["radius"] ** 3 * 4 / 3 * numpy.pi * 2500 * r["vz"] for r in rows)
weight = -10 * run.times()[-1] * sum(r["radius"] ** 3 * 4 / 3 * numpy.pi * 2500 for r in grains(0))
assert abs(momentum(grains(-1)) - momentum(grains(0)) - weight + impulse[2]) < 1e-9, impulse
assert len(run.table("/contacts")) > 0 and run.at(0.0, "/contacts").size == 0
names = [surface.name for surface in run.surfaces()]
assert names == ["floor", "bin"] and run.surfaces()[1].faces.shape == (1, 3) and run.surfaces()[0].plane.shape == (2, 3)
whole = open("more.mcap", "rb").read()
open("cut.mcap", "wb").write(whole[: len(whole) // 2])
cut = grainpipe.Run("cut.mcap")
assert not cut.is_complete and 0 < len(cut.times()) < len(run.times())
for call, error in [
    (lambda: grainpipe.Run("two.toml"), ValueError),
    (lambda: grainpipe.Run("cut.mcap", complete=True), grainpipe.IncompleteError),
    (lambda: run.wall_forces("lid"), KeyError),
    (lambda: run.table("/nothing"), KeyError),
    (lambda: run.table("/energy"), TypeError),
    (lambda: grainpipe.run("two.toml", {"time.untl": 1}, output="no.mcap"), grainpipe.RunError),
]:
    try:
        call()
        raise SystemExit(f"no {error}")
    except error as found:
        assert len(str(found)) > 10, found
stopped = grainpipe.run("two.toml", {"guards.overlap": 1e-6, "time.dt": 2e-5, "time.until": 1.0, "particles.0.source": "low.csv"}, output="stop.mcap")
assert stopped.stopped["stop"] == {"by": "guard", "guard": "overlap"}, stopped.stopped
print("done")
"#;

#[test]
fn the_package_gives_what_the_run_has() {
    let folder = run();
    fs::write(folder.path().join("low.csv"), "x,y,z,radius,vx\n0,0,0.3,0.01,0.5\n0,1,0.4,0.02,0\n").unwrap();
    let Some(said) = said(folder.path(), "mcap, numpy, grainpipe", PACKAGE) else { return };
    assert_eq!(said.trim(), "done");
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
