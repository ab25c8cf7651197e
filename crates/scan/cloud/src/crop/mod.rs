//! Crop: which points stay, by shapes, regions, properties, and rules that look at points together.

mod apply;
mod marks;
mod regions;
mod report;
pub mod rows;
mod rule;
mod rules;
mod shapes;
mod sieve;
mod together;

pub use apply::crop;
pub use marks::{MARK, Reason, marks};
pub use regions::{RegionsError, add_regions};
pub use report::{Cropped, RegionCount};
pub use rule::{filter, grazing, ground, outer, outliers, scatter};
pub use rules::{Action, CropError, Region, Rules};
