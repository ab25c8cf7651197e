//! What is not drawn: things by their names.

use crate::{Role, ViewError};

/// Names of what is not drawn: `grains`, `walls`, `cloud`, `bonds`, `arrows`, or the name of a wall.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Hidden(pub Vec<String>);

impl Hidden {
    /// Whether a layer is hidden; layers of runs are named `what (file)`.
    pub(crate) fn hides_layer(&self, role: Role, name: &str) -> bool {
        self.0.iter().any(|hidden| is_layer(hidden, role, name))
    }

    /// Whether a plane or mesh of that name is hidden.
    pub(crate) fn hides_surface(&self, name: &str) -> bool {
        self.0.iter().any(|hidden| hidden == name || hidden == Role::Walls.word())
    }

    /// Refuses names that are none of these.
    ///
    /// # Errors
    /// A name that nothing has.
    pub(crate) fn check(&self, layers: &[(Role, String)], surfaces: &[String]) -> Result<(), ViewError> {
        let is_known = |hidden: &String| {
            layers.iter().any(|(role, name)| is_layer(hidden, *role, name))
                || surfaces.iter().any(|name| name == hidden)
                || (hidden == Role::Walls.word() && !surfaces.is_empty())
        };
        let Some(unknown) = self.0.iter().find(|hidden| !is_known(hidden)) else { return Ok(()) };
        let mut known: Vec<String> = layers.iter().map(|(_, name)| plain(name).to_owned()).collect();
        known.extend((!surfaces.is_empty()).then(|| Role::Walls.word().to_owned()));
        known.extend(surfaces.iter().cloned());
        let mut seen = Vec::new();
        known.retain(|name| {
            !seen.contains(name) && {
                seen.push(name.clone());
                true
            }
        });
        Err(ViewError::NoHidden { name: unknown.clone(), known })
    }
}

fn is_layer(hidden: &str, role: Role, name: &str) -> bool {
    hidden == role.word() || hidden == name || hidden == plain(name)
}

/// The name without the file behind it.
fn plain(name: &str) -> &str {
    name.rsplit_once(" (").filter(|(_, rest)| rest.ends_with(')')).map_or(name, |(plain, _)| plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hidden(names: &[&str]) -> Hidden {
        Hidden(names.iter().map(|name| (*name).to_owned()).collect())
    }

    #[test]
    fn things_are_hidden_by_what_they_are_and_by_their_names() {
        let all = hidden(&["grains", "drum"]);
        assert!(all.hides_layer(Role::Grains, "grains (run.mcap)") && all.hides_surface("drum"));
        assert!(all.hides_layer(Role::Walls, "drum (run.mcap)") && !all.hides_surface("lid"));
        assert!(hidden(&["walls"]).hides_surface("lid") && !all.hides_layer(Role::Walls, "walls (run.mcap)"));
    }

    #[test]
    fn a_name_that_nothing_has_is_refused_with_those_that_there_are() {
        let layers = [(Role::Grains, "grains (a.mcap)".to_owned())];
        let surfaces = ["drum".to_owned(), "lid".to_owned()];
        assert!(hidden(&["grains", "walls", "lid"]).check(&layers, &surfaces).is_ok());
        let refused = hidden(&["roof"]).check(&layers, &surfaces).expect_err("refused").to_string();
        assert_eq!(refused, "--hide: no 'roof' here: choose one of grains, walls, drum, lid");
    }
}
