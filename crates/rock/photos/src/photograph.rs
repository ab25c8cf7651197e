//! Photographs: JPEG and PNG, detected by content, as linear light.
//!
//! ```text
//! s ≤ 0.04045:  l = s/12.92,   else  l = ((s + 0.055)/1.055)^2.4        IEC 61966-2-1 (sRGB)
//! light = 0.2126 R + 0.7152 G + 0.0722 B
//! ```
//!
//! A pixel on an edge mixes the two sides in linear light, not in the stored values: an edge found in stored values is off by up to 0.3 pixels.

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use thiserror::Error;

/// Most pixels of a side.
const LONGEST: u32 = 30_000;
/// Most pixels: a photograph takes 16 bytes of memory for each of them, and no camera takes more.
const PIXELS: u64 = 400_000_000;
/// Most bytes of a picture in memory.
const BYTES: u64 = 1 << 30;

/// Endings of photographs in a folder.
const ENDINGS: [&str; 3] = ["jpg", "jpeg", "png"];

/// The photographs of a folder, by their endings (.jpg, .jpeg, .png), in the order of their names.
///
/// # Errors
/// A folder that cannot be read.
pub fn in_folder(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let paths = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
    let mut found = paths.collect::<std::io::Result<Vec<PathBuf>>>()?;
    let known = |e: &std::ffi::OsStr| ENDINGS.iter().any(|known| e.eq_ignore_ascii_case(known));
    found.retain(|path| path.extension().is_some_and(known) && path.is_file());
    found.sort();
    Ok(found)
}

/// The file of a photograph's mask: `IMG.0001.jpg` has the mask `IMG.0001.png`.
pub fn mask_name(photograph: &Path) -> PathBuf {
    let mut name = photograph.file_stem().unwrap_or_default().to_owned();
    name.push(".png");
    PathBuf::from(name)
}

/// A photograph in linear light.
#[derive(Debug, Clone, PartialEq)]
pub struct Photograph {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Linear light of each pixel, row by row, from 0 to 1 [–].
    pub light: Vec<f32>,
}

/// Why bytes are no photograph.
#[derive(Debug, Error)]
pub enum PhotographError {
    #[error("neither JPEG nor PNG (it begins with {start}): convert the photograph")]
    Unknown { start: String },
    #[error("cannot read the {format}: {reason}; copy or export it again")]
    Broken { format: &'static str, reason: String },
    #[error("has no pixels: {width} × {height}")]
    Empty { width: usize, height: usize },
    #[error(
        "has {width} × {height} = {} million pixels, and {} million are the most (16 bytes of memory each): export it \
         smaller, such as 4000 × 3000",
        u64::from(*width) * u64::from(*height) / 1_000_000,
        PIXELS / 1_000_000
    )]
    Large { width: u32, height: u32 },
    #[error("cannot write PNG: {0}")]
    Png(String),
}

impl Photograph {
    /// Reads JPEG or PNG; a turned photograph (EXIF orientation) is turned upright.
    ///
    /// # Errors
    /// Other content, or a truncated file.
    pub fn read(bytes: &[u8]) -> Result<Photograph, PhotographError> {
        let picture = decode(bytes)?;
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        if width == 0 || height == 0 {
            return Err(PhotographError::Empty { width, height });
        }
        let table = decoded();
        let light = if picture.color().has_color() {
            let of = |p: &image::Rgb<u8>| {
                let [r, g, b] = p.0.map(|v| table[usize::from(v)]);
                0.2126 * r + 0.7152 * g + 0.0722 * b
            };
            picture.into_rgb8().pixels().map(of).collect()
        } else {
            picture.into_luma8().as_raw().iter().map(|v| table[usize::from(*v)]).collect()
        };
        Ok(Photograph { width, height, light })
    }

    /// The stored values that stand for this light, 0 to 255.
    pub fn encoded(&self) -> Vec<u8> {
        self.light.iter().map(|l| encode(*l)).collect()
    }
}

/// Reads the stored values of a grey picture, such as a mask: width, height, values row by row.
///
/// # Errors
/// As [`Photograph::read`].
pub fn read_values(bytes: &[u8]) -> Result<(usize, usize, Vec<u8>), PhotographError> {
    let picture = decode(bytes)?;
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    Ok((width, height, picture.into_luma8().into_raw()))
}

/// The sRGB value of a linear light.
pub fn encode(light: f32) -> u8 {
    LEAST.partition_point(|least| *least <= light).saturating_sub(1) as u8
}

/// The least light of each sRGB value: a look into it is ten times as fast as the power, and gives the same value.
static LEAST: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|value| {
        // Not negative floats are in the order of their bits.
        let (mut below, mut least) = (0, 1f32.to_bits());
        while value > 0 && least - below > 1 {
            let middle = below + (least - below) / 2;
            let is_less = usize::from(computed(f32::from_bits(middle))) < value;
            *(if is_less { &mut below } else { &mut least }) = middle;
        }
        if value == 0 { 0.0 } else { f32::from_bits(least) }
    })
});

fn computed(light: f32) -> u8 {
    let l = f64::from(light).clamp(0.0, 1.0);
    let s = if l <= 0.003_130_8 { 12.92 * l } else { 1.055 * libm::pow(l, 1.0 / 2.4) - 0.055 };
    (255.0 * s).round() as u8
}

/// The linear light of each sRGB value.
fn decoded() -> [f32; 256] {
    std::array::from_fn(|v| {
        let s = v as f64 / 255.0;
        (if s <= 0.040_45 { s / 12.92 } else { libm::pow((s + 0.055) / 1.055, 2.4) }) as f32
    })
}

/// Writes PNG: 1 channel (grey) or 3 (RGB).
///
/// # Errors
/// Sizes that do not agree.
pub fn png(width: usize, height: usize, values: &[u8]) -> Result<Vec<u8>, PhotographError> {
    let colour =
        if values.len() == 3 * width * height { image::ColorType::Rgb8 } else { image::ColorType::L8 };
    let mut out = Vec::new();
    image::write_buffer_with_format(
        &mut Cursor::new(&mut out),
        values,
        width as u32,
        height as u32,
        colour,
        ImageFormat::Png,
    )
    .map_err(|e| PhotographError::Png(e.to_string()))?;
    Ok(out)
}

fn decode(bytes: &[u8]) -> Result<DynamicImage, PhotographError> {
    let format = match image::guess_format(bytes) {
        Ok(format @ (ImageFormat::Jpeg | ImageFormat::Png)) => format,
        _ => {
            let start: String =
                bytes.iter().take(12).flat_map(|b| std::ascii::escape_default(*b)).map(char::from).collect();
            return Err(PhotographError::Unknown { start: format!("'{start}'") });
        }
    };
    let name = if format == ImageFormat::Jpeg { "JPEG" } else { "PNG" };
    let broken = |e: image::ImageError| PhotographError::Broken { format: name, reason: e.to_string() };
    if format == ImageFormat::Jpeg && !crate::jpeg_end::has_end(bytes) {
        let reason = format!("it ends after {} bytes, before the picture does: it is cut off", bytes.len());
        return Err(PhotographError::Broken { format: name, reason });
    }
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(LONGEST), Some(LONGEST));
    limits.max_alloc = Some(BYTES);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(broken)?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > PIXELS {
        return Err(PhotographError::Large { width, height });
    }
    let orientation = decoder.orientation().map_err(broken)?;
    let mut picture = DynamicImage::from_decoder(decoder).map_err(broken)?;
    picture.apply_orientation(orientation);
    Ok(picture)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stored_values_come_back_through_linear_light() {
        let values: Vec<u8> = (0..=255).collect();
        let photograph = Photograph::read(&png(16, 16, &values).unwrap()).unwrap();
        assert_eq!(photograph.encoded(), values);
        // Half of the light is stored as 188.
        assert!((photograph.light[188] - 0.5).abs() < 0.003, "{}", photograph.light[188]);
    }

    #[test]
    fn values_from_the_table_are_those_of_the_power() {
        let lights = (0..=1 << 14).map(|k| k as f32 / 16384.0);
        let beside = LEAST.iter().flat_map(|l| [l.next_down(), *l, l.next_up()]);
        for light in lights.chain(beside).chain([-1.0, 2.0, f32::NAN]) {
            assert_eq!(encode(light), computed(light), "{light}");
        }
    }

    #[test]
    fn what_is_no_photograph_is_refused_with_its_start() {
        let words = Photograph::read(b"solid x").unwrap_err().to_string();
        assert!(words.contains("'solid x'") && words.contains("convert"), "{words}");
        let whole = png(4, 4, &[7; 16]).unwrap();
        let words = Photograph::read(&whole[..40]).unwrap_err().to_string();
        assert!(words.contains("cannot read the PNG"), "{words}");
    }

    /// A PNG that ends after its header, of this size.
    fn header(width: u32, height: u32) -> Vec<u8> {
        let sum = |bytes: &[u8]| {
            let bit = |c: u32| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 };
            !bytes.iter().fold(!0, |c, b| (0..8).fold(c ^ u32::from(*b), |c, _| bit(c)))
        };
        let size = [width.to_be_bytes(), height.to_be_bytes()].concat();
        let chunk = [&b"IHDR"[..], &size, &[8, 0, 0, 0, 0]].concat();
        let sum = sum(&chunk).to_be_bytes();
        [&b"\x89PNG\r\n\x1a\n\0\0\0\x0d"[..], &chunk, &sum, b"\0\0\0\0IDAT\x35\xaf\x06\x1e"].concat()
    }

    /// Its header says how much memory it would take.
    #[test]
    fn a_photograph_of_too_many_pixels_is_refused_by_its_header() {
        let words = Photograph::read(&header(30_000, 30_000)).unwrap_err().to_string();
        assert!(words.contains("900 million pixels, and 400 million are the most"), "{words}");
        assert!(read_values(&header(20_001, 20_000)).is_err_and(|e| e.to_string().contains("400 million")));
        let words = Photograph::read(&header(400, 300)).unwrap_err().to_string();
        assert!(words.contains("cannot read the PNG"), "{words}");
    }

    /// A decoder fills what is missing with grey.
    #[test]
    fn a_jpeg_that_is_cut_off_is_refused() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../sample-data/head/photographs/00001.jpg");
        let whole = std::fs::read(path).unwrap();
        let read = Photograph::read(&whole).unwrap();
        let appended = [&whole[..], b"a small picture"].concat();
        assert_eq!(Photograph::read(&appended).unwrap(), read);
        for share in [3, 20, 60, 80, 99] {
            let cut = &whole[..whole.len() * share / 100];
            let words = Photograph::read(cut).unwrap_err().to_string();
            assert!(words.contains("cannot read the JPEG") && words.contains("again"), "{share} %: {words}");
        }
    }
}
