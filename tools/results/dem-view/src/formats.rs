//! What the command line's words stand for.

use cli::Output;
use view::{Arrows, Camera, Map, Only, Wanted, WearField};

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Html,
    Png,
    Gif,
    Mp4,
    Vtp,
    Pvd,
}

/// Every format, by the ending of its name.
const ENDINGS: [(&str, Format); 7] = [
    ("html", Format::Html),
    ("htm", Format::Html),
    ("png", Format::Png),
    ("gif", Format::Gif),
    ("mp4", Format::Mp4),
    ("vtp", Format::Vtp),
    ("pvd", Format::Pvd),
];

impl Format {
    /// By the ending of the output's name; HTML to stdout.
    pub fn of(output: &Output) -> anyhow::Result<Format> {
        if output.path().is_none() {
            return Ok(Format::Html);
        }
        let known = ENDINGS.iter().find(|(ending, _)| output.has_extension(ending));
        known.map(|(_, format)| *format).ok_or_else(|| {
            cli::usage(format!(
                "-o {}: unknown format: use a name that ends in .html, .png, .gif, .mp4, .vtp or .pvd",
                output.name()
            ))
        })
    }

    /// The ending of its files, without the dot.
    pub fn ending(self) -> &'static str {
        ENDINGS.iter().find(|(_, format)| *format == self).map_or("", |(ending, _)| *ending)
    }

    /// What to do about an option that is for other formats.
    pub fn instead_of(self, option: &str) -> &'static str {
        match (option, self) {
            ("--from" | "--to" | "--every", Format::Png | Format::Vtp) => "use --time for one moment",
            ("--walls-colour", Format::Vtp | Format::Pvd) => {
                "dem-measure RUN --wear all -o NAME.vtp writes walls with all that was done to them"
            }
            ("--time", _) => "give a film or series its --from and --to",
            _ => "leave it out, or give -o such an ending",
        }
    }
}

/// `LO,HI`.
pub fn range(text: &str) -> Result<[f64; 2], String> {
    let ends: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match ends[..] {
        [lo, hi] if lo < hi && lo.is_finite() && hi.is_finite() => Ok([lo, hi]),
        _ => Err("give two numbers, the lower first: 0,1.5".into()),
    }
}

/// `FIELD=VALUE` or `FIELD=LO,HI`.
pub fn only(text: &str) -> Result<Only, String> {
    let such = "give FIELD=VALUE or FIELD=LO,HI, such as cluster=1,40 or material=rock";
    let (field, value) = text.split_once('=').filter(|(field, _)| !field.is_empty()).ok_or(such)?;
    let numbers: Option<Vec<f64>> =
        value.split(',').map(|part| part.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
    let wanted = match numbers.as_deref() {
        Some([one]) => Wanted::Between(*one, *one),
        Some([low, high]) if low <= high => Wanted::Between(*low, *high),
        None if field == "material" && !value.is_empty() => Wanted::Material(value.to_owned()),
        _ => return Err(such.to_owned()),
    };
    Ok(Only { field: field.to_owned(), wanted })
}

/// The name of a colour map.
pub fn map(text: &str) -> Result<Map, String> {
    Map::named(text).ok_or_else(|| "give viridis, turbo or heat".into())
}

/// What walls are coloured by.
pub fn wear_field(text: &str) -> Result<WearField, String> {
    let names = || WearField::ALL.map(WearField::name).join(", ");
    WearField::named(text).ok_or_else(|| format!("give one of {}", names()))
}

/// What arrows show.
pub fn arrows(text: &str) -> Result<Arrows, String> {
    [Arrows::Velocity, Arrows::Force]
        .into_iter()
        .find(|a| a.word() == text)
        .ok_or_else(|| "give velocity or force".into())
}

/// A view direction.
pub fn camera(text: &str) -> Result<Camera, String> {
    text.parse::<Camera>().map_err(|e| e.to_string())
}

/// `WxH`.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let sides: Vec<u32> = text.split('x').filter_map(|part| part.parse().ok()).collect();
    match sides[..] {
        [w, h] if (64..=16384).contains(&w) && (64..=16384).contains(&h) => Ok([w, h]),
        _ => Err("give width x height, 64 to 16384 each, such as 1920x1080".into()),
    }
}

/// 0 to 1.
pub fn share(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|v| (0.0..=1.0).contains(v)).ok_or_else(|| "give a number from 0 to 1".into())
}

/// A size above nothing.
pub fn megabytes(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|v| *v > 0.0 && *v <= 1e6)
        .ok_or_else(|| "give a number of megabytes above 0".into())
}
