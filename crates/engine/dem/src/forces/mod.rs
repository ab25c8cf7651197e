//! The sweep over the tiles: forces of each tile's contacts, then what arrives from other tiles, and the move.
//!
//! One thread takes both halves of a tile at once, while it is in the cache; several threads take all first halves, then all second ones.
//! Both schedules call the same two functions for a tile. `tile` computes one, `resting` passes over what sleeps. Uses passes and below.

mod clump_patches;
mod patches;
pub mod resting;
pub mod sweep;
pub mod tile;
