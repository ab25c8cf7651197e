//! What is wrong in a recipe or in data is refused with place and cure, before anything runs.

use calibration::recipe;
use std::fs;
use tempfile::TempDir;

const RECIPE: &str = r#"[settings]
trials = 40
[[parameter]]
name = "mu"
bounds = [0.1, 0.9]
[[parameter]]
name = "young"
bounds = ["1 MPa", "1 GPa"]
unit = "Pa"
[[test]]
name = "shear"
command = "model {mu} {young} --seed {seed}"
x = "u"
y = "tau"
data = "lab.csv"
"#;

const DATA: &str = "u,tau\n0,0\n1,2\n2,3\n3,3.5\n4,3.7\n5,3.8\n";

fn read(recipe_text: &str, data: &str, given: &[&str]) -> Result<calibration::Recipe, String> {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("r.toml");
    fs::write(&file, recipe_text).unwrap();
    fs::write(folder.path().join("lab.csv"), data).unwrap();
    let given = given.iter().map(|g| (*g).to_owned()).collect();
    let place = folder.path().canonicalize().unwrap().display().to_string() + "/";
    recipe::read(&file, &given)
        .map_err(|e| e.to_string().replace(&place, "").replace(&format!("{}/", folder.path().display()), ""))
}

/// The message for a recipe with a change.
fn why(from: &str, to: &str) -> String {
    assert!(RECIPE.contains(from), "{from}");
    read(&RECIPE.replacen(from, to, 1), DATA, &[]).expect_err(to)
}

#[test]
fn a_sound_recipe_is_read_with_its_units() {
    let r = read(RECIPE, DATA, &[]).unwrap();
    let young = &r.parameters[1];
    assert_eq!((young.low, young.high, young.log), (1e6, 1e9, true));
    let target = r.tests[0].target.as_ref().unwrap();
    assert_eq!((target.points.len(), target.origin.as_str()), (6, "the curve's own scatter"));
    let sand = RECIPE.replace("bounds = [0.1, 0.9]", "prior = \"material:sand:sliding_friction\"");
    let r = read(&sand, DATA, &[]).unwrap();
    assert!(r.parameters[0].source.as_ref().unwrap().contains("doi:10.1016/j.powtec.2017.01.015"));
    assert!(r.parameters[0].low < 0.12 && r.parameters[0].high > 0.52);
}

#[test]
fn recipes_are_refused_with_place_and_cure() {
    for (from, to, message) in [
        ("[0.1, 0.9]", "[0.9, 0.1]", "r.toml:5:10: bounds = [0.9, 0.1]: they cross: write [0.1, 0.9]"),
        ("[0.1, 0.9]", "[0.9]", "1 numbers: give two"),
        ("[0.1, 0.9]", "[0.9, 0.9]", "leave nothing to find"),
        ("[0.1, 0.9]", "[nan, 0.9]", "give a finite number"),
        ("bounds = [0.1", "bouds = [0.1", "r.toml:5:1: unknown key 'bouds'; did you mean 'bounds'?"),
        ("\"1 MPa\"", "\"1 MN\"", "the unit 'MN' has another dimension than 'Pa'"),
        ("\"1 MPa\"", "\"1 Mpa\"", "the unit 'Mpa' is not known; expected 'Pa'"),
        ("{mu}", "{mo}", "nothing fills the blank {mo}; did you mean 'mu'?"),
        ("{mu}", "0.5", "parameter 'mu' changes nothing"),
        ("trials = 40", "trials = 40\nseeds = 0", "seeds = 0: give a whole number from 1 to 1000"),
        ("trials = 40", "trials = 3", "give first from 4 to trials"),
        (" --seed {seed}\"", "\"\nfrom = 9\nuntil = 1", "from = 9 and until = 1 cross"),
        ("[settings]\n", "[settings]\nsteps = 3\n", "unknown key 'steps'"),
        ("[[test]]", "[test]", "write it with two brackets"),
        ("name = \"young\"", "name = \"mu\"", "is there twice"),
        ("name = \"young\"", "name = \"seed\"", "other than seed and here"),
        ("y = \"tau\"", "y = \"ta\"", "no column 'ta'"),
        ("y = \"tau\"\n", "", "x without y"),
        ("data = \"lab.csv\"", "value = 3", "value is for a number"),
        ("data = \"lab.csv\"", "", "has neither data nor value"),
        ("data = \"lab.csv\"", "data = \"none.csv\"", "none.csv: cannot read the data"),
        ("data = \"lab.csv\"", "data = \"lab.csv\"\ndeviation = -1", "deviation = -1: give a number above 0"),
        ("bounds = [0.1, 0.9]", "prior = \"material:sandd\"", "did you mean 'sand'?"),
        ("bounds = [0.1, 0.9]", "bounds = [0, 0.9]\nscale = \"log\"", "has no logarithm"),
        (
            "[[test]]",
            "[[step]]\nname = \"s\"\nfit = \"mo\"\n[[test]]",
            "fit: no parameter 'mo'; did you mean 'mu'?",
        ),
        (
            "[[test]]",
            "[[step]]\nname = \"s\"\nfit = \"mu\"\nto = [\"shar\"]\n[[test]]",
            "no test 'shar'; did you mean 'shear'?",
        ),
        (
            "[[test]]",
            "[[step]]\nname = \"s\"\nfit = \"mu\"\nto = [{ test = \"shear\", from = 7 }]\n[[test]]",
            "its data reach from 0 to 5",
        ),
        (
            "trials = 40",
            "trials = 40\nwith = { n = 5 }",
            "with: 'n' changes nothing: no command has the blank {n}",
        ),
        ("trials = 40", "trials = 40\nwith = { mu = 5 }", "with: 'mu' is a parameter"),
        ("trials = 40", "trials = 40\nwith = { seed = 5 }", "other than seed and here"),
        ("{mu}", "{mu} {n}", "nothing fills the blank {n}"),
        (
            "data = \"lab.csv\"",
            "data = \"lab.csv\"\n[[test]]\nname = \"sized\"\ncommand = \"model {mu} {n}\"\nvalue = 1\ndeviation = 1\n\
             [[step]]\nname = \"small\"\nfit = \"mu\"\nwith = { n = 3 }\n[[step]]\nname = \"large\"\nfit = \"mu\"\n",
            "step 'large': nothing fills the blank {n} of test 'sized': add with = { n = … }",
        ),
        (
            "data = \"lab.csv\"",
            "data = \"lab.csv\"\n[[test]]\nname = \"plain\"\ncommand = \"model {mu}\"\nvalue = 1\ndeviation = 1\n\
             [[step]]\nname = \"s\"\nfit = \"young\"\nto = [\"plain\"]\n",
            "step 's' fits 'young', and no test that it fits to has the blank {young}",
        ),
        (
            "data = \"lab.csv\"",
            "data = \"lab.csv\"\n[[test]]\nname = \"sized\"\ncommand = \"model {mu} {n}\"\nvalue = 1\ndeviation = 1\n\
             [[step]]\nname = \"s\"\nfit = \"mu\"\nto = [\"shear\"]\nwith = { n = 3 }\n",
            "step 's': with: 'n' changes nothing: no test that it fits to has the blank {n}",
        ),
        (
            "data = \"lab.csv\"",
            "data = \"lab.csv\"\n[[test]]\nname = \"sized\"\ncommand = \"model {mu} {n}\"\nvalue = 1\ndeviation = 1\n\
             [[step]]\nname = \"s\"\nfit = \"mu\"\nwith = { n = \"2 mm\" }\n",
            "with: n = \"2 mm\": a command gets it as it is: give one word",
        ),
        (
            "trials = 40",
            "trials = 40\nfirst = 40\nbatch = 4",
            "r.toml:4:9: batch: changes nothing: all trials come first",
        ),
        (
            "[[test]]",
            "[[step]]\nname = \"s\"\nfit = \"all\"\ntrials = 50\n[[test]]",
            "trials: changes nothing: every step gives its own",
        ),
        (
            "[[test]]",
            "[[step]]\nname = \"s\"\nfit = \"mu\"\nwith = { n = 5 }\n[[step]]\nname = \"t\"\nfit = \"young\"\nwith = { n = 6 }\nrefines = \"s\"\n[[test]]\n\
             name = \"sized\"\ncommand = \"model {mu} {young} {n}\"\nvalue = 1\ndeviation = 1\n[[test]]",
            "refines = \"s\": it fits other parameters",
        ),
        (
            "[[test]]",
            "[[step]]\nname = \"s\"\nfit = \"all\"\nto = [\"sized\"]\nwith = { n = 5 }\n[[step]]\nname = \"t\"\nfit = \"all\"\nwith = { n = 6 }\nrefines = \"s\"\n[[test]]\n\
             name = \"sized\"\ncommand = \"model {mu} {young} {n}\"\nvalue = 1\ndeviation = 1\n[[test]]",
            "refines = \"s\": it does not fit to this part of test 'shear'",
        ),
        (
            "[[test]]",
            "[[step]]\nname = \"s\"\nfit = \"mu\"\nrefines = \"s\"\n[[test]]",
            "refines: no step 's' comes before",
        ),
        (
            "[[test]]",
            "[[step]]\nname = \"s\"\nfit = \"mu\"\n[[step]]\nname = \"t\"\nfit = \"mu\"\nrefines = \"s\"\n[[test]]",
            "refines = \"s\": its specimens are the same",
        ),
        (
            "[[test]]",
            "[[step]]\nname = \"s\"\nfit = \"mu\"\n[[step]]\nname = \"s\"\nfit = \"young\"\n[[test]]",
            "name = \"s\": is there twice: give the steps different names",
        ),
    ] {
        let found = why(from, to);
        assert!(found.contains(message), "{to}: {found}");
        assert!(found.contains("r.toml") || found.contains(".csv"), "names the file: {found}");
    }
}

#[test]
fn data_are_refused_with_line_and_cure() {
    for (data, message) in [
        ("u,tau\n0,0\n1,\n2,3\n", "lab.csv:3: column 'tau' has a gap"),
        ("u,tau\n0,0\n2,1\n1,3\n", "lab.csv:4: x = 1 follows x = 2: x has to grow"),
        ("u,tau\n0,0\n1,x\n", "lab.csv:3: column 'tau': 'x' is not a finite number"),
        ("u,tau\n0,0\n", "a curve has two or more"),
        ("u,tau\n0,1\n1,2\n2,3\n", "too few to see their scatter: give deviation"),
        ("u,tau\n0,0\n1,0\n2,0\n3,0\n4,0\n5,0\n", "every y is 0"),
        ("u [mile],tau\n0,0\n1,2\n", "unknown unit 'mile'"),
        ("", "is empty"),
    ] {
        let found = read(RECIPE, data, &[]).expect_err(data);
        assert!(found.contains(message), "{data}: {found}");
    }
    let gap = "u,tau\n0,0\n1,1\n2,2\n3,3\n4,4\n5,5\n50,6\n51,7\n";
    let warnings = read(RECIPE, gap, &[]).unwrap().warnings;
    assert!(warnings[0].contains("no points from x = 5 to 50: nothing is compared there"), "{warnings:?}");
    let straight = "u,tau\n0,0\n1,1\n2,2\n3,3\n4,4\n5,5\n";
    let warnings = read(RECIPE, straight, &[]).unwrap().warnings;
    assert!(
        warnings[0].contains("is next to none: 0.1 % of the largest value is taken as deviation"),
        "{warnings:?}"
    );
    let found = read(RECIPE, DATA, &["shaer=lab.csv"]).expect_err("no such test");
    assert!(found.contains("--data shaer=lab.csv: no test 'shaer'; did you mean 'shear'?"), "{found}");
}

#[test]
fn specimens_give_a_mean_and_its_deviation() {
    let folder = TempDir::new().unwrap();
    for (name, factor) in [("a", 0.9), ("b", 1.0), ("c", 1.1)] {
        let rows: String = (0..6).map(|k| format!("{k},{}\n", f64::from(k) * factor)).collect();
        fs::write(folder.path().join(format!("{name}.csv")), format!("u,tau\n{rows}")).unwrap();
    }
    let file = folder.path().join("r.toml");
    fs::write(&file, RECIPE.replace("\"lab.csv\"", "[\"a.csv\", \"b.csv\", \"c.csv\"]")).unwrap();
    let r = recipe::read(&file, &Vec::new()).unwrap();
    let target = r.tests[0].target.as_ref().unwrap();
    let last = target.points.last().unwrap();
    // At x = 5: 4.5, 5, 5.5: variance 0.25; mean of all variances 0.01 × 55/6; half of each, over three specimens.
    let wanted = (0.5 * (0.25 + 0.01 * 55.0 / 6.0) / 3.0f64).sqrt();
    assert!((last.y - 5.0).abs() < 1e-12 && (last.deviation - wanted).abs() < 1e-9, "{last:?} {wanted}");
    assert_eq!((target.specimens, target.origin.as_str()), (3, "scatter of 3 specimens"));
}
