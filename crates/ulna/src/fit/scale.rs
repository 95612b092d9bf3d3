//! Lengths off their drawing by one factor: the mark of a stated length that is wrong.
//!
//! Readings of lengths alone know no other unit than the length that was stated: an arm, its tip and the artefact grow
//! together, and every residual with them. Where the artefact is stated too short by a fifth, so is every link, and the
//! readings are met as well as ever. Only the drawing can tell.

use crate::arm::Unit;
use crate::fit::way::OFF_DRAWING;
use crate::identify::identifiability::Known;
use crate::problem::Problem;

/// Factors nearer to 1 are within what drawings and bars are off by anyhow.
const NEAR: f64 = 2e-3;
/// What one factor leaves of the lengths' differences from the drawing, in parts, root mean square, if it is to tell them.
const LEFT: f64 = 0.25;
/// Shorter ones than this part of the longest tell nothing: a drawing's own error is as large.
const SHORT: f64 = 0.02;
/// With fewer lengths one factor always tells much.
const FEWEST: usize = 3;
/// Beyond this, up or down, no drawing was meant.
const CONTRADICTS: f64 = 2.0;

/// One factor between the lengths found and the lengths drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommonFactor {
    /// Found over drawn.
    pub factor: f64,
    /// Whether no drawing could be so far off: the arm or the artefact is stated in another unit, or wrongly.
    pub contradicts: bool,
}

/// The factor by which all lengths of an arm are off those at the start, where one factor s tells most of it: by least
/// squares, s = Σ ab / Σ a², a drawn, b found, and what is left in parts of each length, (b − sa) / a without what it may
/// be off by anyhow, is at most a quarter of |s − 1|, root mean square.
///
/// `drawn`, `found`: all parameters; `determined`: those to look at, of which lengths of the arm's geometry count.
/// None too where the differences are no more than a length is known to before.
pub(super) fn common_factor(
    problem: &Problem,
    drawn: &[f64],
    found: &[f64],
    determined: &[usize],
    known: Known,
) -> Option<CommonFactor> {
    let units = problem.parameter_units();
    let is_length = |j: &usize| *j < problem.arm().geometry_count() && units[*j] == Unit::Mm;
    let lengths: Vec<(f64, f64)> = determined.iter().copied().filter(is_length).map(|j| (drawn[j], found[j])).collect();
    let longest = lengths.iter().fold(0.0, |most: f64, (a, _)| most.max(a.abs()));
    let telling: Vec<(f64, f64)> = lengths.into_iter().filter(|(a, _)| a.abs() > SHORT * longest).collect();
    if telling.len() < FEWEST {
        return None;
    }
    let squares: f64 = telling.iter().map(|(a, _)| a * a).sum();
    let factor = telling.iter().map(|(a, b)| a * b).sum::<f64>() / squares;
    let part_left = |(a, b): &(f64, f64)| ((b - factor * a).abs() - known.length_mm).max(0.0) / a;
    let left = telling.iter().map(|length| part_left(length).powi(2)).sum::<f64>() / telling.len() as f64;
    let off = (factor - 1.0).abs() * longest;
    let told = left.sqrt() <= LEFT * (factor - 1.0).abs();
    let contradicts = !(1.0 / CONTRADICTS..=CONTRADICTS).contains(&factor) && off > OFF_DRAWING * known.length_mm;
    (told && (factor - 1.0).abs() > NEAR && off > known.length_mm).then_some(CommonFactor { factor, contradicts })
}
