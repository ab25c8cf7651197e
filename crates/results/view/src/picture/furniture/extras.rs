//! What bonds, cracks and arrows mean.

use crate::appearance::colour::Rgb;
use crate::picture::{
    chains::PULL,
    ink::{Anchor, Pen},
    lens::Lens,
    paint::Painted,
    shapes::{self, ArrowKey},
};
use crate::things::bodies::grouped;

/// Adds what there is: bonds from `top` down, the arrow at `bottom`.
pub fn add(pen: &mut Pen, top: [f64; 2], bottom: [f64; 2], text: f64, painted: &Painted, lens: &Lens) {
    if let Some((key, count)) = &painted.chains {
        pen.text(top, text, Anchor::Left, &count.words());
        if key.pulls {
            row(pen, [top[0], top[1] + 2.0 * text], text, PULL, "contacts that pull");
        }
    }
    for (k, (kind, name)) in painted.outlines.iter().enumerate() {
        row(pen, [top[0], top[1] + 2.0 * text * k as f64], text, kind.colour(), name);
    }
    if let Some([whole, broken]) = painted.bonds {
        let rows = [(shapes::WHOLE, whole, "bonds"), (shapes::BREAK, broken, "broken")];
        for (k, (colour, count, word)) in rows.into_iter().enumerate() {
            let colour = colour.map(|c| (255.0 * c).round() as u8);
            let words = format!("{} {word}", grouped(count));
            row(pen, [top[0], top[1] + 2.0 * text * k as f64], text, colour, &words);
        }
    }
    if let Some(key) = &painted.arrows {
        arrow(pen, bottom, text, key, lens);
    }
}

/// A patch of a colour, and what it means.
fn row(pen: &mut Pen, [x, y]: [f64; 2], text: f64, colour: Rgb, words: &str) {
    let ink = std::mem::replace(&mut pen.colour, colour);
    pen.fill([x, y - 0.95 * text, x + 1.1 * text, y + 0.05 * text]);
    pen.colour = ink;
    pen.text([x + 1.8 * text, y], text, Anchor::Left, words);
}

/// An arrow of a round value, as long as one at the distance of the point looked at.
fn arrow(pen: &mut Pen, [x, y]: [f64; 2], text: f64, key: &ArrowKey, lens: &Lens) {
    let length = key.example * key.scale * lens.pixels_per_metre();
    let head = (0.8 * text).min(0.6 * length);
    pen.strokes(&[[[x, y], [x + length, y]]], (0.2 * text).max(1.2));
    let tip = [x + length, y];
    let back = |side: f64| [x + length - head, y + 0.45 * side * head];
    pen.strokes(&[[tip, back(1.0)], [tip, back(-1.0)]], (0.2 * text).max(1.2));
    let (unit, factor) = crate::appearance::scale::readable(key.of.unit(), key.example);
    let label = format!("{} {} {unit}", key.of.word(), geom::Shown(key.example * factor));
    pen.text([x, y - 0.9 * text], text, Anchor::Left, &label);
}
