//! The effects of a scene, and the scene without each.

use super::calibration::Calibration;
use super::keys;
use dem::Simulation;
use dem::effects::{active, without};
use dem::setup::{Precision, Setup};
use scene::Scene;
use scene::keys::DragLaw;
use scene::plan::Insertion;
use serde::Serialize;

/// One effect of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Effect {
    pub name: String,
    /// Which keys call for it.
    pub why: String,
    /// Memory between steps [B] for each contact.
    pub bytes_per_contact: usize,
    /// Measured share of a step, when it was measured: how much faster the scene is without it, negative where it is slower [–].
    pub share: Option<f64>,
}

/// An effect, and what is needed to measure it.
pub(super) struct EffectToMeasure {
    pub effect: Effect,
    /// The setup without it, where there is one.
    pub without: Option<Setup>,
    /// Whether it acts in contacts alone.
    pub in_contacts: bool,
}

impl EffectToMeasure {
    /// The effect with its share of a step, where that can be measured.
    pub fn measured(self, whole: Option<Calibration>, insertions: &[Insertion]) -> Effect {
        // Where nothing touches, the time of a step does not depend on contacts.
        let whole = whole.filter(|whole| whole.touching > 0 || !self.in_contacts);
        let less = whole.zip(self.without).and_then(|(whole, setup)| whole.compared(setup, insertions));
        let share = less.zip(whole).map(|(less, whole)| 1.0 - less / whole.processor_seconds_per_step);
        Effect { share, ..self.effect }
    }
}

/// A key with its value, and the pairs of materials that it calls for an effect between.
type Call = (String, Vec<String>);

/// Every effect.
pub(super) fn effects(scene: &Scene, setup: &Setup) -> Vec<EffectToMeasure> {
    let written = &scene.keys;
    let mut found = of_contacts(scene, setup);
    let mut add = |name: &str, why: String, without: Option<Setup>| {
        if !why.is_empty() {
            let effect = Effect { name: name.into(), why, bytes_per_contact: 0, share: None };
            found.push(EffectToMeasure { effect, without, in_contacts: false });
        }
    };
    let named = |there: bool, key: String| if there { key } else { String::new() };
    add("clump", clumps(setup), None);
    let bonds = setup.bonds.iter().enumerate();
    let bonds = bonds.map(|(k, b)| format!("bond.{k} ({})", keys::pair(setup, b.between)));
    let loose = Setup { bonds: Vec::new(), entry_bonds: None, ..setup.clone() };
    add("bond", bonds.collect::<Vec<_>>().join(", "), Some(loose));
    let gravity = format!("gravity = {:?}", written.gravity);
    add("gravity", named(setup.gravity.norm() > 0.0, gravity), None);
    let law = written.drag.as_ref().map(|d| match d.law {
        DragLaw::Stokes => "drag.law = \"stokes\"".to_owned(),
        DragLaw::SchillerNaumann => "drag.law = \"schiller-naumann\"".to_owned(),
    });
    add("drag", law.unwrap_or_default(), Some(Setup { drag: None, ..setup.clone() }));
    add("energy", keys::ledger(scene), Some(Setup { ledger: false, ..setup.clone() }));
    let sleep = setup.sleep.map(|s| format!("sleep.speed = {}", s.speed));
    add("sleep", sleep.unwrap_or_default(), Some(Setup { sleep: None, ..setup.clone() }));
    let precision = format!("precision = \"{}\"", setup.precision.name());
    let double = Setup { precision: Precision::Double, ..setup.clone() };
    let single = setup.precision == Precision::Single;
    let reduced = named(setup.precision != Precision::Double, precision);
    add(if single { "single precision" } else { "mixed precision" }, reduced, Some(double));
    let axes: Vec<String> =
        written.domain.periodic.iter().map(|a| format!("\"{a:?}\"").to_lowercase()).collect();
    add("periodic domain", named(!axes.is_empty(), format!("domain.periodic = [{}]", axes.join(", "))), None);
    let strained = written.domain.strain.axes().into_iter().filter(|(_, strain)| strain.is_some());
    let strained: Vec<String> = strained.map(|(axis, _)| format!("domain.strain.{axis}")).collect();
    add("strained domain", strained.join(", "), None);
    add("outlet", keys::numbered("outlet", setup.outlets.len()), None);
    add("remove", keys::numbered("remove", setup.removals.len()), None);
    add("inlet", keys::numbered("inlet", written.inlet.len()), None);
    add("insert", keys::numbered("insert", written.insert.len()), None);
    add("wall motion", keys::motions(scene, setup, false), None);
    add("belt", keys::belts(scene, setup), None);
    add("servo", keys::motions(scene, setup, true), None);
    found
}

fn clumps(setup: &Setup) -> String {
    let shapes = setup.clumps.shapes.iter().enumerate();
    let shapes = shapes.map(|(k, s)| format!("clump.{k} '{}' of {}", s.name, s.spheres.len()));
    let shapes = shapes.collect::<Vec<_>>().join(", ");
    let (body, member) = Simulation::bytes_of_clump();
    if shapes.is_empty() { shapes } else { format!("{shapes}: {body} B a body, {member} B a member") }
}

/// Effects of contact, each once, with the keys and pairs that call for it.
fn of_contacts(scene: &Scene, setup: &Setup) -> Vec<EffectToMeasure> {
    let number_bytes = if setup.precision == Precision::Single { size_of::<f32>() } else { size_of::<f64>() };
    let mut found: Vec<(EffectToMeasure, Vec<Call>)> = Vec::new();
    for (place, c) in setup.contacts.iter().enumerate() {
        let entry = keys::entry(scene, setup, c);
        let from = entry.map_or("wall file: ".to_owned(), |at| format!("contact.{at}."));
        for effect in active(c) {
            let name = effect.name;
            let (bytes, less) = (number_bytes * effect.columns(), without(c, effect));
            let at = found.iter().position(|(entry, _)| entry.effect.name == name).unwrap_or_else(|| {
                let (name, why) = (name.to_owned(), String::new());
                let effect = Effect { name, why, bytes_per_contact: 0, share: None };
                let without = less.is_some().then(|| setup.clone());
                found.push((EffectToMeasure { effect, without, in_contacts: true }, Vec::new()));
                found.len() - 1
            });
            let (entry, calls) = &mut found[at];
            entry.effect.bytes_per_contact = entry.effect.bytes_per_contact.max(bytes);
            if let (Some(setup), Some(less)) = (&mut entry.without, less) {
                setup.contacts[place] = less;
            }
            let key = format!("{from}{}", effect.because(c));
            keys::add_pair(calls, key, keys::pair(setup, c.between));
        }
    }
    let named = |(mut entry, calls): (EffectToMeasure, Vec<Call>)| {
        let calls = calls.into_iter().map(|(key, pairs)| format!("{key} ({})", pairs.join(", ")));
        entry.effect.why = calls.collect::<Vec<_>>().join("; ");
        entry
    };
    found.into_iter().map(named).collect()
}
