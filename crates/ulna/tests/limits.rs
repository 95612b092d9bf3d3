//! What no arm and no noise can be is refused in words that name it.

mod common;

use common::{any_arm, rng};
use ulna::artefacts::Noise;
use ulna::artefacts::length::LengthRows;
use ulna::kinematics::Angles;
use ulna::problem::Problem;

#[test]
fn an_arm_of_absurd_size_is_refused() {
    let arm = any_arm(&mut rng(1), 5);
    let mut parameters = arm.parameters();
    parameters[2] = 1e30;
    let message = Problem::new(arm.with_parameters(&parameters).unwrap(), None).unwrap_err().to_string();
    assert_eq!(message, "joint.1.a, mm, is 1e30; at most 10 km (1e7 mm) was expected");
}

#[test]
fn noise_too_small_to_weigh_with_is_refused() {
    for (encoder_rad, seat_mm) in [(vec![1e-150; 5], 0.01), (vec![], 1e-170), (vec![], f64::NAN), (vec![-1e-6; 5], 0.0)]
    {
        let arm = any_arm(&mut rng(1), 5);
        let message = Problem::new(arm, Some(Noise { encoder_rad, seat_mm })).unwrap_err().to_string();
        assert!(message.starts_with("a standard deviation of the noise (rad or mm) is "), "{message}");
        assert!(message.ends_with("zero, or a number from 1e-12 to 1e7 was expected"), "{message}");
    }
}

#[test]
fn a_length_that_is_none_is_refused() {
    for length_mm in [0.0, -1.0, 1e-300, 1e300, f64::NAN] {
        let arm = any_arm(&mut rng(1), 5);
        let mut problem = Problem::new(arm, None).unwrap();
        let rows = LengthRows {
            from: Angles::cold(&[0.1; 5]),
            to: Angles::cold(&[0.2; 5]),
            probe: &[0],
            length_mm: &[length_mm],
        };
        let message = problem.add_lengths("bar", rows, 0.0, false).unwrap_err().to_string();
        assert!(message.starts_with("a length of artefact bar, mm, is "), "{message}");
    }
}
