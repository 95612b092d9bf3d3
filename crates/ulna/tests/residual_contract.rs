//! What every kind of readings owes the solver, whatever it observes.

mod common;

use common::{KINDS, any_arm, any_effects, any_full_arm, noises, rng};
use ulna::arm::Arm;
use ulna::artefacts::Weighing;
use ulna::identify::families::pins;
use ulna::monitor::Unwatched;
use ulna::problem::Problem;
use ulna::problem::assembly::Assembly;
use ulna::problem::pins::Kind;
use ulna::solver::LeastSquares;
use ulna::solver::gram::{Cost, Gram};
use ulna::solver::numdiff::worst_difference;
use ulna::solver::triangle::Triangle;

/// The arms that every kind must be right for: plain, with all effects, and with a full last link.
fn arms() -> [(&'static str, Arm); 3] {
    let mut rng = rng(17);
    let plain = any_arm(&mut rng, 6);
    let mut effects = any_effects(&mut rng, 6);
    // upright, so that turning the base turns nothing against gravity
    effects.compliance.iter_mut().for_each(|compliance| compliance.gravity = [0.0, 0.0, -1.0]);
    let full = any_full_arm(&mut rng, 5);
    [("plain", plain.clone()), ("effects", plain.with_effects(effects).unwrap()), ("full last link", full)]
}

/// Calls `check` for every kind under every noise, at arms with residuals of tens of millimetres.
fn for_all(check: impl Fn(&str, &Problem, &[usize])) {
    for (arm_label, arm) in arms() {
        for (kind, add) in KINDS {
            for (noise_label, noise) in noises(arm.encoders()) {
                let mut problem = Problem::new(arm.clone(), noise).unwrap();
                add(&mut problem, &mut rng(18));
                let start = problem.parameters();
                problem.weigh(&start, Weighing::Full);
                let free: Vec<usize> = (0..start.len()).collect();
                check(&format!("{arm_label}, {kind}, {noise_label}"), &problem, &free);
            }
        }
    }
}

fn cost(problem: &Problem, free: &[usize], x: &[f64]) -> f64 {
    let mut cost = Cost::default();
    Assembly::new(problem, free, &[], &Unwatched).rows(x, false, &mut cost).unwrap();
    cost.0
}

#[test]
fn gradient_is_the_derivative_of_the_cost() {
    for_all(|label, problem, free| {
        let x = problem.parameters();
        let mut gram = Gram::new(x.len());
        let mut assembly = Assembly::new(problem, free, &[], &Unwatched);
        assembly.rows(&x, true, &mut gram).unwrap();
        let alone = cost(problem, free, &x);
        assert!((gram.cost() - alone).abs() < 1e-12 * alone, "{label}: cost {alone:e}, {:e}", gram.cost());

        // the base's own parameters have no column where nothing fixes the base
        let base = problem.base_parameters();
        let moving: Vec<usize> = (0..x.len()).filter(|j| !base.contains(j)).collect();
        let at = |values: &[f64]| {
            let mut moved = x.clone();
            moving.iter().zip(values).for_each(|(&j, &v)| moved[j] = v);
            vec![cost(problem, free, &moved)]
        };
        let analytic: Vec<f64> = moving.iter().map(|&j| 2.0 * gram.gradient(j)).collect();
        let values: Vec<f64> = moving.iter().map(|&j| x[j]).collect();
        let natural = assembly.natural_scale();
        let step: Vec<f64> = moving.iter().map(|&j| 1.0 / natural[j]).collect();
        let scaled: Vec<f64> = analytic.iter().zip(&step).map(|(g, s)| (g * s).abs()).collect();
        let largest = scaled.iter().copied().fold(0.0, f64::max);
        // compare in units of the step, so that angles and lengths count alike
        let in_steps = |v: &[f64]| at(&v.iter().zip(&step).map(|(v, s)| v * s).collect::<Vec<_>>());
        let unit: Vec<f64> = values.iter().zip(&step).map(|(v, s)| v / s).collect();
        let analytic: Vec<f64> = analytic.iter().zip(&step).map(|(g, s)| g * s).collect();
        let worst = worst_difference(in_steps, &unit, &vec![1.0; unit.len()], &analytic);
        assert!(worst < 2e-6 * largest, "{label}: {worst:e} of {largest:e}");
    });
}

#[test]
fn triangle_and_normal_equations_agree() {
    for_all(|label, problem, free| {
        let x = problem.parameters();
        let mut assembly = Assembly::new(problem, free, &[], &Unwatched);
        let (mut gram, mut triangle) = (Gram::new(x.len()), Triangle::new(x.len()));
        assembly.rows(&x, true, &mut gram).unwrap();
        assembly.rows(&x, true, &mut triangle).unwrap();
        for i in 0..x.len() {
            for j in 0..=i {
                let product: f64 = (0..=j).map(|k| triangle.at(k, i) * triangle.at(k, j)).sum();
                let size = (gram.at(i, i) * gram.at(j, j)).sqrt();
                assert!((product - gram.at(i, j)).abs() <= 1e-13 * size, "{label}: ({i}, {j})");
            }
        }
    });
}

#[test]
fn turning_the_base_changes_no_cost_of_what_stands_freely() {
    for_all(|label, problem, free| {
        if !problem.base_free() || problem.noise().is_some_and(|n| !n.encoder_rad.is_empty()) {
            // weights taken in base directions stay behind when the base turns
            return;
        }
        let x = problem.parameters();
        let mut turned = x.clone();
        turned[0] += 0.7;
        // a warm link lifts by more where it is longer
        turned[3] += if problem.arm().effects().expansion.is_some() { 0.0 } else { 55.0 };
        let (before, after) = (cost(problem, free, &x), cost(problem, free, &turned));
        assert!((before - after).abs() < 1e-10 * before, "{label}: {before} {after}");
    });
}

#[test]
fn a_part_of_the_readings_has_the_whole_ones_rank() {
    for_all(|label, problem, free| {
        for group in problem.groups() {
            let thin = group.thinned(group.len() / 2 + 4);
            assert!(thin.len() <= group.len(), "{label}");
            assert_eq!(thin.placement_unknowns(), group.placement_unknowns(), "{label}");
        }
        let (pinned, _) = pins(problem, free, &problem.parameters(), &Unwatched).unwrap();
        assert_eq!(
            pinned.iter().filter(|p| p.kind == Kind::Growth).count(),
            usize::from(problem.scale_free()),
            "{label}"
        );
    });
}

#[test]
fn what_is_redrawn_without_noise_is_met_exactly() {
    for_all(|label, problem, free| {
        let model = ulna::artefacts::Model::new(problem.arm());
        let silent = ulna::artefacts::Noise::default();
        for group in problem.groups() {
            let dimensions_mm: Vec<f64> = group.dimensions().iter().map(|d| d.value_mm).collect();
            let at = ulna::artefacts::At { model: &model, dimensions_mm: &dimensions_mm };
            let exact = group.redrawn(at, &silent, &mut rng(3));
            // its dimensions were calibrated anew: what it is has not changed
            let exact = exact.unweighted(at);
            let worst = exact.residuals_mm.iter().fold(0.0_f64, |w, r| w.max(r.abs()));
            assert!(worst < 1e-9, "{label}: {worst:e}, {} free", free.len());
        }
    });
}
