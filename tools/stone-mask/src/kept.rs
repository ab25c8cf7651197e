//! Masks that an earlier call has found: a note in the file says of which photograph and with which settings, and what was found on the
//! way. So a call that was stopped goes on, and one with another photograph, setting or version finds its masks again.

use photos::mask::Found;
use photos::{Mask, MaskSettings};
use serde::{Deserialize, Serialize};
use std::io::Cursor;
use std::path::Path;

/// The keyword of the note in a PNG.
const KEYWORD: &str = "stone-mask";

/// What a mask says of itself.
#[derive(Serialize, Deserialize)]
pub struct Note {
    /// Of the photograph, the settings and the version.
    pub stamp: String,
    pub found: Found,
}

/// What a mask depends on, in short.
pub fn stamp(photograph: &[u8], settings: &MaskSettings) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let text = format!("{version} {settings:?} {}", stream::sha256(photograph));
    stream::sha256(text.as_bytes())
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

/// The mask of a file, if it has this stamp and is whole.
pub fn read(path: &Path, stamp: &str) -> Option<Mask> {
    let bytes = stream::whole::file(path).ok()?;
    let reader = png::Decoder::new(Cursor::new(&bytes)).read_info().ok()?;
    let texts = &reader.info().uncompressed_latin1_text;
    let text = &texts.iter().find(|text| text.keyword == KEYWORD)?.text;
    let note: Note = serde_json::from_str(text).ok().filter(|note: &Note| note.stamp == stamp)?;
    drop(reader);
    let (width, height, coverage) = photos::photograph::read_values(&bytes).ok()?;
    Some(Mask { found: Some(note.found), ..Mask::given(width, height, coverage) })
}
