//! The kind, and what only it knows of its statement.

use super::features::Unknown;
use super::touched::Points;
use crate::artefacts::kind::{Asked, Kind, Statement};
use crate::artefacts::placed::{Group, Placed};
use crate::artefacts::readings::Readings;
use crate::artefacts::stated::{Column, Frame, Rows};
use crate::artefacts::touches::Touches;
use crate::error::Result;
use nalgebra::Vector3;

/// The kind; of two features the length may be a dimension, else what each feature is uncertain of.
pub(in crate::artefacts::kinds) const KIND: Kind = Kind {
    name: "points",
    needs: &[Column::Features, Column::Feature],
    takes: &[Column::Labels, Column::FeatureUncertainty, Column::FeaturesFitted, Column::Frame, Column::Placement],
    dimensions: &[Asked::length("length", false)],
    readings,
};

fn readings(statement: &Statement) -> Result<Box<dyn Readings>> {
    let frame = statement.stated.frame.unwrap_or(Frame::Free);
    let rows = match frame {
        Frame::Free if statement.rows.placement.is_none() => return Err(statement.missing(Column::Placement.name())),
        Frame::Free => *statement.rows,
        // nothing is to be placed
        Frame::Arm => Rows { placement: None, ..*statement.rows },
    };
    let features_mm: Vec<Vector3<f64>> =
        statement.stated.features_mm.unwrap_or_default().iter().map(|&at| at.into()).collect();
    let touches = Touches::new(&rows, statement.arm.encoders());
    let mut counts = vec![0; features_mm.len()];
    touches.feature.iter().for_each(|&feature| counts[feature] += 1);
    let Unknown { dimensions, moves, of_its_own } = Unknown::new(statement, &features_mm, frame, &counts)?;
    let points = Points::new(features_mm, frame, moves, of_its_own, &touches);
    Ok(Box::new(Placed { group: Group { touches, dimensions }, kind: points }))
}
