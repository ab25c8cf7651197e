//! The level between a stone and its background.
//!
//! ```text
//! Otsu: t = argmax over t of  w₀ w₁ (m₀ − m₁)²      w, m: shares and means of the values below and above t
//! ```
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
    // Between two far peaks every level is as good: the one half way.
    best.map(|(_, split)| Split { level: (split.means.iter().sum::<f64>() / 2.0) as u8, ..split })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_peaks_are_parted_half_way() {
        let values: Vec<u8> =
            (0..1000).map(|k| if k % 4 == 0 { 190 + (k % 11) as u8 } else { 20 + (k % 7) as u8 }).collect();
        let split = otsu(&values).unwrap();
        assert!((100..118).contains(&split.level) && split.separation > 0.99, "{split:?}");
        assert_eq!(otsu(&[5; 100]), None);
    }
}
