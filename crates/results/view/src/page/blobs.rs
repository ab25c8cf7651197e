//! The columns of bytes of a page.

use super::pack::Column;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::sync::Arc;

/// Every column of bytes with a number, each place in memory once.
#[derive(Default)]
pub(super) struct Blobs<'a> {
    pub list: Vec<&'a [u8]>,
    number: HashMap<*const Vec<u8>, usize>,
}

impl<'a> Blobs<'a> {
    pub fn number(&mut self, bytes: &'a Arc<Vec<u8>>) -> usize {
        *self.number.entry(Arc::as_ptr(bytes)).or_insert_with(|| {
            self.list.push(bytes);
            self.list.len() - 1
        })
    }

    pub fn column(&mut self, column: &'a Column) -> Value {
        let blob = if column.bytes.is_empty() { Value::Null } else { json!(self.number(&column.bytes)) };
        json!([blob, column.range.lo, column.range.hi, column.width])
    }
}
