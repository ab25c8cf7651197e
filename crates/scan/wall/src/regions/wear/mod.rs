//! Roughness from a table of wear and position.

mod error;
mod lookup;
mod places;
mod table;

pub use error::{Load, WearError};
pub(crate) use lookup::Section;
pub use lookup::{Wear, WearReport};
