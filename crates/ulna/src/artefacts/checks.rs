//! Statements on their way into a problem: what cannot be used is refused, with its name and value.

use super::stated::{Rows, Stated};
use crate::arm::Arm;
use crate::error::{Error, Result};
use crate::kinematics::Angles;

/// What no arm and no artefact has: ten kilometres.
pub(crate) const MOST_MM: f64 = 1e7;
/// What no noise is: less than this is a slip, and its weights would not fit into a number.
pub(crate) const LEAST_NOISE: f64 = 1e-12;

/// The rows: shapes that agree, probes that exist, numbers that are finite.
pub(super) fn check_rows(rows: &Rows, arm: &Arm) -> Result<()> {
    let count = rows.probe.len();
    check_angles("poses", rows.poses, count, arm)?;
    if let Some(second) = rows.second {
        check_angles("second poses", second, count, arm)?;
    }
    check_indices("probe", rows.probe, arm.probes().len())?;
    let lengths = [
        ("the features touched", rows.feature.map(<[_]>::len)),
        ("the placement labels", rows.placement.map(<[_]>::len)),
        ("what was measured", rows.measured_mm.map(<[_]>::len)),
        ("the orientations measured", rows.rotation_rad.map(<[_]>::len)),
        ("the orientations' uncertainties", rows.rotation_u_rad.map(<[_]>::len)),
    ];
    for (what, got) in lengths {
        check_count(what, got.unwrap_or(count), count)?;
    }
    let turned = rows.rotation_rad.unwrap_or_default().as_flattened();
    if let Some(&value) = turned.iter().find(|value| !value.is_finite()) {
        return Err(Error::NotFinite { what: "an orientation measured".into(), value });
    }
    if let Some(&value) = rows.rotation_u_rad.unwrap_or_default().iter().find(|u| !(**u >= 0.0 && u.is_finite())) {
        let what = "the uncertainty of an orientation, rad,".into();
        return Err(Error::OutOfRange { what, value, expected: "a number not below zero" });
    }
    let measured = rows.measured_mm.unwrap_or_default();
    measured.iter().try_for_each(|&value| check_within("a measured length, mm,", value, (-MOST_MM, MOST_MM)))
}

/// The artefact: as many names and uncertainties as features, balls that probes can have.
pub(super) fn check_stated(stated: &Stated, rows: &Rows, arm: &Arm) -> Result<()> {
    let features = stated.features_mm.unwrap_or_default();
    let coordinate = format!("a coordinate of artefact {}, mm,", stated.name);
    features.as_flattened().iter().try_for_each(|&value| check_within(&coordinate, value, (-MOST_MM, MOST_MM)))?;
    check_count("the features' names", stated.labels.map_or(features.len(), <[_]>::len), features.len())?;
    check_count("the features' uncertainties", stated.feature_u_mm.map_or(features.len(), <[_]>::len), features.len())?;
    for &value in stated.feature_u_mm.unwrap_or_default() {
        if !(value.is_finite() && value >= 0.0) {
            let what = format!("the uncertainty of artefact {}", stated.name);
            return Err(Error::OutOfRange { what, value, expected: "a number not below zero" });
        }
    }
    if let Some(touched) = rows.feature {
        check_indices("feature", touched, features.len())?;
    }
    let Some(balls_mm) = stated.balls_mm else { return Ok(()) };
    check_count("the diameters of the probes' balls", balls_mm.len(), arm.probes().len())?;
    for (probe, &value) in arm.probes().iter().zip(balls_mm).enumerate().filter_map(|(k, each)| {
        // balls of probes that took no reading do not matter
        rows.probe.contains(&k).then_some(each)
    }) {
        let what = format!("the diameter of the ball of probe {}, mm,", probe.name);
        check_within(&what, value, (0.0, MOST_MM))?;
    }
    Ok(())
}

/// A number of some size.
pub(super) fn check_within(what: &str, value: f64, (least, most): (f64, f64)) -> Result<()> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    let expected = match least {
        0.0 => "a number from 0 to 1e7",
        l if l > 0.0 => "a number from 1e-6 to 1e7",
        _ => "a number from -1e7 to 1e7",
    };
    Err(Error::OutOfRange { what: what.into(), value, expected })
}

fn check_count(what: &str, got: usize, expected: usize) -> Result<()> {
    if got == expected { Ok(()) } else { Err(Error::Shape { what: what.into(), got, expected }) }
}

fn check_indices(what: &'static str, indices: &[usize], count: usize) -> Result<()> {
    match indices.iter().find(|&&index| index >= count) {
        Some(&index) => Err(Error::NoSuch { what, index: index as i64, count }),
        None => Ok(()),
    }
}

fn check_angles(what: &str, angles: Angles, rows: usize, arm: &Arm) -> Result<()> {
    check_count(&format!("the {what}"), angles.q_rad.len(), rows * arm.encoders())?;
    if let Some(&value) = angles.q_rad.iter().find(|v| !v.is_finite()) {
        return Err(Error::NotFinite { what: format!("an angle of the {what}"), value });
    }
    angles.conditions.check(what, rows, arm.encoders())
}
