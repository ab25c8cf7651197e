//! Light and dark: the colours of paper and ink, and what keeps things apart from the paper.

/// How things are drawn on a paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Theme {
    /// Colour of the paper, parts 0 to 1.
    pub paper: [f32; 3],
    /// Colour of text.
    pub ink: [u8; 3],
    /// Colour of arrows, parts 0 to 1.
    pub arrow: [f32; 3],
    /// Colours of the axes.
    pub axes: [[u8; 3]; 3],
    /// How much of the paper a wall hides, at least [–].
    pub wall: f32,
    /// Brightness of the lines of walls [–].
    pub line: f32,
    /// How much darker than its face a full shadow on a wall is [–].
    pub shade: f32,
    /// Largest share of what is behind it that the face of a plane hides [–].
    pub ground: f32,
    /// Light on all of a grain and on its rim [–]: dark grains are nearly as dark as dark paper.
    pub rim: [f32; 2],
}

const LIGHT: Theme = Theme {
    paper: [1.0; 3],
    ink: [0x22, 0x26, 0x2b],
    arrow: [0.13, 0.15, 0.17],
    axes: [[0xc0, 0x39, 0x2b], [0x2e, 0x8b, 0x57], [0x2c, 0x5f, 0xb3]],
    wall: 0.55,
    line: 0.5,
    shade: 0.45,
    ground: 1.0,
    rim: [0.0; 2],
};

const DARK: Theme = Theme {
    paper: [0x10 as f32 / 255.0, 0x12 as f32 / 255.0, 0x16 as f32 / 255.0],
    ink: [0xe6, 0xe9, 0xed],
    arrow: [0.92, 0.93, 0.95],
    axes: [[0xff, 0x7b, 0x6b], [0x5f, 0xd3, 0x94], [0x7f, 0xb2, 0xf0]],
    wall: 0.7,
    line: 1.1,
    shade: 1.0,
    ground: 0.1,
    rim: [0.07, 0.3],
};

impl Theme {
    /// Of dark or of light paper.
    pub fn of(dark: bool) -> Theme {
        if dark { DARK } else { LIGHT }
    }

    pub fn paper_bytes(self) -> [u8; 3] {
        self.paper.map(|c| (255.0 * c).round() as u8)
    }

    /// A lit colour with the light of the rim; `edge` is 0 where the eye looks straight at it, and 1 at its outline.
    pub fn lit(self, colour: [f32; 3], edge: f32) -> [f32; 3] {
        let [all, rim] = self.rim;
        if all == 0.0 {
            return colour;
        }
        colour.map(|c| c + (all + rim * edge * edge) * (1.0 - c))
    }
}
