//! What `--explain` says: which key calls for what, what is dropped, and no number where nothing was measured.

use run::explain::{Explained, explain};
use scene::Scene;
use std::path::Path;

const SCENE: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 1.0
[[material]]
name = "sinter"
density = 3300
young = 5e6
poisson = 0.25
[[material]]
name = "steel"
young = 2e8
poisson = 0.3
[[contact]]
between = ["sinter", "*"]
restitution = 0.5
sliding_friction = 0.5
[[fill]]
material = "sinter"
shape = "box:0,0,0,0.1,0.1,0.1"
diameter = [0.01, 0.02]
count = 50
[[wall]]
name = "floor"
plane = "0,0,-0.01,0,0,1"
material = "steel"
"#;

const INSERT: &str = r#"[[insert]]
material = "sinter"
diameter = 0.01
shape = "cylinder:0,0,0.4,0,0,0.5,0.05"
velocity = [0, 0, -1]
rate_count = 400
until = 0.5
"#;

/// What is said without a calibration run.
fn explained(scene: &str, sets: &[&str]) -> Explained {
    asked(scene, sets, false)
}

fn measured(scene: &str, sets: &[&str]) -> Explained {
    asked(scene, sets, true)
}

fn asked(scene: &str, sets: &[&str], measure: bool) -> Explained {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let scene = Scene::new("s.toml", scene.to_owned(), &sets, Path::new("")).unwrap();
    let plan = scene.plan(Vec::new()).unwrap();
    explain(&scene, plan, measure).unwrap()
}

/// The words behind the name, bytes and share of an effect.
fn why(explained: &Explained, effect: &str) -> String {
    let found = explained.fields.effects.iter().find(|e| e.name == effect);
    found.unwrap_or_else(|| panic!("{effect} in {}", explained.text)).why.clone()
}

#[test]
fn every_effect_names_the_key_that_calls_for_it() {
    let steel = "[[contact]]\nbetween = [\"sinter\", \"steel\"]\nlaw = \"hooke\"\nstiffness = 1e4\nrestitution = 0.5\n\
                 sliding_friction = { static = 0.5, dynamic = 0.4, speed = 0.1 }\n[[fill]]";
    let lid = "[[wall]]\nname = \"lid\"\nplane = \"0,0,0.2,0,0,-1\"\nmaterial = \"steel\"\n\
               servo = { direction = [0, 0, -1], force = 20, speed_limit = 0.1 }\nmotion = { translate = [0.1, 0, 0] }\n\
               [domain]\nperiodic = [\"x\", \"y\"]\nlow = [0, 0, 0]\nhigh = [0.1, 0.1, 1]\n\
               [drag]\nlaw = \"schiller-naumann\"\nviscosity = 1.8e-5\ndensity = 1.2\n";
    let scene = SCENE.replacen("[[fill]]", steel, 1) + lid;
    let of = explained(&scene, &["output.contacts=true", "guards.energy=0.1"]);
    for (effect, key) in [
        ("hertz", "contact.0.law = \"hertz\", restitution = 0.5 (sinter–sinter)"),
        ("hooke", "contact.1.law = \"hooke\", stiffness = 10000 N/m, restitution = 0.5 (sinter–steel)"),
        ("sliding_friction", "contact.0.sliding_friction = 0.5 (sinter–sinter)"),
        (
            "weakening friction",
            "contact.1.sliding_friction.static = 0.5, sliding_friction.dynamic = 0.4, \
             sliding_friction.speed = 0.1 m/s (sinter–steel)",
        ),
        ("gravity", "gravity = [0.0, 0.0, -9.81]"),
        ("drag", "drag.law = \"schiller-naumann\""),
        ("energy", "output.contacts = true, guards.energy = 0.1"),
        ("periodic domain", "domain.periodic = [\"x\", \"y\"]"),
        ("wall motion", "wall.1.motion (lid)"),
        ("servo", "wall.1.servo (lid)"),
    ] {
        assert_eq!(why(&of, effect), key);
    }
    assert_eq!(
        why(&explained(SCENE, &[]), "sliding_friction"),
        "contact.0.sliding_friction = 0.5 (sinter–sinter, sinter–steel)"
    );
    assert_eq!(why(&explained(SCENE, &["output.energy=true"]), "energy"), "output.energy = true");
    let inserted = explained(&(SCENE.to_owned() + INSERT), &[]);
    assert_eq!(why(&inserted, "insert"), "insert.0");
    assert!(inserted.fields.effects.iter().all(|e| e.name != "inlet"));
}

#[test]
fn what_cannot_matter_is_dropped_and_says_why() {
    for (set, line) in [
        (
            "contact.0.sliding_friction=0",
            "contact.0.sliding_friction = 0 (sinter–sinter, sinter–steel): has no effect",
        ),
        (
            "contact.0.rolling_resistance=0",
            "contact.0.rolling_resistance = 0 (sinter–sinter, sinter–steel): has no effect",
        ),
        (
            "contact.0.twisting_resistance=0",
            "contact.0.twisting_resistance = 0 (sinter–sinter, sinter–steel): has no effect",
        ),
        (
            "contact.0.sliding_friction={static=0,dynamic=0,speed=1}",
            "contact.0.sliding_friction.static = 0, sliding_friction.dynamic = 0, \
             sliding_friction.speed = 1 m/s (sinter–sinter, sinter–steel): has no effect",
        ),
        ("wall.0.motion={rotate={about=[0,0,1],through=[0,0,0],rpm=0}}", "wall.0.motion: moves nothing"),
    ] {
        let text = explained(SCENE, &[set]).text;
        assert!(text.contains(&format!("dropped        {line}")), "{set}: {text}");
    }
    let with =
        |keys: &str| explained(&SCENE.replacen("restitution", &format!("{keys}\nrestitution"), 1), &[]).text;
    let text = with("law = \"jkr\"\nwork_of_adhesion = 0");
    assert!(
        text.contains("dropped        contact.0.work_of_adhesion = 0 J/m² (")
            && text.contains("\"hertz\" is"),
        "{text}"
    );
    let text = with("cohesion = \"sjkr\"\ncohesion_energy_density = 0");
    assert!(text.contains("dropped        contact.0.cohesion_energy_density = 0 J/m³ ("), "{text}");
    let unused = SCENE.replacen(
        "[[fill]]",
        "[[contact]]\nbetween = [\"steel\", \"steel\"]\nrestitution = 1\n[[fill]]",
        1,
    );
    assert!(explained(&unused, &[]).text.contains("dropped        contact.1: holds for no two"));
    assert!(explained(SCENE, &[]).fields.dropped.is_empty());
}

/// Half a second of 400 grains a second, there for three quarters of a run of a second.
#[test]
fn grains_that_come_in_count_in_the_time_and_without_any_there_is_none() {
    // Stiff enough for grains that fall from the faucet.
    let scene = SCENE.replacen("young = 5e6", "young = 1e8", 1) + INSERT;
    let fields = measured(&scene, &[]).fields;
    let (all, there) = fields.coming.particles;
    // The run ends at the step that is nearest to a second.
    assert!((all - 200.0).abs() < 1e-9 && (there - 150.0).abs() < 0.01, "{all}, {there} on average");
    assert_eq!(fields.coming.insertions, ["insert.0"]);
    let calibration = fields.calibration.unwrap_or_else(|| panic!("{:?}", fields.unmeasured));
    assert!(calibration.particles >= 50 && calibration.time <= 0.5);
    // Those of the start, and those that come.
    let growth = (50.0 + there) / calibration.particles as f64;
    let expected = calibration.seconds_per_step * fields.steps as f64 * growth;
    assert!((fields.expected_seconds.unwrap() / expected - 1.0).abs() < 1e-12);

    let (start, end) = (scene.find("[[fill]]").unwrap(), scene.find("[[wall]]").unwrap());
    let empty = scene[..start].to_owned() + &scene[end..];
    let poured = measured(&empty, &["insert.0.until=1"]).fields.calibration.unwrap();
    assert!(poured.particles > 0 && poured.time > 0.0);

    // The faucet opens when the run is over.
    let late = measured(&empty, &["insert.0.from=2", "insert.0.until=3"]);
    assert!(late.fields.calibration.is_none() && late.fields.expected_seconds.is_none());
    assert!(late.fields.effects.iter().all(|e| e.share.is_none()), "{}", late.text);
    for words in ["insert.0 brings about 0 until", "expected       unknown: no particle is there"] {
        assert!(late.text.contains(words), "'{words}' in {}", late.text);
    }
    let (_, shares) = late.text.split_once("called for by").unwrap();
    assert!(!shares.contains(" % "), "{}", late.text);
}

/// What a contact takes does not depend on how many there are.
#[test]
fn bytes_of_a_contact_are_those_of_its_kind() {
    let of = |count: &str| explained(SCENE, &[&format!("fill.0.count={count}")]).fields.bytes_per_contact;
    let one = of("1");
    assert_eq!((one.listed, one.wrench, one.ledger), (8, 64, 0));
    assert_eq!(one, of("60"));
}

/// What accuracy costs, where every user meets it: at the step of an accuracy an impact is off by that, and 1 % takes as many steps as a run that asks for it.
#[test]
fn an_impact_is_off_by_the_accuracy_that_was_asked_for() {
    let at = |set: &str| explained(SCENE, &[set]);
    for (set, wanted) in [("0.1%", 1e-3), ("0.2%", 2e-3), ("0.5%", 5e-3)] {
        let impact = at(&format!("time.accuracy=\"{set}\"")).fields.impact_error.expect("measured");
        assert!((impact.error / wanted - 1.0).abs() < 1e-4 && impact.law == "hertz", "{impact:?}");
    }
    // No longer step was measured than the one that is taken here.
    let percent = at("time.accuracy=\"1%\"");
    let impact = percent.fields.impact_error.expect("measured");
    assert!(impact.error <= 0.01 && impact.within_percent.is_some(), "{impact:?}");
    let usual = at("time.safety=0.5");
    assert!(usual.text.contains("impact         off by up to "), "{}", usual.text);
    let (_, told) = usual.text.split_once("; 1 % takes ").unwrap();
    let (told, _) = told.split_once(" % of the steps").unwrap();
    let times = percent.fields.steps as f64 / usual.fields.steps as f64;
    assert!((told.parse::<f64>().unwrap() / 100.0 - times).abs() <= 0.006, "{times}: {}", usual.text);
    let sampled = at("time.contacts=\"sampled\"").fields.impact_error.expect("measured");
    assert!(sampled.error > 3.0 * usual.fields.impact_error.expect("measured").error, "{sampled:?}");
}
