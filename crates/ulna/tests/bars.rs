//! A bar touched once at each end enters a fit as the one length that it is, and gives the same as with its placement
//! eliminated: estimates, covariance, what is left, and the residual of each touch.

mod common;

use common::{cheng_2011, rng};
use nalgebra::{Point3, Vector3};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use ulna::arm::Arm;
use ulna::artefacts::{Noise, Rows, Size, Stated};
use ulna::fit::calibrate::{Fitted, Options, fit};
use ulna::kinematics::inverse::{Limits, posture_for_point};
use ulna::kinematics::{Angles, Conditions, tip_mm};
use ulna::monitor::Unwatched;
use ulna::problem::Problem;
use ulna::problem::assembly::Assembly;
use ulna::solver::losses::Loss;
use ulna::solver::{LeastSquares, RowBlock, RowSink};

const LENGTH_MM: f64 = 443.0;
const BARS: usize = 100;
/// Of these every third is touched a second time at one end: it is no single length, one way or the other.
const MIXED: usize = 12;

/// What is known of the length.
#[derive(Clone, Copy, PartialEq)]
enum Known {
    Exactly,
    Considered,
    Fitted,
}

/// With two probes well off the last axis.
fn truth() -> Arm {
    cheng_2011(&[("bent", [40.0, 0.0, 200.0]), ("straight", [-15.0, 30.0, 150.0])])
}

fn normal(rng: &mut Xoshiro256PlusPlus) -> f64 {
    StandardNormal.sample(rng)
}

/// Touches of a bar here and there, with noise.
struct Touched {
    q_rad: Vec<f64>,
    probe: Vec<usize>,
    feature: Vec<usize>,
    placement: Vec<i64>,
}

impl Touched {
    fn of(truth: &Arm, noise: &Noise, mixed: bool, rng: &mut Xoshiro256PlusPlus) -> Touched {
        let mut touched = Touched { q_rad: vec![], probe: vec![], feature: vec![], placement: vec![] };
        let limits = Limits { range_rad: vec![(-3.0, 3.0); 7] };
        let mut standing = 0;
        while standing < BARS {
            let anywhere: Vec<f64> = (0..7).map(|_| rng.random_range(-2.5..2.5)).collect();
            let (probe, twice) = (standing % 2, mixed && standing < MIXED && standing % 3 == 0);
            let place: Point3<f64> = tip_mm(truth, probe, &anywhere);
            let along = Vector3::from_fn(|_, _| normal(rng)).normalize() * LENGTH_MM;
            let ends = [place, place + along, place];
            let touches = if twice { 3 } else { 2 };
            let posture = |end: &Point3<f64>, rng: &mut Xoshiro256PlusPlus| {
                let at = end + Vector3::from_fn(|_, _| noise.seat_mm * normal(rng));
                posture_for_point(truth, probe, (at, Conditions::default()), &limits, 20, rng)
            };
            let postures: Option<Vec<Vec<f64>>> = ends[..touches].iter().map(|end| posture(end, rng)).collect();
            let Some(postures) = postures else { continue };
            for (k, posture) in postures.into_iter().enumerate() {
                let sigma = |j: usize| noise.encoder_rad.get(j).copied().unwrap_or(0.0);
                touched.q_rad.extend(posture.iter().enumerate().map(|(j, q)| q + sigma(j) * normal(rng)));
                touched.probe.push(probe);
                touched.feature.push(k % 2);
                touched.placement.push(standing as i64);
            }
            standing += 1;
        }
        touched
    }

    /// Told as a bar: as lengths where it can be.
    fn as_lengths(&self, problem: &mut Problem, known: Known) {
        let (u, fitted) = match known {
            Known::Exactly => (0.0, false),
            Known::Considered => (0.02, false),
            Known::Fitted => (0.02, true),
        };
        let dimensions = [Size { name: "length", value: LENGTH_MM, u, fitted }];
        self.add(problem, &Stated { dimensions: &dimensions, ..Stated::default() });
    }

    /// Told as two features of which the second may be elsewhere along their line: that is always placed. Where the length is
    /// known exactly it may by an amount that is nothing.
    fn placed(&self, problem: &mut Problem, known: Known) {
        let (u_mm, features_fitted) = match known {
            Known::Exactly => (1e-9, false),
            Known::Considered => (0.02, false),
            Known::Fitted => (0.02, true),
        };
        self.add(problem, &Stated { feature_u_mm: Some(&[0.0, u_mm]), features_fitted, ..Stated::default() });
    }

    fn add(&self, problem: &mut Problem, stated: &Stated) {
        let stated = Stated { name: "bar", features_mm: Some(&[[0.0; 3], [LENGTH_MM, 0.0, 0.0]]), ..*stated };
        let rows = Rows {
            poses: Angles::cold(&self.q_rad),
            probe: &self.probe,
            feature: Some(&self.feature),
            placement: Some(&self.placement),
            ..Rows::default()
        };
        problem.add("points", &stated, &rows).unwrap();
    }
}

/// Equations that reach the solver.
struct Counted(usize);

impl RowSink for Counted {
    fn fold(&mut self, block: &mut RowBlock) {
        self.0 += block.columns.column(block.residual)[..block.rows].iter().filter(|r| **r != 0.0).count();
    }
}

fn equations(problem: &Problem) -> usize {
    let mut counted = Counted(0);
    Assembly::new(problem, &[], &[], &Unwatched).rows(&[], false, &mut counted).unwrap();
    counted.0
}

/// Both ways, at the same start.
fn both(touched: &Touched, noise: Option<&Noise>, loss: Option<Loss>, known: Known) -> [Fitted; 2] {
    let truth = truth();
    let problem = |tell: fn(&Touched, &mut Problem, Known)| {
        let mut problem = Problem::new(truth.clone(), noise.cloned()).unwrap();
        problem.set_loss(loss);
        tell(touched, &mut problem, known);
        problem
    };
    let (mut one, mut other) = (problem(Touched::as_lengths), problem(Touched::placed));
    assert_eq!(equations(&other), 3 * touched.probe.len());
    assert!(equations(&one) < 2 * BARS, "the bars are not told as lengths");
    let free: Vec<usize> = (0..one.parameter_count()).collect();
    [&mut one, &mut other].map(|problem| fit(problem, &free, &Options::default(), &Unwatched).unwrap())
}

/// The largest difference of any two numbers, in units of the size at each.
fn worst(one: &[f64], other: &[f64], size: impl Fn(usize) -> f64) -> f64 {
    assert_eq!(one.len(), other.len());
    let off = |(k, (a, b)): (usize, (&f64, &f64))| {
        assert_eq!(a.is_nan(), b.is_nan(), "{k}");
        if a == b || a.is_nan() { 0.0 } else { (a - b).abs() / size(k) }
    };
    one.iter().zip(other).enumerate().map(off).fold(0.0, f64::max)
}

/// Checks that two fits say the same, up to a part of what is uncertain.
fn alike([one, other]: &[Fitted; 2], part: f64, label: &str) {
    let n = one.free.len();
    assert_eq!(one.observations, other.observations, "{label}");
    assert_eq!(one.placement_unknowns, other.placement_unknowns, "{label}");
    assert!((one.degrees_of_freedom - other.degrees_of_freedom).abs() < 1e-6, "{label}: degrees of freedom");
    assert_eq!(one.identifiability.determined, other.identifiability.determined, "{label}");
    let u: Vec<f64> = (0..n).map(|k| other.covariance[k * (n + 1)].sqrt()).collect();
    let (a, b) = (&one.solution.parameters, &other.solution.parameters);
    // what is not determined has no uncertainty, and stays where it was
    let off = worst(a, b, |k| if u[k] > 0.0 { u[k] } else { 1e-6 });
    assert!(off < part, "{label}: parameters by {off:e} of their uncertainties");
    let off = worst(&one.covariance, &other.covariance, |k| (u[k / n] * u[k % n]).max(1e-30));
    assert!(off < part, "{label}: covariance by {off:e}");
    let (a, b) = (
        one.chi2_per_dof.unwrap_or(one.solution.report.cost),
        other.chi2_per_dof.unwrap_or(other.solution.report.cost),
    );
    assert!((a / b - 1.0).abs() < part, "{label}: chi2 {a} {b}");
    let ([a], [b]) = (&one.residuals[..], &other.residuals[..]) else { panic!("{label}: one group was expected") };
    let off = worst(&a.residuals_mm, &b.residuals_mm, |_| other.rms_mm);
    assert!(off < part, "{label}: residuals by {off:e} of their size");
    let off = worst(&a.weights, &b.weights, |k| b.weights[k]);
    assert!(off < part, "{label}: weights by {off:e}");
    assert_eq!(one.counted.is_some(), other.counted.is_some());
    if let (Some(a), Some(b)) = (&one.counted, &other.counted) {
        let off = worst(&a[0], &b[0], |_| 1.0);
        assert!(off < part, "{label}: what a loss lets count by {off:e}");
    }
}

fn for_all(check: impl Fn(&str, bool, Known)) {
    for (label, mixed) in [("all touched once at each end", false), ("some touched more often", true)] {
        for (known_label, known) in
            [("length known", Known::Exactly), ("length considered", Known::Considered), ("fitted", Known::Fitted)]
        {
            check(&format!("{label}, {known_label}"), mixed, known);
        }
    }
}

#[test]
fn where_all_directions_weigh_alike_it_is_the_same_exactly() {
    let seat = Noise { encoder_rad: vec![], seat_mm: 0.02 };
    for_all(|label, mixed, known| {
        let touched = Touched::of(&truth(), &seat, mixed, &mut rng(5));
        // LM ends within a small part of what is uncertain
        alike(&both(&touched, None, None, known), 1e-6, label);
        alike(&both(&touched, Some(&seat), None, known), 1e-6, label);
    });
}

#[test]
fn where_they_do_not_it_is_the_same_to_first_order_in_the_noise() {
    let noise = Noise { encoder_rad: (1..=7).map(|j| 4e-6 * f64::from(j)).collect(), seat_mm: 0.005 };
    for_all(|label, mixed, known| {
        let touched = Touched::of(&truth(), &noise, mixed, &mut rng(6));
        alike(&both(&touched, Some(&noise), None, known), 1e-4, label);
    });
}

#[test]
fn a_loss_judges_both_touches_alike_either_way() {
    let noise = Noise { encoder_rad: vec![1e-5; 7], seat_mm: 0.01 };
    let seat = Noise { encoder_rad: vec![], seat_mm: 0.02 };
    for_all(|label, mixed, known| {
        let mut touched = Touched::of(&truth(), &seat, mixed, &mut rng(7));
        // three bars that are not where they were said to be touched
        (0..3).for_each(|k| touched.q_rad[7 * (31 * k + 40) + 2] += 4e-4);
        for loss in [Loss::Huber, Loss::Cauchy, Loss::Tukey] {
            alike(&both(&touched, None, Some(loss), known), 1e-5, &format!("{label}, {loss:?}"));
            alike(&both(&touched, Some(&seat), Some(loss), known), 1e-5, &format!("{label}, {loss:?}, seats"));
            // to first order in the residuals: outliers have large ones
            alike(&both(&touched, Some(&noise), Some(loss), known), 5e-3, &format!("{label}, {loss:?}, encoders"));
        }
    });
}
