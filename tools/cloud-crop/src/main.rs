//! cloud-crop
fn main() {}
