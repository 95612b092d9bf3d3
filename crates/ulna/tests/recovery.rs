//! Every kind of artefact leads back to the arm that took its readings: exactly without noise, and as far off with noise as
//! the stated uncertainties say.

mod common;

use common::{cheng_2011, rng};
use nalgebra::{Point3, Rotation3, Vector3};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use ulna::arm::{Arm, Unit};
use ulna::artefacts::{KINDS, Noise, Rows, Size, Stated};
use ulna::fit::calibrate::{Options, fit};
use ulna::fit::monte_carlo::{Repeat, recalibrate};
use ulna::kinematics::inverse::{Limits, posture_for_point};
use ulna::kinematics::{Angles, Conditions, frames, tip_mm};
use ulna::monitor::Unwatched;
use ulna::problem::Problem;

/// Adds exact readings of an artefact to a problem, taken by an arm.
type Taking = fn(&mut Problem, &Arm, &mut Xoshiro256PlusPlus);

/// A kind, what is said of it, and how it is read.
const TAKEN: &[(&str, &str, Taking)] = &[
    ("length", "pairs of poses", lengths),
    ("points", "a plate", plate),
    ("sphere", "a ball", |problem, truth, rng| surface(problem, truth, rng, ("sphere", 50.0), &round)),
    ("cylinder", "a shaft", |problem, truth, rng| surface(problem, truth, rng, ("cylinder", 60.0), &shaft)),
    ("distance", "a draw wire", wire),
    // orientations know no length: beside readings that do
    ("orientation", "a target that is mounted anyhow, and pairs of poses", target),
    ("plane", "a flat", |problem, truth, rng| surface(problem, truth, rng, ("plane", 0.0), &flat)),
];

const BALL_MM: f64 = 6.0;

/// With a probe well off the last axis.
fn truth() -> Arm {
    cheng_2011(&[("bent", [40.0, 0.0, 200.0])])
}

/// `joint.3.d`, by which all others are measured where no reading knows a length.
const LINK: usize = 11;

/// What is fitted: all, but one length where the readings know none.
fn free_of(problem: &Problem) -> Vec<usize> {
    (0..problem.parameter_count()).filter(|&j| j != LINK || !problem.scale_free()).collect()
}

/// The same arm, nearly; its base, which nothing fixes, is where it was, and so is that one link.
fn nearly(truth: &Arm, rng: &mut Xoshiro256PlusPlus) -> Arm {
    let mut parameters = truth.parameters();
    for (j, unit) in truth.parameter_units().into_iter().enumerate().filter(|(j, _)| ![0, 3, LINK].contains(j)) {
        parameters[j] += if unit == Unit::Rad { 0.005 } else { 0.5 } * rng.random_range(-1.0..1.0);
    }
    truth.with_parameters(&parameters).unwrap()
}

fn anywhere(rng: &mut Xoshiro256PlusPlus) -> Vec<f64> {
    (0..7).map(|_| rng.random_range(-2.5..2.5)).collect()
}

fn direction(rng: &mut Xoshiro256PlusPlus) -> Vector3<f64> {
    Vector3::from_fn(|_, _| StandardNormal.sample(rng)).normalize()
}

/// Postures that touch all of some points about a place within reach, wherever that is.
fn touch(truth: &Arm, points: &[Vector3<f64>], rng: &mut Xoshiro256PlusPlus) -> Vec<f64> {
    let limits = Limits { range_rad: vec![(-3.0, 3.0); 7] };
    loop {
        let place: Point3<f64> = tip_mm(truth, 0, &anywhere(rng));
        let postures: Option<Vec<Vec<f64>>> = points
            .iter()
            .map(|at| posture_for_point(truth, 0, (place + at, Conditions::default()), &limits, 20, rng))
            .collect();
        if let Some(postures) = postures {
            return postures.into_iter().flatten().collect();
        }
    }
}

fn lengths(problem: &mut Problem, truth: &Arm, rng: &mut Xoshiro256PlusPlus) {
    let (mut q_rad, mut p_rad, mut lengths_mm) = (vec![], vec![], vec![]);
    for _ in 0..150 {
        let (q, p) = (anywhere(rng), anywhere(rng));
        lengths_mm.push((tip_mm(truth, 0, &q) - tip_mm(truth, 0, &p)).norm());
        q_rad.extend(q);
        p_rad.extend(p);
    }
    let poses = Angles::cold(&q_rad);
    let rows = Rows {
        poses,
        probe: &[0; 150],
        second: Some(Angles::cold(&p_rad)),
        measured_mm: Some(&lengths_mm),
        ..Rows::default()
    };
    problem.add("length", &Stated { name: "pairs", ..Stated::default() }, &rows).unwrap();
}

fn plate(problem: &mut Problem, truth: &Arm, rng: &mut Xoshiro256PlusPlus) {
    let features_mm = [[0.0, 0.0, 0.0], [120.0, 0.0, 0.0], [0.0, 150.0, 0.0], [130.0, 90.0, 20.0], [60.0, 60.0, -40.0]];
    let mut q_rad = vec![];
    for _ in 0..20 {
        let turn = Rotation3::new(direction(rng) * 2.0);
        q_rad.extend(touch(truth, &features_mm.map(|at| turn * Vector3::from(at)), rng));
    }
    let rows = Rows {
        poses: Angles::cold(&q_rad),
        probe: &[0; 100],
        feature: Some(&(0..100).map(|row| row % 5).collect::<Vec<_>>()),
        placement: Some(&(0..100).map(|row| row / 5).collect::<Vec<_>>()),
        ..Rows::default()
    };
    problem
        .add("points", &Stated { name: "plate", features_mm: Some(&features_mm), ..Stated::default() }, &rows)
        .unwrap();
}

/// Distances from eight places, of a wire whose dead length is not known.
fn wire(problem: &mut Problem, truth: &Arm, rng: &mut Xoshiro256PlusPlus) {
    const OFFSET_MM: f64 = 12.5;
    let feet: Vec<Point3<f64>> = (0..8).map(|_| tip_mm(truth, 0, &anywhere(rng))).collect();
    let (mut q_rad, mut measured_mm, mut placement) = (vec![], vec![], vec![]);
    for row in 0..200 {
        let q = anywhere(rng);
        measured_mm.push((tip_mm(truth, 0, &q) - feet[row % 8]).norm() - OFFSET_MM);
        placement.push((row % 8) as i64);
        q_rad.extend(q);
    }
    let rows = Rows {
        poses: Angles::cold(&q_rad),
        probe: &[0; 200],
        placement: Some(&placement),
        measured_mm: Some(&measured_mm),
        ..Rows::default()
    };
    let dimensions = &[Size { name: "offset", value: OFFSET_MM, u: 0.0, fitted: true }];
    problem.add("distance", &Stated { name: "wire", dimensions, ..Stated::default() }, &rows).unwrap();
}

/// A target on the last link as an instrument sees it from two places, and lengths.
fn target(problem: &mut Problem, truth: &Arm, rng: &mut Xoshiro256PlusPlus) {
    lengths(problem, truth, rng);
    let mount = Rotation3::new(Vector3::new(0.4, -1.1, 0.7));
    let stands = [Rotation3::new(direction(rng) * 2.0), Rotation3::new(direction(rng))];
    let (mut q_rad, mut rotation_rad, mut placement) = (vec![], vec![], vec![]);
    for row in 0..80 {
        let q = anywhere(rng);
        let link = frames(truth, &q).last().unwrap().rotation.to_rotation_matrix();
        rotation_rad.push((stands[row % 2] * link * mount).scaled_axis().into());
        placement.push((row % 2) as i64);
        q_rad.extend(q);
    }
    let rows = Rows {
        poses: Angles::cold(&q_rad),
        probe: &[0; 80],
        placement: Some(&placement),
        rotation_rad: Some(&rotation_rad),
        rotation_u_rad: Some(&[2e-5; 80]),
        ..Rows::default()
    };
    let near = mount.scaled_axis();
    let size = |name, value, fitted| Size { name, value, u: 0.0, fitted };
    let dimensions =
        &[size("rx", near.x, true), size("ry", near.y, true), size("rz", near.z, true), size("lever", 1000.0, false)];
    problem.add("orientation", &Stated { name: "target", dimensions, ..Stated::default() }, &rows).unwrap();
}

/// Places of a ball's centre that touches the surface in one standing, about a point of it.
type Standing = dyn Fn(f64, &mut Xoshiro256PlusPlus) -> Vec<Vector3<f64>>;

fn round(diameter_mm: f64, rng: &mut Xoshiro256PlusPlus) -> Vec<Vector3<f64>> {
    (0..20).map(|_| direction(rng) * (0.5 * (diameter_mm + BALL_MM))).collect()
}

fn shaft(diameter_mm: f64, rng: &mut Xoshiro256PlusPlus) -> Vec<Vector3<f64>> {
    let turn = Rotation3::new(direction(rng) * 2.0);
    let around = |rng: &mut Xoshiro256PlusPlus| {
        let (sin, cos) = rng.random_range(-std::f64::consts::PI..std::f64::consts::PI).sin_cos();
        Vector3::new(cos, sin, 0.0) * (0.5 * (diameter_mm + BALL_MM)) + Vector3::z() * rng.random_range(-100.0..100.0)
    };
    (0..20).map(|_| turn * around(rng)).collect()
}

fn flat(_: f64, rng: &mut Xoshiro256PlusPlus) -> Vec<Vector3<f64>> {
    let turn = Rotation3::new(direction(rng) * 2.0);
    (0..20)
        .map(|_| turn * Vector3::new(rng.random_range(-150.0..150.0), rng.random_range(-150.0..150.0), 0.0))
        .collect()
}

/// Touches of something with a diameter (none: 0) in 20 places.
fn surface(
    problem: &mut Problem,
    truth: &Arm,
    rng: &mut Xoshiro256PlusPlus,
    (kind, diameter_mm): (&str, f64),
    standing: &Standing,
) {
    let (mut q_rad, mut placement) = (vec![], vec![]);
    for place in 0..20 {
        let points = standing(diameter_mm, rng);
        q_rad.extend(touch(truth, &points, rng));
        placement.extend(points.iter().map(|_| place));
    }
    let diameter = [Size { name: "diameter", value: diameter_mm, u: 0.0, fitted: false }];
    let dimensions = if diameter_mm > 0.0 { &diameter[..] } else { &[] };
    let stated = Stated { name: kind, dimensions, balls_mm: Some(&[BALL_MM]), ..Stated::default() };
    let probe = vec![0; placement.len()];
    let rows = Rows { poses: Angles::cold(&q_rad), probe: &probe, placement: Some(&placement), ..Rows::default() };
    problem.add(kind, &stated, &rows).unwrap();
}

#[test]
fn every_kind_is_taken() {
    for kind in KINDS {
        let there = TAKEN.iter().any(|(name, _, _)| *name == kind.name);
        assert!(
            there,
            "kind {:?} is not taken by any arm in tests/recovery.rs: nothing shows that it leads to one",
            kind.name
        );
    }
}

#[test]
fn exact_readings_lead_back_to_the_arm() {
    for (kind, label, take) in TAKEN {
        let (truth, mut rng) = (truth(), rng(8));
        let mut problem = Problem::new(nearly(&truth, &mut rng), None).unwrap();
        take(&mut problem, &truth, &mut rng);
        let free = free_of(&problem);
        let fitted = fit(&mut problem, &free, &Options::default(), &Unwatched).unwrap();
        let off =
            fitted.arm.parameters().iter().zip(truth.parameters()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-7, "{kind}, {label}: {off:e}, rms {:e} mm", fitted.rms_mm);
        assert_eq!(fitted.identifiability.determined, free.len() - 2, "{kind}, {label}");
    }
}

#[test]
fn noise_leads_as_far_off_as_is_stated() {
    let noise = Noise { encoder_rad: vec![1e-5; 7], seat_mm: 0.01 };
    for (kind, label, take) in TAKEN {
        let (truth, mut rng) = (truth(), rng(9));
        let mut problem = Problem::new(truth.clone(), Some(noise.clone())).unwrap();
        take(&mut problem, &truth, &mut rng);
        let free = free_of(&problem);
        let repeat = Repeat { truth: &truth, first: 0, runs: 100, seed: 4, threads: 2, uncertainties: true };
        let (mut squares, mut count) = (0.0, 0.0);
        for run in recalibrate(&problem, &free, &repeat, &Unwatched).unwrap() {
            assert!(run.converged, "{kind}, {label}");
            for ((found, true_value), u) in run.parameters.iter().zip(truth.parameters()).zip(&run.u) {
                if u.is_finite() {
                    squares += ((found - true_value) / u).powi(2);
                    count += 1.0;
                }
            }
        }
        let ratio = squares / count;
        assert!((0.85..1.15).contains(&ratio), "{kind}, {label}: {ratio} of {count}");
    }
}
