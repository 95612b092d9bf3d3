//! Touches of features told as lengths between pairs of them.

use super::touched::Points;
use crate::artefacts::dimension::Dimension;
use crate::artefacts::kinds::length::Lengths;
use crate::artefacts::placed::Group;
use crate::artefacts::readings::Readings;
use crate::artefacts::stated::{Frame, Rows};
use crate::artefacts::touches::Touches;
use crate::kinematics::Angles;
use std::ops::Range;

/// See [`Readings::as_lengths`].
pub(super) fn pairs(points: &Points, group: &Group) -> Option<Box<dyn Readings>> {
    let told = points.frame == Frame::Free && points.placements.iter().all(|placement| placement.span > 0);
    let touches = &group.touches;
    let pairs: Vec<(usize, usize)> = touches.standings.iter().flat_map(|rows| pairs_of(touches, rows)).collect();
    if !told || pairs.is_empty() {
        return None;
    }
    Some(Box::new(between(points, touches, &pairs, None)))
}

/// See [`Readings::lengths_alone`].
pub(super) fn alone(points: &Points, group: &Group) -> Option<Box<dyn Readings>> {
    let touches = &group.touches;
    let (feature, probe, poses) = (&touches.feature, &touches.probe, &touches.poses);
    let a_bar = |rows: &Range<usize>| {
        let (a, b) = (rows.start, rows.start + 1);
        let warm = |row: usize| poses.sample(row, 0).warmth_k;
        rows.len() == 2 && feature[a] != feature[b] && probe[a] == probe[b] && warm(a) == warm(b)
    };
    let two_features = points.frame == Frame::Free && points.features_mm.len() == 2;
    // what is not known of two features is their distance, or there is more to tell than that
    let known = points.of_its_own.iter().all(|&variance| variance == 0.0) && group.dimensions.len() <= 1;
    let apart = points.placements.iter().all(|placement| placement.span > 0);
    if !(two_features && known && apart && touches.standings.iter().all(a_bar)) {
        return None;
    }
    let pairs: Vec<(usize, usize)> = touches.standings.iter().map(|rows| (rows.start, rows.start + 1)).collect();
    Some(Box::new(between(points, touches, &pairs, group.dimensions.first().cloned())))
}

/// Pairs of touches as lengths between them.
fn between(points: &Points, touches: &Touches, pairs: &[(usize, usize)], length: Option<Dimension>) -> Lengths {
    let (mut q_rad, mut p_rad, mut warmth_k) = (vec![], vec![], vec![]);
    for &(from, to) in pairs {
        let (first, second) = (touches.poses.sample(from, 0), touches.poses.sample(to, 0));
        q_rad.extend(first.q_rad);
        p_rad.extend(second.q_rad);
        warmth_k.extend(first.warmth_k);
    }
    let feature = |row: usize| points.features_mm[touches.feature[row]];
    let rows = Rows {
        poses: Angles { q_rad: &q_rad, warmth_k: &warmth_k },
        probe: &pairs.iter().map(|&(from, _)| touches.probe[from]).collect::<Vec<_>>(),
        p_rad: Some(&p_rad),
        measured_mm: Some(&pairs.iter().map(|&(from, to)| (feature(from) - feature(to)).norm()).collect::<Vec<_>>()),
        ..Rows::default()
    };
    Lengths::new(&rows, touches.poses.encoders(), length)
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
