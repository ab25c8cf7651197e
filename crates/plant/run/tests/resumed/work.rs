//! Sliding work in `/contacts` behind a checkpoint.

use crate::runs::{column, last, made, tables, tray};

/// Grains that slide in a tray: contacts begin and end in every interval.
fn sliding() -> String {
    let grains = "[[fill]]\nmaterial = \"rock\"\nshape = \"box:0,0,0.01,0.05,0.05,0.06\"\ndiameter = [0.006, 0.01]\ncount = 25\n";
    tray("3, 0, -9.81", 0.2).replace("rolling_resistance = 0.1\n", "") + grains
}

/// A resumed run writes the frames of the whole run, the sliding work of each contact included: the interval before the checkpoint is in the frame of
/// that instant, which is in the file of the run that was resumed.
#[test]
fn frames_behind_a_checkpoint_have_the_work_of_their_own_intervals() {
    let (_, whole) = made(&sliding(), &[], None).unwrap();
    let (_, begun) = made(&sliding(), &["time.until=0.1".to_owned()], None).unwrap();
    let (_, rest) = made(&sliding(), &[], Some(last(&begun))).unwrap();
    let (whole, rest) = (tables(&whole, "/contacts"), tables(&rest, "/contacts"));
    assert_eq!((whole.len(), rest.len()), (21, 10));
    let slid = |table: &stream::Table| column(table, "work").iter().sum::<f64>();
    assert!(slid(&rest[0].1) > 0.0 && slid(&whole[10].1) > 0.0, "nothing slides");
    for (expected, found) in whole[11..].iter().zip(&rest) {
        assert_eq!(expected, found);
    }
}

/// A checkpoint between two frames holds the work since the frame before it.
#[test]
fn a_checkpoint_between_frames_keeps_the_work_since_the_last_frame() {
    let sets = |until: &str| ["output.every=0.04", &format!("time.until={until}")].map(str::to_owned);
    let (_, whole) = made(&sliding(), &sets("0.2"), None).unwrap();
    let between = made(&sliding(), &sets("0.1"), None).unwrap().1;
    let (_, rest) = made(&sliding(), &sets("0.2"), Some(last(&between))).unwrap();
    let (whole, rest) = (tables(&whole, "/contacts"), tables(&rest, "/contacts"));
    assert_eq!((whole.len(), rest.len()), (6, 3));
    assert_eq!(whole[3..], rest[..]);
}
