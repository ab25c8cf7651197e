//! The Pareto front of settings, and the fastest setting that is good enough.

use crate::point::Error;

/// Which points no other beats in both work and error: the Pareto front, from little work to much.
/// Of equals the first counts.
pub fn front(work: &[f64], errors: &[Option<Error>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..work.len())
        .filter(|k| work[*k].is_finite() && errors.get(*k).is_some_and(Option::is_some))
        .collect();
    let size = |k: usize| errors[k].map_or(f64::NAN, |e| e.size);
    order.sort_by(|a, b| work[*a].total_cmp(&work[*b]).then(size(*a).total_cmp(&size(*b))).then(a.cmp(b)));
    let mut best = f64::INFINITY;
    order.retain(|k| {
        let better = size(*k) < best;
        best = best.min(size(*k));
        better
    });
    order
}

/// What to take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Choice {
    /// The fastest point whose error, with its interval, is within what was asked for.
    Point(usize),
    /// Only the reference itself is: everything else is too far from it.
    OnlyReference(usize),
    /// None is; the point that comes nearest.
    None(Option<usize>),
}

/// The fastest point whose upper end of the error is not above `wanted`; `reference` has no error by definition and is
/// the last resort.
pub fn recommend(work: &[f64], errors: &[Option<Error>], reference: Option<usize>, wanted: f64) -> Choice {
    let upper = |k: usize| errors[k].map_or(f64::INFINITY, |e| e.upper());
    let known: Vec<usize> =
        (0..errors.len()).filter(|k| errors[*k].is_some() && work[*k].is_finite()).collect();
    let others = || known.iter().copied().filter(|k| Some(*k) != reference);
    let good = others().filter(|k| upper(*k) <= wanted).min_by(|a, b| work[*a].total_cmp(&work[*b]));
    match (good, reference) {
        (Some(good), Some(reference)) if work[reference] <= work[good] => Choice::Point(reference),
        (Some(good), _) => Choice::Point(good),
        (None, Some(reference)) if known.contains(&reference) => Choice::OnlyReference(reference),
        _ => Choice::None(others().min_by(|a, b| upper(*a).total_cmp(&upper(*b)))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some(size: f64, interval: f64) -> Option<Error> {
        Some(Error { size, interval, relative: true })
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let work = [1.0, 2.0, 3.0, 4.0, 2.0, f64::NAN];
        let errors = [some(0.5, 0.0), some(0.1, 0.0), some(0.2, 0.0), some(0.05, 0.0), None, some(0.0, 0.0)];
        assert_eq!(front(&work, &errors), [0, 1, 3]);
    }

    #[test]
    fn the_fastest_whose_upper_end_is_within_is_recommended() {
        let work = [1.0, 2.0, 3.0, 10.0];
        let errors = [some(0.02, 0.0), some(0.009, 0.004), some(0.008, 0.001), some(0.0, 0.0)];
        assert_eq!(
            recommend(&work, &errors, Some(3), 0.01),
            Choice::Point(2),
            "1.3 % is the end of the second"
        );
        assert_eq!(recommend(&work, &errors, Some(3), 0.013), Choice::Point(1));
        assert_eq!(recommend(&work, &errors, Some(3), 0.5), Choice::Point(0));
        assert_eq!(recommend(&work, &errors, Some(3), 1e-4), Choice::OnlyReference(3));
        assert_eq!(recommend(&work[..3], &errors[..3], None, 1e-4), Choice::None(Some(2)));
        assert_eq!(recommend(&[f64::NAN], &[None], None, 1.0), Choice::None(None));
        assert_eq!(
            recommend(&[1.0, 0.5], &[some(0.0, 0.0), some(0.0, 0.0)], Some(1), 0.01),
            Choice::Point(1)
        );
    }
}
