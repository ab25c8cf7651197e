//! Annotations of a picture: colour bar, scale bar, time, count and axes.

mod bar;
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
    // Kinds leave place below for the bar of walls.
    let top = if painted.wall_key.is_some() { 0.14 } else { 0.3 };
    if let Some((key, _)) = &painted.chains {
        bar::add(&mut pen, [w, h], text, &key.bar, where_bar(painted, 0));
    }
    match &painted.key {
        Key::Bar(key) => bar::add(&mut pen, [w, h], text, key, where_bar(painted, 0)),
        Key::Kinds { field, names } => {
            let colours: Vec<colour::Rgb> = names.iter().map(|(number, _)| colour::kind(*number)).collect();
            let by_number =
                if names.is_empty() { format!("{field} (colours repeat)") } else { field.clone() };
            let names: Vec<String> = names.iter().map(|(_, name)| name.clone()).collect();
            kinds(&mut pen, [w, h], (text, top), &by_number, &names, &colours);
        }
        Key::Classes { classes, map } => {
            let of = |k| map.at(classes.share(k)).map(|c| (c * 255.0).round() as u8);
            let colours: Vec<colour::Rgb> = (0..classes.names.len()).map(of).collect();
            kinds(&mut pen, [w, h], (text, top), crate::appearance::field::SIZE, &classes.names, &colours);
        }
        Key::None => {}
    }
    if let Some(key) = &painted.wall_key {
        bar::add(&mut pen, [w, h], text, &key.bar, where_bar(painted, 1));
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

/// Where a colour bar stands in the height of a picture [–]: that of grains above that of walls, where there are both.
fn where_bar(painted: &Painted, number: usize) -> [f64; 2] {
    let alone = matches!(painted.key, Key::None) && painted.chains.is_none();
    match &painted.wall_key {
        Some(_) if alone => [0.22, 0.74],
        None => [0.22, 0.74],
        _ => [[0.12, 0.38], [0.54, 0.79]][number],
    }
}

/// "50 000 grains, 12 000 wall spheres".
fn count(painted: &Painted) -> String {
    let layers = |role| painted.layers.iter().filter(move |l| l.role == role);
    let spheres = |role| layers(role).map(|l| l.spheres.len()).sum();
    let grains = layers(Role::Grains).map(|l| GrainCount::with(l.spheres.len(), &l.bodies));
    let grains = grains.fold(GrainCount::default(), GrainCount::plus);
    Counts { grains, walls: spheres(Role::Walls), points: spheres(Role::Cloud) }.words(painted.shrunk)
}

/// Width of the longest of some labels [pixel].
fn widest(labels: &[String], height: f64) -> f64 {
    labels.iter().map(|label| font::width(label, height)).fold(0.0, f64::max)
}

/// A patch and a name for each kind.
fn kinds(
    pen: &mut Pen,
    [w, h]: [f64; 2],
    (text, top): (f64, f64),
    field: &str,
    names: &[String],
    colours: &[colour::Rgb],
) {
    let top = top * h;
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
