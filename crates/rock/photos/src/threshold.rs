//! The level between a stone and its background.
//!
//! ```text
//! Otsu: t = argmax over t of  w₀ w₁ (m₀ − m₁)²      w, m: shares and means of the values below and above t
//! then  (t − m₀)/σ₀ = (m₁ − t)/σ₁                    σ: standard deviations, with t not in the outer fifths between m₀ and m₁
//! ```
//!
//! The second rule puts the level nearer to the class that scatters less, the background: dark speckle at the edge of a white stone is stone.
//!
//! Otsu (1979), IEEE Trans. Syst. Man Cybern. 9(1), doi:10.1109/TSMC.1979.4310076. It is applied to stored values (about the cube root of
//! the light): in linear light the shaded side of a white stone is nearer to the background than to its lit side. Edges are then found in
//! linear light.

/// What Otsu's rule finds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Split {
    /// Values up to this are the dark class [0–255].
    pub level: u8,
    /// Means of the dark and of the bright class [0–255].
    pub means: [f64; 2],
    /// Share of the variance that is between the classes, 0 to 1 [–].
    pub separation: f64,
}

/// Splits values into dark and bright ones; none when all are equal.
pub fn otsu(values: &[u8]) -> Option<Split> {
    let mut count = [0u64; 256];
    values.iter().for_each(|v| count[usize::from(*v)] += 1);
    let total = values.len() as f64;
    let sum: f64 = (0..256).map(|v| v as f64 * count[v] as f64).sum();
    let mean = sum / total;
    let variance: f64 = (0..256).map(|v| (v as f64 - mean).powi(2) * count[v] as f64).sum::<f64>() / total;
    let (mut below, mut first) = (0.0, 0.0);
    let mut best: Option<(f64, Split)> = None;
    for (level, count) in count.iter().enumerate().take(255) {
        below += *count as f64;
        first += level as f64 * *count as f64;
        if below == 0.0 || below == total {
            continue;
        }
        let means = [first / below, (sum - first) / (total - below)];
        let between = below * (total - below) / (total * total) * (means[1] - means[0]).powi(2);
        if best.is_none_or(|(most, _)| between > most) {
            best = Some((between, Split { level: level as u8, means, separation: between / variance }));
        }
    }
    best.map(|(_, split)| Split { level: between(&count, split.level, split.means), ..split })
}

/// The level at the same number of standard deviations from both classes.
fn between(count: &[u64; 256], level: u8, [low, high]: [f64; 2]) -> u8 {
    let deviation = |from: usize, to: usize, mean: f64| {
        let n: u64 = count[from..to].iter().sum();
        let squares: f64 = (from..to).map(|v| count[v] as f64 * (v as f64 - mean).powi(2)).sum();
        (squares / n.max(1) as f64).sqrt() + 1.0
    };
    let level = usize::from(level) + 1;
    let (s, t) = (deviation(0, level, low), deviation(level, 256, high));
    let share = (s / (s + t)).clamp(0.2, 0.8);
    (low + share * (high - low)) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_peaks_are_parted() {
        let values: Vec<u8> =
            (0..1000).map(|k| if k % 4 == 0 { 190 + (k % 11) as u8 } else { 20 + (k % 7) as u8 }).collect();
        let split = otsu(&values).unwrap();
        // Deviations of 2 and of 3.2, and 1 for both.
        assert!((88..98).contains(&split.level) && split.separation > 0.99, "{split:?}");
        assert_eq!(otsu(&[5; 100]), None);
    }
}
