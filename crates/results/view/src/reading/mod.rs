//! From a run to what can be shown: layers, moments, series and diagrams.

pub(crate) mod diagram;
pub(crate) mod hidden;
mod history;
pub(crate) mod moment;
pub(crate) mod only;
pub(crate) mod run;
pub(crate) mod series;
pub(crate) mod show;
mod worn;
