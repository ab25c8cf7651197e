//! Priors that are ranges of the table of materials.

use crate::error::hint;
use scene::materials::{Range, find};

/// The range that a prior such as `material:sand` or `material:sand:sliding_friction` stands for.
///
/// # Errors
/// Another word, an unknown material or key.
pub(crate) fn of_table(word: &str, parameter: &str) -> Result<Range, String> {
    let Some(rest) = word.strip_prefix("material:") else {
        return Err(format!(
            "prior = \"{word}\": give \"uniform\", \"material:NAME\", or {{ mean = …, deviation = … }}"
        ));
    };
    let (name, key) = rest.split_once(':').unwrap_or((rest, parameter));
    let material = find(name.trim())?;
    match material.ranges.get(key.trim()) {
        Some(range) => Ok(range.clone()),
        None => {
            let hint = hint(key, material.ranges.keys().map(String::as_str));
            Err(format!(
                "prior = \"{word}\": the table has no '{key}' of {name}{hint}; write material:{name}:KEY"
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn priors_are_found_by_name_and_key() {
        assert_eq!(of_table("material:quartz sand:sliding_friction", "mu").unwrap().ends, [0.12, 0.52]);
        assert_eq!(of_table("material:sand", "sliding_friction").unwrap().ends, [0.12, 0.52]);
        assert!(
            of_table("material:sand", "slidingfriction")
                .unwrap_err()
                .contains("did you mean 'sliding_friction'?")
        );
        assert!(of_table("uniformm", "mu").unwrap_err().contains("give \"uniform\""));
    }
}
