//! Letters as strokes, in the manner of engineering drawings: sharp at any size, and no font file.
//!
//! A glyph is a few strokes. Each begins with its kind, `-` straight, `~` a curve drawn towards its corners,
//! `o` a closed one; then points, a digit for x and a letter for y: `c` the line the text stands on, `g` the top
//! of small letters, `i` the top of capitals, `a` the bottom of `g`.

/// Height of capitals [grid unit].
pub const CAPITAL: f64 = 6.0;

/// Gap between letters [grid unit].
const GAP: f64 = 1.9;

const GLYPHS: [(char, &str); 87] = [
    ('0', "o0c4c4i0i"),
    ('1', "-1h2i2c"),
    ('2', "~0g0i4i4f1e0c -0c4c"),
    ('3', "~0h0i4i4f1f ~1f4f4c0c0d"),
    ('4', "-3c3i0e4e"),
    ('5', "-4i1i0f ~0f1g4g4c0c0d"),
    ('6', "o0c4c4g0g ~0e0f0i3i"),
    ('7', "-0i4i1c"),
    ('8', "o0c4c4f0f o0f4f4i0i"),
    ('9', "o0e4e4i0i ~4g4f4c1c"),
    ('a', "o0c3c3g0g -3c3g"),
    ('b', "-0c0i o0c3c3g0g"),
    ('c', "~3f3g0g0c3c3d"),
    ('d', "-3c3i o0c3c3g0g"),
    ('e', "-0e3e ~3e3g0g0c3c3d"),
    ('f', "~3i1i1f1c -0g2g"),
    ('g', "o0c3c3g0g -3g3c ~3c3a0a0b"),
    ('h', "-0c0i ~0f0g3g3e3c"),
    ('i', "-0c0g -0i0i"),
    ('j', "-1g1c ~1c1a0a -1i1i"),
    ('k', "-0c0i -3g0d -1e3c"),
    ('l', "-0c0i"),
    ('m', "-0c0g ~0f0g2g2e2c ~2f2g4g4e4c"),
    ('n', "-0c0g ~0f0g3g3e3c"),
    ('o', "o0c3c3g0g"),
    ('p', "-0a0g o0c3c3g0g"),
    ('q', "-3a3g o0c3c3g0g"),
    ('r', "-0c0g ~0e0g2g"),
    ('s', "~3f3g0g0e3e3c0c0d"),
    ('t', "~1i1e1c2c -0g2g"),
    ('u', "~0g0e0c3c3e -3g3c"),
    ('v', "-0g2c4g"),
    ('w', "-0g1c2f3c4g"),
    ('x', "-0g3c -0c3g"),
    ('y', "-0g2c -4g1a"),
    ('z', "-0g3g0c3c"),
    ('µ', "-0a0g ~0e0c3c3e -3g3c"),
    ('A', "-0c2i4c -1e3e"),
    ('B', "-0c0i ~0i4i4f0f ~0f4f4c0c"),
    ('C', "~4h4i0i0c4c4d"),
    ('D', "-0c0i ~0i4i4c0c"),
    ('E', "-4i0i0c4c -0f3f"),
    ('F', "-4i0i0c -0f3f"),
    ('G', "~4h4i0i0c4c4e -4e4f2f"),
    ('H', "-0c0i -4c4i -0f4f"),
    ('I', "-0c0i"),
    ('J', "~3i3e3c0c0d"),
    ('K', "-0c0i -4i0e -1f4c"),
    ('L', "-0i0c4c"),
    ('M', "-0c0i2e4i4c"),
    ('N', "-0c0i4c4i"),
    ('O', "o0c5c5i0i"),
    ('P', "-0c0i ~0i4i4f0f"),
    ('Q', "o0c5c5i0i -3e5c"),
    ('R', "-0c0i ~0i4i4f0f -2f4c"),
    ('S', "~4h4i0i0f4f4c0c0d"),
    ('T', "-0i4i -2i2c"),
    ('U', "~0i0e0c4c4e4i"),
    ('V', "-0i2c4i"),
    ('W', "-0i1c3h5c6i"),
    ('X', "-0c4i -0i4c"),
    ('Y', "-0i2f4i -2f2c"),
    ('Z', "-0i4i0c4c"),
    ('.', "-0c0c"),
    (',', "-0c0b"),
    (':', "-0c0c -0f0f"),
    ('-', "-0e2e"),
    ('−', "-0f3f"),
    ('+', "-0f4f -2d2h"),
    ('=', "-0e3e -0g3g"),
    ('/', "-0b3i"),
    ('(', "~2i0h0c2b"),
    (')', "~0i2h2c0b"),
    ('%', "-0c4i o0g1g1i0i o3c4c4e3e"),
    ('°', "o0g2g2i0i"),
    ('·', "-0f0f"),
    ('_', "-0b3b"),
    ('[', "-1i0i0b1b"),
    (']', "-0i1i1b0b"),
    ('<', "-3g0e3c"),
    ('>', "-0g3e0c"),
    ('≤', "-3h0f3d -0c3c"),
    ('≥', "-0h3f0d -0c3c"),
    ('²', "~0h0i2i2h0f -0f2f"),
    ('³', "~0i2i2h0h ~0h2h2f0f"),
    ('×', "-0d3g -0g3d"),
    ('?', "~0h0i3i3f1f1e -1c1c"),
];

/// A character that is not known is shown as an empty frame.
const UNKNOWN: &str = "-0c3c3i0i0c";

/// A straight piece of a stroke, from one end to the other [grid unit].
pub type Piece = [[f64; 2]; 2];

/// The pieces of a line of text that stands on y = 0 with y up, and its width [grid unit].
pub fn lay_out(text: &str) -> (Vec<Piece>, f64) {
    let mut pieces = Vec::new();
    let mut x = 0.0;
    for letter in text.chars() {
        if letter == ' ' {
            x += GAP + 1.2;
            continue;
        }
        let glyph = GLYPHS.iter().find(|(known, _)| *known == letter).map_or(UNKNOWN, |(_, glyph)| glyph);
        let mut width: f64 = if letter.is_ascii_digit() { 4.0 } else { 0.0 };
        for stroke in glyph.split(' ') {
            let corners: Vec<[f64; 2]> = stroke.as_bytes()[1..].chunks_exact(2).map(corner).collect();
            width = corners.iter().fold(width, |w, c| w.max(c[0]));
            let path = path(stroke.as_bytes()[0], &corners);
            pieces.extend(path.windows(2).map(|p| [[p[0][0] + x, p[0][1]], [p[1][0] + x, p[1][1]]]));
        }
        x += width + GAP;
    }
    (pieces, (x - GAP).max(0.0))
}

fn corner(pair: &[u8]) -> [f64; 2] {
    [f64::from(pair[0]) - f64::from(b'0'), f64::from(pair[1]) - f64::from(b'c')]
}

/// The points that a stroke runs through.
fn path(kind: u8, corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let between = |a: [f64; 2], b: [f64; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    let count = corners.len();
    match kind {
        b'o' => {
            let middle = |i: usize| between(corners[i % count], corners[(i + 1) % count]);
            (0..count).flat_map(|i| curve(middle(i), corners[(i + 1) % count], middle(i + 1))).collect()
        }
        b'~' if count > 2 => {
            let last = count - 2;
            let from = |i: usize| if i == 1 { corners[0] } else { between(corners[i - 1], corners[i]) };
            let to =
                |i: usize| if i == last { corners[count - 1] } else { between(corners[i], corners[i + 1]) };
            (1..=last).flat_map(|i| curve(from(i), corners[i], to(i))).collect()
        }
        _ => corners.to_vec(),
    }
}

/// A parabola from a to c that leaves a and reaches c in the direction of b.
fn curve(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    (0..=8).map(move |i| {
        let t = f64::from(i) / 8.0;
        std::array::from_fn(|k| (1.0 - t).powi(2) * a[k] + 2.0 * t * (1.0 - t) * b[k] + t * t * c[k])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_stays_in_its_box() {
        for (letter, _) in GLYPHS {
            let (pieces, width) = lay_out(&letter.to_string());
            assert!(!pieces.is_empty(), "{letter}");
            for [x, y] in pieces.into_iter().flatten() {
                assert!((0.0..=width).contains(&x) && (-2.0..=CAPITAL).contains(&y), "{letter} {x} {y}");
            }
        }
    }

    #[test]
    fn digits_are_equally_wide() {
        assert_eq!(lay_out("1111").1, lay_out("8008").1);
    }
}
