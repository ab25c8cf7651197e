//! The Protobuf message `foxglove.PointCloud`, in which viewers of MCAP files read points: <https://docs.foxglove.dev/docs/sdk/schemas/point-cloud>.
//! Fields that nothing here reads are left out.

use prost::{Enumeration, Message};

/// Name of the message.
pub(super) const NAME: &str = "foxglove.PointCloud";

/// Its descriptor and those of the messages in it, a `google.protobuf.FileDescriptorSet`: a file of the Foxglove SDK 0.30 (MIT).
pub(super) const DESCRIPTOR: &[u8] = include_bytes!("point_cloud.desc");

#[derive(Clone, PartialEq, Message)]
pub(super) struct PointCloud {
    #[prost(message, optional, tag = "1")]
    pub timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub frame_id: String,
    #[prost(message, optional, tag = "3")]
    pub pose: Option<Pose>,
    /// Width of a row [B].
    #[prost(fixed32, tag = "4")]
    pub point_stride: u32,
    #[prost(message, repeated, tag = "5")]
    pub fields: Vec<PackedElementField>,
    #[prost(bytes = "bytes", tag = "6")]
    pub data: prost::bytes::Bytes,
}

/// `google.protobuf.Timestamp`
#[derive(Clone, PartialEq, Message)]
pub(super) struct Timestamp {
    #[prost(int64, tag = "1")]
    pub seconds: i64,
    #[prost(int32, tag = "2")]
    pub nanos: i32,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct Pose {
    #[prost(message, optional, tag = "1")]
    pub position: Option<Vector3>,
    #[prost(message, optional, tag = "2")]
    pub orientation: Option<Quaternion>,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct Vector3 {
    #[prost(double, tag = "1")]
    pub x: f64,
    #[prost(double, tag = "2")]
    pub y: f64,
    #[prost(double, tag = "3")]
    pub z: f64,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct Quaternion {
    #[prost(double, tag = "1")]
    pub x: f64,
    #[prost(double, tag = "2")]
    pub y: f64,
    #[prost(double, tag = "3")]
    pub z: f64,
    #[prost(double, tag = "4")]
    pub w: f64,
}

/// A column.
#[derive(Clone, PartialEq, Message)]
pub(super) struct PackedElementField {
    #[prost(string, tag = "1")]
    pub name: String,
    /// Where it begins in a row [B].
    #[prost(fixed32, tag = "2")]
    pub offset: u32,
    #[prost(enumeration = "NumericType", tag = "3")]
    pub r#type: i32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub(super) enum NumericType {
    Unknown = 0,
    Uint8 = 1,
    Int8 = 2,
    Uint16 = 3,
    Int16 = 4,
    Uint32 = 5,
    Int32 = 6,
    Float32 = 7,
    Float64 = 8,
}
