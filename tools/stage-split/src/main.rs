//! stage-split
fn main() {}
