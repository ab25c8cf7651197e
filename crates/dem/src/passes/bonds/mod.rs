//! Bonds: elastic beams between particles, a pass before the move that adds to the sums of wrenches.

pub mod pull;
pub mod zones;
