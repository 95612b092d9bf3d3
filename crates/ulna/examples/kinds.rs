//! What a reading costs by the artefact it touches, and by what the arm does beyond its geometry; JSON for `make bench`.
//!
//! Nanoseconds of a touch, one thread: residuals and derivatives of all 27 parameters, the placement eliminated, as in
//! every iteration of a fit. The arm and the timing are those of `bench`. A bar has its two ends touched in each place;
//! a plate nine balls; a seat and every surface are touched 20 times each. Effects are timed on the bars.

mod shared;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use shared::{Dropped, TABLE_2, arm, best};
use std::f64::consts::PI;
use ulna::arm::{Arm, Backlash, Body, Compliance, Effects, Expansion, Harmonics};
use ulna::artefacts::{Rows, Size, Stated, Weighing};
use ulna::kinematics::inverse::{Limits, posture_for_point};
use ulna::kinematics::{Angles, Conditions, tip_mm};
use ulna::monitor::Unwatched;
use ulna::problem::Problem;
use ulna::problem::assembly::Assembly;
use ulna::solver::LeastSquares;

const TIP_MM: [f64; 3] = [10.0, 0.0, 200.0];
const BALL_MM: f64 = 6.0;
const SPHERE_MM: f64 = 25.0;
const TOUCHES: usize = 18_000;

type Point = [f64; 3];

/// Touched points of one standing about a place, each with the feature it is of.
type Standing = fn(&mut Xoshiro256PlusPlus) -> Vec<(Point, usize)>;

fn direction(rng: &mut Xoshiro256PlusPlus) -> Point {
    loop {
        let v: Point = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        if norm > 0.1 && norm < 1.0 {
            return v.map(|x| x / norm);
        }
    }
}

/// Ends of a bar of 300 mm.
fn bar(rng: &mut Xoshiro256PlusPlus) -> Vec<(Point, usize)> {
    let along = direction(rng);
    vec![([0.0; 3], 0), (along.map(|x| 300.0 * x), 1)]
}

/// Nine balls, 100 mm apart, level: what a touch costs does not depend on how the plate stands.
fn plate(_: &mut Xoshiro256PlusPlus) -> Vec<(Point, usize)> {
    plate_mm().into_iter().enumerate().map(|(k, at)| (at, k)).collect()
}

fn plate_mm() -> Vec<Point> {
    (0..9).map(|k| [100.0 * f64::from(k / 3), 100.0 * f64::from(k % 3), 0.0]).collect()
}

fn seat(_: &mut Xoshiro256PlusPlus) -> Vec<(Point, usize)> {
    vec![([0.0; 3], 0); 20]
}

fn sphere(rng: &mut Xoshiro256PlusPlus) -> Vec<(Point, usize)> {
    (0..20).map(|_| (direction(rng).map(|x| 0.5 * (SPHERE_MM + BALL_MM) * x), 0)).collect()
}

fn cylinder(rng: &mut Xoshiro256PlusPlus) -> Vec<(Point, usize)> {
    let around = |rng: &mut Xoshiro256PlusPlus| {
        let (sin, cos) = rng.random_range(-PI..PI).sin_cos();
        let apart = 0.5 * (SPHERE_MM + BALL_MM);
        ([apart * cos, apart * sin, rng.random_range(-100.0..100.0)], 0)
    };
    (0..20).map(|_| around(rng)).collect()
}

fn plane(rng: &mut Xoshiro256PlusPlus) -> Vec<(Point, usize)> {
    (0..20).map(|_| ([rng.random_range(-150.0..150.0), rng.random_range(-150.0..150.0), 0.0], 0)).collect()
}

/// Tips about the fixed point that an instrument measures from.
fn distance(rng: &mut Xoshiro256PlusPlus) -> Vec<(Point, usize)> {
    (0..20).map(|_| (direction(rng).map(|x| rng.random_range(50.0..250.0) * x), 0)).collect()
}

/// Readings of standings all over the volume, as many as make `TOUCHES`.
struct Touched {
    q_rad: Vec<f64>,
    feature: Vec<usize>,
    placement: Vec<i64>,
    /// from the place's origin
    measured_mm: Vec<f64>,
}

fn touch(truth: &Arm, standing: Standing, rng: &mut Xoshiro256PlusPlus) -> Touched {
    let limits = Limits { range_rad: vec![(-PI, PI); 7] };
    let mut touched = Touched { q_rad: vec![], feature: vec![], placement: vec![], measured_mm: vec![] };
    let mut place = 0;
    while touched.feature.len() < TOUCHES {
        let q: Vec<f64> = (0..7).map(|_| rng.random_range(-3.0..3.0)).collect();
        let origin = tip_mm(truth, 0, &q);
        let points = standing(rng);
        let poses: Option<Vec<Vec<f64>>> = points
            .iter()
            .map(|(at, _)| {
                let point = origin + Vector3::from(*at);
                posture_for_point(truth, 0, (point, Conditions::default()), &limits, 10, rng)
            })
            .collect();
        let Some(poses) = poses else { continue };
        touched.q_rad.extend(poses.into_iter().flatten());
        touched.feature.extend(points.iter().map(|(_, feature)| feature));
        touched.measured_mm.extend(points.iter().map(|(at, _)| Vector3::from(*at).norm()));
        touched.placement.extend(std::iter::repeat_n(place, points.len()));
        place += 1;
    }
    touched
}

/// Nanoseconds a touch.
fn cost(problem: &mut Problem, touches: usize) -> f64 {
    let x = problem.parameters();
    let free: Vec<usize> = (0..problem.parameter_count()).collect();
    problem.weigh(&x, Weighing::Full);
    let mut assembly = Assembly::new(problem, &free, &[], &Unwatched);
    let seconds = best(60, || assembly.rows(&x, true, &mut Dropped).expect("rows"));
    seconds * 1e9 / touches as f64
}

fn of(arm: &Arm, touched: &Touched, kind: &str, stated: &Stated) -> Problem {
    let mut problem = Problem::new(arm.clone(), None).expect("a valid problem");
    let rows = Rows {
        poses: Angles::cold(&touched.q_rad),
        probe: &vec![0; touched.feature.len()],
        feature: stated.features_mm.map(|_| &touched.feature[..]),
        placement: Some(&touched.placement),
        measured_mm: (kind == "distance").then_some(&touched.measured_mm),
        ..Rows::default()
    };
    problem.add(kind, stated, &rows).expect("valid rows");
    problem
}

fn points(features_mm: &[Point]) -> Stated<'_> {
    Stated { name: "artefact", features_mm: Some(features_mm), ..Stated::default() }
}

fn main() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2011);
    let truth = arm(TABLE_2, TIP_MM);
    let mut costs: Vec<(&str, f64)> = Vec::new();

    let bars = touch(&truth, bar, &mut rng);
    let ends = points(&[[0.0; 3], [300.0, 0.0, 0.0]]);
    costs.push(("bar", cost(&mut of(&truth, &bars, "points", &ends), bars.feature.len())));
    let (plate_mm, ball) = (plate_mm(), Stated { name: "ball", balls_mm: Some(&[BALL_MM]), ..Stated::default() });
    let diameter = [Size { name: "diameter", value: SPHERE_MM, u: 0.0, fitted: false }];
    let kinds: [(&str, Standing, &str, Stated); 6] = [
        ("plate", plate, "points", points(&plate_mm)),
        ("seat", seat, "points", points(&[[0.0; 3]])),
        ("sphere", sphere, "sphere", Stated { dimensions: &diameter, ..ball }),
        ("cylinder", cylinder, "cylinder", Stated { dimensions: &diameter, ..ball }),
        ("plane", plane, "plane", ball),
        ("distance", distance, "distance", Stated { name: "wire", ..Stated::default() }),
    ];
    for (name, standing, kind, stated) in kinds {
        let touched = touch(&truth, standing, &mut rng);
        costs.push((name, cost(&mut of(&truth, &touched, kind, &stated), touched.feature.len())));
    }

    let body = Body { mass_kg: 1.0, centre_mm: [0.0, 0.0, 50.0] };
    let compliance =
        Compliance { rad_per_nm: vec![1e-6; 7], bodies: vec![body; 7], gravity: [0.0, 0.0, -1.0], payload_kg: 0.0 };
    for (name, effects) in [
        ("harmonics 1", Effects { harmonics: Some(Harmonics::zero(&[1], 7)), ..Effects::default() }),
        ("harmonics 1, 2", Effects { harmonics: Some(Harmonics::zero(&[1, 2], 7)), ..Effects::default() }),
        ("backlash", Effects { backlash: Some(Backlash { rad: vec![1e-5; 7] }), ..Effects::default() }),
        ("expansion", Effects { expansion: Some(Expansion { per_kelvin: vec![1e-5; 7] }), ..Effects::default() }),
        ("compliance", Effects { compliance: Some(compliance), ..Effects::default() }),
    ] {
        let arm = truth.with_effects(effects).expect("valid effects");
        costs.push((name, cost(&mut of(&arm, &bars, "points", &ends), bars.feature.len())));
    }

    let list: Vec<String> = costs.iter().map(|(name, ns)| format!("\"{name}\": {ns:.2}")).collect();
    println!("{{{}}}", list.join(", "));
}
