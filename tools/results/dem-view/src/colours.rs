//! Colours of a scan as bytes, whatever numbers its file has them in.

use stream::{Table, Values};

/// The largest number of each way to write a colour: a share, a byte, 16 bits.
const TOPS: [f64; 3] = [1.0, 255.0, 65535.0];

/// Makes bytes of the columns red, green and blue. The largest of their numbers says how they are written: whole numbers up to 255 are bytes, also in a
/// column of 16 bits; fractions up to 1 are shares. Columns with other numbers stay as they are.
pub fn to_bytes(table: &mut Table) {
    const NAMES: [&str; 3] = ["red", "green", "blue"];
    let [Some(red), Some(green), Some(blue)] = NAMES.map(|name| table.get(name)) else { return };
    let columns = [red, green, blue];
    if columns.iter().all(|column| matches!(column, Values::U8(_))) {
        return;
    }
    let (mut least, mut most) = (0.0f64, 0.0f64);
    for value in columns.iter().flat_map(|column| column.iter()) {
        (least, most) = (least.min(value), most.max(value));
    }
    let are_shares = columns.iter().all(|column| matches!(column, Values::F32(_) | Values::F64(_)));
    let top = TOPS.into_iter().find(|top| most <= *top && (*top > 1.0 || are_shares));
    let Some(top) = top.filter(|_| least >= 0.0) else { return };
    let byte = |value: f64| (255.0 * value / top).round() as u8;
    let bytes = columns.map(|column| Values::U8(column.iter().map(byte).collect()));
    for (name, values) in NAMES.into_iter().zip(bytes) {
        let replaced = table.replace(name, values);
        debug_assert!(replaced.is_ok(), "as many as before");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(columns: [Values; 3]) -> Vec<Option<Values>> {
        let mut table = Table::with_rows(2);
        for (name, values) in ["red", "green", "blue"].into_iter().zip(columns) {
            table.push(name, values).unwrap();
        }
        to_bytes(&mut table);
        ["red", "green", "blue"].iter().map(|name| table.get(name).cloned()).collect()
    }

    #[test]
    fn colours_of_any_width_become_bytes() {
        let wanted: Vec<_> = [[0, 255], [128, 3], [64, 7]].map(|c| Some(Values::U8(c.to_vec()))).into();
        let wide = [[0, 65535], [128 * 257, 3 * 257], [64 * 257, 7 * 257]];
        assert_eq!(shown(wide.map(|c| Values::U16(c.to_vec()))), wanted);
        assert_eq!(shown(wide.map(|c| Values::F64(c.map(f64::from).to_vec()))), wanted);
        // Bytes in columns of 16 bits, as many programs write them.
        assert_eq!(shown([[0, 255], [128, 3], [64, 7]].map(|c| Values::U16(c.to_vec()))), wanted);
        let shares = [[0.0, 1.0], [128.0 / 255.0, 3.0 / 255.0], [64.0 / 255.0, 7.0 / 255.0]];
        assert_eq!(shown(shares.map(|c| Values::F64(c.to_vec()))), wanted);
        // No colours.
        let other = [[-1.0, 1e9], [0.0, 1.0], [0.0, 1.0]].map(|c| Values::F64(c.to_vec()));
        assert_eq!(shown(other.clone()), other.map(Some).to_vec());
    }
}
