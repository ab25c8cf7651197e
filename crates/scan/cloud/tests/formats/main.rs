//! Every format is read back from bytes made here, and broken bytes are refused with their place.

mod broken;
mod drawings;
mod e57;
#[path = "../geotiff/mod.rs"]
mod geotiff;
mod las;
mod pcd;
mod ply;
#[path = "../shared/mod.rs"]
mod shared;
mod text;

use cloud::{Cloud, from_bytes};
use shared::refused;

fn read(bytes: impl AsRef<[u8]>) -> Cloud {
    from_bytes(bytes.as_ref().to_vec()).unwrap()
}

fn column(cloud: &Cloud, name: &str) -> Vec<f64> {
    cloud.attributes.get(name).unwrap_or_else(|| panic!("no column {name}")).to_f64()
}
