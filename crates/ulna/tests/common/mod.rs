//! Arms and readings that the tests share.
#![allow(dead_code, reason = "each test file uses its own part")]

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use ulna::arm::{Arm, Joint, JointModel, Probe};
use ulna::kinematics::tip_mm;
use ulna::problem::Problem;
use ulna::residuals::Noise;
use ulna::residuals::length::LengthRows;
use ulna::residuals::points::{Features, Frame, PointRows};

pub fn rng(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

pub fn angles(rng: &mut Xoshiro256PlusPlus, count: usize) -> Vec<f64> {
    (0..count).map(|_| rng.random_range(-3.0..3.0)).collect()
}

/// An arm of `n` encoders with all kinds of joints, signs and two probes.
pub fn any_arm(rng: &mut Xoshiro256PlusPlus, n: usize) -> Arm {
    let mut joint = |i: usize| {
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
    };
    let joints = (0..n - 1).map(&mut joint).collect();
    let probes = ["straight", "bent"].map(|name| Probe {
        name: name.into(),
        tip_mm: [rng.random_range(-50.0..50.0), rng.random_range(-50.0..50.0), rng.random_range(100.0..250.0)],
    });
    Arm::new(joints, if n.is_multiple_of(2) { 1.0 } else { -1.0 }, probes.to_vec()).unwrap()
}

/// Every kind of readings, not consistent with anything: `label`, and a function that adds them to a problem.
pub type Kind = (&'static str, fn(&mut Problem, &mut Xoshiro256PlusPlus));

pub const KINDS: [Kind; 6] = [
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
    let rows = LengthRows { q_rad: &q, p_rad: &p, probe: &probe, length_mm: &length_mm };
    problem.add_lengths("pairs", rows, 0.0).unwrap();
}

/// Tips come close to the features by correcting nothing: residuals of tens of millimetres, as at a start.
fn points(
    problem: &mut Problem,
    rng: &mut Xoshiro256PlusPlus,
    frame: Frame,
    features: &[[f64; 3]],
    placements: usize,
    touches: usize,
) {
    let n = problem.arm().encoders();
    let count = placements * touches * features.len();
    let q = angles(rng, n * count);
    let probe: Vec<usize> = (0..count).map(|i| i % 2).collect();
    let feature: Vec<usize> = (0..count).map(|i| i % features.len()).collect();
    let placement: Vec<i64> = (0..count).map(|i| (i / features.len() % placements) as i64).collect();
    let rows = PointRows { q_rad: &q, probe: &probe, feature: &feature, placement: &placement };
    let features = Features { name: "artefact", coordinates_mm: features, u_mm: 0.0, frame };
    problem.add_points(&features, rows).unwrap();
}

/// Tips by the plain map, mm.
pub fn plain(arm: &Arm, probe: usize, q_rad: &[f64]) -> Vec<[f64; 3]> {
    q_rad.chunks_exact(arm.encoders()).map(|q| tip_mm(arm, probe, q).into()).collect()
}
