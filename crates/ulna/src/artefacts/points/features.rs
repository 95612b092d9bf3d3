//! An artefact's features, and which of their coordinates are not known exactly.

use crate::artefacts::dimension::Dimension;
use nalgebra::{Matrix3, Vector3};

/// Where an artefact's coordinates hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// In its own frame: each placement has an unknown pose.
    Free,
    /// In the arm's base frame.
    Arm,
}

/// What is not known of an artefact's features.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Uncertainty<'a> {
    /// Nothing: they are exact.
    None,
    /// Standard uncertainty of the distance between two features, mm.
    Length(f64),
    /// Standard uncertainty of the coordinates of each feature, mm.
    Each(&'a [f64]),
}

/// An artefact's features: coordinates, and how well they are known.
#[derive(Debug, Clone)]
pub struct Features<'a> {
    /// The artefact's name.
    pub name: &'a str,
    /// The name of each feature.
    pub labels: &'a [String],
    /// Coordinates, mm.
    pub coordinates_mm: &'a [[f64; 3]],
    /// How well they are known.
    pub u: Uncertainty<'a>,
    /// Whether they may move within their uncertainty: then they are unknowns of the fit.
    pub fitted: bool,
    /// Where the coordinates hold.
    pub frame: Frame,
}

/// A dimension of the artefact, and which feature it moves, in which direction of the artefact's frame.
pub(super) type Move = (usize, Vector3<f64>);

/// Features this close to a line, as a part of the artefact's size, are in line.
const IN_LINE: f64 = 1e-8;

/// The dimensions that are not known, each with what it moves; and for each feature the variance that it adds to its own
/// reading alone, mm², where it was touched just once: an error of its own for that reading.
///
/// Of features in line only the place along the line is a dimension: across it they cannot be told from a turn of the
/// artefact about itself.
pub(super) fn unknown(features: &Features, touches: &[usize]) -> (Vec<Dimension>, Vec<Move>, Vec<f64>) {
    let at = |k: usize| Vector3::from(features.coordinates_mm[k]);
    let mut of_its_own = vec![0.0; features.coordinates_mm.len()];
    let dimension =
        |name: String, value_mm: f64, u_mm: f64| Dimension { name, value_mm, u_mm, fitted: features.fitted };
    let name = features.name;
    match features.u {
        Uncertainty::None => (vec![], vec![], of_its_own),
        Uncertainty::Length(u_mm) if u_mm > 0.0 && features.coordinates_mm.len() == 2 => {
            let between = at(1) - at(0);
            let length = dimension(format!("artefact.{name}.length"), between.norm(), u_mm);
            (vec![length], vec![(1, between.normalize())], of_its_own)
        }
        Uncertainty::Length(_) => (vec![], vec![], of_its_own),
        Uncertainty::Each(each) => {
            let (mut dimensions, mut moves) = (vec![], vec![]);
            if features.coordinates_mm.len() == 1 && features.frame == Frame::Free {
                return (dimensions, moves, of_its_own);
            }
            let line = (features.frame == Frame::Free).then(|| line_of(features.coordinates_mm)).flatten();
            for (k, &u_mm) in each.iter().enumerate().filter(|(_, u)| **u > 0.0) {
                if touches[k] <= 1 {
                    of_its_own[k] = u_mm * u_mm;
                    continue;
                }
                let label = &features.labels[k];
                let axes = match line {
                    Some(along) => vec![("along", along)],
                    None => (0..3).map(|j| (["x", "y", "z"][j], Vector3::ith(j, 1.0))).collect(),
                };
                for (axis, direction) in axes {
                    let value_mm = at(k).dot(&direction);
                    dimensions.push(dimension(format!("artefact.{name}.{label}.{axis}"), value_mm, u_mm));
                    moves.push((k, direction));
                }
            }
            (dimensions, moves, of_its_own)
        }
    }
}

/// The direction of the line that all features are on, if they are.
fn line_of(coordinates_mm: &[[f64; 3]]) -> Option<Vector3<f64>> {
    let points: Vec<Vector3<f64>> = coordinates_mm.iter().map(|&c| c.into()).collect();
    let mean = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let scatter: Matrix3<f64> = points.iter().map(|p| (p - mean) * (p - mean).transpose()).sum();
    let eigen = scatter.symmetric_eigen();
    let (largest, size) = eigen.eigenvalues.argmax();
    let across = eigen.eigenvalues.sum() - size;
    let along: Vector3<f64> = eigen.eigenvectors.column(largest).into();
    // towards growing coordinates, so that the sign says something
    let along = if along[along.iamax()] < 0.0 { -along } else { along };
    (size > 0.0 && across <= size * IN_LINE * IN_LINE).then_some(along)
}
