//! Masks of photographs, and the scale of what is made of them.

use crate::every_option::files::inputs;
use grainpipe_tests::tools::{line, tool};
use grainpipe_tests::tree::root;
use std::fs;
use std::path::Path;

fn bytes(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).expect("a mask")
}

#[test]
fn masks_that_are_there_stay_and_others_are_found() {
    let made = inputs();
    let folder = made.path();
    let run = |more: &str| {
        let done = line(folder, &format!("stone-mask photographs -o masks{more}"));
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.stderr
    };
    let first = run("");
    assert!(!first.contains("found before"), "{first}");
    let [one, two] = ["masks/01.png", "masks/02.png"].map(|name| bytes(folder, name));

    // One is missing, one is cut short, one belongs to another photograph.
    fs::remove_file(folder.join("masks/01.png")).expect("removed");
    fs::write(folder.join("masks/02.png"), &two[..two.len() / 2]).expect("written");
    fs::copy(folder.join("masks/04.png"), folder.join("masks/03.png")).expect("copied");
    let again = run("");
    assert!(
        again.contains("02.png of an earlier call was drawn or changed elsewhere, and is replaced"),
        "{again}"
    );
    assert!(again.contains("12 masks, 9 of them found before"), "{again}");
    assert_eq!([bytes(folder, "masks/01.png"), bytes(folder, "masks/02.png")], [one, two]);
    assert_ne!(bytes(folder, "masks/03.png"), bytes(folder, "masks/04.png"));

    // The same of all, with the sheet and what is doubtful.
    let sheet = run(" --sheet sheet.png --report before.json");
    assert!(sheet.contains("12 of them found before"), "{sheet}");
    fs::remove_dir_all(folder.join("masks")).expect("removed");
    let drawn = bytes(folder, "sheet.png");
    run(" --sheet sheet.png --report fresh.json");
    assert_eq!(bytes(folder, "sheet.png"), drawn);

    let other = run(" --level 100");
    assert!(!other.contains("found before"), "{other}");
    let given = run(" --given drawn");
    assert!(!given.contains("found before"), "{given}");
}

#[test]
fn tags_give_the_scale() {
    let made = inputs();
    let run = |more: &str| {
        let call =
            format!("stone-hull tagged --masks tagged-masks --poses tagged.txt --cells 30 -o t.ply{more}");
        let done = line(made.path(), &call);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let report = fs::read_to_string(made.path().join("r.json")).expect("a report");
        let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
        (done.stderr, report["length"].as_f64().expect("a length"), report["tags"].clone())
    };
    let (words, plain, _) = run(" --report r.json");
    assert!(words.contains("--tag-size"), "{words}");
    // The tag is 20 mm wide, as the poses say; and were it 30 mm, all would be half as large again.
    for (size, times) in [("0.02", 1.0), ("0.03", 1.5)] {
        let (words, length, tags) = run(&format!(" --report r.json --tag-size {size}"));
        assert!((length / plain / times - 1.0).abs() < 0.005, "{words}");
        assert!(!words.contains("warning") && tags["sightings"].as_u64() > Some(2), "{words}");
    }
}

#[test]
fn what_shows_no_tag_is_refused() {
    let made = inputs();
    let done = line(made.path(), "stone-mask photographs -o masks -q");
    assert_eq!(done.code, 0, "{}", done.stderr);
    let call = "stone-hull photographs --masks masks --poses poses.txt --tag-size 0.02 --cells 20 -o t.ply";
    let done = line(made.path(), call);
    let words = "--tag-size: no tag was found";
    assert!(done.code == 1 && done.stderr.contains(words), "{}", done.stderr);
}

#[test]
fn names_with_dots_have_masks_of_their_own() {
    let made = inputs();
    let folder = made.path();
    fs::create_dir(folder.join("dots")).expect("made");
    for k in 1..=3 {
        let name = format!("IMG.000{k}.png");
        fs::copy(folder.join(format!("photographs/0{k}.png")), folder.join("dots").join(name))
            .expect("copied");
    }
    let done = line(folder, "stone-mask dots -o dotted -q");
    assert_eq!(done.code, 0, "{}", done.stderr);
    let masks: Vec<bool> = (1..=3).map(|k| folder.join(format!("dotted/IMG.000{k}.png")).exists()).collect();
    assert_eq!(masks, [true; 3]);
}

/// Masks of half the size have cameras of half the size; tags are on the photographs as they are.
#[test]
fn tags_give_the_scale_beside_smaller_masks() {
    let made = inputs();
    let folder = made.path();
    fs::create_dir(folder.join("half")).expect("made");
    for k in 1..=6 {
        let bytes = fs::read(folder.join(format!("tagged-masks/0{k}.png"))).expect("a mask");
        let (w, h, values) = photos::photograph::read_values(&bytes).expect("a picture");
        let half: Vec<u8> = (0..w * h / 4).map(|n| values[n / (w / 2) * 2 * w + n % (w / 2) * 2]).collect();
        let png = photos::photograph::png(w / 2, h / 2, &half).expect("a picture");
        fs::write(folder.join(format!("half/0{k}.png")), png).expect("written");
    }
    let call = "stone-hull tagged --masks half --poses tagged.txt --poses-size 384x288 --tag-size 0.02 --cells 20 -o t.ply --report r.json";
    let done = line(folder, call);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let report = fs::read_to_string(folder.join("r.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    let factor = report["tags"]["factor"].as_f64().expect("a factor");
    assert!((factor - 1.0).abs() < 0.005, "{}", done.stderr);
}

/// A sheet among the masks would be taken for one; a photograph that cannot be read costs no other its mask.
#[test]
fn a_sheet_replaces_no_mask_and_a_broken_photograph_stops_no_other() {
    let made = inputs();
    let folder = made.path();
    for (words, told) in [
        ("--sheet masks/01.png", "lies among the photographs or masks"),
        ("--sheet photographs/sheet.png", "lies among the photographs or masks"),
        ("--sheet sheet.jpg", "the sheet is a PNG"),
        ("--given nowhere", "no such folder"),
    ] {
        let done = line(folder, &format!("stone-mask photographs -o masks {words}"));
        assert!(done.code == 2 && done.stderr.contains(told), "{words}: {}", done.stderr);
    }
    let photograph = fs::read_dir(folder.join("photographs")).unwrap().next().unwrap().unwrap().path();
    let whole = fs::read(&photograph).unwrap();
    fs::write(&photograph, &whole[..whole.len() / 2]).unwrap();
    let done = line(folder, "stone-mask photographs -o masks");
    assert!(done.code == 1 && done.stderr.contains("1 of 12 photographs have no mask"), "{}", done.stderr);
    assert_eq!(fs::read_dir(folder.join("masks")).unwrap().count(), 11);
    fs::write(&photograph, whole).unwrap();
    let done = line(folder, "stone-mask photographs -o masks");
    assert!(done.code == 0 && done.stderr.contains("12 masks, 11 of them found before"), "{}", done.stderr);
}

/// Two masks that belong to other photographs: the warning says what they cost in the unit of the hull that is written, not in that of the poses.
#[test]
fn masks_that_disagree_cost_a_volume_of_the_scaled_stone() {
    let made = tempfile::tempdir().expect("a folder");
    let (folder, head) = (made.path(), root().join("sample-data/head"));
    fs::create_dir(folder.join("masks")).expect("made");
    for entry in fs::read_dir(head.join("masks")).expect("masks") {
        let path = entry.expect("a mask").path();
        fs::copy(&path, folder.join("masks").join(path.file_name().expect("a name"))).expect("copied");
    }
    for (from, to) in [("00013.png", "00025.png"), ("00049.png", "00039.png")] {
        fs::copy(folder.join("masks").join(from), folder.join("masks").join(to)).expect("copied");
    }
    let [photographs, poses] = ["photographs", "poses.txt"].map(|name| head.join(name).display().to_string());
    let options = ["--masks", "masks", "--poses", &poses, "--poses-size", "2736x1540", "--length", "0.3"];
    let more = ["--cells", "30", "-o", "head.ply", "--report", "r.json"];
    let done = tool(folder, "stone-hull", &[&[&*photographs][..], &options, &more].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    let (_, rest) = done.stderr.split_once("the volume is ").expect("the warning");
    let said: f64 = rest.split(' ').next().expect("a number").parse().expect("a number");
    let report: serde_json::Value = serde_json::from_slice(&bytes(folder, "r.json")).expect("a report");
    let volume = report["volume"].as_f64().expect("a volume");
    assert!((said / volume - 1.0).abs() < 1e-4, "{said} {volume}");
}
