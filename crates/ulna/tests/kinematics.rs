//! The batch kernels against the formula, and the derivatives against differences, for every kind of joint.

mod common;

use common::{Told, angles, any_arm, any_effects, any_full_arm, rng, sliding};
use proptest::prelude::*;
use rand::RngExt;
use ulna::arm::Arm;
use ulna::kinematics::propagate::check_jacobian;
use ulna::kinematics::{Chain, Poses, batch, encoder_jacobian, jacobian, tip_mm};
use ulna::simd::Columns;
use ulna::solver::numdiff::worst_difference;

/// Any arm: bare or full last link, with or without effects beyond its geometry; and what is true at its poses.
fn any(seed: u64, encoders: usize, rows: usize) -> (Arm, Vec<f64>, Told) {
    let mut rng = rng(seed);
    let arm = if rng.random() { any_arm(&mut rng, encoders) } else { any_full_arm(&mut rng, encoders) };
    let arm = if rng.random() { arm.with_effects(any_effects(&mut rng, encoders)).unwrap() } else { arm };
    let arm = if rng.random() { sliding(&arm, &mut rng) } else { arm };
    let mut q = angles(&mut rng, encoders * rows);
    for (i, value) in q.iter_mut().enumerate() {
        *value *= if arm.slides(i % encoders) { 100.0 } else { 1.0 };
    }
    let (warmths, approaches) = ([0, 1, encoders][rng.random_range(0..3)], [0, encoders][rng.random_range(0..2)]);
    let mut told = Told::any(&mut rng, rows, warmths, approaches);
    if rng.random() {
        told.payload.clear();
    }
    (arm, q, told)
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn batch_equals_plain(seed in 0..u64::MAX, encoders in 2usize..12, rows in 1usize..70) {
        let (arm, q_rad, told) = any(seed, encoders, rows);
        let poses = told.at(&q_rad);
        let tolerance = 2e-14 * arm.reach_mm(1) * encoders as f64;
        let chain = Chain::new(&arm);

        let mut from_rows = vec![0.0; 3 * rows];
        let tip = arm.probes()[1].tip_mm;
        batch::tips_from_rows_mm(&chain, tip, poses, &mut from_rows);
        let mut kept = Poses::new(poses, encoders);
        let mut columns = Columns::zeros(3, rows);
        for keep in [false, true] {
            if keep {
                kept.keep_sin_cos();
            }
            batch::tips_of_probe_mm(&chain, &kept, tip, &mut columns);
            for row in 0..rows {
                let p = tip_mm(&arm, 1, poses.pose(row, encoders));
                for j in 0..3 {
                    prop_assert!((columns.column(j)[row] - p[j]).abs() <= tolerance);
                    prop_assert!((from_rows[3 * row + j] - p[j]).abs() <= tolerance);
                }
            }
        }
    }

    #[test]
    fn batch_derivatives_equal_plain(seed in 0..u64::MAX, encoders in 2usize..9) {
        let rows = 9;
        let (arm, q_rad, told) = any(seed, encoders, rows);
        let poses = told.at(&q_rad);
        let chain = Chain::new(&arm);
        let plain: Vec<_> = (0..rows).map(|row| jacobian(&arm, 0, poses.pose(row, encoders))).collect();
        let mut worst = 0.0_f64;
        batch::for_each_derivative(&chain, arm.probes()[0].tip_mm, poses, |row, component, column, value| {
            if let Some(parameter) = chain.parameter_of(column, 0, 2) {
                let plain = plain[row][(component, parameter)];
                // a column of compliance is in N m, of expansion in kelvin: some tens of either
                worst = worst.max((plain - value).abs() / (1.0 + plain.abs() / arm.reach_mm(0)));
            }
        });
        prop_assert!(worst <= 4e-14 * arm.reach_mm(0) * encoders as f64, "{worst:e}");
    }

    #[test]
    fn derivatives_equal_differences(seed in 0..u64::MAX, encoders in 2usize..9) {
        let (arm, generic, told) = any(seed, encoders, 1);
        let near_zero: Vec<f64> = generic.iter().map(|q| q * 1e-9).collect();
        // stretched out: every joint where its link lies along the one before
        let singular: Vec<f64> = arm
            .signs()
            .zip(arm.joints().iter().map(|j| j.theta0_rad).chain([0.0]))
            .map(|(sign, theta0)| sign * theta0)
            .collect();
        for q_rad in [&generic, &near_zero, &singular] {
            let worst = check_jacobian(&arm, 0, told.at(q_rad));
            prop_assert!(worst < 3e-11, "{worst:e}");
        }
    }

    #[test]
    fn encoder_derivatives_equal_differences(seed in 0..u64::MAX, encoders in 2usize..9) {
        let (arm, q_rad, told) = any(seed, encoders, 1);
        let tip = |q: &[f64]| {
            tip_mm(&arm, 0, told.at(q).pose(0, encoders)).coords.as_slice().to_vec()
        };
        let analytic = encoder_jacobian(&arm, 0, told.at(&q_rad).pose(0, encoders));
        let worst = worst_difference(tip, &q_rad, &vec![1e-3; encoders], analytic.transpose().as_slice());
        prop_assert!(worst < 1e-10 * arm.reach_mm(0), "{worst:e}");
    }
}
