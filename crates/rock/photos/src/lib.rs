//! From photographs of a stone to its silhouettes and its visual hull.
//!
//! ```text
//! photograph  JPEG and PNG → linear light
//! threshold   the level between stone and background
//! raster      true/false pixels: morphology, largest region, holes
//! mask        a photograph → coverage of each pixel by the stone, with its warnings
//! contour     the edge of a mask at a fraction of a pixel
//! field       signed distance to that edge
//! camera      where a point of space is on a photograph
//! turntable   one camera, one axis, known steps
//! poses       COLMAP's text files, tables of matrices
//! hull        what no silhouette excludes
//! coherence   whether silhouettes agree, and how poses are refined until they do
//! adjusted    a turntable whose numbers are a little wrong
//! turned      a stone that was turned over
//! refine      from the hull inwards, by correlation of photographs
//! suspects    views that do not agree with most others
//! tags        the scale from tags of known size
//! rendered    photographs of a mesh, for tests and trials
//! sheet       many photographs with their outlines on one picture
//! ```
//!
//! Pixel (0, 0) has its centre at (0, 0); x runs to the right and y down, in pixels.

pub mod adjusted;
pub mod camera;
pub mod coherence;
pub mod contour;
pub mod field;
pub mod hull;
mod jpeg_end;
pub mod mask;
pub mod photograph;
pub mod poses;
pub mod raster;
pub mod refine;
pub mod rendered;
pub mod sheet;
pub mod suspects;
pub mod tags;
pub mod threshold;
pub mod turned;
pub mod turntable;

pub use camera::Camera;
pub use contour::{Segment, contour};
pub use field::Field;
pub use hull::{HullError, View, hull};
pub use mask::{Mask, MaskSettings, MaskWarning, Polarity, find_mask};
pub use photograph::{Photograph, PhotographError};
pub use raster::Raster;
pub use turned::{Alignment, align};
pub use turntable::{Turntable, TurntableError};
