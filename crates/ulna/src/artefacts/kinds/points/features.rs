//! An artefact's features, and which of their coordinates are not known exactly.

use crate::arm::Unit;
use crate::artefacts::dimension::Dimension;
use crate::artefacts::kind::Statement;
use crate::artefacts::stated::Frame;
use crate::error::Result;
use nalgebra::{Matrix3, Vector3};

/// A dimension of the artefact, and which feature it moves, in which direction of the artefact's frame.
pub(super) type Move = (usize, Vector3<f64>);

/// What is not known of an artefact's features.
#[derive(Debug, Clone)]
pub(super) struct Unknown {
    /// the dimensions that are not known
    pub dimensions: Vec<Dimension>,
    /// whether the one dimension is the distance of the two features
    pub is_length: bool,
    /// what each moves
    pub moves: Vec<Move>,
    /// for each feature the variance that it adds to its own reading alone, mm², where it was touched just once
    pub of_its_own: Vec<f64>,
}

/// Features this close to a line, as a part of the artefact's size, are in line.
const IN_LINE: f64 = 1e-8;
/// A length that is stated twice is the same but for this part of it.
const SAME: f64 = 1e-9;

impl Unknown {
    /// Of features touched so many times each.
    ///
    /// Of features in line only the place along the line is a dimension: across it they cannot be told from a turn of the
    /// artefact about itself. A feature touched once has an error of its own instead of a dimension.
    pub fn new(
        statement: &Statement,
        features_mm: &[Vector3<f64>],
        frame: Frame,
        touches: &[usize],
    ) -> Result<Unknown> {
        let stated = statement.stated;
        let mut unknown =
            Unknown { dimensions: vec![], is_length: false, moves: vec![], of_its_own: vec![0.0; features_mm.len()] };
        let each_mm = stated.feature_u_mm.unwrap_or_default();
        if let Some(size) = statement.size("length") {
            unknown.of_a_bar(statement, features_mm, frame, size.value)?;
            if each_mm.iter().any(|&u_mm| u_mm > 0.0) {
                let why = "its length is stated and feature_u_mm as well; one of them was expected";
                return Err(statement.contradiction(why.into()));
            }
        }
        if features_mm.len() == 1 && frame == Frame::Free {
            return Ok(unknown);
        }
        let line = if frame == Frame::Free { line_of(features_mm) } else { None };
        for (k, &u_mm) in each_mm.iter().enumerate().filter(|(_, u)| **u > 0.0) {
            if touches[k] <= 1 {
                unknown.of_its_own[k] = u_mm * u_mm;
                continue;
            }
            let label = stated.labels.map_or_else(|| (k + 1).to_string(), |labels| labels[k].clone());
            let axes = match line {
                Some(along) => vec![("along", along)],
                None => (0..3).map(|j| (["x", "y", "z"][j], Vector3::ith(j, 1.0))).collect(),
            };
            for (axis, direction) in axes {
                unknown.dimensions.push(Dimension {
                    name: format!("artefact.{}.{label}.{axis}", stated.name),
                    unit: Unit::Mm,
                    value: features_mm[k].dot(&direction),
                    u: u_mm,
                    fitted: stated.features_fitted,
                });
                unknown.moves.push((k, direction));
            }
        }
        Ok(unknown)
    }

    /// The length of two features, as stated, if it is not known exactly.
    fn of_a_bar(
        &mut self,
        statement: &Statement,
        features_mm: &[Vector3<f64>],
        frame: Frame,
        length_mm: f64,
    ) -> Result<()> {
        let [first, second] = features_mm else {
            let why = format!("a length is stated, but there are {} features; 2 were expected", features_mm.len());
            return Err(statement.contradiction(why));
        };
        if frame == Frame::Arm {
            let why = "a length is stated, but coordinates hold in the arm's frame; feature_u_mm was expected";
            return Err(statement.contradiction(why.into()));
        }
        let between = second - first;
        if (between.norm() - length_mm).abs() > SAME * length_mm {
            let why =
                format!("its length is stated as {length_mm} mm, but its features are {} mm apart", between.norm());
            return Err(statement.contradiction(why));
        }
        if let Some(length) = statement.dimension("length") {
            self.dimensions.push(length);
            self.is_length = true;
            self.moves.push((1, between.normalize()));
        }
        Ok(())
    }
}

/// The direction of the line that all features are on, if they are.
fn line_of(points: &[Vector3<f64>]) -> Option<Vector3<f64>> {
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
