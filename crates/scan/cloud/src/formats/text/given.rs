//! Names that a user gives the columns of text, where the file does not say which of them are x, y and z.

use super::columns::axes;
use super::words::split;
use std::str::FromStr;

/// A column that is left out, whatever stands in it.
const LEFT_OUT: &str = "-";

/// Names for the columns of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TextColumns {
    /// Of all columns in the order of the file; `None` leaves a column out. They replace those of the file.
    Listed(Vec<Option<String>>),
    /// Names of x, y and z in the file's line of names.
    Chosen([String; 3]),
}

impl FromStr for TextColumns {
    type Err = String;

    /// `id,x,y,z`, `-,easting,northing,height`, or `x=Rechts,y=Hoch,z=H`.
    fn from_str(text: &str) -> Result<TextColumns, String> {
        let names = split(text, Some(','));
        if let Some(empty) = names.iter().position(String::is_empty) {
            return Err(format!("name {} is empty: - leaves a column out", empty + 1));
        }
        if names.iter().any(|name| name.contains('=')) {
            return chosen(&names);
        }
        axes(&names)?.ok_or(
            "x, y and z (or easting, northing, height) must be among the names; for columns that the file names itself: \
             x=NAME,y=NAME,z=NAME",
        )?;
        let plain = |name: &String| name.to_ascii_lowercase();
        let twice = (1..names.len())
            .find(|&k| names[k] != LEFT_OUT && names[..k].iter().any(|n| plain(n) == plain(&names[k])));
        if let Some(twice) = twice {
            return Err(format!(
                "'{}' stands there twice: each column has a name, - leaves one out",
                names[twice]
            ));
        }
        Ok(TextColumns::Listed(names.into_iter().map(|name| (name != LEFT_OUT).then_some(name)).collect()))
    }
}

fn chosen(names: &[String]) -> Result<TextColumns, String> {
    let of = |axis: &str| {
        let mut of = names
            .iter()
            .filter_map(|n| n.split_once('='))
            .filter(|(a, _)| a.trim().eq_ignore_ascii_case(axis));
        of.next().map(|(_, name)| name.trim().to_owned()).filter(|name| !name.is_empty())
    };
    match [of("x"), of("y"), of("z")] {
        [Some(x), Some(y), Some(z)] if names.len() == 3 => Ok(TextColumns::Chosen([x, y, z])),
        _ => Err("give each of the three once: x=NAME,y=NAME,z=NAME".to_owned()),
    }
}
