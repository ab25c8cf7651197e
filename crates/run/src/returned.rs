//! Warnings about particles that went back through planes, against the flow.

use dem::Returned;

/// A warning for each plane that particles went back through.
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
    lists.iter().flat_map(warning).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_planes_that_grains_went_back_through_are_named() {
        assert!(warnings(&Returned::default()).is_empty());
        let returned =
            Returned { inlets: vec![0, 3], removed: vec![0, 0], outlets: vec![0], fallen: vec![2] };
        let found = warnings(&returned);
        assert!(found.len() == 2 && found[0].starts_with("inlet.1: 3 grains went back"), "{found:?}");
        assert!(found[1].starts_with("outlet.0: 2 grains were recorded"), "{found:?}");
    }
}
