//! Every form of a SHAPE, and its outside.

use super::files::{inputs, plate};
use super::help;
use grainpipe_tests::tools::{line, succeed};

/// A shape of each form that holds some points of the plate and not others.
const SHAPES: [&str; 9] = [
    "box:-1,-1,-1,0.1,1,1",
    "sphere:0,0,0,0.1",
    "cylinder:0,0,-1,0,0,1,0.1",
    "cone:0,0,-0.1,0,0,0.1,0.15,0.05",
    "halfspace:0.03,0,0,1,0,0",
    "prism:prism.json",
    "mesh:tetra.ply",
    "mesh:tetra.ply,scale=0.9",
    "mesh:tetra.ply,transform=0,-1,0,0.06,1,0,0,0,0,0,1,0,0,0,0,1",
];

/// The forms that a help text lists.
fn forms(help: &str) -> Vec<String> {
    let text = help.split_once("\nSHAPE: ").expect("a list of shapes").1;
    let text = text.split(';').next().unwrap_or_default();
    text.split(" | ")
        .filter_map(|form| form.split_once(':'))
        .map(|(name, _)| name.trim().to_owned())
        .collect()
}

#[test]
fn every_form_of_a_shape_keeps_what_is_inside_and_with_a_mark_what_is_outside() {
    for tool in ["cloud-crop", "dem-measure"] {
        let listed = forms(&help(tool));
        let tried: Vec<&str> = SHAPES.iter().filter_map(|shape| shape.split(':').next()).collect();
        assert_eq!(listed, tried, "{tool} --help lists the forms that are tried here");
    }
    let folder = inputs();
    let count = |shape: &str| {
        let done = line(folder.path(), &format!("cloud-crop flat.xyz --keep '{shape}' --ascii"));
        assert_eq!(done.code, 0, "{shape}: {}", done.stderr);
        String::from_utf8_lossy(&done.stdout).lines().skip_while(|row| *row != "end_header").count() - 1
    };
    for shape in SHAPES {
        let (inside, outside) = (count(shape), count(&format!("!{shape}")));
        assert!(inside > 0 && outside > 0, "{shape}: {inside} inside, {outside} outside");
        assert_eq!(inside + outside, plate().count(), "{shape}");
    }
}

/// Where a volume is needed, every form with one gives it.
#[test]
fn every_form_of_a_shape_measures() {
    let folder = inputs();
    succeed(folder.path(), "dem-run", &["s.toml", "-q", "-o", "run.mcap"]);
    for shape in SHAPES {
        let command = format!("dem-measure run.mcap --residence '{shape}'");
        let done = line(folder.path(), &command);
        assert_eq!(done.code, 0, "{command}: {}", done.stderr);
        let command = format!("dem-measure run.mcap --porosity '{shape}'");
        let (done, endless) = (line(folder.path(), &command), shape.starts_with("halfspace"));
        assert_eq!(done.code != 0, endless, "{command}: {}", done.stderr);
    }
}
