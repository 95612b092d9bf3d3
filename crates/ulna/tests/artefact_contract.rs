//! What every kind of artefact in the registry owes the solver, whatever it observes.

mod common;

use common::cases::{CASES, ORIENTATION_U_MM};
use common::{angles, any_arm, any_effects, any_full_arm, noises, rng};
use ulna::arm::{Arm, JointModel};
use ulna::artefacts::{At, KINDS, Model, Noise, Rows, Stated, Weighing};
use ulna::identify::families::pins;
use ulna::kinematics::Angles;
use ulna::monitor::Unwatched;
use ulna::problem::assembly::Assembly;
use ulna::problem::pins::Kind;
use ulna::problem::{Problem, whitened_rows};
use ulna::solver::gram::{Cost, Gram};
use ulna::solver::numdiff::worst_difference;
use ulna::solver::triangle::Triangle;
use ulna::solver::{LeastSquares, RowBlock, RowSink};

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
        for case in CASES {
            for (noise_label, noise) in noises(arm.encoders()) {
                let mut problem = Problem::new(arm.clone(), noise).unwrap();
                (case.add)(&mut problem, &mut rng(18), case.kind);
                let start = problem.parameters();
                problem.weigh(&start, Weighing::Full);
                let free: Vec<usize> = (0..start.len()).collect();
                check(&format!("{arm_label}, {}, {noise_label}", case.label), &problem, &free);
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
fn every_kind_has_a_case() {
    for kind in KINDS {
        let there = CASES.iter().any(|case| case.kind == kind.name);
        assert!(there, "kind {:?} has no case in tests/common/cases.rs: nothing here asks what it owes", kind.name);
    }
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
        // a short step: two ends of a bar that lie within a millimetre of each other bend the cost
        let worst = worst_difference(in_steps, &unit, &vec![0.02; unit.len()], &analytic);
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
            usize::from(problem.scale_free() && problem.tells_places()),
            "{label}"
        );
    });
}

#[test]
fn what_is_redrawn_without_noise_is_met_exactly() {
    for_all(|label, problem, free| {
        let model = Model::new(problem.arm());
        let silent = Noise::default();
        for group in problem.groups() {
            let dimensions: Vec<f64> = group.dimensions().iter().map(|d| d.value).collect();
            let at = At { model: &model, dimensions: &dimensions };
            let exact = group.redrawn(at, &silent, &mut rng(3));
            // its dimensions were calibrated anew: what it is has not changed
            let exact = exact.unweighted(at);
            let worst = exact.residuals_mm.iter().fold(0.0_f64, |w, r| w.max(r.abs()));
            // but for what an instrument's readings scatter by of their own
            let own_mm = if group.tell_places() { 0.0 } else { 6.0 * ORIENTATION_U_MM };
            assert!(worst < 1e-9 + own_mm, "{label}: {worst:e}, {} free", free.len());
        }
    });
}

/// The problem with readings that are exact where it starts.
fn exact(problem: &Problem) -> Problem {
    let mut exact = problem.redrawn(&problem.parameters(), &Noise::default(), &mut rng(3));
    exact.weigh(&problem.parameters(), Weighing::Full);
    exact
}

/// Parameters that have a column: all, but for those of the base where nothing fixes it.
fn moving(problem: &Problem) -> Vec<usize> {
    let base = problem.base_parameters();
    (0..problem.parameter_count()).filter(|j| !base.contains(j)).collect()
}

#[test]
fn derivatives_are_those_of_the_residuals() {
    for_all(|label, problem, _| {
        if problem.noise().is_some() {
            // residuals as a person reads them have no weights
            return;
        }
        let exact = exact(problem);
        // where it is exact: its dimensions were calibrated anew
        let (x, free) = (problem.parameters(), moving(problem));
        let mut assembly = Assembly::new(&exact, &free, &[], &Unwatched);
        let start: Vec<f64> = free.iter().map(|&j| x[j]).collect();
        let natural = assembly.natural_scale().to_vec();
        let mut gram = Gram::new(free.len());
        assembly.rows(&start, true, &mut gram).unwrap();
        // where readings are met exactly a placement follows to first order only
        let residuals = |k: usize, step: f64| -> Vec<f64> {
            let mut moved = x.clone();
            moved[free[k]] += step / natural[k];
            exact.unweighted(&moved).0.into_iter().flat_map(|group| group.residuals_mm).collect()
        };
        let column = |k: usize| -> Vec<f64> {
            let central = |h: f64| {
                let (up, down) = (residuals(k, h), residuals(k, -h));
                up.iter().zip(down).map(|(u, d)| (u - d) / (2.0 * h)).collect::<Vec<f64>>()
            };
            let (wide, narrow) = (central(0.1), central(0.05));
            narrow.iter().zip(wide).map(|(n, w)| n + (n - w) / 3.0).collect()
        };
        let columns: Vec<Vec<f64>> = (0..free.len()).map(column).collect();
        // a column that vanishes is compared with one that does not
        let least = 1e-6 * (0..free.len()).map(|j| gram.at(j, j).sqrt() / natural[j]).fold(0.0, f64::max);
        let length = |j: usize| (gram.at(j, j).sqrt() / natural[j]).max(least);
        for i in 0..free.len() {
            for j in 0..=i {
                // priors of dimensions are rows of their own
                let of_prior = if i == j { prior_of(&exact, free[i]) } else { 0.0 };
                let numerical: f64 = columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum();
                let analytic = (gram.at(i, j) - of_prior) / (natural[i] * natural[j]);
                let size = length(i) * length(j);
                assert!((numerical - analytic).abs() <= 1e-5 * size, "{label}: ({i}, {j}) {numerical:e} {analytic:e}");
            }
        }
    });
}

/// What a prior adds to the square of a parameter's column.
fn prior_of(problem: &Problem, parameter: usize) -> f64 {
    let own = problem.priors().into_iter().find(|prior| prior.parameter == parameter);
    own.map_or(0.0, |prior| (problem.unit() / prior.u).powi(2))
}

#[test]
fn no_reading_is_counted_twice() {
    /// Keeps the size of every residual but those that are padding.
    struct Kept(Vec<f64>);
    impl RowSink for Kept {
        fn fold(&mut self, block: &mut RowBlock) {
            let rows = &block.columns.column(block.residual)[..block.rows];
            self.0.extend(rows.iter().filter(|r| **r != 0.0).map(|r| r.abs()));
        }
    }
    let sorted = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values
    };
    for_all(|label, problem, free| {
        let x = problem.parameters();
        let mut streamed = Kept(vec![]);
        Assembly::new(problem, free, &[], &Unwatched).rows(&x, false, &mut streamed).unwrap();
        // what only says where a bar stands that is told as a length need not be streamed: five numbers of six
        let left_out = problem.equations() - streamed.0.len();
        assert!(left_out.is_multiple_of(5) && left_out <= problem.placement_unknowns(), "{label}: {left_out}");
        let whitened: f64 = problem.whitened(&x).iter().flat_map(|group| &group.norms).map(|norm| norm * norm).sum();
        let cost = cost(problem, free, &x);
        assert!((whitened - cost).abs() < 1e-11 * cost, "{label}: {whitened} {cost}");
        if problem.noise().is_none() && left_out == 0 {
            let (groups, _) = problem.unweighted(&x);
            let read = groups.iter().flat_map(|group| &group.residuals_mm).map(|r| r.abs()).collect();
            for (a, b) in sorted(streamed.0).iter().zip(sorted(read)) {
                assert!((a - b).abs() < 1e-9 * (1.0 + b), "{label}: {a} {b}");
            }
        }
    });
}

#[test]
fn whitened_rows_are_the_normal_equations_with_placements_eliminated() {
    for_all(|label, problem, free| {
        let mut problem = problem.clone();
        let found = whitened_rows(&mut problem, free, &Unwatched).unwrap();
        assert_eq!(found.standing.len(), problem.equations() - problem.placement_unknowns(), "{label}");
        assert!(found.standing.is_sorted(), "{label}");
        let standings: usize = problem.groups().iter().map(|group| group.standings()).sum();
        // none has no row of its own in these cases, and none is beyond the last
        assert_eq!(found.standing.chunk_by(|a, b| a == b).count(), standings, "{label}");
        assert_eq!(found.standing.last().map(|&last| last as usize + 1), Some(standings), "{label}");
        let n = free.len();
        let mut gram = Gram::new(n);
        Assembly::new(&problem, free, &[], &Unwatched).rows(&problem.parameters(), true, &mut gram).unwrap();
        for i in 0..n {
            for j in 0..=i {
                let product: f64 = found.rows.chunks_exact(n).map(|row| row[i] * row[j]).sum();
                let of_prior = if i == j { prior_of(&problem, i) } else { 0.0 };
                let size = (gram.at(i, i) * gram.at(j, j)).sqrt();
                assert!((product - (gram.at(i, j) - of_prior)).abs() <= 1e-12 * size, "{label}: ({i}, {j})");
            }
        }
    });
}

#[test]
fn rows_of_a_standing_are_those_it_has_alone() {
    let bar = Stated { name: "bar", features_mm: Some(&[[0.0; 3], [443.0, 0.0, 0.0]]), ..Stated::default() };
    let (arm, n) = (any_arm(&mut rng(3), 6), 6);
    for (noise_label, noise) in noises(n) {
        // touches of a standing that fill more than one tile, and of others once at each end, mixed
        let placement: Vec<i64> = (0..240).map(|row| if row % 6 < 4 { 7 } else { row / 6 }).collect();
        let feature: Vec<usize> = (0..240).map(|row| row % 2).collect();
        let q = angles(&mut rng(4), n * placement.len());
        let rows_of = |standings: &[i64]| {
            let own: Vec<usize> = (0..placement.len()).filter(|&row| standings.contains(&placement[row])).collect();
            let q_rad: Vec<f64> = own.iter().flat_map(|&row| &q[n * row..n * (row + 1)]).copied().collect();
            let mut problem = Problem::new(arm.clone(), noise.clone()).unwrap();
            let rows = Rows {
                poses: Angles::cold(&q_rad),
                probe: &vec![1; own.len()],
                feature: Some(&own.iter().map(|&row| feature[row]).collect::<Vec<_>>()),
                placement: Some(&own.iter().map(|&row| placement[row]).collect::<Vec<_>>()),
                ..Rows::default()
            };
            problem.add("points", &bar, &rows).unwrap();
            let free: Vec<usize> = (0..problem.parameter_count()).collect();
            whitened_rows(&mut problem, &free, &Unwatched).unwrap()
        };
        let mut met: Vec<i64> = vec![];
        placement.iter().for_each(|label| {
            if !met.contains(label) {
                met.push(*label)
            }
        });
        let whole = rows_of(&met);
        let width = whole.rows.len() / whole.standing.len();
        let gram = |rows: &[f64]| -> Vec<f64> {
            let of = |(i, j): (usize, usize)| rows.chunks_exact(width).map(|row| row[i] * row[j]).sum();
            (0..width).flat_map(|i| (0..=i).map(move |j| (i, j))).map(of).collect()
        };
        for (number, &label) in met.iter().enumerate() {
            let alone = rows_of(&[label]);
            let first = whole.standing.partition_point(|&standing| (standing as usize) < number);
            let own = &whole.rows[width * first..][..alone.rows.len()];
            assert!(whole.standing[first..][..alone.standing.len()].iter().all(|&k| k as usize == number));
            let (a, b) = (gram(own), gram(&alone.rows));
            let size = b.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-11 * size), "{noise_label}: standing {label}");
        }
    }
}

#[test]
fn readings_determine_all_but_what_nothing_shows() {
    for_all(|label, problem, free| {
        if problem.arm().effects().count() > 0 {
            // some are redundant by themselves
            return;
        }
        let (pinned, _) = pins(problem, free, &problem.parameters(), &Unwatched).unwrap();
        // the base's turn and lift have no column; the size of the arm, and the link that only carries the probes, are lost
        assert_eq!(problem.base_parameters().len(), if problem.base_free() { 2 } else { 0 }, "{label}");
        let carrying = if problem.arm().has_full_last_link() { 4 } else { 0 };
        if carrying > 0 && problem.scale_free() {
            // what grows and what only carries the probes mix where residuals are left
            return;
        }
        if !problem.tells_places() {
            // four angles of a Hayati joint and the next joint make one rotation
            let hayati = problem.arm().joints().iter().filter(|joint| joint.model == JointModel::Hayati).count();
            assert!(pinned.len() <= hayati, "{label}: {} pinned", pinned.len());
            return;
        }
        assert_eq!(pinned.len(), usize::from(problem.scale_free()) + carrying, "{label}");
    });
}

#[test]
fn whitened_residuals_scatter_as_their_freedoms_say() {
    for_all(|label, problem, _| {
        let Some(noise) = problem.noise() else { return };
        let truth = problem.parameters();
        let exact = exact(problem);
        let (mut squares, mut freedoms, mut rng) = (0.0, 0.0, rng(31));
        for _ in 0..60 {
            let mut drawn = exact.redrawn(&truth, noise, &mut rng);
            drawn.weigh(&truth, Weighing::Full);
            // dimensions are what they are, however they were calibrated
            for group in drawn.whitened(&truth) {
                squares += group.norms.iter().map(|norm| norm * norm).sum::<f64>();
                freedoms += group.freedoms.iter().sum::<f64>();
            }
        }
        // of a chi-square of so many degrees of freedom, five standard deviations
        let allowed = 5.0 * (2.0 / freedoms).sqrt();
        assert!((squares / freedoms - 1.0).abs() < allowed, "{label}: {} of {freedoms}", squares / freedoms);
    });
}
