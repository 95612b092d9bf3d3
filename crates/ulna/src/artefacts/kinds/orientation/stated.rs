//! The kind, and what only it knows of its statement.

use super::attitudes::Attitudes;
use crate::arm::Unit;
use crate::artefacts::kind::{Asked, Kind, Statement};
use crate::artefacts::placed::{Group, Placed};
use crate::artefacts::readings::Readings;
use crate::artefacts::standings::Standings;
use crate::artefacts::stated::{Column, Frame};
use crate::artefacts::touches::Touches;
use crate::error::Result;
use nalgebra::{Rotation3, Vector3};

/// How the target is mounted, a rotation vector in the probe's frame.
pub(super) const MOUNT: [&str; 3] = ["rx", "ry", "rz"];

const fn turn(name: &'static str) -> Asked {
    Asked { name, unit: Unit::Rad, needed: true, range: (-7.0, 7.0), expected: "a number from -7 to 7" }
}

/// The kind.
pub(in crate::artefacts::kinds) const KIND: Kind = Kind {
    name: "orientation",
    needs: &[Column::Rotation],
    takes: &[Column::RotationUncertainty, Column::Frame, Column::Placement],
    dimensions: &[turn(MOUNT[0]), turn(MOUNT[1]), turn(MOUNT[2]), Asked::length("lever", true)],
    readings,
};

fn readings(statement: &Statement) -> Result<Box<dyn Readings>> {
    let frame = statement.stated.frame.unwrap_or(Frame::Free);
    let rows = statement.rows_in(frame)?;
    let lever = statement.size("lever");
    if lever.is_some_and(|lever| lever.fitted || lever.u > 0.0) {
        let why = "its lever says how an angle counts beside a length; there is nothing uncertain about it".into();
        return Err(statement.contradiction(why));
    }
    let lever_mm = lever.map_or(0.0, |lever| lever.value);
    let touches = Touches::new(&rows, statement.arm.encoders(), Standings::new(&rows), |row| row);
    let measured = rows.rotation_rad.unwrap_or_default();
    let u_rad = rows.rotation_u_rad;
    let (unknown, dimensions) =
        MOUNT.iter().enumerate().filter_map(|(axis, name)| Some((axis, statement.dimension(name)?))).unzip();
    let attitudes = Attitudes::new(
        frame,
        Vector3::from(MOUNT.map(|name| statement.size(name).map_or(0.0, |size| size.value))),
        unknown,
        lever_mm,
        touches.order.iter().map(|&row| Rotation3::new(Vector3::from(measured[row]))).collect(),
        touches.order.iter().map(|&row| lever_mm * u_rad.map_or(0.0, |each| each[row])).collect(),
    );
    Ok(Box::new(Placed { group: Group { touches, dimensions }, kind: attitudes }))
}
