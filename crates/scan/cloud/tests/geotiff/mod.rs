//! The coordinate reference system of a LAS file, as keys of GeoTIFF.

/// A record of keys and their values, of which each is one short number.
pub fn record(keys: &[[u16; 2]]) -> las::Vlr {
    let head = [1, 1, 0, keys.len() as u16].into_iter();
    let numbers = head.chain(keys.iter().flat_map(|&[key, value]| [key, 0, 1, value]));
    las::Vlr {
        user_id: "LASF_Projection".to_owned(),
        record_id: 34735,
        description: String::new(),
        data: numbers.flat_map(u16::to_le_bytes).collect(),
    }
}
