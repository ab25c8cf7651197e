//! Poses of photographs that were not taken on a turntable: COLMAP's text files, or tables of 3 × 4 matrices.

use crate::camera::Camera;
use geom::Vec3;
use nalgebra::{Matrix3x4, Quaternion, UnitQuaternion};
use std::collections::BTreeMap;
use thiserror::Error;

/// A pose of one photograph.
#[derive(Debug, Clone, PartialEq)]
pub struct Pose {
    /// Name of the photograph, as in the file.
    pub name: String,
    pub camera: Camera,
    /// Width and height of the photograph that the camera is for, where the file says them [px].
    pub size: Option<[usize; 2]>,
}

/// What is wrong with a file of poses.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PoseError {
    #[error("line {line}: {what}: '{text}'")]
    Line { line: usize, what: String, text: String },
    #[error("has no pose")]
    Empty,
    #[error("photograph {0} has two poses: remove one of them")]
    Twice(String),
    #[error("the matrix of {0} is that of no camera: its left three columns have no inverse")]
    Matrix(String),
}

fn line_error(line: usize, what: impl Into<String>, text: &str) -> PoseError {
    PoseError::Line { line, what: what.into(), text: text.chars().take(60).collect() }
}

/// Text without the mark of UTF-8 that some programs write first.
fn bare(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// Lines that are neither empty nor comments, with their numbers from 1.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let text = bare(text);
    (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'))
}

/// A table: the name of a photograph and twelve numbers (P row by row) a line; blanks, commas or semicolons between them. Pixel (0, 0) has its
/// centre at (0, 0).
///
/// # Errors
/// A line that is none of these.
pub fn table(text: &str) -> Result<Vec<Pose>, PoseError> {
    let mut poses = Vec::new();
    for (line, row) in lines(text) {
        let words: Vec<&str> =
            row.split([' ', '\t', ',', ';']).map(str::trim).filter(|w| !w.is_empty()).collect();
        let numbers: Vec<f64> = words.iter().skip(1).map_while(|w| w.parse().ok()).collect();
        // A first line of words names the columns.
        if poses.is_empty() && numbers.is_empty() && words.len() > 1 {
            continue;
        }
        if numbers.len() != 12 || words.len() != 13 {
            return Err(line_error(line, "give the name of a photograph and twelve numbers", row));
        }
        poses.push(pose(words[0], &numbers)?);
    }
    whole(poses)
}

/// The pose of a matrix in a file of its own: twelve numbers, row by row.
///
/// # Errors
/// Other text than twelve numbers.
pub fn matrix(name: &str, text: &str) -> Result<Pose, PoseError> {
    let numbers: Result<Vec<f64>, _> = bare(text).split_whitespace().map(str::parse).collect();
    match numbers {
        Ok(numbers) if numbers.len() == 12 => pose(name, &numbers),
        _ => Err(line_error(1, "give twelve numbers, row by row", text.lines().next().unwrap_or_default())),
    }
}

fn pose(name: &str, numbers: &[f64]) -> Result<Pose, PoseError> {
    let camera = Camera::from_matrix(&Matrix3x4::from_row_slice(numbers));
    let camera = camera.ok_or_else(|| PoseError::Matrix(name.to_owned()))?;
    Ok(Pose { name: name.to_owned(), camera, size: None })
}

/// Sorted by name, each once.
fn whole(mut poses: Vec<Pose>) -> Result<Vec<Pose>, PoseError> {
    poses.sort_by(|a, b| a.name.cmp(&b.name));
    if let Some(twice) = poses.windows(2).find(|w| w[0].name == w[1].name) {
        return Err(PoseError::Twice(twice[0].name.clone()));
    }
    if poses.is_empty() { Err(PoseError::Empty) } else { Ok(poses) }
}

/// COLMAP's `cameras.txt` and `images.txt`. There the first pixel has its centre at (½, ½).
///
/// # Errors
/// Lines that are not COLMAP's, and camera models other than SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL and OPENCV.
pub fn colmap(cameras: &str, images: &str) -> Result<Vec<Pose>, PoseError> {
    let mut known = BTreeMap::new();
    for (line, row) in lines(cameras) {
        let camera = intrinsics(row).map_err(|what| line_error(line, format!("cameras.txt: {what}"), row))?;
        known.insert(row.split_whitespace().next().unwrap_or_default().to_owned(), camera);
    }
    let mut poses = Vec::new();
    // Every second line lists points, and may be empty.
    let rows = (1..).zip(bare(images).lines()).filter(|(_, line)| !line.trim_start().starts_with('#'));
    for (line, row) in rows.step_by(2).filter(|(_, row)| !row.trim().is_empty()) {
        let wrong = |what: &str| line_error(line, format!("images.txt: {what}"), row);
        let words: Vec<&str> = row.split_whitespace().collect();
        let pose = words.iter().skip(1).take(7).map_while(|w| w.parse().ok());
        let pose: Vec<f64> = pose.filter(|v: &f64| v.is_finite()).collect();
        let &[w, x, y, z, tx, ty, tz] = &pose[..] else {
            return Err(wrong("give ID QW QX QY QZ TX TY TZ CAMERA NAME"));
        };
        if words.len() < 10 {
            return Err(wrong("give ID QW QX QY QZ TX TY TZ CAMERA NAME"));
        }
        let (camera, size) = known.get(words[8]).ok_or_else(|| wrong("cameras.txt has no such camera"))?;
        let turn = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9)
            .ok_or_else(|| wrong("the quaternion is 0"))?;
        let rotation = turn.to_rotation_matrix().into_inner();
        let camera = Camera { rotation, translation: Vec3::new(tx, ty, tz), ..*camera };
        poses.push(Pose { name: words[9..].join(" "), camera, size: Some(*size) });
    }
    whole(poses)
}

/// A line of `cameras.txt`: a camera without a pose, and its size.
fn intrinsics(row: &str) -> Result<(Camera, [usize; 2]), String> {
    let words: Vec<&str> = row.split_whitespace().collect();
    let [_, model, width, height, ref rest @ ..] = words[..] else {
        return Err("give ID MODEL WIDTH HEIGHT PARAMETERS".to_owned());
    };
    let size = [width.parse(), height.parse()].map(|v: Result<usize, _>| v.unwrap_or(0));
    let p: Vec<f64> = rest.iter().map_while(|w| w.parse().ok()).filter(|v: &f64| v.is_finite()).collect();
    let (focal, centre, distortion) = match (model, &p[..]) {
        ("SIMPLE_PINHOLE", &[f, cx, cy]) => ([f, f], [cx, cy], [0.0; 4]),
        ("PINHOLE", &[fx, fy, cx, cy]) => ([fx, fy], [cx, cy], [0.0; 4]),
        ("SIMPLE_RADIAL", &[f, cx, cy, k]) => ([f, f], [cx, cy], [k, 0.0, 0.0, 0.0]),
        ("RADIAL", &[f, cx, cy, k1, k2]) => ([f, f], [cx, cy], [k1, k2, 0.0, 0.0]),
        ("OPENCV", &[fx, fy, cx, cy, k1, k2, p1, p2]) => ([fx, fy], [cx, cy], [k1, k2, p1, p2]),
        ("SIMPLE_PINHOLE" | "PINHOLE" | "SIMPLE_RADIAL" | "RADIAL" | "OPENCV", _) => {
            return Err(format!("{} parameters are not those of {model}", rest.len()));
        }
        _ => {
            return Err(format!(
                "model {model} is not read: export with SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL or OPENCV"
            ));
        }
    };
    if size.contains(&0) || !(focal[0] > 0.0 && focal[1] > 0.0) {
        return Err("give a width, a height and a focal length above 0".to_owned());
    }
    let camera = Camera {
        focal: [focal[0], focal[1], 0.0],
        centre: centre.map(|c| c - 0.5),
        distortion,
        rotation: nalgebra::Matrix3::identity(),
        translation: Vec3::zeros(),
    };
    Ok((camera, size))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERAS: &str =
        "# comment\n1 PINHOLE 320 240 700 690 160 120\n2 OPENCV 320 240 700 690 160 120 0.1 0 0 0\n";
    const IMAGES: &str = "# comment\n1 1 0 0 0 0 0 2 1 a one.jpg\n\n2 0.7071067811865476 0 0 0.7071067811865476 0 0 2 2 b.jpg\n1 2 3\n";

    #[test]
    fn colmap_text_gives_cameras() {
        let poses = colmap(CAMERAS, IMAGES).unwrap();
        assert_eq!(poses.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["a one.jpg", "b.jpg"]);
        let (at, depth) = poses[0].camera.project(&Vec3::new(0.1, 0.0, 0.0));
        assert!((at[0] - (159.5 + 35.0)).abs() < 1e-9 && (at[1] - 119.5).abs() < 1e-9 && depth == 2.0);
        // Turned by 90° about the line of sight.
        let (at, _) = poses[1].camera.project(&Vec3::new(0.1, 0.0, 0.0));
        assert!((at[0] - 159.5).abs() < 1e-9 && at[1] > 150.0, "{at:?}");
        let wrong = colmap(&CAMERAS.replace("PINHOLE", "FISHEYE"), IMAGES).unwrap_err().to_string();
        assert!(wrong.contains("line 2") && wrong.contains("FISHEYE"), "{wrong}");
        assert!(colmap(CAMERAS, "1 1 0 0\n").unwrap_err().to_string().contains("images.txt"));
    }

    #[test]
    fn a_table_of_matrices_gives_the_same_as_their_files() {
        let row = "700 0 160 320 0 690 120 240 0 0 1 2";
        let table = table(&format!("name,p11,p12\nb.jpg {row}\na.jpg,{}\n", row.replace(' ', ","))).unwrap();
        assert_eq!(table.len(), 2);
        assert_eq!(table[0].camera, matrix("x", row).unwrap().camera);
        let wrong = super::table(&format!("a {row} 3\n")).unwrap_err().to_string();
        assert!(wrong.contains("line 1") && wrong.contains("twelve"), "{wrong}");
        let twice = format!("a {row}\na {row}\n");
        assert!(super::table(&twice).unwrap_err().to_string().contains("two poses"));
    }

    /// Some programs mark UTF-8 with three bytes in front; they are no part of the first name.
    #[test]
    fn a_byte_order_mark_is_no_part_of_a_name() {
        let row = "700 0 160 320 0 690 120 240 0 0 1 2";
        let text = format!("a.jpg {row}\nb.jpg {row}\n");
        assert_eq!(table(&format!("\u{feff}{text}")), table(&text));
        assert_eq!(matrix("x", &format!("\u{feff}{row}")), matrix("x", row));
        let marked = |text: &str| format!("\u{feff}{text}");
        let bare =
            |text: &str| text.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join("\n");
        assert_eq!(colmap(&marked(&bare(CAMERAS)), &marked(&bare(IMAGES))), colmap(CAMERAS, IMAGES));
    }
}
