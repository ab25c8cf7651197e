//! dem-view
fn main() {}
