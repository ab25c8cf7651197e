//! dem-run
fn main() {}
