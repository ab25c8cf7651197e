//! What is doubtful about a mask, alone and among the others.

use super::{Mask, median};
use geom::Shown;
use thiserror::Error;

/// Share of the frame that the class of the stone may take.
const FRAME: f64 = 0.2;
/// Least share of the variance between stone and background.
const SEPARATION: f64 = 0.6;
/// Wider edges than this share of the stone's extent, and than this number of pixels, are blurred.
const BLURRED: (f64, f64) = (0.015, 7.0);
/// A width beyond this multiple of the usual one is blurred.
const WIDER: f64 = 2.0;
/// An area beyond this multiple of the median is not the stone alone.
const LARGER: f64 = 3.0;

/// Something doubtful about a mask.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MaskWarning {
    #[error(
        "mask is empty: nothing stands out from the background; give --level or --object, or draw the mask and use --given"
    )]
    Empty,
    #[error(
        "the frame cuts the stone: {pixels} pixels of the mask are on the frame; what is beyond stays uncarved: leave this photograph out or move the camera back"
    )]
    CutByFrame { pixels: usize },
    #[error("blurred: its edge is {} pixels wide{}; leave it out or take it again", Shown(*.width), of_others(*.usual))]
    Blurred { width: f64, usual: Option<f64> },
    #[error("background may be in the mask: {} % of the frame is as {word} as the stone; check the contact sheet, give --level or --object", Shown((100.0 * .share).round()))]
    Background { share: f64, word: &'static str },
    #[error("weak contrast: stone and background explain only {} % of the variance of its values; use an even background that is much darker or brighter than the stone", Shown((100.0 * .separation).round()))]
    Contrast { separation: f64 },
    #[error("its mask has {} % of the median area of all masks: {}; check the contact sheet", Shown((100.0 * .times).round()), if *.times > 1.0 { "background may be in it, or another stone" } else { "some of the stone may be missing" })]
    Area { times: f64 },
}

fn of_others(width: Option<f64>) -> String {
    width.map_or(String::new(), |w| format!(", that of the others {}", Shown(w)))
}

fn rounded(width: f64) -> f64 {
    (10.0 * width).round() / 10.0
}

impl Mask {
    /// What is doubtful about this mask alone.
    pub fn warnings(&self) -> Vec<MaskWarning> {
        let area = self.area();
        if self.bounds().is_none() {
            return vec![MaskWarning::Empty];
        }
        let mut warnings = Vec::new();
        let pixels = self.on_frame();
        if pixels > 0 {
            warnings.push(MaskWarning::CutByFrame { pixels });
        }
        let Some(found) = self.found else { return warnings };
        if found.edge_width > BLURRED.1 && found.edge_width > BLURRED.0 * area.sqrt() {
            warnings.push(MaskWarning::Blurred { width: rounded(found.edge_width), usual: None });
        }
        if found.frame > FRAME {
            let word = if found.polarity == super::Polarity::Bright { "bright" } else { "dark" };
            warnings.push(MaskWarning::Background { share: found.frame, word });
        }
        if found.separation < SEPARATION {
            warnings.push(MaskWarning::Contrast { separation: found.separation });
        }
        warnings
    }
}

/// What is doubtful about masks among the others; the number of the mask comes first.
pub fn among(areas: &[f64], widths: &[Option<f64>]) -> Vec<(usize, MaskWarning)> {
    let mut warnings = Vec::new();
    let usual = median(areas.iter().copied().filter(|a| *a > 0.0).collect());
    let sharp = median(widths.iter().flatten().copied().filter(|w| *w > 0.0).collect());
    for (k, (area, width)) in areas.iter().zip(widths).enumerate() {
        if *area > LARGER * usual || (*area > 0.0 && *area * LARGER < usual) {
            warnings.push((k, MaskWarning::Area { times: area / usual }));
        }
        if let Some(width) = width.filter(|w| *w > WIDER * sharp && *w > BLURRED.1) {
            warnings.push((k, MaskWarning::Blurred { width: rounded(width), usual: Some(rounded(sharp)) }));
        }
    }
    warnings
}
