//! Touches of features told as lengths between pairs of them.

use super::touched::Points;
use crate::artefacts::kinds::length::Lengths;
use crate::artefacts::placed::Group;
use crate::artefacts::readings::Readings;
use crate::artefacts::stated::Frame;
use crate::artefacts::touches::Touches;
use std::ops::Range;

/// See [`Readings::as_lengths`].
pub(super) fn pairs(points: &Points, group: &Group) -> Option<Box<dyn Readings>> {
    let told = points.frame == Frame::Free && points.placements.iter().all(|placement| placement.span > 0);
    let touches = &group.touches;
    let pairs: Vec<(usize, usize)> = touches.standings.iter().flat_map(|rows| pairs_of(touches, rows)).collect();
    if !told || pairs.is_empty() {
        return None;
    }
    Some(Box::new(between(points, touches, &pairs)))
}

/// Pairs of touches as lengths between them.
fn between(points: &Points, touches: &Touches, pairs: &[(usize, usize)]) -> Lengths {
    let feature = |row: usize| points.features_mm[touches.feature[row]];
    let probe: Vec<usize> = pairs.iter().map(|&(from, _)| touches.probe[from]).collect();
    let length_mm: Vec<f64> = pairs.iter().map(|&(from, to)| (feature(from) - feature(to)).norm()).collect();
    Lengths::between(&probe, &length_mm, None, |rows| {
        let end = |row_of: fn(&(usize, usize)) -> usize| {
            touches.poses.picked(&rows.iter().map(|&row| row_of(&pairs[row])).collect::<Vec<_>>())
        };
        [end(|pair| pair.0), end(|pair| pair.1)]
    })
}

/// Touches of one standing in pairs at different features, with one probe each: every touch with three others at most,
/// as many as hold a body of points together.
fn pairs_of(touches: &Touches, rows: &Range<usize>) -> Vec<(usize, usize)> {
    let apart = |a: usize, b: usize| {
        let same = touches.feature[a] == touches.feature[b];
        !same && touches.probe[a] == touches.probe[b]
    };
    let half = rows.len() / 2;
    let partners = |a: usize| {
        let others = (0..rows.len()).map(move |k| rows.start + (a - rows.start + half + k) % rows.len());
        others.filter(move |&b| b > a && apart(a, b)).take(3).map(move |b| (a, b)).collect::<Vec<_>>()
    };
    rows.clone().flat_map(partners).collect()
}
