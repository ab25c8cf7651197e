//! PCD: viewpoint, padding, several values.

use super::{column, read, refused};
use geom::Vec3;
use stream::Values;

#[test]
fn pcd_states_its_viewpoint() {
    let text = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n\
                VIEWPOINT 1.5 -2 0.25 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n";
    let cloud = read(text);
    assert_eq!(cloud.viewpoints().collect::<Vec<_>>(), [Vec3::new(1.5, -2.0, 0.25)]);
    let mut ply = Vec::new();
    cloud::write_ply(&mut ply, &cloud, Default::default()).unwrap();
    assert_eq!(read(ply).viewpoints().collect::<Vec<_>>(), [Vec3::new(1.5, -2.0, 0.25)], "PLY passes it on");
}

#[test]
fn pcd_as_text_and_binary() {
    let header = |data: &str| {
        format!(
            "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb label\nSIZE 4 4 4 4 2\nTYPE F F F U U\nCOUNT 1 1 1 1 1\n\
             WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA {data}\n"
        )
    };
    let text = header("ascii") + "1 2 3 16711935 7\n4 nan 6 255 8\n";
    let mut binary = header("binary").into_bytes();
    for (p, rgb, label) in [([1f32, 2.0, 3.0], 16711935u32, 7u16), ([4.0, f32::NAN, 6.0], 255, 8)] {
        p.iter().for_each(|c| binary.extend(c.to_le_bytes()));
        binary.extend(rgb.to_le_bytes());
        binary.extend(label.to_le_bytes());
    }
    for bytes in [text.as_bytes(), &binary] {
        let cloud = read(bytes);
        assert_eq!(cloud.points[0], Vec3::new(1.0, 2.0, 3.0));
        assert!(cloud.points[1].y.is_nan() && !cloud.double);
        assert_eq!((column(&cloud, "red")[0], column(&cloud, "green")[0]), (255.0, 0.0));
        assert_eq!(cloud.attributes.get("label"), Some(&Values::U16(vec![7, 8])));
        assert_eq!(cloud.viewpoints().count(), 0, "zero is no viewpoint");
        assert!(refused(&bytes[..bytes.len() - 6]).starts_with("PCD"));
    }
    assert!(refused(text.replace(" x y z ", " a y z ")).contains("no fields x, y, z"));
}

/// As ROS and PCL write it: bytes that only fill a point up, several values of a name, a remark before the head.
#[test]
fn pcd_with_padding_and_several_values() {
    let head = |data: &str| {
        format!(
            "# exported\nVERSION 0.7\nFIELDS _ x y z _ hist ring _\nSIZE 4 4 4 4 1 4 2 1\nTYPE F F F F U F U U\n\
             COUNT 1 1 1 1 4 2 1 10\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA {data}\n"
        )
    };
    let mut binary = head("binary").into_bytes();
    for k in [0u8, 1] {
        [9.0, 1.0, 2.0, 3.0].iter().for_each(|c: &f32| binary.extend((c + f32::from(k)).to_le_bytes()));
        binary.extend([255; 4]);
        [5.0, 6.0].iter().for_each(|c: &f32| binary.extend((c + f32::from(k)).to_le_bytes()));
        binary.extend([7 + k, 0]);
        binary.extend([255; 10]);
    }
    let blank = "0 ".repeat(10);
    let text = head("ascii") + &format!("9 1 2 3 0 0 0 0 5 6 7 {blank}\n10 2 3 4 0 0 0 0 6 7 8 {blank}\n");
    for bytes in [&binary, text.as_bytes()] {
        let cloud = read(bytes);
        assert_eq!(cloud.points, [Vec3::new(1.0, 2.0, 3.0), Vec3::new(2.0, 3.0, 4.0)]);
        let names: Vec<&str> = cloud.attributes.columns().iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["hist_0", "hist_1", "ring"]);
        assert_eq!((column(&cloud, "hist_1"), column(&cloud, "ring")), (vec![6.0, 7.0], vec![7.0, 8.0]));
    }
    let more = [&binary[..], &binary[binary.len() - 42..]].concat();
    for told in [refused(more), refused(text.replace("POINTS 2", "POINTS 1"))] {
        assert!(told.contains("points, and there are") && told.contains("correct POINTS"), "{told}");
    }
}
