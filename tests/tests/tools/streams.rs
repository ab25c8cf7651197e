//! What comes out does not depend on how it goes out: a name, or stdout that is a file; what goes in, not on how it is named.

use grainpipe_tests::scenes::{ABOVE, AT, SINTER, folder};
use grainpipe_tests::tools::{line, succeed};
use std::fs;
use std::path::Path;

fn done(folder: &Path, words: &str) -> String {
    let done = line(folder, words);
    assert_eq!(done.code, 0, "{words}: {}", done.stderr);
    done.stderr
}

#[test]
fn a_file_is_the_same_under_its_name_and_as_stdout() {
    let scene = format!("{}{ABOVE}", SINTER.toml()).replace("until = 0.3", "until = 0.05");
    let outlet = "[[outlet]]\nplane = \"0,0,0,0,0,-1\"\n";
    let cloud: String =
        (0..400).map(|k| format!("{} {} 0\n", 0.01 * f64::from(k % 20), 0.01 * f64::from(k / 20))).collect();
    let folder = folder(&[("s.toml", format!("{scene}{outlet}")), ("c.xyz", cloud)]);
    let f = folder.path();
    for (command, name) in [
        ("dem-run s.toml", "run.mcap"),
        ("stage-replay run.mcap", "in.mcap"),
        ("wallgen c.xyz --roughness 0.002", "walls.mcap"),
        ("cloud-crop c.xyz --keep box:0,0,-1,0.1,0.1,1", "c.ply"),
        ("dem-measure run.mcap --contacts", "m.csv"),
    ] {
        done(f, &format!("{command} -q -o {name}"));
        done(f, &format!("{command} -q > as-stdout"));
        assert!(fs::read(f.join(name)).unwrap() == fs::read(f.join("as-stdout")).unwrap(), "{command}");
        fs::write(f.join("appended"), "before").unwrap();
        done(f, &format!("{command} -q >> appended"));
        let appended = fs::read(f.join("appended")).unwrap();
        assert!(appended == [b"before", &fs::read(f.join(name)).unwrap()[..]].concat(), "{command} >>");
    }
}

/// A run that ends with the record of its inlet lacks nothing that crosses the plane, however it comes in; one that goes on does, and says from when.
#[test]
fn a_run_that_ends_with_the_record_of_its_inlet_is_not_warned_of_it() {
    let plant = format!("{}{ABOVE}", SINTER.toml());
    let plant = plant.replace("young = 5e7", "young = 5e5").replace("mass = 0.15", "count = 60");
    let folder = folder(&[("plant.toml", plant)]);
    let f = folder.path();
    for motion in ["constant", "ballistic", "recorded"] {
        for keep in ["upstream", "downstream"] {
            let args =
                ["plant.toml", "--at", AT, "--motion", motion, "--keep", keep, "-o", &format!("{keep}.toml")];
            succeed(f, "stage-split", &args);
        }
        done(f, "dem-run upstream.toml --until 0.1 -q -o up.mcap");
        done(f, "stage-replay up.mcap --keep-times -q -o in.mcap");
        for (until, warned) in [("0.1", false), ("0.102", true)] {
            let said = done(f, &format!("dem-run downstream.toml in.mcap --until {until} -o down.mcap"));
            let told = said.contains("inlet.0: the record ends at t = ");
            assert_eq!(told, warned, "{motion}, {until}: {said}");
        }
    }
}

/// A record that ends early gives a warning in the output, and so does a scene whose numbers look like another unit.
#[test]
fn a_run_is_the_same_for_an_inlet_and_a_scene_with_a_name_and_for_stdin() {
    // A density that looks like g/cm³, and a modulus with which the step is still long.
    let changes =
        [("density = 3300", "density = 9"), ("young = 5e7", "young = 5e5"), ("mass = 0.15", "count = 60")];
    let plant = format!("{}{ABOVE}", SINTER.toml());
    let plant = changes.iter().fold(plant, |text, (from, to)| text.replace(from, to));
    let folder = folder(&[("plant.toml", plant)]);
    let f = folder.path();
    for keep in ["upstream", "downstream"] {
        succeed(f, "stage-split", &["plant.toml", "--at", AT, "--keep", keep, "-o", &format!("{keep}.toml")]);
    }
    done(f, "dem-run upstream.toml --until 0.1 -q -o up.mcap");
    done(f, "stage-replay up.mcap -q -o in.mcap");
    let said = done(f, "dem-run downstream.toml in.mcap --until 0.15 -o named.mcap");
    assert!(said.contains("inlet.0: the record ends at t = ") && said.contains("is lighter than"), "{said}");
    done(f, "dem-run downstream.toml - --until 0.15 -o piped.mcap < in.mcap");
    done(f, "dem-run - in.mcap --until 0.15 -o scene.mcap < downstream.toml");
    fs::create_dir(f.join("below")).unwrap();
    fs::copy(f.join("downstream.toml"), f.join("below/other.toml")).unwrap();
    done(f, "dem-run below/other.toml in.mcap --until 0.15 -o below.mcap");
    let named = fs::read(f.join("named.mcap")).unwrap();
    for other in ["piped.mcap", "scene.mcap", "below.mcap"] {
        assert!(fs::read(f.join(other)).unwrap() == named, "{other}");
    }
}
