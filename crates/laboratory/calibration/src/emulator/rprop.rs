//! Minimum of a function with its gradient inside a box: iRprop−.
//!
//! Igel & Hüsken (2003), Neurocomputing 50, 105–123, doi:10.1016/S0925-2312(01)00700-7.

use std::cmp::Ordering;

/// A function's value and gradient; `None` where it has none.
pub(super) type Function<'a> = dyn Fn(&[f64]) -> Option<(f64, Vec<f64>)> + 'a;

/// The least value that is met, and where.
pub(super) fn least(
    of: &Function,
    start: &[f64],
    range: &[[f64; 2]],
    steps: usize,
) -> Option<(f64, Vec<f64>)> {
    let inside = |k: usize, v: f64| v.clamp(range[k][0], range[k][1]);
    let mut at: Vec<f64> = start.iter().enumerate().map(|(k, v)| inside(k, *v)).collect();
    let (mut size, mut before) = (vec![0.4; at.len()], vec![0.0; at.len()]);
    let mut best: Option<(f64, Vec<f64>)> = None;
    for _ in 0..steps {
        let Some((value, gradient)) = of(&at) else { break };
        if best.as_ref().is_none_or(|b| value < b.0) {
            best = Some((value, at.clone()));
        }
        for k in 0..at.len() {
            let turned = gradient[k] * before[k];
            let slope = if turned < 0.0 { 0.0 } else { gradient[k] };
            let factor = match turned.partial_cmp(&0.0) {
                Some(Ordering::Greater) => 1.2,
                Some(Ordering::Less) => 0.5,
                _ => 1.0,
            };
            size[k] = f64::clamp(size[k] * factor, 1e-4, 1.5);
            before[k] = slope;
            let way = if slope == 0.0 { 0.0 } else { -size[k] * slope.signum() };
            at[k] = inside(k, at[k] + way);
        }
        if size.iter().all(|s| *s < 2e-3) {
            break;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_valley_is_followed_into_the_corner_of_the_box() {
        let f = |p: &[f64]| {
            Some((
                100.0 * (p[0] - 0.3).powi(2) + (p[1] - 9.0).powi(2),
                vec![200.0 * (p[0] - 0.3), 2.0 * (p[1] - 9.0)],
            ))
        };
        let (_, at) = least(&f, &[-1.0, 0.0], &[[-2.0, 2.0], [-1.0, 5.0]], 60).unwrap();
        assert!((at[0] - 0.3).abs() < 1e-2 && at[1] == 5.0, "{at:?}");
    }
}
