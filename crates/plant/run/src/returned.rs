//! What is said of particles that went back through planes, against the flow, of cuts that hold back the stream, and of what was taken out.

use dem::setup::Removed;
use dem::{HeldBack, NoRoom, Returned};
use geom::{Shown, counted};

/// Share of the momentum of a stream above which a cut holds it back [–]: where a stream falls freely, undivided or cut, it is 0.02.
const HOLDS_BACK: f64 = 0.05;
/// Fewer than these say nothing.
const FEWEST: u64 = 20;

/// A warning for each plane that particles went back through, and for each that holds back the stream.
pub fn warnings(returned: &Returned) -> Vec<String> {
    let lists = [
        (
            &returned.inlets,
            "inlet",
            "went back through the calculation plane: what they meet there is not simulated (the run stops at one that goes back through the \
             whole zone, unless guards.zones says otherwise); where there are many, cut the plant farther upstream",
        ),
        (
            &returned.removed,
            "inlet",
            "were taken out (guards.zones = \"remove\"): they had gone back through the whole zone, or stood in it where another came in; their \
             mass is missing downstream, so where there are many, cut the plant farther upstream",
        ),
        (
            &returned.outlets,
            "outlet",
            "were past the storage plane when the run started, and came back upstream: they are recorded when they pass it again",
        ),
        (
            &returned.fallen,
            "outlet",
            "were recorded, and fell back through the storage plane in the zone, where they were taken out: the stage downstream has them all \
             the same; turn the plane with the flow, or cut where grains do not come back",
        ),
    ];
    let warning = |(counts, zone, what): &(&Vec<u64>, &str, &str)| {
        let of =
            |(i, count): (usize, &u64)| (*count > 0).then(|| format!("{zone}.{i}: {count} grains {what}"));
        counts.iter().enumerate().filter_map(of).collect::<Vec<_>>()
    };
    let held = returned
        .held_back
        .iter()
        .enumerate()
        .filter_map(|(i, of)| Some(format!("outlet.{i}: {}", held_back(of)?)));
    let inserts = returned.inserts.iter().enumerate().flat_map(|(k, insert)| no_room(k, insert));
    lists.iter().flat_map(warning).chain(held).chain(inserts).collect()
}

/// What each `[[remove]]` has taken out.
pub fn removals(returned: &Returned) -> Vec<String> {
    let said = |(k, &Removed { count, mass }): (usize, &Removed)| {
        format!("remove.{k} took out {} of {} kg", counted(count as usize, "grain"), Shown(mass))
    };
    returned.regions.iter().enumerate().map(said).collect()
}

/// What insertion `k` found no room for.
fn no_room(k: usize, &NoRoom { waited, waiting, skipped }: &NoRoom) -> Vec<String> {
    let cure = format!("lower insert.{k}.rate, or move insert.{k}.shape to where nothing lies or piles up");
    let grains = |count: u64| counted(count as usize, "grain");
    let mut all = Vec::new();
    if skipped > 0 {
        let left_out = grains(skipped);
        all.push(format!(
            "insert.{k}: {left_out} found no room and did not come in (when_blocked = \"skip\"): {cure}"
        ));
    }
    if waited > 0 {
        let (late, came) = (grains(waited), waited - waiting);
        all.push(format!(
            "insert.{k}: {late} found no room when due; {came} came in later, {waiting} still wait: {cure}"
        ));
    }
    all
}

/// How much of its stream an outlet holds back, where that is more than a free stream has.
fn held_back(&HeldBack { impulse, momentum, passed }: &HeldBack) -> Option<String> {
    let share = impulse / momentum;
    (passed >= FEWEST && share > HOLDS_BACK).then(|| {
        format!(
            "grains behind its plane held back those that follow by {} N s, {} % of the momentum of the stream ({} N s); where a stream is free it is about 2 %. Unless they press each other \
             forward anyway, as a bed that is pushed, the flow is another than without the cut: move the plane 3 to 4 grain diameters down the stream, or give the outlet motion = \"recorded\" \
             where it has another",
            Shown(impulse),
            Shown((1e3 * share).round() / 10.0),
            Shown(momentum)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_planes_that_grains_went_back_through_are_named() {
        assert!(warnings(&Returned::default()).is_empty());
        let returned = Returned {
            inlets: vec![0, 3],
            removed: vec![0, 0],
            outlets: vec![0],
            fallen: vec![2],
            ..Returned::default()
        };
        let found = warnings(&returned);
        assert!(found.len() == 2 && found[0].starts_with("inlet.1: 3 grains went back"), "{found:?}");
        assert!(found[1].starts_with("outlet.0: 2 grains were recorded"), "{found:?}");
        let inserts = vec![
            NoRoom::default(),
            NoRoom { waited: 1, waiting: 0, skipped: 0 },
            NoRoom { waited: 9, waiting: 2, skipped: 3 },
        ];
        let found = warnings(&Returned { inserts, ..Returned::default() });
        assert!(
            found.len() == 3
                && found[0].starts_with(
                    "insert.1: 1 grain found no room when due; 1 came in later, 0 still wait: lower"
                ),
            "{found:?}"
        );
        assert!(found[1].starts_with("insert.2: 3 grains found no room and did not come in"), "{found:?}");
        assert!(
            found[2].contains(
                "9 grains found no room when due; 7 came in later, 2 still wait: lower insert.2.rate"
            ),
            "{found:?}"
        );
        let held = |impulse| HeldBack { impulse, momentum: 2.0, passed: 30 };
        let returned = Returned { held_back: vec![held(0.05), held(0.25)], ..Returned::default() };
        let found = warnings(&returned);
        assert!(found.len() == 1 && found[0].starts_with("outlet.1: grains behind its plane"), "{found:?}");
        assert!(found[0].contains("by 0.25 N s, 12.5 % of the momentum of the stream (2 N s)"), "{found:?}");
    }
}
