//! Runs that are resumed: what they repeat, and what they refuse.

mod runs;
mod work;
