//! What no arm and no noise can be is refused in words that name it.

mod common;

use common::{any_arm, rng};
use ulna::artefacts::{KINDS, Noise, Rows, Size, Stated};
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

fn refused(kind: &str, stated: &Stated, rows: &Rows) -> String {
    let arm = any_arm(&mut rng(1), 5);
    Problem::new(arm, None).unwrap().add(kind, stated, rows).unwrap_err().to_string()
}

/// One reading of a pose.
fn one(q_rad: &[f64]) -> Rows<'_> {
    Rows { poses: Angles::cold(q_rad), probe: &[0], ..Rows::default() }
}

#[test]
fn a_length_that_is_none_is_refused() {
    for length_mm in [0.0, -1.0, 1e-300, 1e300, f64::NAN] {
        let rows = Rows { second: Some(Angles::cold(&[0.2; 5])), measured_mm: Some(&[length_mm]), ..one(&[0.1; 5]) };
        let message = refused("length", &Stated { name: "bar", ..Stated::default() }, &rows);
        assert!(message.contains(" length") && message.contains("mm, is "), "{message}");
    }
}

#[test]
fn a_kind_that_there_is_not_is_refused_with_those_that_there_are() {
    let message = refused("torus", &Stated { name: "ring", ..Stated::default() }, &one(&[0.1; 5]));
    assert!(message.starts_with("artefact ring is of kind \"torus\"; one of points, length, "), "{message}");
}

#[test]
fn what_a_kind_needs_and_lacks_is_named() {
    for kind in KINDS {
        let message = refused(kind.name, &Stated { name: "thing", ..Stated::default() }, &one(&[0.1; 5]));
        let expected = format!("artefact thing is of kind {:?}, which needs ", kind.name);
        assert!(message.starts_with(&expected), "{message}");
        let dimensions = kind.dimensions.iter().filter(|asked| asked.needed).map(|asked| asked.name);
        let named = kind.needs.iter().map(|column| column.name()).chain(dimensions);
        assert!(named.into_iter().any(|name| message.contains(name)), "{message}");
    }
}

#[test]
fn what_a_kind_has_no_use_for_is_named() {
    let stated = Stated { name: "table", balls_mm: Some(&[6.0, 6.0]), ..Stated::default() };
    let rows = Rows { placement: Some(&[0]), ..one(&[0.1; 5]) };
    let message = refused("plane", &Stated { inside: true, ..stated }, &rows);
    assert_eq!(message, "artefact table is of kind \"plane\", which has no use for inside; leave it out");
    let dimensions = &[Size { name: "width", value: 1.0, u: 0.0, fitted: false }];
    let message = refused("plane", &Stated { dimensions, ..stated }, &rows);
    assert!(message.contains("no use for the dimension \"width\""), "{message}");
}

#[test]
fn a_length_that_the_features_do_not_have_is_refused() {
    let dimensions = &[Size { name: "length", value: 443.0, u: 0.1, fitted: true }];
    let rows = Rows { feature: Some(&[0]), placement: Some(&[0]), ..one(&[0.1; 5]) };
    let bar =
        Stated { name: "bar", dimensions, features_mm: Some(&[[0.0; 3], [444.0, 0.0, 0.0]]), ..Stated::default() };
    let message = refused("points", &bar, &rows);
    assert_eq!(message, "artefact bar: its length is stated as 443 mm, but its features are 444 mm apart");
    let message = refused("points", &Stated { features_mm: Some(&[[0.0; 3]; 3]), ..bar }, &rows);
    assert!(message.contains("there are 3 features; 2 were expected"), "{message}");
}
