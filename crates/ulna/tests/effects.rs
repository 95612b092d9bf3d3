//! What every effect beyond the geometry owes, run over the registry; and what is said of effects that are stated badly.

mod common;

use common::{Told, angles, any_arm, any_effects, rng};
use std::collections::BTreeMap;
use ulna::arm::effects::Effect;
use ulna::arm::{Arm, Array, Coupling, Effects, Harmonics, Stated, Unit};
use ulna::artefacts::{At, Frame, Model, Noise, Rows, Stated as Artefact, Weighing};
use ulna::fit::calibrate::{Options, fit};
use ulna::fit::monte_carlo::{Repeat, recalibrate};
use ulna::kinematics::{Angles, Conditions, Pose, encoder_jacobian, jacobian, tip_mm};
use ulna::monitor::Unwatched;
use ulna::problem::Problem;

const JOINTS: usize = 6;

/// Every effect there is, as large as those of real arms.
fn all_effects() -> Effects {
    let mut effects = any_effects(&mut rng(5), JOINTS);
    assert_eq!(
        effects.all().map(Effect::kind).collect::<Vec<_>>(),
        Effects::KINDS,
        "any_effects leaves one out: what is tested with it is not tested for that"
    );
    let small: Vec<f64> = effects.all().flat_map(|effect| effect.values()).map(|value| 0.02 * value).collect();
    effects.set(&small);
    effects
}

fn tip(arm: &Arm, probe: usize, told: &Told, q_rad: &[f64], row: usize) -> nalgebra::Point3<f64> {
    tip_mm(arm, probe, told.at(q_rad).pose(row, JOINTS))
}

#[test]
fn an_arm_names_and_carries_every_parameter() {
    let arm = any_arm(&mut rng(1), JOINTS).with_effects(all_effects()).unwrap();
    let (names, units) = (arm.parameter_names(), arm.parameter_units());
    let mut first = arm.geometry_count();
    for effect in arm.effects().all() {
        let count = effect.values().len();
        assert_eq!(effect.joints(), JOINTS);
        assert_eq!(arm.parameters()[first..first + count], *effect.values(), "{}", effect.kind());
        assert!(units[first..first + count].iter().all(|unit| *unit == effect.unit()));
        for (j, name) in names.iter().enumerate().skip(first).take(count) {
            let joint = arm.joint_of(j).unwrap() + 1;
            assert!(name.starts_with(&format!("joint.{joint}.")), "{name}");
        }
        first += count;
    }
    assert_eq!(first, arm.parameter_count());
    let different: std::collections::BTreeSet<&String> = names.iter().collect();
    assert_eq!(different.len(), names.len());
    let other: Vec<f64> = (0..arm.parameter_count()).map(|j| 1e-3 * j as f64).collect();
    assert_eq!(arm.with_parameters(&other).unwrap().parameters(), other);
    // of another number of joints they are not this arm's
    assert!(any_arm(&mut rng(1), JOINTS + 1).with_effects(all_effects()).is_err());
}

#[test]
fn no_parameter_moves_the_tip_by_much_more_than_it_says() {
    let arm = any_arm(&mut rng(1), JOINTS).with_effects(all_effects()).unwrap();
    let reach = arm.reach_mm(0);
    let (q_rad, told) = (angles(&mut rng(2), JOINTS * 200), Told::any(&mut rng(3), 200, 1, JOINTS));
    let names = arm.parameter_names();
    for (j, moves_mm) in arm.moves_mm(reach).into_iter().enumerate().skip(arm.geometry_count()) {
        let of_pose = |row| jacobian(&arm, 0, told.at(&q_rad).pose(row, JOINTS)).column(j).norm();
        let most = (0..200).map(of_pose).fold(0.0, f64::max);
        assert!(most <= 2.0 * moves_mm, "{}: {most} of {moves_mm}", names[j]);
        // the last axes are as near to the tip as the probe is short, and carry next to nothing
        assert!(most >= 1e-4 * moves_mm, "{}: {most} of {moves_mm}", names[j]);
    }
}

/// Lengths that are exact for an arm, every joint approached from either side, the temperature another each time.
fn exact_lengths(truth: &Arm, count: usize) -> (Vec<f64>, Vec<f64>, [Told; 2], Vec<f64>) {
    let mut rng = rng(7);
    let (q, p) = (angles(&mut rng, JOINTS * count), angles(&mut rng, JOINTS * count));
    let told = [Told::any(&mut rng, count, 1, JOINTS), Told::any(&mut rng, count, 1, JOINTS)];
    let length = |row| (tip(truth, 1, &told[0], &q, row) - tip(truth, 1, &told[1], &p, row)).norm();
    let length_mm = (0..count).map(length).collect();
    (q, p, told, length_mm)
}

fn problem(arm: Arm, truth: &Arm, count: usize, noise: Option<Noise>) -> Problem {
    let (q, p, told, length_mm) = exact_lengths(truth, count);
    let mut problem = Problem::new(arm, noise).unwrap();
    let rows = Rows {
        poses: told[0].at(&q),
        second: Some(told[1].at(&p)),
        probe: &vec![1; count],
        measured_mm: Some(&length_mm),
        ..Rows::default()
    };
    problem.add("length", &Artefact { name: "bar", ..Artefact::default() }, &rows).unwrap();
    problem
}

/// The same arm with all effects zero.
fn without(arm: &Arm) -> Arm {
    let mut parameters = arm.parameters();
    parameters[arm.geometry_count()..].fill(0.0);
    arm.with_parameters(&parameters).unwrap()
}

fn of_base(name: &str) -> bool {
    name.starts_with("joint.1.tilt_") || name.starts_with("joint.1.base_")
}

#[test]
fn a_fit_recovers_all_of_them_at_once() {
    let truth = any_arm(&mut rng(1), JOINTS).with_effects(all_effects()).unwrap();
    let mut problem = problem(without(&truth), &truth, 500, None);
    let free: Vec<usize> = (0..truth.parameter_count()).collect();
    let fitted = fit(&mut problem, &free, &Options::default(), &Unwatched).unwrap();
    assert!(fitted.rms_mm < 1e-9, "{:e}", fitted.rms_mm);
    let parameters = fitted.solution.parameters.iter().zip(truth.parameters());
    let scale = truth.moves_mm(truth.reach_mm(1));
    for (j, (found, true_value)) in parameters.enumerate().skip(truth.geometry_count()) {
        // lengths see an arm from nowhere but itself
        assert_eq!(fitted.identifiability.in_lost[j], of_base(&fitted.names[j]), "{}", fitted.names[j]);
        if of_base(&fitted.names[j]) {
            continue;
        }
        assert!((found - true_value).abs() * scale[j] < 1e-6, "{}: {found} {true_value}", fitted.names[j]);
    }
}

#[test]
fn repeated_calibrations_scatter_as_the_covariance_says() {
    let truth = any_arm(&mut rng(1), JOINTS).with_effects(all_effects()).unwrap();
    let noise = Noise { encoder_rad: vec![2e-5; JOINTS], seat_mm: 0.01 };
    let problem = problem(truth.clone(), &truth, 300, Some(noise));
    let free: Vec<usize> = (0..truth.parameter_count()).collect();
    let repeat = Repeat { truth: &truth, first: 0, runs: 60, seed: 3, threads: 1, uncertainties: true };
    let runs = recalibrate(&problem, &free, &repeat, &Unwatched).unwrap();
    let mut ratios = Vec::new();
    let names = truth.parameter_names();
    for j in (truth.geometry_count()..truth.parameter_count()).filter(|&j| !of_base(&names[j])) {
        ratios.extend(runs.iter().map(|run| ((run.parameters[j] - truth.parameters()[j]) / run.u[j]).powi(2)));
    }
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    // 60 runs of some 50 parameters, no two independent: a mean of ten is a poor one of 60
    assert!((0.8..1.2).contains(&mean), "{mean}");
}

#[test]
fn two_touches_of_a_bar_approached_differently_are_a_length() {
    let arm = any_arm(&mut rng(1), JOINTS).with_effects(all_effects()).unwrap();
    let (q_rad, told) = (angles(&mut rng(2), JOINTS * 20), Told::any(&mut rng(3), 20, 1, JOINTS));
    let bar = Artefact { name: "bar", features_mm: Some(&[[0.0; 3], [443.0, 0.0, 0.0]]), ..Artefact::default() };
    let feature: Vec<usize> = (0..20).map(|row| row % 2).collect();
    let placement: Vec<i64> = (0..20).map(|row| row / 2).collect();
    let rows = Rows {
        poses: told.at(&q_rad),
        probe: &[0; 20],
        feature: Some(&feature),
        placement: Some(&placement),
        ..Rows::default()
    };
    let mut problem = Problem::new(arm.clone(), None).unwrap();
    problem.add("points", &bar, &rows).unwrap();
    let model = Model::new(&arm);
    let group = &problem.groups()[0];
    let at = At { model: &model, dimensions: &[] };
    let apart_mm = |k: usize| (tip(&arm, 0, &told, &q_rad, 2 * k) - tip(&arm, 0, &told, &q_rad, 2 * k + 1)).norm();
    let lengths = group.as_lengths().unwrap();
    assert_eq!(lengths.len(), 10);
    for (k, residual) in lengths.unweighted(at).residuals_mm.iter().enumerate() {
        assert!((residual - (apart_mm(k) - 443.0)).abs() < 1e-9, "{k}");
    }
    // as the touches that they are, each end has half of it
    assert_eq!(group.len(), 20);
    for (row, residual) in group.unweighted(at).residuals_mm.chunks_exact(3).enumerate() {
        let off_mm = 0.5 * (apart_mm(row / 2) - 443.0).abs();
        assert!((nalgebra::Vector3::from_column_slice(residual).norm() - off_mm).abs() < 1e-9, "{row}");
    }
}

#[test]
fn half_the_backlash_lies_on_either_side() {
    let arm = any_arm(&mut rng(1), JOINTS);
    let zero = Effects { backlash: all_effects().backlash, ..Effects::default() };
    let backlash = zero.backlash.clone().unwrap().rad;
    let bent = arm.with_effects(zero).unwrap();
    let q_rad = angles(&mut rng(2), JOINTS);
    let approach = [1.0, -1.0, 0.0, 1.0, 1.0, -1.0];
    // approached so, an arm with play stands where one without stands at other angles
    let moved: Vec<f64> = (0..JOINTS).map(|i| q_rad[i] + 0.5 * backlash[i] * approach[i]).collect();
    let conditions = Conditions { approach: &approach, ..Conditions::default() };
    let there = tip_mm(&bent, 0, Pose { q_rad: &q_rad, conditions });
    assert!((there - tip_mm(&arm, 0, &moved)).norm() < 1e-10);
    assert!((tip_mm(&bent, 0, &q_rad) - tip_mm(&arm, 0, &q_rad)).norm() < 1e-12);
    let names = bent.parameter_names();
    assert_eq!(names[bent.geometry_count() + 2], "joint.3.backlash");
    assert_eq!(bent.parameter_units()[bent.geometry_count()], Unit::Rad);
}

/// Joint 3 turns with joint 2's encoder too, joint 6 with those of 4 and 5.
fn coupled() -> (Arm, Arm, Coupling) {
    let arm = any_arm(&mut rng(1), JOINTS);
    let others = vec![vec![], vec![], vec![1], vec![], vec![], vec![3, 4]];
    let coupling = Coupling { others, ratios: vec![1.0, -0.5, 0.25] };
    let bound = arm.with_effects(Effects { coupling: Some(coupling.clone()), ..Effects::default() }).unwrap();
    (arm, bound, coupling)
}

#[test]
fn a_coupled_joint_turns_with_the_encoders_of_others() {
    let (arm, bound, coupling) = coupled();
    let q_rad = angles(&mut rng(2), JOINTS);
    let mut turned = q_rad.clone();
    coupling.pairs().for_each(|(joint, other, ratio)| turned[joint] += ratio * q_rad[other]);
    assert!((tip_mm(&bound, 0, &q_rad) - tip_mm(&arm, 0, &turned)).norm() < 1e-10);
    let names = bound.parameter_names();
    assert_eq!(names[bound.geometry_count()..], ["joint.3.coupling2", "joint.6.coupling4", "joint.6.coupling5"]);
    assert_eq!(bound.joint_of(bound.geometry_count() + 1), Some(5));
}

#[test]
fn noise_of_an_encoder_moves_every_joint_that_turns_with_it() {
    let (_, bound, _) = coupled();
    let sigma: Vec<f64> = (1..=JOINTS).map(|i| 1e-5 * i as f64).collect();
    let noise = Noise { encoder_rad: sigma.clone(), seat_mm: 0.01 };
    let mut problem = Problem::new(bound.clone(), Some(noise)).unwrap();
    let (q, p) = (angles(&mut rng(2), JOINTS), angles(&mut rng(3), JOINTS));
    let (from, to) = (tip_mm(&bound, 0, &q), tip_mm(&bound, 0, &p));
    let length_mm = (from - to).norm() - 1.0;
    let rows = Rows {
        poses: Angles::cold(&q),
        second: Some(Angles::cold(&p)),
        probe: &[0],
        measured_mm: Some(&[length_mm]),
        ..Rows::default()
    };
    problem.add("length", &Artefact { name: "rows", ..Artefact::default() }, &rows).unwrap();
    let at =
        Artefact { name: "at", features_mm: Some(&[[1.0, 2.0, 3.0]]), frame: Some(Frame::Arm), ..Artefact::default() };
    let rows =
        Rows { poses: Angles::cold(&q), probe: &[0], feature: Some(&[0]), placement: Some(&[0]), ..Rows::default() };
    problem.add("points", &at, &rows).unwrap();
    problem.weigh(&problem.parameters(), Weighing::Full);
    let whitened = problem.whitened(&problem.parameters());

    let covariance = |pose: &[f64]| {
        let jacobian = encoder_jacobian(&bound, 0, pose);
        let scaled = &jacobian * nalgebra::DMatrix::from_diagonal(&nalgebra::DVector::from_column_slice(&sigma));
        &scaled * scaled.transpose() + nalgebra::Matrix3::from_diagonal_element(0.01_f64.powi(2))
    };
    let u = (from - to).normalize();
    let variance = u.dot(&((covariance(&q) + covariance(&p)) * u));
    let squared = |group: usize| whitened[group].norms.iter().map(|r| r * r).sum::<f64>();
    assert!((squared(0) * variance - 1.0).abs() < 1e-9, "{}", squared(0) * variance);
    let off = from - nalgebra::Point3::new(1.0, 2.0, 3.0);
    let expected = off.dot(&(covariance(&q).try_inverse().unwrap() * off));
    // where directions differ in what is known of them, a millionth is added to all of them
    assert!((squared(1) / expected - 1.0).abs() < 1e-4, "{} {expected}", squared(1));
}

fn stated(kind: &str, arrays: &[(&str, &[usize], &[f64])]) -> Stated {
    let array = |shape: &[usize], values: &[f64]| Array { shape: shape.to_vec(), values: values.to_vec() };
    Stated::new(kind, arrays.iter().map(|(name, shape, values)| ((*name).to_string(), array(shape, values))))
}

#[test]
fn effects_are_made_of_numbers_with_names() {
    let given = [
        stated("backlash", &[("backlash_rad", &[2], &[1e-4, 2e-4])]),
        stated("encoder-harmonics", &[("orders", &[1], &[2.0]), ("amplitudes_rad", &[2, 1, 2], &[0.1, 0.2, 0.3, 0.4])]),
    ];
    let effects = Effects::from_stated(given, 2).unwrap();
    let harmonics = Harmonics { orders: vec![2], amplitudes_rad: vec![[0.1, 0.2], [0.3, 0.4]] };
    assert_eq!(effects.harmonics, Some(harmonics));
    assert_eq!(effects.backlash.unwrap().rad, [1e-4, 2e-4]);
    assert!(effects.expansion.is_none() && effects.compliance.is_none());
}

#[test]
fn what_is_stated_badly_is_refused_in_words() {
    let two: (&str, &[usize], &[f64]) = ("backlash_rad", &[2], &[1e-4, 2e-4]);
    let nine: (&str, &[usize], &[f64]) = ("amplitudes_rad", &[2, 1, 2], &[0.0; 4]);
    let told: BTreeMap<&str, Vec<Stated>> = BTreeMap::from([
        (
            "there is no effect \"slack\"; expected one of [\"encoder-harmonics\", \"backlash\", \"coupling\", \
             \"link-expansion\", \"compliance\", \"base-tilt\", \"base-offset\"]",
            vec![stated("slack", &[])],
        ),
        ("backlash_rad of effect \"backlash\" is not stated", vec![stated("backlash", &[])]),
        ("effect \"backlash\" has no \"size\"", vec![stated("backlash", &[two, ("size", &[], &[1.0])])]),
        ("effect \"backlash\" is stated twice", vec![stated("backlash", &[two]), stated("backlash", &[two])]),
        (
            "backlash_rad of effect \"backlash\" has the shape [3], expected [2]",
            vec![stated("backlash", &[("backlash_rad", &[3], &[0.0; 3])])],
        ),
        (
            "an order of harmonics is 1.5; a whole number from 1 to 1e6 was expected",
            vec![stated("encoder-harmonics", &[("orders", &[1], &[1.5]), nine])],
        ),
    ]);
    for (message, given) in told {
        assert_eq!(Effects::from_stated(given, 2).unwrap_err().to_string(), message);
    }
    let harmonics = Some(Harmonics::zero(&[2, 1], JOINTS));
    let refused = any_arm(&mut rng(1), JOINTS).with_effects(Effects { harmonics, ..Effects::default() });
    assert_eq!(refused.unwrap_err().to_string(), "the orders of harmonics are [2, 1]; expected 1 or more, ascending");
}

#[test]
fn an_approach_is_from_one_side_or_the_other() {
    let arm = any_arm(&mut rng(1), JOINTS);
    let mut problem = Problem::new(arm, None).unwrap();
    let q_rad = angles(&mut rng(2), JOINTS);
    for (approach, message) in [
        (vec![1.0; 5], "the approaches of the second poses has 5 values, expected 6"),
        (
            vec![1.0, -1.0, 0.5, 1.0, 1.0, 1.0],
            "an approach of the second poses is 0.5; +1 (the encoder angle had been rising), -1 (falling) or 0 \
             (unknown) was expected",
        ),
    ] {
        let told = Told { warmth_k: vec![], approach, payload: vec![] };
        let rows = Rows {
            poses: ulna::kinematics::Angles::cold(&q_rad),
            second: Some(told.at(&q_rad)),
            probe: &[0],
            measured_mm: Some(&[443.0]),
            ..Rows::default()
        };
        let bar = Artefact { name: "bar", ..Artefact::default() };
        assert_eq!(problem.add("length", &bar, &rows).unwrap_err().to_string(), message);
    }
}
