//! What accuracy costs: the error of each setting and its interval, the settings that nothing beats, the fastest that
//! is good enough, and all of it in plain words. Numbers in, numbers and sentences out; nothing is run here.

mod error;
mod front;
mod point;
mod words;

pub use error::{Norm, Truth, errors};
pub use front::{Choice, front, recommend};
pub use point::{Error, Point, Sample};
pub use words::{amount, change, order, percent, sentence, share_of_time};
