//! Films: one picture after the other, with the same colours, bytes that do not change from run to run.

mod gif;
mod mp4;
mod palette;
mod reel;

pub use gif::Gif;
pub use mp4::{Mp4, find_ffmpeg};
pub use palette::Palette;
pub use reel::Reel;
