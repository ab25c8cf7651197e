//! Every contact law that a scene can ask for, on a device.

use super::*;
use crate::model::compose::tests::laws;
use gpu::compositions::NAMES;
use std::collections::BTreeSet;

/// The trough with one law for all; every second one with walls that move, every third one sampled.
fn of(n: usize, law: &ContactLaw) -> Setup {
    let make = if n.is_multiple_of(2) { trough } else { shaken };
    let mut setup = make(every_composition()[0]);
    if n.is_multiple_of(3) {
        setup.sampling = Sampling::Sampled;
    }
    setup.contacts = [(0, 0), (0, 1), (1, 1)]
        .map(|between| {
            let mut law = law.clone();
            law.between = between;
            law
        })
        .to_vec();
    setup
}

#[test]
fn the_same_bits_with_every_law() {
    let all = laws(|key| match key.name {
        "stiffness" => Some(2e4),
        "contact_modulus" => Some(1e6),
        // Another way of saying what is said.
        "effective_modulus" | "tangential_ratio" | "tangential_stiffness" | "normal_damping" => None,
        _ => key.example.parse().ok(),
    });
    let mut computed = BTreeSet::new();
    for (n, mut law) in all.into_iter().enumerate() {
        if law.number("contact_modulus").is_some() {
            law.set("stiffness", None);
        }
        let mut device = there(of(n, &law), Local::default());
        let kinds = device.model.kinds.iter().filter_map(kinds::numbers_of);
        computed.extend(kinds.map(|(composition, _)| NAMES[composition]));
        advance(&mut device, 400).expect("within the guards");
        let mut host = here(of(n, &law), 400);
        assert!(bits(&mut device) == bits(&mut host), "{law:?}");
    }
    assert_eq!(computed.len(), NAMES.len(), "{computed:?}");
}
