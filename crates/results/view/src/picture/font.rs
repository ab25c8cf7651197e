//! Letters of pictures: DejaVu Sans, as in plots. `data/DejaVuSans.ttf` has its Latin and Greek letters, digits and signs, without hints.

use fontdue::{Font, FontSettings};
use std::sync::LazyLock;

static FONT: LazyLock<Option<Font>> = LazyLock::new(|| {
    let file: &[u8] = include_bytes!("../../data/DejaVuSans.ttf");
    Font::from_bytes(file, FontSettings::default()).ok()
});

/// Height of capitals over that of the typeface [–].
const CAPITAL: f32 = 1493.0 / 2048.0;

/// Size of letters whose capitals are so high [pixel].
fn size(height: f64) -> f32 {
    height as f32 / CAPITAL
}

/// Rows above and below the line that letters stand on, in which all of them are [pixel].
pub fn reach(height: f64) -> [f64; 2] {
    [1.2, 0.5].map(|ems| ems * f64::from(size(height)))
}

/// The ink of a line of text.
pub struct Ink {
    /// Its first column right of where the text begins, and its first row above the line that the text stands on [pixel].
    pub corner: [i32; 2],
    /// Columns and rows.
    pub size: [usize; 2],
    /// Share of each pixel that is ink, row by row, 0 to 1.
    pub shares: Vec<f64>,
}

/// Width of a line of text whose capitals are so high [pixel].
pub fn width(text: &str, height: f64) -> f64 {
    let Some(font) = FONT.as_ref() else { return 0.0 };
    let size = size(height);
    text.chars().map(|letter| f64::from(font.metrics(letter, size).advance_width)).sum()
}

/// A letter in a line of text.
struct Letter {
    /// Its first column, and one past the last.
    columns: [i32; 2],
    /// Its lowest row above the line, and one past the highest.
    rows: [i32; 2],
    /// Ink of each pixel, row by row from above, 0 to 255.
    ink: Vec<u8>,
}

/// A line of text whose capitals are so high [pixel], with a margin of empty pixels.
pub fn ink(text: &str, height: f64, margin: usize) -> Ink {
    let size = size(height);
    let mut at = 0.0;
    let mut letters: Vec<Letter> = Vec::new();
    for letter in text.chars() {
        let Some(font) = FONT.as_ref() else { continue };
        let (metrics, ink) = font.rasterize(letter, size);
        let [left, bottom] = [at + metrics.bounds.xmin, metrics.bounds.ymin].map(|v| v.round() as i32);
        let (columns, rows) = ([left, left + metrics.width as i32], [bottom, bottom + metrics.height as i32]);
        if !ink.is_empty() {
            letters.push(Letter { columns, rows, ink });
        }
        at += metrics.advance_width;
    }
    let least = |of: fn(&Letter) -> i32| letters.iter().map(of).min().unwrap_or(0);
    let most = |of: fn(&Letter) -> i32| letters.iter().map(of).max().unwrap_or(0);
    let [left, right] = [least(|l| l.columns[0]), most(|l| l.columns[1])];
    let [bottom, top] = [least(|l| l.rows[0]), most(|l| l.rows[1])];
    let [wide, high] = [right - left, top - bottom].map(|n| n as usize + 2 * margin);
    let mut shares = vec![0.0f64; wide * high];
    for letter in &letters {
        let width = (letter.columns[1] - letter.columns[0]) as usize;
        let corner = [letter.columns[0] - left, top - letter.rows[1]].map(|n| n as usize + margin);
        for (n, ink) in letter.ink.iter().enumerate() {
            let place = &mut shares[(corner[1] + n / width) * wide + corner[0] + n % width];
            // Letters that overlap, such as f and i, ink a pixel once.
            *place = place.max(f64::from(*ink) / 255.0);
        }
    }
    Ink { corner: [left - margin as i32, top + margin as i32], size: [wide, high], shares }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_messages_have_ink() {
        let font = FONT.as_ref().expect("a font");
        for letter in ('!'..='~').chain("äöüßéñçøŁ°²³µ·×−–—≤≥αρφω₀∞".chars())
        {
            assert!(font.lookup_glyph_index(letter) != 0, "{letter}");
            let ink = ink(&letter.to_string(), 20.0, 2);
            assert!(ink.shares.iter().any(|share| *share > 0.5), "{letter}");
            let rows = [ink.corner[1], ink.size[1] as i32 - ink.corner[1]].map(|n| f64::from(n - 2));
            assert!((0..2).all(|k| rows[k] <= reach(20.0)[k]), "{letter}: {rows:?}");
        }
    }

    #[test]
    fn capitals_have_the_height_that_is_asked_for() {
        for height in [7.0, 20.0, 132.0] {
            let ink = ink("HEI", height, 3);
            let rows =
                ink.shares.chunks(ink.size[0]).filter(|row| row.iter().any(|share| *share > 0.5)).count();
            assert!((rows as f64 - height).abs() <= 1.0, "{height}: {rows}");
            let wide = ink.size[0] as f64 - 6.0;
            assert!(
                wide < width("HEI", height) + 1.0 && wide > 0.8 * width("HEI", height),
                "{height}: {wide}"
            );
        }
    }

    #[test]
    fn digits_are_equally_wide() {
        assert_eq!(width("1111", 20.0), width("8008", 20.0));
    }

    #[test]
    fn an_empty_text_has_no_ink() {
        assert_eq!(ink("", 20.0, 3).shares.iter().sum::<f64>() + width("", 20.0), 0.0);
    }
}
