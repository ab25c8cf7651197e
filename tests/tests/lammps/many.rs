//! Many grains on both engines: the same until collisions make small differences large, and alike in the mean after that.

use crate::lmp;
use crate::stages::mean;
use grainpipe_tests::engines::both;
use grainpipe_tests::recorded::column;
use grainpipe_tests::scenes::{GLASS, folder};
use stream::Table;

/// Grains in a box: sizes, periodic sides, a floor.
#[test]
fn a_pile_settles_to_the_same_height() {
    if !lmp() {
        return;
    }
    let pile = "[domain]\nperiodic = [\"x\", \"y\"]\nlow = [0, 0, 0]\nhigh = [0.04, 0.04, 1]\n[[fill]]\nmaterial = \"glass\"\n\
                shape = \"box:0,0,0,0.04,0.04,0.1\"\ndiameter = [0.004, 0.006]\ncount = 600\n[[wall]]\nname = \"floor\"\n\
                plane = \"0,0,0,0,0,1\"\nmaterial = \"glass\"\n";
    let folder = folder(&[("s.toml", GLASS.toml() + pile)]);
    let [ours, theirs] = both(folder.path(), &[]);
    let heights = |frames: &[Table]| frames.iter().map(|f| mean(f, "z")).collect::<Vec<_>>();
    let (a, b) = (heights(&ours), heights(&theirs));
    assert_eq!(column(&ours[0], "x"), column(&theirs[0], "x"), "the same grains to begin with");
    let largest = a.iter().zip(&b).map(|(p, q)| (p - q).abs() / a[0]).fold(0.0, f64::max);
    println!("mean heights differ by {largest:.2e} of the first at most");
    assert!(a[0] > 1.5 * a[15] && largest < 0.01, "{a:?} {b:?}");
}

/// Grains of an insertion come in at the same places and times.
#[test]
fn grains_come_in_where_and_when_they_do_in_dem_run() {
    if !lmp() {
        return;
    }
    let insert = "[[insert]]\nmaterial = \"glass\"\nshape = \"box:-0.03,-0.03,0.5,0.03,0.03,0.52\"\n\
                  diameter = [0.004, 0.006]\nvelocity = [0, 0, -0.5]\nrate_count = 2000\nuntil = 0.25\n";
    let folder = folder(&[("s.toml", GLASS.toml() + insert)]);
    let [ours, theirs] = both(folder.path(), &[]);
    for (a, b) in ours.iter().zip(&theirs) {
        assert_eq!(column(a, "id"), column(b, "id"));
        let off = |name: &str| {
            column(a, name).iter().zip(column(b, name)).map(|(p, q)| (p - q).abs()).fold(0.0, f64::max)
        };
        let worst = ["x", "y", "z"].map(off).into_iter().fold(0.0, f64::max);
        assert!(worst < 1e-4, "{worst:e} m");
    }
    assert!(theirs[15].rows() > 400, "{}", theirs[15].rows());
}
