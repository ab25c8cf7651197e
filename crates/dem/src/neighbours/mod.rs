//! Lists.

pub mod contacts;
pub mod list;
pub mod rebuild;
