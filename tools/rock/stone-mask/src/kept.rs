//! Masks that an earlier call has found: a note in the file says of which photograph and with which settings, and what was found on the
//! way. So a call that was stopped goes on, and one with another photograph, setting or version finds its masks again.

use photos::mask::Found;
use photos::{Mask, MaskSettings};
use serde::{Deserialize, Serialize};
use std::io::Cursor;
use std::path::Path;

/// The keyword of the note in a PNG.
const KEYWORD: &str = "stone-mask";
/// To be raised when masks come out differently.
const METHOD: u32 = 1;

/// What a mask says of itself.
#[derive(Serialize, Deserialize)]
pub struct Note {
    /// Of the photograph, the settings and the method.
    stamp: String,
    /// Of the size and the pixels of the mask.
    pixels: String,
    pub found: Found,
}

/// What is there where a mask will be.
pub enum Before {
    /// The mask that is wanted.
    Mask(Mask),
    /// Nothing, or a mask of another photograph, or with other settings.
    Other,
    /// What this program has not written, or not so.
    Foreign,
}

impl Note {
    /// Of a mask that was found, with its numbers as they will be read; none of one that was given.
    pub fn new(stamp: String, mask: &Mask) -> anyhow::Result<Option<Note>> {
        let Some(found) = mask.found else { return Ok(None) };
        let note = Note { stamp, pixels: pixels(mask), found };
        Ok(Some(serde_json::from_str(&serde_json::to_string(&note)?)?))
    }
}

/// What a mask depends on, in short.
pub fn stamp(photograph: &[u8], settings: &MaskSettings) -> String {
    stream::sha256(format!("{METHOD} {settings:?} {}", stream::sha256(photograph)).as_bytes())
}

fn pixels(mask: &Mask) -> String {
    let size = [mask.width as u64, mask.height as u64].map(u64::to_le_bytes).concat();
    stream::sha256(&[size, mask.coverage.clone()].concat())
}

/// A mask as a grey PNG, with its note.
pub fn png(mask: &Mask, note: Option<&Note>) -> anyhow::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, mask.width as u32, mask.height as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_compression(png::Compression::Fast);
    if let Some(note) = note {
        encoder.add_text_chunk(KEYWORD.to_owned(), serde_json::to_string(note)?)?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&mask.coverage)?;
    writer.finish()?;
    Ok(bytes)
}

/// What there is of a mask with this stamp.
pub fn read(path: &Path, stamp: &str) -> Before {
    if !path.exists() {
        return Before::Other;
    }
    match noted(path) {
        Some((note, mask)) if note.stamp == stamp => Before::Mask(mask),
        Some(_) => Before::Other,
        None => Before::Foreign,
    }
}

/// A mask with its note; none where one of them is missing, or the mask has other pixels than the note says.
fn noted(path: &Path) -> Option<(Note, Mask)> {
    let bytes = stream::whole::file(path).ok()?;
    let reader = png::Decoder::new(Cursor::new(&bytes)).read_info().ok()?;
    let texts = &reader.info().uncompressed_latin1_text;
    let text = &texts.iter().find(|text| text.keyword == KEYWORD)?.text;
    let note: Note = serde_json::from_str(text).ok()?;
    drop(reader);
    let (width, height, coverage) = photos::photograph::read_values(&bytes).ok()?;
    let mask = Mask { found: Some(note.found), ..Mask::given(width, height, coverage) };
    (pixels(&mask) == note.pixels).then_some((note, mask))
}
