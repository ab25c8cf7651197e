//! stage-replay
fn main() {}
