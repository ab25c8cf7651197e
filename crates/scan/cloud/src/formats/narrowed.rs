//! Colours as whole numbers, where they are.

use stream::Values;

/// Colours in the smallest type that holds them all.
pub(crate) fn narrowed(column: Vec<f32>) -> Values {
    let fits = |top: f32| column.iter().all(|&c| c.fract() == 0.0 && (0.0..=top).contains(&c));
    if fits(255.0) {
        Values::U8(column.iter().map(|&c| c as u8).collect())
    } else if fits(65535.0) {
        Values::U16(column.iter().map(|&c| c as u16).collect())
    } else {
        Values::F32(column)
    }
}
