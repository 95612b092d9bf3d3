//! The batch kernels against the formula, and the derivatives against differences, for every kind of joint.

mod common;

use common::{angles, any_arm, plain, rng};
use proptest::prelude::*;
use ulna::kinematics::{Chain, Poses, batch, jacobian};
use ulna::propagate::check_jacobian;
use ulna::simd::Columns;

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn batch_equals_plain(seed in 0..u64::MAX, encoders in 2usize..12, rows in 1usize..70) {
        let mut rng = rng(seed);
        let arm = any_arm(&mut rng, encoders);
        let q = angles(&mut rng, encoders * rows);
        let expected = plain(&arm, 1, &q);
        let tolerance = 1e-14 * arm.reach_mm(1) * encoders as f64;

        let mut from_rows = vec![0.0; 3 * rows];
        let tip = arm.probes()[1].tip_mm;
        batch::tips_from_rows_mm(&Chain::new(&arm), tip, &q, &mut from_rows);
        let mut poses = Poses::from_rows(&q, encoders);
        let mut columns = Columns::zeros(3, rows);
        for keep in [false, true] {
            if keep {
                poses.keep_sin_cos();
            }
            batch::tips_of_probe_mm(&Chain::new(&arm), &poses, tip, &mut columns);
            for (row, p) in expected.iter().enumerate() {
                for j in 0..3 {
                    prop_assert!((columns.column(j)[row] - p[j]).abs() <= tolerance);
                    prop_assert!((from_rows[3 * row + j] - p[j]).abs() <= tolerance);
                }
            }
        }
    }

    #[test]
    fn batch_derivatives_equal_plain(seed in 0..u64::MAX, encoders in 2usize..9) {
        let mut rng = rng(seed);
        let arm = any_arm(&mut rng, encoders);
        let q = angles(&mut rng, encoders * 9);
        let tip = arm.probes()[0].tip_mm;
        let joints = arm.joint_parameter_count();
        let mut worst = 0.0_f64;
        batch::for_each_derivative(&Chain::new(&arm), tip, &q, |row, component, column, value| {
            if column < joints + 3 {
                let plain = jacobian(&arm, 0, &q[row * encoders..(row + 1) * encoders]);
                worst = worst.max((plain[(component, column)] - value).abs());
            }
        });
        prop_assert!(worst <= 1e-14 * arm.reach_mm(0) * encoders as f64, "{worst:e}");
    }

    #[test]
    fn derivatives_equal_differences(seed in 0..u64::MAX, encoders in 2usize..9) {
        let mut rng = rng(seed);
        let arm = any_arm(&mut rng, encoders);
        let generic = angles(&mut rng, encoders);
        let near_zero: Vec<f64> = generic.iter().map(|q| q * 1e-9).collect();
        // stretched out: every joint where its link lies along the one before
        let singular: Vec<f64> = arm
            .signs()
            .zip(arm.joints().iter().map(|j| j.theta0_rad).chain([0.0]))
            .map(|(sign, theta0)| sign * theta0)
            .collect();
        for q in [generic, near_zero, singular] {
            prop_assert!(check_jacobian(&arm, 0, &q) < 1e-11);
        }
    }
}
