//! Colours for values: maps with a steady rise of lightness, and a set for kinds.

/// Red, green, blue, 0–255, as a display takes them (sRGB).
pub type Rgb = [u8; 3];

/// Colour of walls when they are not what is looked at.
pub const WALL: Rgb = [0xb4, 0xb8, 0xbe];

/// Viridis (S. van der Walt, N. Smith 2015, CC0): even steps in lightness, safe for colour-blind readers.
const VIRIDIS: [u32; 10] = [
    0x44_01_54, 0x48_28_78, 0x3e_4a_89, 0x31_68_8e, 0x26_82_8e, 0x1f_9e_89, 0x35_b7_79, 0x6e_ce_58,
    0xb5_de_2b, 0xfd_e7_25,
];

/// Turbo (A. Mikhailov 2019): a rainbow without false edges, for small differences.
const TURBO: [u32; 15] = [
    0x30_12_3b, 0x41_45_ab, 0x46_75_ed, 0x39_a2_fc, 0x1b_cf_d4, 0x24_ec_a6, 0x61_fc_6c, 0xa4_fc_3b,
    0xd1_e8_34, 0xf3_c6_3a, 0xfe_9b_2d, 0xf3_63_15, 0xd9_38_06, 0xb1_19_01, 0x7a_04_02,
];

/// Heat: pale to dark red, lighter all the way down; for walls, beside grains in viridis.
const HEAT: [u32; 7] = [0xe6_e4_dc, 0xf6_dc_8b, 0xf8_b6_50, 0xee_81_38, 0xd1_48_2c, 0x96_1f_2f, 0x4f_0d_2c];

/// Kinds (M. Okabe, K. Ito 2008), the yellow and black moved to the end.
const KINDS: [u32; 8] =
    [0x00_72_b2, 0xe6_9f_00, 0x00_9e_73, 0xd5_5e_00, 0x56_b4_e9, 0xcc_79_a7, 0xf0_e4_42, 0x55_55_55];

/// A map from 0–1 to colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Map {
    /// Dark violet to yellow.
    #[default]
    Viridis,
    /// Blue over green to red.
    Turbo,
    /// Pale over orange to dark red.
    Heat,
}

impl Map {
    /// Every map, with its name.
    pub const ALL: [(&'static str, Map); 3] =
        [("viridis", Map::Viridis), ("turbo", Map::Turbo), ("heat", Map::Heat)];

    /// The map of that name.
    pub fn named(name: &str) -> Option<Map> {
        Map::ALL.iter().find(|(known, _)| *known == name).map(|(_, map)| *map)
    }

    /// Its anchors, evenly spaced.
    pub(crate) fn anchors(self) -> Vec<Rgb> {
        let anchors: &[u32] = match self {
            Map::Viridis => &VIRIDIS,
            Map::Turbo => &TURBO,
            Map::Heat => &HEAT,
        };
        anchors.iter().map(|&hex| rgb(hex)).collect()
    }

    /// The colour at `share`, 0 to 1, as fractions.
    pub(crate) fn at(self, share: f64) -> [f32; 3] {
        let anchors = self.anchors();
        let place = share.clamp(0.0, 1.0) * (anchors.len() - 1) as f64;
        let below = (place as usize).min(anchors.len() - 2);
        let part = (place - below as f64) as f32;
        let [a, b] = [fraction(anchors[below]), fraction(anchors[below + 1])];
        std::array::from_fn(|k| (1.0 - part) * a[k] + part * b[k])
    }
}

/// The colour of a kind, by its number.
pub fn kind(number: usize) -> Rgb {
    rgb(KINDS[number % KINDS.len()])
}

/// The colour of a clump, by its number: that of its first sphere, so neighbouring ones differ by the spheres of a clump, and
/// a multiple of 8 would be one colour for all. A hash scatters them (D. Knuth 1998, The Art of Computer Programming 3,
/// 6.4: by the golden ratio).
pub fn scattered(number: usize) -> Rgb {
    kind(((number as u32).wrapping_mul(0x9e37_79b9) >> 29) as usize)
}

/// How many kinds have a colour of their own.
pub const KIND_COUNT: usize = KINDS.len();

/// The same colour, each part 0 to 1.
pub fn fraction(colour: Rgb) -> [f32; 3] {
    colour.map(|c| f32::from(c) / 255.0)
}

fn rgb(hex: u32) -> Rgb {
    let [_, r, g, b] = hex.to_be_bytes();
    [r, g, b]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clumps_of_eight_spheres_have_all_colours() {
        let colours: std::collections::HashSet<Rgb> = (0..40).map(|n| scattered(8 * n)).collect();
        assert_eq!(colours.len(), KIND_COUNT);
    }

    #[test]
    fn viridis_grows_lighter_all_the_way() {
        let light = |s: f64| {
            let [r, g, b] = Map::Viridis.at(s);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert!((0..100).all(|i| light(f64::from(i) / 100.0) < light(f64::from(i + 1) / 100.0)));
    }

    #[test]
    fn heat_grows_darker_all_the_way() {
        let light = |s: f64| {
            let [r, g, b] = Map::Heat.at(s);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert!((0..100).all(|i| light(f64::from(i) / 100.0) > light(f64::from(i + 1) / 100.0)));
    }

    #[test]
    fn ends_of_a_map_are_its_first_and_last_anchor() {
        assert_eq!(Map::Viridis.at(-1.0), fraction([0x44, 0x01, 0x54]));
        assert_eq!(Map::Turbo.at(2.0), fraction([0x7a, 0x04, 0x02]));
    }
}
