//! Sliding work in `/contacts` behind a checkpoint.

use crate::runs::{column, last, made, tables};

/// Grains that slide in a tray: contacts begin and end in every interval.
const SLIDING: &str = r#"gravity = [3, 0, -9.81]
[time]
until = 0.2
[output]
every = 0.01
checkpoint = 0.02
energy = true
contacts = true
[[material]]
name = "rock"
density = 2600
young = 2e6
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.4
sliding_friction = 0.5
[[fill]]
material = "rock"
shape = "box:0,0,0.01,0.05,0.05,0.06"
diameter = [0.006, 0.01]
count = 25
[[wall]]
name = "tray"
box = [0, 0, 0, 0.06, 0.06, 0.2]
faces = ["x-", "x+", "y-", "y+", "z-"]
material = "rock"
"#;

/// A resumed run writes the frames of the whole run, the sliding work of each contact included: the interval before the checkpoint is in the frame of
/// that instant, which is in the file of the run that was resumed.
#[test]
fn frames_behind_a_checkpoint_have_the_work_of_their_own_intervals() {
    let (_, whole) = made(SLIDING, &[], None).unwrap();
    let (_, begun) = made(SLIDING, &["time.until=0.1".to_owned()], None).unwrap();
    let (_, rest) = made(SLIDING, &[], Some(last(&begun))).unwrap();
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
    let (_, whole) = made(SLIDING, &sets("0.2"), None).unwrap();
    let between = made(SLIDING, &sets("0.1"), None).unwrap().1;
    let (_, rest) = made(SLIDING, &sets("0.2"), Some(last(&between))).unwrap();
    let (whole, rest) = (tables(&whole, "/contacts"), tables(&rest, "/contacts"));
    assert_eq!((whole.len(), rest.len()), (6, 3));
    assert_eq!(whole[3..], rest[..]);
}
