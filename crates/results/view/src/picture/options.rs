//! What a picture is to be like.

use crate::{Camera, Hidden, Map, PartValues, WallScale};
use record::WallsEnd;

/// A picture's settings.
#[derive(Debug, Clone)]
pub struct PictureOptions {
    /// Width [pixel].
    pub width: u32,
    /// Height [pixel].
    pub height: u32,
    /// Where to look from.
    pub camera: Camera,
    /// Field to colour by; none: speed, else height.
    pub colour: Option<String>,
    /// Colour map.
    pub map: Map,
    /// Ends of the colour scale in the field's unit; none: what 98 % of the values lie in.
    pub range: Option<[f64; 2]>,
    /// Time to state in the picture [s].
    pub time: Option<f64>,
    /// How much of the grains a wall in front of them hides, 0 to 1.
    pub wall_opacity: f64,
    /// Leave out the half of the walls that is nearer to the eye than the middle.
    pub cut: bool,
    /// Light text on dark paper.
    pub dark: bool,
    /// Where walls end: the camera does not look for grains that have fallen past all of them.
    pub walls_end: Option<WallsEnd>,
    /// What is not drawn.
    pub hidden: Hidden,
    /// What walls are coloured by; none: they are grey.
    pub walls: Option<WallScale>,
    /// How much of what is behind it a coloured wall hides, 0 to 1: a colour that is seen through is another one.
    pub coloured_opacity: f64,
    /// Values of the faces of each surface, in the unit of that.
    pub surface_values: Vec<Option<PartValues>>,
}

impl Default for PictureOptions {
    fn default() -> Self {
        PictureOptions {
            width: 1920,
            height: 1080,
            camera: Camera::default(),
            colour: None,
            map: Map::default(),
            range: None,
            time: None,
            wall_opacity: 0.2,
            cut: false,
            dark: false,
            walls_end: None,
            hidden: Hidden::default(),
            walls: None,
            coloured_opacity: 1.0,
            surface_values: Vec::new(),
        }
    }
}
