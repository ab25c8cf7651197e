//! Transport: what passes a plane, how long particles stay, where they go.

pub mod flow;
pub mod residence;
pub mod track;
