//! Arms and readings that the tests share.
#![allow(dead_code, reason = "each test file uses its own part")]

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use ulna::arm::{Arm, Backlash, Body, Compliance, Effects, Expansion, Harmonics, Joint, JointModel, Probe};
use ulna::artefacts::length::LengthRows;
use ulna::artefacts::points::{Features, Frame, Uncertainty};
use ulna::artefacts::surface::Side;
use ulna::artefacts::{Noise, TouchRows};
use ulna::kinematics::{Angles, Conditions, tip_mm};
use ulna::problem::{BallArtefact, Problem};

pub fn rng(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

pub fn angles(rng: &mut Xoshiro256PlusPlus, count: usize) -> Vec<f64> {
    (0..count).map(|_| rng.random_range(-3.0..3.0)).collect()
}

/// An arm of `n` encoders with all kinds of joints, signs and two probes.
pub fn any_arm(rng: &mut Xoshiro256PlusPlus, n: usize) -> Arm {
    let joints = (0..n - 1).map(|i| any_joint(rng, i)).collect();
    let probes = any_probes(rng);
    Arm::new(joints, if n.is_multiple_of(2) { 1.0 } else { -1.0 }, probes).unwrap()
}

/// The same with a link after the last joint too.
pub fn any_full_arm(rng: &mut Xoshiro256PlusPlus, n: usize) -> Arm {
    let joints = (0..n).map(|i| any_joint(rng, i)).collect();
    let probes = any_probes(rng);
    Arm::with_full_last_link(joints, probes).unwrap()
}

/// What some arms do beyond their geometry, larger than any arm would.
pub fn any_effects(rng: &mut Xoshiro256PlusPlus, n: usize) -> Effects {
    let mut small = |size: f64| rng.random_range(-size..size);
    let mut harmonics = Harmonics::zero(&[1, 2, 5], n);
    harmonics.amplitudes_rad.iter_mut().flatten().for_each(|amplitude| *amplitude = small(0.02));
    let body = |small: &mut dyn FnMut(f64) -> f64| Body {
        mass_kg: 3.0 + small(2.0),
        centre_mm: [small(100.0), small(100.0), small(100.0)],
    };
    Effects {
        harmonics: Some(harmonics),
        backlash: Some(Backlash { rad: (0..n).map(|_| small(0.05)).collect() }),
        expansion: Some(Expansion { per_kelvin: (0..n).map(|_| small(1e-3)).collect() }),
        compliance: Some(Compliance {
            rad_per_nm: (0..n).map(|_| small(5e-3)).collect(),
            bodies: (0..n).map(|_| body(&mut small)).collect(),
            gravity: [small(1.0), small(1.0), -1.5],
        }),
    }
}

/// Temperatures above 20 °C, one for each joint of each pose.
pub fn warmth(rng: &mut Xoshiro256PlusPlus, count: usize) -> Vec<f64> {
    (0..count).map(|_| rng.random_range(-8.0..15.0)).collect()
}

/// From which side each joint of each pose was approached: any, unknown ones too.
pub fn approach(rng: &mut Xoshiro256PlusPlus, count: usize) -> Vec<f64> {
    (0..count).map(|_| f64::from(rng.random_range(-1..=1))).collect()
}

/// What was true at poses: of `joints` numbers each, warmth one or one for each joint.
pub struct Told {
    pub warmth_k: Vec<f64>,
    pub approach: Vec<f64>,
}

impl Told {
    pub fn any(rng: &mut Xoshiro256PlusPlus, poses: usize, warmths: usize, approaches: usize) -> Told {
        Told { warmth_k: warmth(rng, poses * warmths), approach: approach(rng, poses * approaches) }
    }

    pub fn at<'a>(&'a self, q_rad: &'a [f64]) -> Angles<'a> {
        Angles { q_rad, conditions: Conditions { warmth_k: &self.warmth_k, approach: &self.approach } }
    }
}

fn any_joint(rng: &mut Xoshiro256PlusPlus, i: usize) -> Joint {
    let hayati = i % 3 == 1;
    Joint {
        theta0_rad: rng.random_range(-3.0..3.0),
        alpha_rad: rng.random_range(-2.0..2.0),
        a_mm: rng.random_range(-300.0..300.0),
        d_mm: if hayati { 0.0 } else { rng.random_range(-300.0..300.0) },
        beta_rad: if hayati { rng.random_range(-0.5..0.5) } else { 0.0 },
        sign: if rng.random::<bool>() { 1.0 } else { -1.0 },
        model: if hayati { JointModel::Hayati } else { JointModel::Dh },
    }
}

fn any_probes(rng: &mut Xoshiro256PlusPlus) -> Vec<Probe> {
    let mut tip = || [rng.random_range(-50.0..50.0), rng.random_range(-50.0..50.0), rng.random_range(100.0..250.0)];
    ["straight", "bent"].map(|name| Probe { name: name.into(), tip_mm: tip() }).to_vec()
}

/// Every kind of readings, not consistent with anything: `label`, and a function that adds them to a problem.
pub type Kind = (&'static str, fn(&mut Problem, &mut Xoshiro256PlusPlus));

pub const KINDS: [Kind; 14] = [
    ("length", |p, r| lengths(p, r, 40)),
    ("bar touched once", |p, r| points(p, r, Frame::Free, &[[0.0; 3], [443.0, 0.0, 0.0]], 20, 1)),
    ("bar touched often", |p, r| points(p, r, Frame::Free, &[[0.0; 3], [443.0, 0.0, 0.0]], 3, 13)),
    ("seat", |p, r| points(p, r, Frame::Free, &[[0.0; 3]], 2, 45)),
    ("plate", |p, r| {
        let plate = [[0.0; 3], [100.0, 0.0, 0.0], [0.0, 150.0, 0.0], [80.0, 90.0, 5.0]];
        points(p, r, Frame::Free, &plate, 3, 4);
    }),
    ("coordinates", |p, r| {
        let grid = [[300.0, 0.0, 100.0], [0.0, 400.0, 200.0], [-300.0, 200.0, 0.0]];
        points(p, r, Frame::Arm, &grid, 1, 12);
    }),
    ("ball bar of many balls in line", |p, r| {
        let bar: Vec<[f64; 3]> = (0..8).map(|k| [60.0 * f64::from(k), 0.0, 0.0]).collect();
        points(p, r, Frame::Free, &bar, 3, 4);
    }),
    ("plate whose features may move", |p, r| {
        let plate = [[0.0; 3], [100.0, 0.0, 0.0], [0.0, 150.0, 0.0], [80.0, 90.0, 5.0]];
        let u = Uncertainty::Each(&[0.4, 0.0, 0.3, 0.2]);
        uncertain_points(p, r, Frame::Free, &plate, (u, true), 3, 4);
    }),
    ("bar whose length may change", |p, r| {
        let bar = [[0.0; 3], [443.0, 0.0, 0.0]];
        uncertain_points(p, r, Frame::Free, &bar, (Uncertainty::Length(0.5), true), 12, 2);
    }),
    ("ball", |p, r| ball(p, r, false, Side::Outside)),
    ("ball of unknown diameter", |p, r| ball(p, r, true, Side::Outside)),
    ("hollow sphere", |p, r| ball(p, r, false, Side::Inside)),
    ("flat", |p, r| flat(p, r, [6.0, 6.0])),
    ("flat touched with two balls", |p, r| flat(p, r, [6.0, 40.0])),
];

pub fn noises(encoders: usize) -> [(&'static str, Option<Noise>); 3] {
    let seat_only = Noise { encoder_rad: vec![], seat_mm: 0.02 };
    let both = Noise { encoder_rad: vec![2e-5; encoders], seat_mm: 0.01 };
    [("no noise stated", None), ("seat noise", Some(seat_only)), ("encoder and seat noise", Some(both))]
}

fn lengths(problem: &mut Problem, rng: &mut Xoshiro256PlusPlus, count: usize) {
    let n = problem.arm().encoders();
    let (q, p) = (angles(rng, n * count), angles(rng, n * count));
    let probe: Vec<usize> = (0..count).map(|i| i % 2).collect();
    let length_mm: Vec<f64> = (0..count).map(|_| rng.random_range(100.0..900.0)).collect();
    let (from, to) = (Told::any(rng, count, 1, n), Told::any(rng, count, 1, n));
    let rows = LengthRows { from: from.at(&q), to: to.at(&p), probe: &probe, length_mm: &length_mm };
    problem.add_lengths("pairs", rows, 0.0, false).unwrap();
}

fn points(
    problem: &mut Problem,
    rng: &mut Xoshiro256PlusPlus,
    frame: Frame,
    features: &[[f64; 3]],
    placements: usize,
    touches: usize,
) {
    uncertain_points(problem, rng, frame, features, (Uncertainty::None, false), placements, touches);
}

/// Tips come close to the features by correcting nothing: residuals of tens of millimetres, as at a start.
fn uncertain_points(
    problem: &mut Problem,
    rng: &mut Xoshiro256PlusPlus,
    frame: Frame,
    features: &[[f64; 3]],
    (u, fitted): (Uncertainty, bool),
    placements: usize,
    touches: usize,
) {
    let n = problem.arm().encoders();
    let count = placements * touches * features.len();
    let q = angles(rng, n * count);
    let told = Told::any(rng, count, n, n);
    let probe: Vec<usize> = (0..count).map(|i| i % 2).collect();
    let feature: Vec<usize> = (0..count).map(|i| i % features.len()).collect();
    let placement: Vec<i64> = (0..count).map(|i| (i / features.len() % placements) as i64).collect();
    let rows = TouchRows { poses: told.at(&q), probe: &probe, feature: &feature, placement: &placement };
    let labels: Vec<String> = (1..=features.len()).map(|k| format!("f{k}")).collect();
    let features = Features { name: "artefact", labels: &labels, coordinates_mm: features, u, fitted, frame };
    problem.add_points(&features, rows).unwrap();
}

/// Touches all around two places of a ball a little smaller than the arm's reach.
fn ball(problem: &mut Problem, rng: &mut Xoshiro256PlusPlus, fitted: bool, side: Side) {
    let diameter_mm = 1.2 * problem.arm().reach_mm(0);
    let ball = BallArtefact { name: "ball", diameter_mm, u_mm: 0.0, fitted, side, balls_mm: &[6.0, 6.0] };
    touched(problem, rng, 2, 21, |problem, rows| problem.add_sphere(&ball, rows));
}

fn flat(problem: &mut Problem, rng: &mut Xoshiro256PlusPlus, balls_mm: [f64; 2]) {
    touched(problem, rng, 3, 14, |problem, rows| problem.add_plane(&balls_mm, rows));
}

fn touched(
    problem: &mut Problem,
    rng: &mut Xoshiro256PlusPlus,
    placements: usize,
    touches: usize,
    add: impl Fn(&mut Problem, TouchRows) -> ulna::Result<usize>,
) {
    let n = problem.arm().encoders();
    let count = placements * touches;
    let q = angles(rng, n * count);
    let told = Told::any(rng, count, 1, n);
    let probe: Vec<usize> = (0..count).map(|i| i % 2).collect();
    let placement: Vec<i64> = (0..count).map(|i| (i % placements) as i64).collect();
    let rows = TouchRows { poses: told.at(&q), probe: &probe, feature: &vec![0; count], placement: &placement };
    add(problem, rows).unwrap();
}

/// Tips by the plain map, mm.
pub fn plain(arm: &Arm, probe: usize, q_rad: &[f64]) -> Vec<[f64; 3]> {
    q_rad.chunks_exact(arm.encoders()).map(|q| tip_mm(arm, probe, q).into()).collect()
}
