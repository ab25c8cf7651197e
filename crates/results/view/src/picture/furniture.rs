//! Annotations of a picture: colour bar, scale bar, time, count and axes.

mod extras;

use super::{
    caption::text_height,
    counts::Counts,
    font,
    ink::{Anchor, Canvas, Pen},
    key::Key,
    lens::Lens,
    options::PictureOptions,
    paint::Painted,
    theme::Theme,
};
use crate::appearance::{colour, scale};
use crate::{GrainCount, Role};

/// Adds what of it is in the rows of a canvas.
pub fn add(canvas: Canvas, painted: &Painted, lens: &Lens, options: &PictureOptions) {
    let text = text_height(canvas.size[0], canvas.size[1]);
    let [w, h] = canvas.size.map(f64::from);
    let theme = Theme::of(options.dark);
    let mut pen = Pen { canvas, colour: theme.ink, paper: theme.paper_bytes() };
    match &painted.key {
        Key::Bar { .. } => bar(&mut pen, [w, h], text, &painted.key),
        Key::Kinds { field, names } => {
            let colours: Vec<colour::Rgb> = (0..names.len()).map(colour::kind).collect();
            let by_number =
                if names.is_empty() { format!("{field} (colours repeat)") } else { field.clone() };
            kinds(&mut pen, [w, h], text, &by_number, names, &colours);
        }
        Key::Classes { classes, map } => {
            let of = |k| map.at(classes.share(k)).map(|c| (c * 255.0).round() as u8);
            let colours: Vec<colour::Rgb> = (0..classes.names.len()).map(of).collect();
            kinds(&mut pen, [w, h], text, crate::appearance::field::SIZE, &classes.names, &colours);
        }
        Key::None => {}
    }
    let margin = 2.2 * text;
    let mut line = margin + text;
    if let Some(time) = options.time {
        pen.text([margin, line], 1.15 * text, Anchor::Left, &format!("t = {time:.3} s"));
        line += 2.2 * text;
    }
    pen.text([margin, line], text, Anchor::Left, &count(painted));
    extras::add(
        &mut pen,
        [margin, line + 2.2 * text],
        [margin, h - margin - 4.4 * text],
        text,
        painted,
        lens,
    );
    scale_bar(&mut pen, [margin, h - margin], text, lens, 0.16 * w);
    gnomon(&mut pen, [w - 4.6 * text, h - 4.6 * text], text, lens, theme.axes);
}

/// "50 000 grains, 12 000 wall spheres".
fn count(painted: &Painted) -> String {
    let layers = |role| painted.layers.iter().filter(move |l| l.role == role);
    let spheres = |role| layers(role).map(|l| l.spheres.len()).sum();
    let grains = layers(Role::Grains).map(|l| GrainCount::with(l.spheres.len(), &l.bodies));
    let grains = grains.fold(GrainCount::default(), GrainCount::plus);
    Counts { grains, walls: spheres(Role::Walls), points: spheres(Role::Cloud) }.words(painted.shrunk)
}

/// A number as printed, with a true minus.
fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().any(|b| (b'1'..=b'9').contains(&b)) => format!("−{rest}"),
        Some(rest) => rest.to_owned(),
        None => text,
    }
}

/// The colour bar at the right, pointed at an end that values lie beyond.
fn bar(pen: &mut Pen, [w, h]: [f64; 2], text: f64, key: &Key) {
    let Key::Bar { field, unit, range, beyond, map } = key else { return };
    let ink = pen.colour;
    let (unit, factor) = scale::readable(unit, range.lo.abs().max(range.hi.abs()));
    // In small pictures the axes, too, want their place.
    let (top, bottom) = ((0.22 * h).round(), (0.74 * h).min(h - 10.5 * text).round());
    let width = (1.5 * text).round();
    let (ticks, decimals) = scale::ticks(scale::Range { lo: range.lo * factor, hi: range.hi * factor }, 6);
    let labels: Vec<String> = ticks.iter().map(|&tick| number(tick, decimals)).collect();
    let left = (w - (0.078 * w).max(width + 2.15 * text + widest(&labels, text))).round();
    for y in (top - width) as i64..(bottom + width) as i64 {
        let middle = y as f64 + 0.5;
        let over = (top - middle).max(middle - bottom).max(0.0);
        if over > 0.0 && !beyond[usize::from(middle < top)] {
            continue;
        }
        let inset = 0.5 * over;
        pen.colour = map.at((bottom - middle) / (bottom - top)).map(|c| (c * 255.0).round() as u8);
        pen.fill([left + inset, y as f64, left + width - inset, y as f64 + 1.0]);
    }
    pen.colour = ink;
    for (tick, label) in ticks.into_iter().zip(&labels) {
        let y = bottom - (bottom - top) * range.share(tick / factor);
        pen.strokes(&[[[left + width, y], [left + width + 0.4 * text, y]]], (0.09 * text).max(1.0));
        pen.text([left + width + 1.25 * text, y + 0.5 * text], text, Anchor::Left, label);
    }
    let title = if unit.is_empty() { field.clone() } else { format!("{field} [{unit}]") };
    pen.text([w - 0.9 * text, top - width - 1.3 * text], text, Anchor::Right, &title);
}

/// Width of the longest of some labels [pixel].
fn widest(labels: &[String], height: f64) -> f64 {
    labels.iter().map(|label| font::width(label, height)).fold(0.0, f64::max)
}

/// A patch and a name for each kind.
fn kinds(pen: &mut Pen, [w, h]: [f64; 2], text: f64, field: &str, names: &[String], colours: &[colour::Rgb]) {
    let top = 0.3 * h;
    let own = widest(&[field.to_owned()], text);
    let left = w - (0.085 * w).max(2.8 * text + widest(names, text)).max(own + text);
    pen.text([left, top - 1.4 * text], text, Anchor::Left, field);
    for (n, (name, colour)) in names.iter().zip(colours).enumerate() {
        let y = top + 2.2 * text * n as f64;
        let ink = std::mem::replace(&mut pen.colour, *colour);
        pen.fill([left, y, left + 1.2 * text, y + 1.2 * text]);
        pen.colour = ink;
        pen.text([left + 1.9 * text, y + 1.1 * text], text, Anchor::Left, name);
    }
}

/// A round length at the distance of the point looked at.
fn scale_bar(pen: &mut Pen, [x, y]: [f64; 2], text: f64, lens: &Lens, longest: f64) {
    let metres = scale::round_below(longest / lens.pixels_per_metre());
    let length = metres * lens.pixels_per_metre();
    let line = (0.14 * text).max(1.0);
    let tick = 0.45 * text;
    pen.strokes(
        &[
            [[x, y], [x + length, y]],
            [[x, y - tick], [x, y + tick]],
            [[x + length, y - tick], [x + length, y + tick]],
        ],
        line,
    );
    let (unit, factor) = scale::readable("m", metres);
    let label = format!("{} {unit}", (metres * factor * 1e6).round() / 1e6);
    pen.text([x + 0.5 * length, y - 0.9 * text], text, Anchor::Middle, &label);
}

/// The axes of the world as the eye sees them.
fn gnomon(pen: &mut Pen, [x, y]: [f64; 2], text: f64, lens: &Lens, colours: [[u8; 3]; 3]) {
    let ink = pen.colour;
    for k in 0..3 {
        let [right, down, away] = lens.axis(k);
        if away.abs() > 0.98 {
            continue; // it points at the eye
        }
        pen.colour = colours[k];
        let end = |length: f64| [x + length * text * right, y + length * text * down];
        pen.strokes(&[[[x, y], end(2.2)]], (0.16 * text).max(1.2));
        let [lx, ly] = end(3.1);
        pen.text([lx, ly + 0.33 * text], 0.85 * text, Anchor::Middle, ["x", "y", "z"][k]);
    }
    pen.colour = ink;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a small picture, too: nothing is written over its right edge.
    #[test]
    fn the_labels_of_the_bar_stay_in_the_picture() {
        for size in [[340, 210], [640, 720], [1920, 1080]] {
            let [width, height] = size;
            let mut rgba = vec![255; 4 * (width * height) as usize];
            let range = scale::Range { lo: -11.8, hi: -10.7 };
            let (field, unit) = ("z".to_owned(), "m");
            let key = Key::Bar { field, unit, range, beyond: [true; 2], map: crate::Map::default() };
            let canvas = Canvas { size, top: 0, rgba: &mut rgba };
            let mut pen = Pen { canvas, colour: [0; 3], paper: [255; 3] };
            bar(&mut pen, size.map(f64::from), text_height(width, height), &key);
            let inked = |x: u32| (0..height).any(|y| rgba[4 * (y * width + x) as usize..][..4] != [255; 4]);
            let last = (0..width).rfind(|&x| inked(x)).unwrap();
            assert!(last < width - 2, "{size:?}: ink in column {last}");
        }
    }

    #[test]
    fn numbers_are_printed_for_readers() {
        assert_eq!([number(-0.04, 1), number(-1.5, 1), number(2.0, 0)], ["0.0", "−1.5", "2"]);
    }
}
