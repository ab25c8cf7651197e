//! Mean stress and strain of a specimen, against its walls.

use super::{column, failed, measure};
use grainpipe_tests::tools::{Done, succeed};
use std::fs;
use tempfile::{TempDir, tempdir};

/// 64 grains on a lattice between six planes, of which the lid comes down by 1 % of the height.
fn squeezed(bonds: &str) -> TempDir {
    let folder = tempdir().unwrap();
    let mut rows = "x,y,z,radius\n".to_owned();
    for k in 0..64 {
        let at = |n: i32| 0.005 + 0.01 * f64::from(n);
        rows += &format!("{},{},{},0.005\n", at(k % 4), at(k / 4 % 4), at(k / 16));
    }
    let scene = format!(
        "gravity = [0, 0, 0]\n[time]\nuntil = 0.04\n[output]\nevery = 0.004\nprecision = \"f64\"\ncontacts = true\nwall_forces = true\n\
         [[material]]\nname = \"m\"\ndensity = 2500\nyoung = 1e6\npoisson = 0.3\n[[contact]]\nbetween = [\"*\", \"*\"]\n\
         law = \"hooke\"\ncontact_modulus = 1e6\nrestitution = 0.1\n{bonds}[[particles]]\nsource = \"grains.csv\"\nmaterial = \"m\"\n\
         [[wall]]\nname = \"box\"\nbox = [0, 0, 0, 0.04, 0.04, 1]\nfaces = [\"x-\", \"x+\", \"y-\", \"y+\", \"z-\"]\nmaterial = \"m\"\n\
         [[wall]]\nname = \"lid\"\nplane = [0, 0, 0.04, 0, 0, -1]\nmaterial = \"m\"\nmotion = {{ translate = [0, 0, -0.02], until = 0.02 }}\n"
    );
    fs::write(folder.path().join("grains.csv"), rows).unwrap();
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    succeed(folder.path(), "dem-run", &["scene.toml", "-o", "run.mcap"]);
    folder
}

/// The lid moves by 0.4 of 40 mm; a floor and a lid of twice the stiffness of two grains take a share of it as overlap at both ends: 3/4 of
/// the 0.4 mm are between the centres of the outer grains, 30 mm apart.
#[test]
fn stress_and_strain_of_a_squeezed_lattice() {
    let bond = "[[bond]]\nbetween = [\"m\", \"m\"]\ngap = 1e-6\nkind = \"contact\"\nmodulus = 1e6\nstiffness_ratio = 2\ndamping = 0.2\n";
    for bonds in ["", bond] {
        let folder = squeezed(bonds);
        let stress = measure(&folder, &["--stress", "box:0,0,0,0.04,0.04,0.0396"]);
        let lid = measure(&folder, &["--wall-force", "all", "--wall", "lid"]);
        let last = |done: &Done, name: &str| *column(done, name).last().expect("a frame");
        let (along, pushed) = (last(&stress, "zz"), last(&lid, "fz") / (0.04 * 0.04));
        assert!(pushed > 100.0 && (along / pushed - 1.0).abs() < 1e-3, "{along} Pa, {pushed} Pa on the lid");
        assert!(last(&stress, "xx").abs() < 1e-6 * along && last(&stress, "xz").abs() < 1e-6 * along);
        assert!(
            (last(&stress, "q") / along - 1.0).abs() < 1e-6
                && (3.0 * last(&stress, "p") / along - 1.0).abs() < 1e-6
        );
        // A layer in the middle bears the same.
        let middle = measure(&folder, &["--stress", "box:0,0,0.01,0.04,0.04,0.03"]);
        assert!((last(&middle, "zz") / along - 1.0).abs() < 0.05, "{} Pa", last(&middle, "zz"));
        let strain = measure(&folder, &["--strain"]);
        let squeezed = last(&strain, "zz");
        assert!((squeezed / 0.01 - 1.0).abs() < 0.01, "{squeezed}");
        assert!(
            last(&strain, "xx").abs() < 1e-9
                && last(&strain, "rest") < 1e-6
                && last(&strain, "grains") == 64.0
        );
        assert_eq!(column(&strain, "zz")[0], 0.0);
        let lower = measure(&folder, &["--strain", "--within", "box:0,0,0,0.04,0.04,0.02"]);
        assert_eq!(last(&lower, "grains"), 32.0);
    }
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let folder = squeezed("");
    for (arguments, wanted) in [
        (&["--stress", "all"][..], "only in a domain that is periodic along x, y and z"),
        (&["--strain", "--within", "sphere:0,0,0,0.006"], "a mean strain"),
        (&["--strain", "--time", "0.02"], "measured over time"),
    ] {
        let message = failed(&folder, arguments);
        assert!(message.contains(wanted), "{wanted}: {message}");
    }
}
