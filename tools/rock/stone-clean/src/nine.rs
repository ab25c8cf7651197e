//! Text with nine numbers a line: the corners of a triangle, or a point with its colour and its normal.

use geom::Vec3;

/// How far the length of a normal may be from 1 [–]: it was rounded.
const ROUNDED: f64 = 0.02;
/// Largest colour.
const COLOR: f64 = 255.0;
/// Rows from which on numbers are no chance.
const ROWS: usize = 10;
/// Corners that all triangles of a fan, or of two of them, share.
const FANS: usize = 2;

/// Whether text is a cloud: it names its columns or counts its points, or six of nine numbers are a colour and a normal, or only one of these is.
pub fn is_cloud(bytes: &[u8]) -> bool {
    if cloud::formats::name_of(bytes) != Some("XYZ/PTS") {
        return false;
    }
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text.trim_start_matches('\u{feff}').lines().filter(|line| !line.trim().is_empty());
    if lines.next().is_some_and(|line| line.trim().parse::<u64>().is_ok()) {
        return true;
    }
    // Names of other columns than those of a point are refused there.
    let Ok(cloud) = cloud::from_bytes(bytes.to_vec()) else { return false };
    let columns = cloud.attributes.columns();
    if columns.len() != 6 {
        return false;
    }
    if !(4..).zip(columns).all(|(k, column)| column.name == format!("c{k}")) {
        return true;
    }
    let rows = || 0..cloud.points.len();
    if rows().len() < ROWS {
        return false;
    }
    let three = |first: usize, row: usize| Vec3::from([0, 1, 2].map(|k| columns[first + k].values.get(row)));
    let is_whole = |v: &Vec3| v.iter().all(|c| c.fract() == 0.0);
    let is_unit = |v: &Vec3| (v.norm() - 1.0).abs() < ROUNDED;
    let is_color = |v: &Vec3| is_whole(v) && v.iter().all(|c| (0.0..=COLOR).contains(c));
    // The corners of a box in millimetres are whole numbers, too, and those of a unit sphere have a distance of 1.
    let is_colored = !cloud.points.iter().all(is_whole);
    let has_normals = !cloud.points.iter().all(is_unit);
    let differ = |first: usize| {
        let mut all: Vec<[u64; 3]> = rows().map(|row| three(first, row).map(f64::to_bits).into()).collect();
        all.sort_unstable();
        all.dedup();
        all.len() > FANS
    };
    [0, 3].into_iter().any(|first| {
        let is_either = is_colored && rows().all(|row| is_color(&three(first, row)))
            || has_normals && rows().all(|row| is_unit(&three(first, row)));
        is_either && differ(first)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a sphere of radius 0.1 m, each with its normal.
    fn points(color: &str) -> String {
        let point = |k: u32| {
            let (a, z) = (2.4 * f64::from(k), f64::from(k) / 20.0 - 0.975);
            let flat = (1.0 - z * z).sqrt();
            let n = [flat * a.cos(), flat * a.sin(), z];
            let [x, y, h] = n.map(|c| 0.1 * c);
            format!("{x:.6} {y:.6} {h:.6} {color} {:.6} {:.6} {:.6}\n", n[0], n[1], n[2])
        };
        (0..40).map(point).collect()
    }

    #[test]
    fn points_with_colours_and_normals_are_a_cloud() {
        let rows = points("0.8 0.4 0.2");
        for text in [
            format!("x y z Rf Gf Bf nx ny nz\n{rows}"),
            format!("//X Y Z R G B Nx Ny Nz\n{rows}"),
            format!("# x y z r g b nx ny nz\n{rows}"),
            format!("40\n{rows}"),
            format!("\u{feff}40\r\n{}", rows.replace('\n', "\r\n")),
            rows.clone(),
            points("200 17 0"),
            (0..12).map(|k| format!("0.{k} 0.25 1 200 {k} 0 0.1 0.2 0.3\n")).collect(),
        ] {
            assert!(is_cloud(text.as_bytes()), "{}", &text[..60]);
        }
    }

    #[test]
    fn corners_of_triangles_are_none() {
        for text in [
            "0 0 0 1 0 0 0 1 0\n1 0 0 1 1 0 0 1 0\n",
            "0 0 0 100 0 0 0 100 0\n100 0 0 100 100 0 0 100 0\n",
            // On a sphere of radius 1.
            "1 0 0 0 1 0 0 0 1\n0 1 0 -1 0 0 0 0 1\n",
            "0.1 0 0 0.2 0 0 0.1 0.1 0\n",
            // A fan around one corner, and one triangle.
            &(0..12).map(|k| format!("0.{k} 0.5 0 0.2 {k}.5 0 0 0 1\n")).collect::<String>(),
            "0.5 0 0 1 0 0 0 1 0\n",
            "x1 y1 z1 x2 y2 z2 x3 y3 z3\n0.1 0 0 0.2 0 0 0.1 0.1 0\n",
            "# corners\n0.1 0 0 0.2 0 0 0.1 0.1 0\n",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        ] {
            assert!(!is_cloud(text.as_bytes()), "{text}");
        }
    }
}
