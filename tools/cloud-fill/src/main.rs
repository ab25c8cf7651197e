//! cloud-fill
fn main() {}
