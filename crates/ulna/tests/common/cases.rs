//! Readings of every kind of artefact, not consistent with anything: residuals of tens of millimetres, as at a start.
//!
//! A new kind gets a case here, or the contract fails and says so.

use super::{Told, angles};
use nalgebra::{Rotation3, Vector3};
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;
use ulna::artefacts::{Frame, Rows, Size, Stated};
use ulna::kinematics::frames;
use ulna::problem::Problem;

/// An artefact and its readings.
pub struct Case {
    pub label: &'static str,
    /// its kind, as the registry calls it
    pub kind: &'static str,
    pub add: Add,
}

type Add = fn(&mut Problem, &mut Xoshiro256PlusPlus, &'static str);

const fn case(label: &'static str, kind: &'static str, add: Add) -> Case {
    Case { label, kind, add }
}

const BAR: &[[f64; 3]] = &[[0.0; 3], [443.0, 0.0, 0.0]];
/// The bar's length, where it is calibrated and fitted, and where nothing is known of it.
const MAY_CHANGE: &[Size] = &[size("length", 443.0, 0.5, true)];
const UNKNOWN: &[Size] = &[size("length", 443.0, 0.0, true)];
const PLATE: &[[f64; 3]] = &[[0.0; 3], [100.0, 0.0, 0.0], [0.0, 150.0, 0.0], [80.0, 90.0, 5.0]];
const IN_LINE: &[[f64; 3]] = &[[0.0; 3], [60.0, 0.0, 0.0], [120.0, 0.0, 0.0], [240.0, 0.0, 0.0], [420.0, 0.0, 0.0]];

pub const CASES: &[Case] = &[
    case("pairs of poses", "length", |p, r, k| lengths(p, r, k, &[])),
    case("pairs of poses whose length may change", "length", |p, r, k| lengths(p, r, k, MAY_CHANGE)),
    case("pairs of poses an unknown length apart", "length", |p, r, k| lengths(p, r, k, UNKNOWN)),
    case("bar touched once", "points", |p, r, k| touched(p, r, k, &points(BAR), (30, 1))),
    case("bar touched once at each end by one probe", "points", |p, r, k| bars(p, r, k, &points(BAR), (30, 0))),
    case("bar touched once at each end whose length may change", "points", |p, r, k| {
        bars(p, r, k, &bar(MAY_CHANGE), (40, 0))
    }),
    case("bar touched once at each end, of unknown length", "points", |p, r, k| bars(p, r, k, &bar(UNKNOWN), (40, 0))),
    case("bar touched once at each end here and more often there", "points", |p, r, k| {
        bars(p, r, k, &bar(MAY_CHANGE), (25, 9))
    }),
    case("bar touched often", "points", |p, r, k| touched(p, r, k, &points(BAR), (3, 13))),
    case("bar whose length may change", "points", |p, r, k| touched(p, r, k, &bar(MAY_CHANGE), (12, 2))),
    case("bar of unknown length", "points", |p, r, k| touched(p, r, k, &bar(UNKNOWN), (12, 2))),
    case("seat", "points", |p, r, k| touched(p, r, k, &points(&[[0.0; 3]]), (2, 45))),
    case("plate", "points", |p, r, k| touched(p, r, k, &points(PLATE), (3, 4))),
    case("plate whose features may move", "points", |p, r, k| {
        let stated = Stated { feature_u_mm: Some(&[0.4, 0.0, 0.3, 0.2]), features_fitted: true, ..points(PLATE) };
        touched(p, r, k, &stated, (3, 4));
    }),
    case("coordinates", "points", |p, r, k| {
        let grid = [[300.0, 0.0, 100.0], [0.0, 400.0, 200.0], [-300.0, 200.0, 0.0]];
        touched(p, r, k, &Stated { frame: Some(Frame::Arm), ..points(&grid) }, (1, 12));
    }),
    case("ball bar of many balls in line", "points", |p, r, k| touched(p, r, k, &points(IN_LINE), (3, 6))),
    case("ball", "sphere", |p, r, k| round(p, r, k, size("diameter", 1.2, 0.0, false), false)),
    case("ball of a diameter that may change", "sphere", |p, r, k| {
        round(p, r, k, size("diameter", 1.2, 0.01, true), false)
    }),
    case("ball of unknown diameter", "sphere", |p, r, k| round(p, r, k, size("diameter", 1.2, 0.0, true), false)),
    case("hollow sphere", "sphere", |p, r, k| round(p, r, k, size("diameter", 1.2, 0.0, false), true)),
    case("shaft", "cylinder", |p, r, k| round(p, r, k, size("diameter", 1.2, 0.0, false), false)),
    case("bore of a diameter that may change", "cylinder", |p, r, k| {
        round(p, r, k, size("diameter", 1.2, 0.01, true), true)
    }),
    case("shaft of unknown diameter", "cylinder", |p, r, k| round(p, r, k, size("diameter", 1.2, 0.0, true), false)),
    case("distances", "distance", |p, r, k| distances(p, r, k, &[])),
    case("distances of an instrument that may be off", "distance", |p, r, k| {
        distances(p, r, k, &[size("offset", 5.0, 1.0, true), size("scale", 1.001, 0.01, true)])
    }),
    case("distances of an instrument of unknown scale", "distance", |p, r, k| {
        distances(p, r, k, &[size("scale", 1.0, 0.0, true)])
    }),
    case("distances of an instrument of which nothing is known", "distance", |p, r, k| {
        distances(p, r, k, &[size("offset", 5.0, 0.0, true), size("scale", 1.001, 0.0, true)])
    }),
    case("orientations", "orientation", |p, r, k| turned(p, r, k, false, Frame::Free)),
    case("orientations of a target mounted anyhow", "orientation", |p, r, k| turned(p, r, k, true, Frame::Free)),
    case("orientations in the arm's frame", "orientation", |p, r, k| turned(p, r, k, true, Frame::Arm)),
    case("flat", "plane", |p, r, k| touched(p, r, k, &balls(&[6.0, 6.0]), (3, 14))),
    // so many that no standing's balls leave its side undecided: there the cost has a kink
    case("flat touched with two balls", "plane", |p, r, k| touched(p, r, k, &balls(&[6.0, 40.0]), (3, 16))),
];

/// What an orientation of these cases scatters by, at its lever.
pub const ORIENTATION_U_MM: f64 = 2e-5 * 800.0;

const fn size(name: &str, value: f64, u: f64, fitted: bool) -> Size<'_> {
    Size { name, value, u, fitted }
}

fn points(features_mm: &[[f64; 3]]) -> Stated<'_> {
    Stated { name: "artefact", features_mm: Some(features_mm), ..Stated::default() }
}

/// The bar with what is stated of its length.
fn bar<'a>(dimensions: &'a [Size<'a>]) -> Stated<'a> {
    Stated { dimensions, ..points(BAR) }
}

fn balls(balls_mm: &[f64]) -> Stated<'_> {
    Stated { name: "artefact", balls_mm: Some(balls_mm), ..Stated::default() }
}

fn lengths(problem: &mut Problem, rng: &mut Xoshiro256PlusPlus, kind: &str, dimensions: &[Size]) {
    let (n, count) = (problem.arm().encoders(), 45);
    let (q, p) = (angles(rng, n * count), angles(rng, n * count));
    let (from, to) = (Told::any(rng, count, 1, n), Told::any(rng, count, 1, n));
    let unlike: Vec<f64> = (0..count).map(|_| rng.random_range(100.0..900.0)).collect();
    let alike = dimensions.first().map(|length| vec![length.value; count]);
    let rows = Rows {
        poses: from.at(&q),
        probe: &(0..count).map(|i| i % 2).collect::<Vec<_>>(),
        second: Some(to.at(&p)),
        measured_mm: Some(&alike.unwrap_or(unlike)),
        ..Rows::default()
    };
    problem.add(kind, &Stated { name: "pairs", dimensions, ..Stated::default() }, &rows).unwrap();
}

/// Distances from two places, as they might be read.
fn distances(problem: &mut Problem, rng: &mut Xoshiro256PlusPlus, kind: &str, dimensions: &[Size]) {
    let (n, count) = (problem.arm().encoders(), 44);
    let (q, told) = (angles(rng, n * count), Told::any(rng, count, 1, n));
    let reach_mm = problem.arm().reach_mm(0);
    let measured_mm: Vec<f64> = (0..count).map(|_| reach_mm * rng.random_range(0.8..1.2)).collect();
    let rows = Rows {
        poses: told.at(&q),
        probe: &(0..count).map(|i| i % 2).collect::<Vec<_>>(),
        placement: Some(&(0..count).map(|i| (i % 2) as i64).collect::<Vec<_>>()),
        measured_mm: Some(&measured_mm),
        ..Rows::default()
    };
    problem.add(kind, &Stated { name: "wire", dimensions, ..Stated::default() }, &rows).unwrap();
}

/// A target on the last link as an instrument sees it from two places, some hundredths of a radian off.
fn turned(problem: &mut Problem, rng: &mut Xoshiro256PlusPlus, kind: &str, fitted: bool, frame: Frame) {
    let (n, count) = (problem.arm().encoders(), 44);
    let (q, told) = (angles(rng, n * count), Told::any(rng, count, 1, n));
    let mount_rad = [0.7, -1.1, 0.4];
    let placement: Vec<i64> = (0..count).map(|i| (i % 2) as i64).collect();
    let stands = [Rotation3::identity(), Rotation3::new(Vector3::new(0.9, -0.3, 2.0))];
    let poses = told.at(&q);
    let seen = |row: usize| {
        let link = frames(problem.arm(), poses.pose(row, n)).last().unwrap().rotation.to_rotation_matrix();
        let off = Vector3::from([0, 1, 2].map(|_| rng.random_range(-0.05..0.05)));
        let stand = if frame == Frame::Free { stands[row % 2] } else { stands[0] };
        (stand * Rotation3::new(off) * link * Rotation3::new(Vector3::from(mount_rad))).scaled_axis().into()
    };
    let rotation_rad: Vec<[f64; 3]> = (0..count).map(seen).collect();
    let mount = ["rx", "ry", "rz"].iter().zip(mount_rad).map(|(name, value)| size(name, value + 0.02, 0.0, fitted));
    let dimensions: Vec<Size> = mount.chain([size("lever", 800.0, 0.0, false)]).collect();
    let rows = Rows {
        poses,
        probe: &(0..count).map(|i| i % 2).collect::<Vec<_>>(),
        placement: Some(&placement),
        rotation_rad: Some(&rotation_rad),
        rotation_u_rad: Some(&vec![ORIENTATION_U_MM / 800.0; count]),
        ..Rows::default()
    };
    let stated = Stated { name: "target", dimensions: &dimensions, frame: Some(frame), ..Stated::default() };
    problem.add(kind, &stated, &rows).unwrap();
}

/// Touches all around places of something round, its diameter in reaches of the arm.
fn round(problem: &mut Problem, rng: &mut Xoshiro256PlusPlus, kind: &str, diameter: Size, inside: bool) {
    let reach_mm = problem.arm().reach_mm(0);
    let dimensions = &[Size { value: diameter.value * reach_mm, u: diameter.u * reach_mm, ..diameter }];
    touched(problem, rng, kind, &Stated { dimensions, inside, ..balls(&[6.0, 6.0]) }, (2, 21));
}

/// Touches of a bar where it stands, each place by one probe: in so many places once at each end, and in so many three
/// times, all mixed.
fn bars(
    problem: &mut Problem,
    rng: &mut Xoshiro256PlusPlus,
    kind: &str,
    stated: &Stated,
    (once, thrice): (usize, usize),
) {
    let n = problem.arm().encoders();
    let mut of_row: Vec<(i64, usize)> =
        (0..once + thrice).flat_map(|standing| [(standing as i64, 0), (standing as i64, 1)]).collect();
    of_row.extend((0..thrice).map(|k| ((once + k) as i64, k % 2)));
    // rows of a standing need not come one after the other
    let count = of_row.len();
    let mixed: Vec<(i64, usize)> = (0..count).map(|i| of_row[i * 7919 % count]).collect();
    let (q, told) = (angles(rng, n * count), Told::any(rng, count, n, n));
    let rows = Rows {
        poses: told.at(&q),
        probe: &mixed.iter().map(|&(standing, _)| (standing % 2) as usize).collect::<Vec<_>>(),
        feature: Some(&mixed.iter().map(|&(_, feature)| feature).collect::<Vec<_>>()),
        placement: Some(&mixed.iter().map(|&(standing, _)| standing).collect::<Vec<_>>()),
        ..Rows::default()
    };
    problem.add(kind, stated, &rows).unwrap();
}

/// Touches of so many standings, each feature so often.
fn touched(
    problem: &mut Problem,
    rng: &mut Xoshiro256PlusPlus,
    kind: &str,
    stated: &Stated,
    (placements, touches): (usize, usize),
) {
    let features = stated.features_mm.map(<[_]>::len);
    let (n, each) = (problem.arm().encoders(), features.unwrap_or(1));
    let count = placements * touches * each;
    let q = angles(rng, n * count);
    let told = Told::any(rng, count, n, n);
    let feature: Vec<usize> = (0..count).map(|i| i % each).collect();
    let placement: Vec<i64> = (0..count).map(|i| (i / each % placements) as i64).collect();
    let rows = Rows {
        poses: told.at(&q),
        probe: &(0..count).map(|i| i % 2).collect::<Vec<_>>(),
        feature: features.map(|_| &feature[..]),
        placement: Some(&placement),
        ..Rows::default()
    };
    problem.add(kind, stated, &rows).unwrap();
}
