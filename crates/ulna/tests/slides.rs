//! Joints that slide: what they are, what readings tell of them, and that a fit finds it.

mod common;

use common::rng;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;
use ulna::arm::{Arm, Coupling, Effects, Joint, JointModel, Probe};
use ulna::artefacts::{Frame, Noise, Rows, Stated};
use ulna::fit::calibrate::{Fitted, Options, fit};
use ulna::fit::monte_carlo::{Repeat, recalibrate};
use ulna::identify::causes::Cause;
use ulna::kinematics::{Angles, tip_mm};
use ulna::monitor::Unwatched;
use ulna::problem::Problem;

/// A shoulder, an elbow, a slide (joint `slide`, counted from 0) and a wrist of two joints; axes nowhere parallel.
fn arm(slide: usize) -> Arm {
    let rows = [[0.2, -1.5, 40.0, 255.0], [2.1, 1.4, -400.0, 30.0], [0.3, -1.6, 35.0, 120.0], [2.0, 1.3, -30.0, 25.0]];
    let probe = Probe { name: "bent".into(), tip_mm: [40.0, -10.0, 180.0] };
    let arm = Arm::new(rows.map(Joint::dh).to_vec(), 1.0, vec![probe]).unwrap();
    let slides: Vec<Option<f64>> = (0..5).map(|i| (i == slide).then_some(400.0)).collect();
    arm.with_slides(&slides).unwrap()
}

fn poses(arm: &Arm, count: usize, rng: &mut Xoshiro256PlusPlus) -> Vec<f64> {
    let one = |i: usize, rng: &mut Xoshiro256PlusPlus| match arm.slides(i) {
        true => rng.random_range(0.0..400.0),
        false => rng.random_range(-2.8..2.8),
    };
    (0..count * arm.encoders()).map(|k| one(k % arm.encoders(), rng)).collect()
}

/// Points of the base frame, each read with what the truth reads there; with noise where asked.
fn problem(start: &Arm, truth: &Arm, count: usize, noise: Option<Noise>) -> Problem {
    let mut rng = rng(3);
    let q_rad = poses(truth, count, &mut rng);
    let points: Vec<[f64; 3]> =
        q_rad.chunks_exact(truth.encoders()).map(|q| tip_mm(truth, 0, q).coords.into()).collect();
    let mut problem = Problem::new(start.clone(), noise).unwrap();
    let stated = Stated { name: "tracker", features_mm: Some(&points), frame: Some(Frame::Arm), ..Stated::default() };
    let feature: Vec<usize> = (0..count).collect();
    let rows = Rows {
        poses: Angles::cold(&q_rad),
        probe: &vec![0; count],
        feature: Some(&feature),
        placement: Some(&vec![0; count]),
        ..Rows::default()
    };
    problem.add("points", &stated, &rows).unwrap();
    problem
}

fn all(arm: &Arm) -> Vec<usize> {
    (0..arm.parameter_count()).collect()
}

#[test]
fn a_slide_shifts_along_its_axis() {
    let (arm, mut rng) = (arm(2), rng(1));
    for q in poses(&arm, 20, &mut rng).chunks_exact(5) {
        let mut t = Isometry3::identity();
        for (i, joint) in arm.joints().iter().enumerate() {
            let (turn, shift) = if i == 2 { (-joint.theta0_rad, q[i]) } else { (q[i] - joint.theta0_rad, 0.0) };
            t *= UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
            t *= Translation3::new(joint.a_mm, 0.0, joint.d_mm + shift);
            t *= UnitQuaternion::from_axis_angle(&Vector3::x_axis(), joint.alpha_rad);
        }
        t *= UnitQuaternion::from_axis_angle(&Vector3::z_axis(), q[4]);
        let expected = t * Point3::from(arm.probes()[0].tip_mm);
        assert!((tip_mm(&arm, 0, q) - expected).norm() < 1e-11);
    }
}

/// In its base frame an arm of five joints shows 4 · 4 + 3 parameters; of a slide's axis only two are there.
#[test]
fn of_the_axis_of_a_slide_only_the_direction_matters() {
    for slide in 1..5 {
        let arm = arm(slide);
        let fitted = fitted(&mut problem(&arm, &arm, 200, None), &arm);
        let lost = &fitted.identifiability.lost;
        assert_eq!(fitted.identifiability.determined, arm.parameter_count() - 2, "joint {}: {lost:?}", slide + 1);
        for each in lost {
            assert_eq!(each.because.cause, Cause::SlidingAxis, "{each:?}");
            assert!(each.because.because.contains(&format!("joint {} slides", slide + 1)), "{each:?}");
            assert!(each.combination.iter().all(|(name, _)| !name.ends_with("theta0") && !name.ends_with("alpha")));
        }
    }
}

/// A portal: three slides at nearly right angles, then a wrist of two joints.
#[test]
fn three_slides_in_a_row_are_one_matter() {
    let rows = [[0.02, -1.5, 5.0, 3.0], [1.5, 1.6, 10.0, 4.0], [1.6, 0.3, 20.0, 0.0], [0.1, 1.5, 30.0, 50.0]];
    let probe = Probe { name: "bent".into(), tip_mm: [40.0, -10.0, 180.0] };
    let arm = Arm::new(rows.map(Joint::dh).to_vec(), 1.0, vec![probe]).unwrap();
    let arm = arm.with_slides(&[Some(400.0), Some(400.0), Some(400.0), None, None]).unwrap();
    let lost = fitted(&mut problem(&arm, &arm, 200, None), &arm).identifiability.lost;
    // directions of three axes, the zeros of three scales; what is turned with the third is turned with the fourth
    assert!(lost.len() >= 4, "{lost:?}");
    assert!(lost.iter().all(|each| each.because.cause == Cause::SlidingAxis), "{lost:?}");
}

fn fitted(problem: &mut Problem, arm: &Arm) -> Fitted {
    fit(problem, &all(arm), &Options::default(), &Unwatched).unwrap()
}

#[test]
fn a_fit_finds_the_arm_but_for_what_no_point_depends_on() {
    for slide in 1..5 {
        let truth = arm(slide);
        let mut rng = rng(7);
        let drawn = truth.parameters();
        let off = drawn
            .iter()
            .zip(truth.parameter_units())
            .map(|(value, unit)| value + rng.random_range(-1.0..1.0) * if unit.as_str() == "rad" { 0.02 } else { 2.0 });
        let start = truth.with_parameters(&off.collect::<Vec<f64>>()).unwrap();
        let fitted = fitted(&mut problem(&start, &truth, 200, None), &truth);
        let found = truth.with_parameters(&fitted.solution.parameters[..truth.parameter_count()]).unwrap();
        for q in poses(&truth, 50, &mut rng).chunks_exact(5) {
            assert!((tip_mm(&found, 0, q) - tip_mm(&truth, 0, q)).norm() < 1e-8, "joint {}", slide + 1);
        }
    }
}

#[test]
fn repeated_calibrations_scatter_as_the_covariance_says() {
    let truth = arm(2);
    // of the slide mm
    let noise = Noise { encoder_rad: vec![2e-5, 2e-5, 0.03, 2e-5, 2e-5], seat_mm: 0.01 };
    let problem = problem(&truth, &truth, 150, Some(noise));
    // what says the same twice is held
    let names = truth.parameter_names();
    let held = ["joint.3.a", "joint.3.d"];
    let free: Vec<usize> = all(&truth).into_iter().filter(|&j| !held.contains(&names[j].as_str())).collect();
    let repeat = Repeat { truth: &truth, first: 0, runs: 80, seed: 3, threads: 1, uncertainties: true };
    let runs = recalibrate(&problem, &free, &repeat, &Unwatched).unwrap();
    let mut ratios = Vec::new();
    for &j in &free {
        ratios.extend(runs.iter().map(|run| ((run.parameters[j] - truth.parameters()[j]) / run.u[j]).powi(2)));
    }
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    assert!((0.8..1.2).contains(&mean), "{mean}");
}

#[test]
fn a_slide_says_a_length_and_tells_the_arm_from_its_mirror_image() {
    let arm = arm(2);
    let mut rng = rng(5);
    let q_rad = poses(&arm, 40, &mut rng);
    let seat = Stated { name: "cone", features_mm: Some(&[[0.0; 3]]), ..Stated::default() };
    let mut problem = Problem::new(arm.clone(), None).unwrap();
    let rows = Rows {
        poses: Angles::cold(&q_rad),
        probe: &[0; 40],
        feature: Some(&[0; 40]),
        placement: Some(&[0; 40]),
        ..Rows::default()
    };
    problem.add("points", &seat, &rows).unwrap();
    assert!(!problem.scale_free() && !problem.mirror_free() && problem.base_free());
    let turning = arm.with_slides(&[None; 5]).unwrap();
    let mut problem = Problem::new(turning, None).unwrap();
    problem.add("points", &seat, &rows).unwrap();
    assert!(problem.scale_free() && problem.mirror_free());
}

#[test]
fn what_cannot_slide_is_refused() {
    let arm = arm(2);
    let of = |i: usize, mm: f64| (0..5).map(|k| (k == i).then_some(mm)).collect::<Vec<_>>();
    let message = |refused: ulna::error::Result<Arm>| refused.unwrap_err().to_string();
    assert!(message(arm.with_slides(&of(1, 0.0))).contains("the travel of joint 2, mm, is 0"));
    assert!(message(arm.with_slides(&[None; 4])).contains("4 values, expected 5"));
    let mut joints = arm.joints().to_vec();
    joints[1] = Joint { model: JointModel::Hayati, d_mm: 0.0, ..joints[1] };
    let hayati = Arm::new(joints, 1.0, arm.probes().to_vec()).unwrap();
    assert!(message(hayati.with_slides(&of(1, 100.0))).contains("none of a Hayati joint"));
    let coupling = Coupling { others: vec![vec![], vec![], vec![], vec![2], vec![]], ratios: vec![0.5] };
    let coupled = arm.with_effects(Effects { coupling: Some(coupling), ..Effects::default() });
    assert!(message(coupled).contains("none of a coupled joint"));
}
