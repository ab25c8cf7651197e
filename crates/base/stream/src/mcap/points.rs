//! Tables as `foxglove.PointCloud` messages.

use super::point_cloud::{NumericType, PackedElementField, PointCloud, Pose, Quaternion, Timestamp, Vector3};
use crate::{
    NumberType, Rows, Table, Values,
    rows::{column, pack, pack_rows},
};
use prost::Message;
use rayon::prelude::*;

/// Protobuf tag of `PointCloud.data`: field 6, length-delimited. Checked by a test against prost.
const DATA_TAG: u8 = (6 << 3) | 2;

fn numeric(kind: NumberType) -> NumericType {
    match kind {
        NumberType::I8 => NumericType::Int8,
        NumberType::U8 => NumericType::Uint8,
        NumberType::I16 => NumericType::Int16,
        NumberType::U16 => NumericType::Uint16,
        NumberType::I32 => NumericType::Int32,
        NumberType::U32 => NumericType::Uint32,
        NumberType::F32 => NumericType::Float32,
        NumberType::F64 => NumericType::Float64,
    }
}

fn kind(numeric: NumericType) -> Option<NumberType> {
    Some(match numeric {
        NumericType::Unknown => return None,
        NumericType::Int8 => NumberType::I8,
        NumericType::Uint8 => NumberType::U8,
        NumericType::Int16 => NumberType::I16,
        NumericType::Uint16 => NumberType::U16,
        NumericType::Int32 => NumberType::I32,
        NumericType::Uint32 => NumberType::U32,
        NumericType::Float32 => NumberType::F32,
        NumericType::Float64 => NumberType::F64,
    })
}

/// What is around the rows of a message.
pub(super) struct Head<'a> {
    pub fields: Vec<(&'a str, NumberType)>,
    pub rows: usize,
    pub time_ns: u64,
    pub frame_id: &'a str,
}

/// Encodes a table into `message`, whose memory is used again.
pub(super) fn encode(
    table: &Table,
    time_ns: u64,
    frame_id: &str,
    message: &mut Vec<u8>,
) -> Result<(), String> {
    let columns: Vec<&Values> = table.columns().iter().map(|c| &c.values).collect();
    let fields = table.columns().iter().map(|c| (&*c.name, c.values.kind())).collect();
    let head = Head { fields, rows: table.rows(), time_ns, frame_id };
    head.encode(message, |_, out| pack::<false>(&columns, 0, out))
}

/// Encodes rows that are not held in memory.
pub(super) fn encode_rows(
    rows: &impl Rows,
    time_ns: u64,
    frame_id: &str,
    message: &mut Vec<u8>,
) -> Result<(), String> {
    let head = Head { fields: rows.fields(), rows: rows.count(), time_ns, frame_id };
    head.encode(message, |stride, out| pack_rows(rows, stride, out))
}

impl Head<'_> {
    /// The few small fields go through prost; `fill` packs the rows of a width [B] behind them in place, without a copy.
    fn encode(self, message: &mut Vec<u8>, fill: impl FnOnce(usize, &mut [u8])) -> Result<(), String> {
        let Head { fields, rows, time_ns, frame_id } = self;
        let mut stride = 0;
        let fields = fields.into_iter().map(|(name, kind)| {
            let offset = stride as u32;
            stride += kind.size();
            PackedElementField { name: name.to_owned(), offset, r#type: numeric(kind) as i32 }
        });
        let fields = fields.collect();
        let head = PointCloud {
            timestamp: Some(Timestamp {
                seconds: (time_ns / 1_000_000_000) as i64,
                nanos: (time_ns % 1_000_000_000) as i32,
            }),
            frame_id: frame_id.to_owned(),
            pose: Some(Pose {
                position: Some(Vector3::default()),
                orientation: Some(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }),
            }),
            point_stride: stride as u32,
            fields,
            data: Default::default(),
        };
        let size = rows * stride;
        // A protobuf message is smaller than 2 GiB.
        if size > i32::MAX as usize - 65536 {
            return Err(format!("{rows} rows of {stride} bytes do not fit one message (2 GiB)"));
        }
        message.clear();
        // Room for all at once: a list that grows takes twice its length.
        message.reserve_exact(head.encoded_len() + 16 + size);
        head.encode(message).map_err(|e| e.to_string())?;
        if size > 0 {
            message.push(DATA_TAG);
            prost::encoding::encode_varint(size as u64, message);
            let start = message.len();
            message.resize(start + size, 0);
            fill(stride, &mut message[start..]);
        }
        Ok(())
    }
}

/// Decodes a message.
pub(super) fn decode(message: Vec<u8>) -> Result<Table, String> {
    let cloud = PointCloud::decode(prost::bytes::Bytes::from(message)).map_err(|e| e.to_string())?;
    let stride = cloud.point_stride as usize;
    if stride == 0 {
        return if cloud.data.is_empty() && cloud.fields.is_empty() {
            Ok(Table::default())
        } else {
            Err("point_stride is 0".to_owned())
        };
    }
    if cloud.data.len() % stride != 0 {
        return Err(format!("{} bytes are not a whole number of rows of {stride} bytes", cloud.data.len()));
    }
    let columns: Vec<Result<Values, String>> =
        cloud.fields.par_iter().map(|f| field(f, &cloud.data, stride)).collect();
    let mut table = Table::with_rows(cloud.data.len() / stride);
    for (field, values) in cloud.fields.iter().zip(columns) {
        table.push(&field.name, values?).map_err(|e| e.to_string())?;
    }
    Ok(table)
}

fn field(field: &PackedElementField, data: &[u8], stride: usize) -> Result<Values, String> {
    let name = &field.name;
    let kind = NumericType::try_from(field.r#type).ok().and_then(kind);
    let kind = kind.ok_or_else(|| format!("field '{name}' has the unknown type {}", field.r#type))?;
    let offset = field.offset as usize;
    if offset + kind.size() > stride {
        return Err(format!(
            "field '{name}' at offset {offset} reaches over the end of a row ({stride} bytes)"
        ));
    }
    Ok(column::<false>(data, stride, offset, kind))
}
