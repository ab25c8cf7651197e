//! Named regions of a plant, kept in a file so that every scan of it is cropped alike.
//!
//! ```toml
//! tolerance = 0.02                  # m, of the outer shape; 0 when absent
//!
//! [[region]]
//! name = "mounting"
//! shape = "box:-1,-1,-1,0,1,1"      # as on the command line; files are sought beside this one
//! action = "remove"                 # or "keep", or "outer": a piece of the outer shape of the equipment
//! ```

use super::rules::{Action, Region, Rules};
use geom::Shape;
use geom::shape::ShapeError;
use serde::Deserialize;
use std::path::Path;
use thiserror::Error;

/// Why a text is no list of regions.
#[derive(Debug, Error)]
pub enum RegionsError {
    #[error("line {line}: not a list of [[region]] with name, shape and action: {message}")]
    Toml { line: usize, message: String },
    #[error("region '{name}'")]
    Shape {
        name: String,
        #[source]
        source: ShapeError,
    },
    #[error("two regions have the name '{0}': rename one of them")]
    Twice(String),
    #[error("region '{0}': an outer shape encloses the equipment: remove the ! before it")]
    OuterOutside(String),
    #[error("tolerance {0} m: must be a length, 0 or more")]
    Tolerance(f64),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    tolerance: Option<f64>,
    #[serde(default)]
    region: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: String,
    shape: String,
    action: Action,
}

/// Adds the regions of a TOML `text` to the rules; files named in it are sought in `folder`.
///
/// # Errors
/// Unknown keys, names given twice, texts that are no shapes.
pub fn add_regions(rules: &mut Rules, text: &str, folder: &Path) -> Result<usize, RegionsError> {
    let file: File = toml::from_str(text).map_err(|e| {
        let before = e.span().and_then(|span| text.get(..span.start)).unwrap_or_default();
        let message = e.message().replace('`', "'");
        RegionsError::Toml { line: 1 + before.matches('\n').count(), message }
    })?;
    if let Some(tolerance) = file.tolerance {
        if !(tolerance >= 0.0 && tolerance.is_finite()) {
            return Err(RegionsError::Tolerance(tolerance));
        }
        rules.outer.tolerance = tolerance;
    }
    for (i, region) in file.region.iter().enumerate() {
        if file.region[..i].iter().any(|r| r.name == region.name) {
            return Err(RegionsError::Twice(region.name.clone()));
        }
        let shape = Shape::parse(&region.shape, &mesh::Files(folder));
        let shape = shape.map_err(|source| RegionsError::Shape { name: region.name.clone(), source })?;
        match region.action {
            Action::Outer if shape.outside => return Err(RegionsError::OuterOutside(region.name.clone())),
            Action::Outer => rules.outer.shapes.push(shape),
            action => rules.regions.push(Region { name: region.name.clone(), shape, action }),
        }
    }
    Ok(file.region.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;

    #[test]
    fn regions_become_rules() {
        let text = r#"
            [[region]]
            name = "chute"
            shape = "box:0,0,0,1,1,1"
            action = "keep"
            [[region]]
            name = "bolt"
            shape = "sphere:0,0,0,0.1"
            action = "remove"
            [[region]]
            name = "all of it"
            shape = "cone:0,0,0,0,0,1,1,0.5"
            action = "outer""#;
        let mut rules = Rules::default();
        let text = format!("tolerance = 0.01\n{text}");
        assert_eq!(add_regions(&mut rules, &text, Path::new(".")).unwrap(), 3);
        let [chute, bolt] = &rules.regions[..] else { panic!("{:?}", rules.regions) };
        assert!(chute.shape.contains(&Vec3::repeat(0.5)) && chute.action == Action::Keep);
        assert!(bolt.shape.contains(&Vec3::zeros()) && bolt.name == "bolt");
        assert_eq!((rules.outer.shapes.len(), rules.outer.tolerance), (1, 0.01));
    }

    #[test]
    fn wrong_files_name_the_region_or_the_line() {
        for (text, part) in [
            ("[[region]]\nname = 'a'\nshape = 'ball:1'\naction = 'keep'", "'a'"),
            ("[[region]]\nname = 'a'\nshape = 'sphere:0,0,0,1'\naction = 'drop'", "drop"),
            ("[[regoin]]", "regoin"),
            ("tolerance = -1", "tolerance -1 m"),
            ("[[region]]\nname = 'a'\nshape = '!sphere:0,0,0,1'\naction = 'outer'", "remove the !"),
            (
                "[[region]]\nname = 'a'\nshape = 'sphere:0,0,0,1'\naction = 'keep'\n[[region]]\nname = 'a'\nshape = 'sphere:0,0,0,1'\naction = 'keep'",
                "two regions",
            ),
        ] {
            let error = add_regions(&mut Rules::default(), text, Path::new(".")).unwrap_err();
            assert!(error.to_string().contains(part), "{error}");
        }
    }

    #[test]
    fn files_are_sought_beside_the_regions() {
        let region = |shape: &str| format!("[[region]]\nname = 'a'\nshape = '{shape}'\naction = 'keep'");
        for (shape, part) in [
            ("!prism:a.json", "'!prism:a.json': cannot read a.json"),
            ("mesh:/x/a.ply", "cannot read the mesh"),
        ] {
            let error = add_regions(&mut Rules::default(), &region(shape), Path::new("/plant")).unwrap_err();
            let cause = std::error::Error::source(&error).map(ToString::to_string).unwrap_or_default();
            assert!(cause.contains(part), "{error}: {cause}");
        }
    }
}
