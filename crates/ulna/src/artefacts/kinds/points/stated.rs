//! The kind, and what only it knows of its statement.

use super::bars::Bars;
use super::features::Unknown;
use super::touched::Points;
use crate::artefacts::kind::{Asked, Kind, Statement};
use crate::artefacts::kinds::length::Lengths;
use crate::artefacts::parts::{Part, Parts};
use crate::artefacts::placed::{Group, Placed};
use crate::artefacts::readings::Readings;
use crate::artefacts::standings::Standings;
use crate::artefacts::stated::{Column, Frame, Rows};
use crate::artefacts::touches::Touches;
use crate::error::Result;
use crate::kinematics::Poses;
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
    let rows = statement.rows_in(frame)?;
    let features_mm: Vec<Vector3<f64>> =
        statement.stated.features_mm.unwrap_or_default().iter().map(|&at| at.into()).collect();
    let mut counts = vec![0; features_mm.len()];
    rows.feature.unwrap_or_default().iter().for_each(|&feature| counts[feature] += 1);
    let unknown = Unknown::new(statement, &features_mm, frame, &counts)?;
    Ok(by_standing(&rows, statement.arm.encoders(), frame, features_mm, unknown))
}

/// Standings of two features touched once each as lengths, where the distance of features is all that is uncertain of them
/// or nothing is; the others as touches.
fn by_standing(
    rows: &Rows,
    encoders: usize,
    frame: Frame,
    features_mm: Vec<Vector3<f64>>,
    unknown: Unknown,
) -> Box<dyn Readings> {
    let free = frame == Frame::Free && (unknown.dimensions.is_empty() || unknown.is_length);
    let feature = |row: usize| rows.feature.map_or(0, |feature| feature[row]);
    let length_mm = |rows: &[usize]| (features_mm[feature(rows[0])] - features_mm[feature(rows[1])]).norm();
    let known = |row: usize| unknown.of_its_own[feature(row)] == 0.0;
    let a_bar = |standing: &[usize]| match *standing {
        [a, b] => {
            let alike = rows.probe[a] == rows.probe[b];
            free && alike && known(a) && known(b) && length_mm(standing) > 0.0
        }
        _ => false,
    };
    let [(bars, bar_numbers), (others, other_numbers)] = Standings::new(rows).split(a_bar);
    // rows of the file as each part counts them
    let mut number = vec![0; rows.probe.len()];
    let [of_bars, of_others] = [&bars, &others].map(|part| {
        let mut of_part: Vec<u32> = part.order.iter().map(|&row| row as u32).collect();
        of_part.sort_unstable();
        of_part.iter().enumerate().for_each(|(k, &row)| number[row as usize] = k);
        of_part
    });
    let mut parts = Vec::new();
    if !bars.each.is_empty() {
        let probe: Vec<usize> = bars.order.iter().step_by(2).map(|&row| rows.probe[row]).collect();
        let stated_mm = unknown.dimensions.first().map(|length| length.value);
        let apart_mm = bars.order.chunks_exact(2).map(|pair| stated_mm.unwrap_or_else(|| length_mm(pair)));
        let lengths =
            Lengths::between(&probe, &apart_mm.collect::<Vec<_>>(), unknown.dimensions.first().cloned(), |own| {
                [0, 1].map(|end| {
                    let of_end: Vec<usize> = own.iter().map(|&k| bars.order[2 * k + end]).collect();
                    Poses::gathered(rows.poses, encoders, &of_end)
                })
            });
        let ends = bars.order.chunks_exact(2).map(|pair| [pair[0], pair[1]].map(|row| number[row] as u32)).collect();
        parts.push(Part { readings: Box::new(Bars::new(lengths, ends)), rows: of_bars, standings: bar_numbers });
    }
    if !others.each.is_empty() || parts.is_empty() {
        let Unknown { dimensions, moves, of_its_own, .. } = unknown;
        let touches = Touches::new(rows, encoders, others, |row| number[row]);
        let points = Points::new(features_mm, frame, moves, of_its_own, &touches);
        let readings = Box::new(Placed { group: Group { touches, dimensions }, kind: points });
        parts.push(Part { readings, rows: of_others, standings: other_numbers });
    }
    Parts::together(parts)
}
