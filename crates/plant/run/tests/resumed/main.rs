//! Runs that are resumed: what they repeat, and what they refuse.

mod changed;
mod runs;
mod work;
