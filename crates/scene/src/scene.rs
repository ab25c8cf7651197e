//! A scene that was read and whose values are sound.

use crate::check::Check;
use crate::error::SceneError;
use crate::model::Model;
use crate::parse::parse;
use crate::text::Text;
use std::path::{Path, PathBuf};

/// A scene.
#[derive(Debug, Clone)]
pub struct Scene {
    /// As it was written, with the changes of `--set`.
    pub text: Text,
    /// Its keys.
    pub model: Model,
    /// Files that it names are relative to this folder.
    pub folder: PathBuf,
}

impl Scene {
    /// Reads a scene, changes what `overrides` say (`KEY=VALUE`), and checks every value.
    ///
    /// # Errors
    /// What is wrong, with line and column, key, value, unit and cure.
    pub fn new(name: &str, toml: String, overrides: &[String], folder: &Path) -> Result<Scene, SceneError> {
        let mut text = Text::new(name, toml);
        if !overrides.is_empty() {
            // Errors of the file itself are told with the places of the file itself.
            parse(&text)?;
            text.set(overrides)?;
            text.name = format!("{name} with --set");
        }
        let model = parse(&text)?;
        Check { text: &text }.model(&model)?;
        Ok(Scene { text, model, folder: folder.to_owned() })
    }
}
