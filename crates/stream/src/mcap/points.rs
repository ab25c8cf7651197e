//! Tables as `foxglove.PointCloud` messages.

use crate::{
    Kind, Table, Values,
    rows::{column, pack, stride},
};
use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{PackedElementField, PointCloud, Pose, Quaternion, Timestamp, Vector3};
use prost::Message;
use rayon::prelude::*;

/// Protobuf tag of `PointCloud.data`: field 6, length-delimited. Checked by a test against prost.
const DATA_TAG: u8 = (6 << 3) | 2;

fn numeric(kind: Kind) -> NumericType {
    match kind {
        Kind::I8 => NumericType::Int8,
        Kind::U8 => NumericType::Uint8,
        Kind::I16 => NumericType::Int16,
        Kind::U16 => NumericType::Uint16,
        Kind::I32 => NumericType::Int32,
        Kind::U32 => NumericType::Uint32,
        Kind::F32 => NumericType::Float32,
        Kind::F64 => NumericType::Float64,
    }
}

fn kind(numeric: NumericType) -> Option<Kind> {
    Some(match numeric {
        NumericType::Unknown => return None,
        NumericType::Int8 => Kind::I8,
        NumericType::Uint8 => Kind::U8,
        NumericType::Int16 => Kind::I16,
        NumericType::Uint16 => Kind::U16,
        NumericType::Int32 => Kind::I32,
        NumericType::Uint32 => Kind::U32,
        NumericType::Float32 => Kind::F32,
        NumericType::Float64 => Kind::F64,
    })
}

/// Encodes a table into `message`, whose memory is used again.
///
/// The few small fields go through prost; the rows are packed behind them in place, without a copy.
pub(super) fn encode(
    table: &Table,
    time_ns: u64,
    frame_id: &str,
    message: &mut Vec<u8>,
) -> Result<(), String> {
    let columns: Vec<&Values> = table.columns().iter().map(|c| &c.values).collect();
    let stride = stride(&columns);
    let mut offset = 0;
    let fields = table.columns().iter().map(|column| {
        let kind = column.values.kind();
        let field = PackedElementField { name: column.name.clone(), offset, r#type: numeric(kind) as i32 };
        offset += kind.size() as u32;
        field
    });
    let head = PointCloud {
        timestamp: Some(Timestamp::new((time_ns / 1_000_000_000) as u32, (time_ns % 1_000_000_000) as u32)),
        frame_id: frame_id.to_owned(),
        pose: Some(Pose {
            position: Some(Vector3::default()),
            orientation: Some(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }),
        }),
        point_stride: stride as u32,
        fields: fields.collect(),
        data: Default::default(),
    };
    let size = table.rows() * stride;
    // A protobuf message is smaller than 2 GiB.
    if size > i32::MAX as usize - 65536 {
        return Err(format!("{} rows of {stride} bytes do not fit one message (2 GiB)", table.rows()));
    }
    message.clear();
    head.encode(message).map_err(|e| e.to_string())?;
    if size > 0 {
        message.push(DATA_TAG);
        prost::encoding::encode_varint(size as u64, message);
        let start = message.len();
        message.resize(start + size, 0);
        pack::<false>(&columns, 0, &mut message[start..]);
    }
    Ok(())
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
        return Err(format!("{} bytes are no whole number of rows of {stride} bytes", cloud.data.len()));
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

/// The schema of [`encode`]'s messages: name, encoding, descriptor.
pub(super) fn schema() -> Option<foxglove::Schema> {
    <PointCloud as foxglove::Encode>::get_schema()
}
