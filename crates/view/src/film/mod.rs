//! Films: one picture after the other, with the same colours, bytes that do not change from run to run.

mod gif;
mod palette;

pub use gif::Gif;
pub use palette::Palette;
