//! wallgen
fn main() {}
