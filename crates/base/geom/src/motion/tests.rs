use super::*;

fn drum() -> Motion {
    Motion {
        velocity: Vec3::new(0.0, 0.0, 1.0),
        turn: Vec3::new(0.0, 0.0, 0.5 * PI),
        through: Vec3::new(1.0, 0.0, 0.0),
        amplitude: Vec3::new(0.0, 0.0, 0.25),
        frequency: 0.25,
        ..Motion::default()
    }
}

#[test]
fn a_quarter_turn_a_shift_and_the_crest_of_a_vibration() {
    let place = drum().pose(1.0).position(&Vec3::new(2.0, 0.0, 0.0));
    assert!((place - Vec3::new(1.0, 1.0, 1.25)).norm() < 1e-12, "{place}");
}

#[test]
fn home_is_the_inverse_of_place() {
    let (pose, home) = (drum().pose(0.37), Vec3::new(0.3, -0.7, 2.0));
    assert!((pose.home(&pose.position(&home)) - home).norm() < 1e-12);
    assert!(drum().moves() && !Motion::default().moves());
}

/// Every kind of motion, one after the other and at the same time.
fn all() -> Motion {
    let row = |time, x, angle| PathRow { time, shift: Vec3::new(x, 0.0, -0.5 * x), angle };
    let path = Path::new(Vec3::y(), vec![row(0.1, 3.0, 1.0), row(0.5, 3.4, 1.2), row(0.8, 3.1, 0.7)]);
    let swing = Vec3::new(0.1, 0.2, 0.0);
    Motion::of(vec![
        Motion { ramp: 0.2, from: 0.1, until: 1.5, ..drum() },
        Motion { swing, swing_frequency: 0.7, through: Vec3::y(), from: 0.3, ..Motion::default() },
        Motion { path: Some(path.unwrap()), through: Vec3::x(), from: 0.05, ..Motion::default() },
        Motion { velocity: Vec3::new(0.5, 0.0, 0.0), from: 2.0, until: 2.4, ramp: 0.1, ..Motion::default() },
        Motion { turn: Vec3::new(0.3, 0.0, 1.0), from: 0.4, until: 2.2, ..Motion::default() },
    ])
}

#[test]
fn the_velocity_is_the_derivative_of_the_position() {
    let (motion, h) = (all(), 1e-6);
    for home in [Vec3::new(2.0, 0.3, -0.4), Vec3::zeros()] {
        // Not at the corners of a path, nor where a motion without a ramp starts or ends.
        for time in [0.02, 0.07, 0.17, 0.2, 0.33, 0.47, 0.61, 0.9, 1.25, 1.45, 1.7, 2.05, 2.35, 2.7] {
            let at = |t: f64| motion.pose(t).position(&home);
            let slope = (at(time + h) - at(time - h)) / (2.0 * h);
            let velocity = motion.pose(time).velocity(&at(time));
            assert!((slope - velocity).norm() < 1e-7 * (1.0 + slope.norm()), "{time}: {slope} {velocity}");
        }
    }
}

#[test]
fn positions_do_not_jump_and_speeds_keep_below_the_bound() {
    let (motion, home, dt) = (all(), Vec3::new(2.0, 0.3, -0.4), 1e-3);
    let bound = motion.fastest(|axis| (home - axis).norm());
    assert!(bound.is_finite());
    for k in 0..3000 {
        let at = |k: i32| motion.pose(dt * f64::from(k)).position(&home);
        let step = (at(k + 1) - at(k)).norm();
        assert!(step <= bound * dt * 1.000_001, "step {k}: {step} m, bound {bound} m/s");
        let speed = motion.pose(dt * f64::from(k)).velocity(&at(k)).norm();
        assert!(speed <= bound * 1.000_001, "step {k}: {speed} m/s, bound {bound} m/s");
    }
}

#[test]
fn a_gate_opens_and_closes_to_where_it_was() {
    let part = |v: f64, from: f64| {
        let velocity = Vec3::new(v, 0.0, 0.0);
        Motion { velocity, from, until: from + 0.4, ramp: 0.05, ..Motion::default() }
    };
    let gate = Motion::of(vec![part(0.5, 2.0), part(-0.5, 5.0)]);
    let x = |t: f64| gate.pose(t).position(&Vec3::zeros()).x;
    assert!(x(1.0) == 0.0 && x(6.0).abs() < 1e-15, "{}", x(6.0));
    assert!((x(3.0) - 0.5 * 0.35).abs() < 1e-12, "{}", x(3.0));
    assert!(gate.runs(2.2) && !gate.runs(3.0) && gate.runs(5.1) && !gate.runs(5.4));
}

#[test]
fn an_axis_is_carried_by_the_motions_that_follow() {
    let spin = Motion { turn: Vec3::new(0.0, 0.0, PI), through: Vec3::x(), ..Motion::default() };
    let orbit = Motion { turn: Vec3::new(0.0, 0.0, 0.5 * PI), ..Motion::default() };
    let both = Motion::of(vec![spin, orbit]).pose(1.0);
    assert!((both.position(&Vec3::x()) - Vec3::y()).norm() < 1e-12, "the axis is a quarter turn on");
    assert!((both.position(&Vec3::new(1.1, 0.0, 0.0)) - Vec3::new(0.0, 0.9, 0.0)).norm() < 1e-12);
}

#[test]
fn the_surface_of_a_wall_at_rest_moves_with_the_wall_s_orientation() {
    let turned = Motion { turn: Vec3::new(0.0, 0.0, 0.5 * PI), until: 1.0, ..Motion::default() };
    let along = SurfaceMotion { velocity: Vec3::x(), ..SurfaceMotion::still() };
    let velocity = turned.pose(2.0).surface(&along).velocity(&Vec3::new(5.0, 6.0, 7.0));
    assert!((velocity - Vec3::y()).norm() < 1e-12, "{velocity}");
    let table = SurfaceMotion { turn: Vec3::z(), through: Vec3::x(), ..SurfaceMotion::still() };
    let velocity = Motion::still().pose(0.0).surface(&table).velocity(&Vec3::new(1.0, 2.0, 0.0));
    assert!((velocity - Vec3::new(-2.0, 0.0, 0.0)).norm() < 1e-12, "{velocity}");
}

#[test]
fn a_table_that_goes_to_and_fro_is_a_vibration() {
    let path = |rows: usize, shift: &dyn Fn(f64) -> Vec3, angle: &dyn Fn(f64) -> f64| {
        let row = |k: usize| {
            let time = k as f64 * 1e-3;
            PathRow { time, shift: shift(time), angle: angle(time) }
        };
        let path = Path::new(Vec3::z(), (0..rows).map(row).collect()).unwrap();
        Motion { path: Some(path), ..Motion::default() }.vibration()
    };
    let still = |_| 0.0;
    // 10 Hz in 100 rows a period, also about an axis, and on a circle.
    let wave = |t: f64| (20.0 * PI * t).sin();
    let near = |found: f64| (found - 10.0).abs() < 0.3;
    assert!(near(path(300, &|t| Vec3::x() * wave(t), &still)));
    assert!(near(path(300, &|t| Vec3::new(wave(t), wave(t + 0.025), 1e-12 * wave(80.0 * t)), &still)));
    assert!(near(path(300, &|_| Vec3::zeros(), &wave)));
    // There and back is none.
    assert_eq!(path(90, &|t| Vec3::x() * wave(t / 2.0), &still), 0.0);
    assert_eq!(path(90, &|t| Vec3::x() * t, &still), 0.0);
}

/// A motion whose points and directions are turned by `turn` and shifted by `by` [m].
fn seen(motion: &Motion, turn: &nalgebra::Rotation3<f64>, by: &Vec3) -> Motion {
    let one = |m: &Motion| {
        let table = |path: &Path| {
            let rows = path.rows().iter().map(|r| PathRow { shift: turn * r.shift, ..*r }).collect();
            Path::new(turn * path.axis(), rows).unwrap()
        };
        let [velocity, amplitude] = [m.velocity, m.amplitude].map(|v| turn * v);
        let [spin, swing] = [m.turn, m.swing].map(|v| turn * v);
        let (through, path) = (turn * m.through + by, m.path.as_ref().map(table));
        Motion { velocity, amplitude, turn: spin, swing, through, path, then: Vec::new(), ..m.clone() }
    };
    Motion::of(motion.parts().map(one).collect())
}

/// The shift of any list of motions is the way of a point of the wall: it turns with the frame of coordinates, and does not depend on its origin.
#[test]
fn the_shift_does_not_depend_on_the_origin() {
    let moves = Motion { velocity: Vec3::new(0.1, -0.3, 0.2), until: 0.4, ..Motion::default() };
    let shakes = Motion { amplitude: Vec3::new(0.0, 0.02, 0.0), frequency: 3.0, ..Motion::default() };
    let parts: Vec<Motion> =
        all().parts().cloned().map(|m| Motion { then: Vec::new(), ..m }).chain([moves, shakes]).collect();
    let count = parts.len();
    let mut next = 1u64;
    let mut random = |below: usize| {
        next = next.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (next >> 33) as usize % below
    };
    for _ in 0..200 {
        let list = (0..=random(4)).map(|_| parts[random(count)].clone()).collect();
        let motion = Motion::of(list);
        let turn = nalgebra::Rotation3::new(Vec3::from([0, 1, 2].map(|_| random(600) as f64 * 0.01)));
        let by = Vec3::from([0, 1, 2].map(|_| random(2000) as f64 * 0.01 - 10.0));
        let (other, time) = (seen(&motion, &turn, &by), random(300) as f64 * 0.01);
        let (here, there) = (motion.pose(time), other.pose(time));
        let off = (turn * here.shift() - there.shift()).norm();
        assert!(off < 1e-11, "{off} m: {motion:?} at {time} s");
        let point = motion.reference();
        assert!((here.position(&point) - point - here.shift()).norm() < 1e-12);
        let place = turn * here.position(&Vec3::x()) + by;
        assert!((place - there.position(&(turn * Vec3::x() + by))).norm() < 1e-11, "the same motion");
    }
}

/// A motion that repeats is the list of its times written out, for every kind of motion.
#[test]
fn a_motion_that_repeats_is_that_of_its_times_written_out() {
    let row = |time, x, angle| PathRow { time, shift: Vec3::new(x, 0.0, 0.0), angle };
    let path = Path::new(Vec3::z(), vec![row(0.0, 0.0, 0.0), row(0.2, 0.3, 0.5), row(0.5, 0.0, 0.2)]).ok();
    let window = Motion { from: 0.3, until: 0.9, ..Motion::default() };
    let kinds = [
        Motion { velocity: Vec3::new(0.4, 0.0, -1.0), ramp: 0.1, ..window.clone() },
        Motion { turn: Vec3::new(0.0, 0.0, 2.0), through: Vec3::x(), ramp: 0.3, ..window.clone() },
        Motion { path, through: Vec3::x(), ..window },
    ];
    let home = Vec3::new(0.3, 0.7, -0.2);
    for kind in kinds {
        for period in [0.6, 1.0, 1.7] {
            let times = |k: u32| Motion {
                from: kind.from + period * f64::from(k),
                until: kind.until + period * f64::from(k),
                ..kind.clone()
            };
            let (list, again) = (Motion::of((0..5).map(times).collect()), Motion { period, ..kind.clone() });
            for k in 0..300u32 {
                // Times on which nothing starts or ends.
                let time = 0.0171 * f64::from(k);
                if time > 0.3 + 5.0 * period {
                    break;
                }
                let (a, b) = (list.pose(time), again.pose(time));
                let (at, other) = (a.position(&home), b.position(&home));
                assert!((at - other).norm() < 1e-13, "{time}: {at} {other}");
                assert!((a.velocity(&at) - b.velocity(&other)).norm() < 1e-11, "{time}");
                assert_eq!(list.runs(time), again.runs(time), "{time}");
            }
        }
    }
}

/// Numbers from 0 to 1 in a fixed order (Marsaglia 2003, doi:10.18637/jss.v008.i14).
fn random(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// A part of any kind at any time, a third of them again and again.
fn any_part(state: &mut u64) -> Motion {
    let mut number = |low: f64, high: f64| low + (high - low) * random(state);
    let vector = |number: &mut dyn FnMut(f64, f64) -> f64| {
        Vec3::new(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0))
    };
    let (kind, from, axis, point) =
        (number(0.0, 5.0), number(0.0, 2.0), vector(&mut number), vector(&mut number));
    let window = Motion { from, until: from + number(0.1, 0.5), through: point, ..Motion::default() };
    let period = if number(0.0, 3.0) < 1.0 { 0.5 + number(0.0, 2.0).floor() } else { f64::INFINITY };
    let (window, ramp) = (Motion { period, ..window }, number(0.0, 0.05));
    let row = |time, x: f64, angle| PathRow { time, shift: axis * x, angle };
    match kind as u32 {
        0 => Motion { velocity: axis, ramp, ..window },
        1 => Motion { turn: axis, ramp, ..window },
        2 => Motion { amplitude: axis * 0.1, frequency: number(1.0, 5.0), period: f64::INFINITY, ..window },
        3 => Motion { swing: axis, swing_frequency: number(1.0, 5.0), period: f64::INFINITY, ..window },
        _ => {
            let rows = vec![row(0.0, 0.0, 0.0), row(0.1, 0.3, 0.4), row(0.3, number(-1.0, 1.0).round(), 0.0)];
            Motion { path: Path::new(point, rows).ok(), ..window }
        }
    }
}

#[test]
fn no_point_of_any_list_is_faster_than_its_bound() {
    let (mut state, mut finite) = (20_040_713, 0);
    for _ in 0..400 {
        let count = 1 + (6.0 * random(&mut state)) as usize;
        let motion = Motion::of((0..count).map(|_| any_part(&mut state)).collect());
        let home = Vec3::new(random(&mut state), random(&mut state), random(&mut state));
        let bound = motion.fastest(|axis| (home - axis).norm());
        finite += usize::from(bound.is_finite());
        for k in 0..1000 {
            let pose = motion.pose(5e-3 * f64::from(k));
            let speed = pose.velocity(&pose.position(&home)).norm();
            assert!(speed <= bound * (1.0 + 1e-12), "{motion:?} at step {k}: {speed} m/s, bound {bound} m/s");
        }
    }
    assert!(finite > 200, "{finite}");
}

#[test]
fn turns_one_after_the_other_about_one_axis_are_as_fast_as_one_of_them() {
    let turn = |k: i32, period: f64, until: f64| {
        let from = until * f64::from(k);
        let rate = if k % 2 == 0 { 2.0 } else { -2.0 };
        Motion {
            turn: Vec3::new(0.0, rate, 0.0),
            through: Vec3::x(),
            from,
            until: from + until,
            period,
            ..Motion::default()
        }
    };
    let span = |point: &Vec3| (Vec3::new(4.0, 0.0, 0.0) - point).norm();
    let list = |period: f64, count: i32| Motion::of((0..count).map(|k| turn(k, period, 0.1)).collect());
    assert_eq!(list(f64::INFINITY, 1).fastest(span), 6.0);
    assert_eq!(list(f64::INFINITY, 40).fastest(span), 6.0);
    assert_eq!(list(4.5, 40).fastest(span), 6.0, "within the period");
    assert_eq!(list(1.05, 11).fastest(span), 12.0, "the last runs on into the next period");
}
