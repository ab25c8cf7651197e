//! Every format is read back from bytes made here, and broken bytes are refused with their place.

mod broken;
mod drawings;
mod e57;
mod las;
mod pcd;
mod ply;
mod text;

use cloud::{Cloud, from_bytes};

fn read(bytes: impl AsRef<[u8]>) -> Cloud {
    from_bytes(bytes.as_ref().to_vec()).unwrap()
}

/// The error and its causes on one line.
fn refused(bytes: impl AsRef<[u8]>) -> String {
    let error = from_bytes(bytes.as_ref().to_vec()).unwrap_err();
    let mut text = error.to_string();
    let mut cause = std::error::Error::source(&error);
    while let Some(c) = cause {
        text += &format!(": {c}");
        cause = c.source();
    }
    text
}

fn column(cloud: &Cloud, name: &str) -> Vec<f64> {
    cloud.attributes.get(name).unwrap_or_else(|| panic!("no column {name}")).to_f64()
}
