//! Every error of the engine: its own text states a fact; the scene's adds the key and the remedy.

mod halts;
mod setup;

use super::explain_setup_error;
use dem::setup::Precision;
use dem::*;

const WALL: &str = "wall 'floor'";

fn pair() -> [String; 2] {
    ["glass".to_owned(), "steel".to_owned()]
}

fn floor() -> String {
    "floor".to_owned()
}

fn out_of_range(of: Subject, name: &'static str, allowed: impl Into<Allowed>) -> SetupError {
    let quantity = of.quantity(name);
    SetupError::OutOfRange(Box::new(OutOfRange { quantity, value: -1.5, unit: "m", allowed: allowed.into() }))
}

/// An error and words that the scene's message must have.
type Advice<E> = (E, &'static [&'static str]);

/// The engine knows no file of the user: no table, no dotted key, no option, no remedy.
fn states_a_fact(text: &str) {
    for word in
        ["[[", "[sleep", "[drag", "time.", "guards.", "neighbours.", "dt =", "--", "shorten", "give ", "use "]
    {
        assert!(!text.contains(word), "'{word}' in: {text}");
    }
}

/// Numbers outside their range: their keys as scenes have them.
#[test]
fn numbers_outside_their_range_have_the_keys_of_scenes() {
    let cases = [
        (Subject::Setup, "gravity", "gravity: -1.5 m"),
        (Subject::Guards, "overlap", "guards.overlap: -1.5 m"),
        (Subject::NeighbourLists, "skin", "neighbours.skin: "),
        (Subject::Drag, "viscosity", "drag.viscosity: "),
        (Subject::Sleep, "speed", "sleep.speed: "),
        (Subject::Sleep, "gravity", "gravity, with [sleep]: "),
        (Subject::Precision(Precision::Mixed), "radius", "precision \"mixed\": radius: "),
        (Subject::Material("glass".to_owned()), "young", "material 'glass': young: "),
        (Subject::Contact(Some(pair())), "restitution", "contact glass–steel: restitution: "),
        (Subject::Bond(None), "between", "bond: between: "),
        (Subject::Particle(7), "radius", "particle 7: radius: "),
        (Subject::PeriodicEnd("low"), "x", "domain low: x: "),
        (Subject::Entry(7), "radius", "inlet: radius of particle 7: "),
        (Subject::Entry(7), "inlet", "inlet of particle 7: "),
        (Subject::EntryAlongFlow(7), "velocity", "inlet: velocity of particle 7 along the flow: "),
        (Subject::EntryClump(7), "shape", "inlet: clump 7: "),
        (Subject::Path(7), "time", "inlet: path of particle 7: time: "),
        (Subject::Wall(floor()), "speed", "wall 'floor': speed: "),
    ];
    for (of, name, key) in cases {
        let text = explain_setup_error(&out_of_range(of, name, "numbers above 0"));
        assert!(text.starts_with(key) && text.contains("is outside numbers above 0"), "{text}");
    }
    let text =
        explain_setup_error(&out_of_range(Subject::Wall(floor()), "material", Allowed::IndexOf("materials")));
    assert!(text.ends_with("the scene's materials"), "{text}");
}
