//! Where text stands in a picture.

use super::{font, options::PictureOptions, paint::Painted};

/// Height of capitals in a picture of so many pixels [pixel].
pub fn text_height(width: u32, height: u32) -> f64 {
    (f64::from(height.min(width)) / 62.0).max(7.0)
}

/// The parts of a picture in which text stands, as left, top, right, bottom [pixel]: at the top left, and at the bottom
/// left. They are the same for all pictures of a film.
pub fn boxes(painted: &Painted, options: &PictureOptions) -> [[f64; 4]; 2] {
    let [w, h] = [options.width, options.height].map(f64::from);
    let text = text_height(options.width, options.height);
    let margin = 2.2 * text;
    let wide = font::width;
    let time = options.time.map_or(0.0, |t| wide(&format!("t = {t:.3} s"), 1.15 * text));
    let lines = 1.0
        + if options.time.is_some() { 1.1 } else { 0.0 }
        + if painted.bonds.is_some() { 2.0 } else { 0.0 }
        + painted.chains.as_ref().map_or(0.0, |(key, _)| if key.pulls { 2.0 } else { 1.0 })
        + painted.outlines.len() as f64;
    let chains = painted.chains.as_ref().map_or(0.0, |(key, _)| wide(&key.longest(), text));
    let named = painted.outlines.iter().map(|(_, name)| 1.8 * text + wide(name, text));
    let counts = wide(&painted.counts.words(painted.shrunk), text);
    let right = margin + named.fold(time.max(chains).max(counts), f64::max) + text;
    let arrow = if painted.arrows.is_some() { 4.4 * text } else { 0.0 };
    let scale = [0.0, h - margin - 2.6 * text - arrow, margin + 0.16 * w + 2.0 * text, h];
    [[0.0, 0.0, right, margin + 2.1 * lines * text], scale]
}
