//! The kinds of artefacts that there are: a line and a row for each, and nothing else that asks which one it is.

mod cylinder;
mod distance;
mod length;
mod orientation;
mod plane;
mod points;
mod sphere;

use super::kind::{Kind, Statement};
use super::readings::Readings;
use super::stated::{Rows, Stated};
use crate::arm::Arm;
use crate::error::{Error, Result};

/// Every kind.
pub const KINDS: &[Kind] =
    &[points::KIND, length::KIND, sphere::KIND, plane::KIND, cylinder::KIND, distance::KIND, orientation::KIND];

/// Dimensions of one artefact that are carried through a fit as columns of their own.
const MOST_DIMENSIONS: usize = 1500;

/// Readings of an artefact of some kind, taken by an arm.
///
/// # Errors
/// No such kind; what the kind needs is not stated, or something that it does not take; shapes that do not agree, an
/// unknown probe or feature, a value that is not finite or not of a size that it can have.
pub fn readings_of(kind: &str, stated: &Stated, rows: &Rows, arm: &Arm) -> Result<Box<dyn Readings>> {
    let artefact = || stated.name.to_string();
    let found = KINDS.iter().find(|known| known.name == kind).ok_or_else(|| Error::NoSuchKind {
        artefact: artefact(),
        kind: kind.into(),
        known: KINDS.iter().map(|known| known.name).collect::<Vec<_>>().join(", "),
    })?;
    let readings = (found.readings)(&Statement::checked(found, stated, rows, arm)?)?;
    let dimensions = readings.dimensions().len();
    if dimensions > MOST_DIMENSIONS {
        return Err(Error::TooManyDimensions { artefact: artefact(), dimensions, most: MOST_DIMENSIONS });
    }
    Ok(readings)
}
