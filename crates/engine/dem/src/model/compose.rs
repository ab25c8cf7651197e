//! The compositions of effects that are compiled.
//!
//! Each composition is compiled for every width of lanes, with and without the ledger. So that they stay few, the laws and resistances
//! that most scenes use are compiled in every precision; all others in double precision only, where cohesion, the weakening of
//! friction, and moduli or dashpots that are given, which keep nothing, are not compositions of their own but a branch for each group of contacts.

use laws::contact::{Composition, Narrow};
use laws::effects::*;
use laws::simd::Precision;
use std::marker::PhantomData;

macro_rules! compositions {
    (normal: $($nm:ident :: $normal:ident),*; cohesion: $am:ident :: $adhesion:ident;
     sliding: $($sm:ident :: $sliding:ident <$of:ident :: $model:ident>),*; rolling: $($rm:ident :: $rolling:ident),*;
     twisting: $($tm:ident :: $twisting:ident),*;) => {
        /// The effects of a pair, composed.
        pub fn compose(pair: &Pair, precision: Precision) -> Box<dyn Composition> {
            if active(pair.law).all(|d| d.every_precision) {
                if let Some(Linear::Plain(hooke)) = Linear::of(pair) {
                    return in_every_precision(pair, precision, hooke);
                }
                if let Some(hertz) = Hertz::of(pair) {
                    return in_every_precision(pair, precision, hertz);
                }
            }
            $(if let Some(law) = $normal::of(pair) { return adhering(pair, law); })*
            Box::new(())
        }

        fn adhering<N: Effect>(pair: &Pair, law: N) -> Box<dyn Composition> {
            let so_far = (law, $adhesion::of(pair));
            $(if let Some(effect) = $sliding::<$model>::of(pair) { return rolling(pair, (so_far, effect)); })*
            Box::new(so_far)
        }

        fn rolling<E: Effect>(pair: &Pair, so_far: E) -> Box<dyn Composition> {
            $(if let Some(effect) = $rolling::of(pair) { return twisting(pair, (so_far, effect)); })*
            twisting(pair, so_far)
        }

        fn twisting<E: Effect>(pair: &Pair, so_far: E) -> Box<dyn Composition> {
            $(if let Some(effect) = $twisting::of(pair) { return Box::new((so_far, effect)); })*
            Box::new(so_far)
        }
    };
}
laws::effects!(compositions);

fn in_every_precision<N>(pair: &Pair, precision: Precision, law: N) -> Box<dyn Composition>
where
    N: Effect,
{
    let (sliding, rolling) = (SlidingFriction::<f64>::of(pair), RollingResistance::of(pair));
    match (sliding, rolling) {
        (None, _) => precise(precision, law),
        (Some(sliding), None) => precise(precision, (law, sliding)),
        (Some(sliding), Some(rolling)) => precise(precision, (law, (sliding, rolling))),
    }
}

fn precise<E: Effect>(precision: Precision, effects: E) -> Box<dyn Composition> {
    match precision {
        Precision::Double => Box::new(effects),
        Precision::Mixed => Box::new(Narrow(effects, PhantomData::<f64>)),
        Precision::Single => Box::new(Narrow(effects, PhantomData::<f32>)),
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use laws::effects::Compliance;
    use laws::effects::Key;
    use laws::effects::Material;

    /// Every law that a scene can ask for, with these numbers: each normal law with each choice of effects for the other slots.
    pub fn laws(number: impl Fn(&Key) -> Option<f64>) -> Vec<ContactLaw> {
        let with = |mut law: ContactLaw, effect: &Description| {
            effect.keys.iter().for_each(|key| law.set(key.name, number(key)));
            effect.model.into_iter().for_each(|model| law.choose(model.key, model.value));
            law
        };
        let of = |slot: Slot| DESCRIPTIONS.iter().filter(move |d| d.slot == slot);
        let mut all: Vec<ContactLaw> =
            of(Slot::Normal).map(|d| with(ContactLaw::new((0, 0), d.name), d)).collect();
        for slot in [Slot::Cohesion, Slot::Sliding, Slot::Rolling, Slot::Twisting] {
            let more = |law: &ContactLaw| {
                let fits = move |d: &&&Description| {
                    active(law).all(|a| a.excludes.is_none_or(|(slot, _)| slot != d.slot))
                        && d.needs.is_none_or(|needed| active(law).any(|a| a.slot == needed))
                };
                of(slot).filter(fits).map(|d| with(law.clone(), d)).collect::<Vec<_>>()
            };
            all.extend(all.iter().flat_map(more).collect::<Vec<_>>());
        }
        all
    }

    #[test]
    fn kernels_keep_what_their_effects_describe_and_no_more() {
        let material = Material { name: "a".to_owned(), density: 1e3, young: 1e6, poisson: 0.3 };
        let elastic = Elastic::of(&material, &material);
        let all = laws(|_| Some(0.5));
        assert!(all.len() > 70, "{}", all.len());
        for law in all {
            let compliance = Compliance { clumps: 1.0, springs: 1.0 };
            let pair = Pair { law: &law, elastic, compliance, damping: Damping::NONE };
            let composition = compose(&pair, Precision::Double);
            let flips = active(&law).flat_map(|d| d.history);
            let flips = flips.flat_map(|field| vec![field.kind == Kind::Vector; field.kind.columns()]);
            let found: Vec<bool> =
                (0..composition.columns()).map(|column| composition.flips(column)).collect();
            assert_eq!(found, flips.collect::<Vec<_>>(), "{law:?}");
            let has = |slot: Slot| active(&law).any(|d| d.slot == slot);
            assert_eq!(composition.rotates(), has(Slot::Sliding), "{law:?}");
            assert_eq!(composition.torques(), has(Slot::Rolling) || has(Slot::Twisting), "{law:?}");
        }
    }

    /// What does nothing is dropped with its keys, but not what something else needs.
    #[test]
    fn idle_effects_are_dropped() {
        let law = |friction: f64, twisting: f64| {
            let law = ContactLaw::new((0, 0), "jkr").with("restitution", 0.5).with("work_of_adhesion", 0.0);
            needed(&law.with("sliding_friction", friction).with("twisting_resistance", twisting))
        };
        let hertz = ContactLaw::new((0, 0), "hertz").with("restitution", 0.5);
        let (less, dropped) = law(0.0, 0.0);
        assert_eq!((less, dropped.len()), (hertz.clone(), 3), "{dropped:?}");
        let (less, dropped) = law(0.0, 0.1);
        assert_eq!(less, hertz.clone().with("sliding_friction", 0.0).with("twisting_resistance", 0.1));
        assert_eq!(dropped.len(), 1, "{dropped:?}");
        // Without sliding friction nothing turns, so that what resists turning goes with it.
        let rubs = hertz.clone().with("sliding_friction", 0.5).with("twisting_resistance", 0.1);
        let sliding = active(&rubs).find(|d| d.slot == Slot::Sliding).expect("it slides");
        assert_eq!(without(&rubs, sliding), Some(hertz));
    }
}
