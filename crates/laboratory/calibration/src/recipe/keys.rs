//! The keys of a recipe, as they are written.

use serde::Deserialize;
use std::collections::BTreeMap;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RecipeKeys {
    #[serde(default)]
    pub settings: SettingsKeys,
    #[serde(default)]
    pub parameter: Vec<Spanned<ParameterKeys>>,
    #[serde(default)]
    pub test: Vec<Spanned<TestKeys>>,
    #[serde(default)]
    pub step: Vec<Spanned<StepKeys>>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct SettingsKeys {
    pub trials: Option<Spanned<i64>>,
    pub first: Option<Spanned<i64>>,
    pub batch: Option<Spanned<i64>>,
    pub seeds: Option<Spanned<i64>>,
    pub seed: Option<Spanned<i64>>,
    pub interval: Option<Spanned<Number>>,
    pub failures: Option<Spanned<Number>>,
    pub timeout: Option<Spanned<Number>>,
    pub abandon: Option<Spanned<Number>>,
    pub with: Option<Spanned<BTreeMap<String, Number>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterKeys {
    pub name: Spanned<String>,
    pub bounds: Option<Spanned<Vec<Number>>>,
    pub unit: Option<Spanned<String>>,
    pub scale: Option<Scale>,
    pub prior: Option<Spanned<PriorKeys>>,
    pub start: Option<Spanned<Number>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TestKeys {
    pub name: Spanned<String>,
    pub command: Option<Spanned<String>>,
    pub read: Option<String>,
    pub x: Option<Spanned<String>>,
    pub y: Option<Spanned<String>>,
    pub x_unit: Option<Spanned<String>>,
    pub y_unit: Option<Spanned<String>>,
    pub rows: Option<BTreeMap<String, Number>>,
    pub pick: Option<Pick>,
    pub data: Option<Spanned<OneOrMany>>,
    pub data_x: Option<String>,
    pub data_y: Option<String>,
    pub value: Option<Spanned<Number>>,
    pub deviation: Option<Spanned<Number>>,
    pub discrepancy: Option<Spanned<Number>>,
    pub correlation: Option<Spanned<Number>>,
    pub from: Option<Spanned<Number>>,
    pub until: Option<Spanned<Number>>,
    pub points: Option<Spanned<i64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StepKeys {
    pub name: String,
    pub fit: Spanned<OneOrMany>,
    pub to: Option<Spanned<Vec<PartKeys>>>,
    pub with: Option<Spanned<BTreeMap<String, Number>>>,
    pub refines: Option<Spanned<String>>,
    pub trials: Option<Spanned<i64>>,
    pub first: Option<Spanned<i64>>,
    pub batch: Option<Spanned<i64>>,
}

/// A test, or a part of its curve.
#[derive(Deserialize)]
#[serde(untagged)]
pub(super) enum PartKeys {
    Test(String),
    Part(Part),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Part {
    pub test: String,
    pub from: Option<Number>,
    pub until: Option<Number>,
}

/// A number, or text with a unit.
#[derive(Deserialize, Clone)]
#[serde(untagged, expecting = "a number, such as 0.5, or text with a unit, such as \"8 mm\" or \"5 %\"")]
pub(super) enum Number {
    Whole(i64),
    Plain(f64),
    Text(String),
}

/// One text or several.
#[derive(Deserialize)]
#[serde(untagged, expecting = "a text, or a list of texts")]
pub(super) enum OneOrMany {
    One(String),
    Many(Vec<String>),
}

impl OneOrMany {
    pub fn list(&self) -> Vec<String> {
        match self {
            OneOrMany::One(text) => vec![text.clone()],
            OneOrMany::Many(list) => list.clone(),
        }
    }
}

/// A prior: its name, or mean and deviation.
#[derive(Deserialize)]
#[serde(untagged, expecting = "\"uniform\", \"material:NAME\", or { mean = …, deviation = … }")]
pub(super) enum PriorKeys {
    Named(String),
    Normal(NormalKeys),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NormalKeys {
    pub mean: Number,
    pub deviation: Number,
}

/// How a parameter is spread between its bounds.
#[derive(Deserialize, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub(super) enum Scale {
    Lin,
    Log,
}

/// Which row of a column is the number.
#[derive(Deserialize, Debug, Clone, Copy, PartialEq, Eq, Default)]
#[serde(rename_all = "lowercase")]
pub enum Pick {
    /// The first row.
    First,
    /// The last row.
    #[default]
    Last,
    /// The largest value.
    Max,
    /// The smallest value.
    Min,
    /// The mean of all rows.
    Mean,
}
