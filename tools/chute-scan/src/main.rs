//! chute-scan
fn main() {}
