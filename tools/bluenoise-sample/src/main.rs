//! bluenoise-sample
fn main() {}
