//! Encoders that count nobody knows which way: signs found together with zero offsets.
//!
//! An encoder that counts the other way and an axis that points the other way are the same:
//! `Rz(t) = Rx(π) Rz(-t) Rx(π)`. So an arm with another sign of joint i is the same arm with half a turn more in alpha of
//! joints i-1 and i, and d and theta0 of joint i negated (of the first joint the base is turned over, of the last the
//! tip). Any signs with which the readings are explained will do, then; which of all such twins is meant, the nominal
//! arm says.

use crate::arm::{Arm, JointModel};
use crate::error::Result;
use crate::fit::search::{Plan, Throw, better_image, search_over, throw};
use crate::fit::symmetry::{Distance, Folded, Freedom, fold};
use crate::monitor::Monitor;
use crate::problem::Problem;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::f64::consts::PI;

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FoundSigns {
    /// Of every encoder.
    pub signs: Vec<f64>,
    /// Free parameters, with these signs.
    pub x: Vec<f64>,
    /// How many starts were tried.
    pub starts: usize,
    /// Sets of joints that may all count the other way: the readings and the nominal arm do not tell.
    pub undecided: Vec<Undecided>,
}

/// Joints that may all count the other way.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Undecided {
    /// From 0, ascending.
    pub joints: Vec<usize>,
    /// Whether the arm is then the mirror image of what was found; else it is the same arm, written differently.
    pub mirrored: bool,
}

/// Readings used for a start.
const READINGS: usize = 200;
/// More unknown signs than this are told apart one by one, not in all combinations.
const ALL_COMBINATIONS: u32 = 12;
/// Signs are undecided where others make an arm that is not this much farther from the nominal one.
const FARTHER: f64 = 2.0;
const FARTHER_MM: f64 = 1.0;

/// Finds zero offsets and the signs of the joints in `unknown` (a bit each). The free parameters are those of the geometry.
pub(crate) fn search(
    problem: &Problem,
    free: &[usize],
    given: &[f64],
    unknown: u64,
    plan: Plan,
    monitor: &dyn Monitor,
) -> Result<FoundSigns> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(plan.seed);
    let patterns = 1_usize << unknown.count_ones().min(ALL_COMBINATIONS);
    let thin = problem.for_search(READINGS);
    let found = search_over(thin, free, &[], given, plan, monitor, |thin, attempt, x| {
        // every combination comes up once in each round, in an order that looks like none
        let pattern = combination(attempt, patterns);
        let wide = if unknown.count_ones() > ALL_COMBINATIONS { rng.random::<u64>() } else { spread(pattern, unknown) };
        thin.set_arm(thin.arm().with_signs(&signed(thin.arm(), unknown, wide)));
        let known = plan.throw == Throw::Widening && attempt < patterns;
        if !known {
            throw(thin, free, plan.throw.width(attempt / patterns), x, &mut rng);
        }
    })?;
    let found = better_image(problem, free, &[], found, monitor)?;
    let nominal = problem.parameters();
    let mut parameters = nominal.clone();
    free.iter().zip(&found.x).for_each(|(&j, &value)| parameters[j] = value);
    let twin = nearest(problem, free, &found.signs, &parameters, unknown, plan.throw == Throw::Anywhere);
    Ok(FoundSigns {
        signs: twin.signs,
        x: free.iter().map(|&j| twin.parameters[j]).collect(),
        starts: found.starts,
        undecided: twin.undecided,
    })
}

/// One of so many combinations (a power of two) for each attempt: an odd step goes through all of them.
fn combination(attempt: usize, patterns: usize) -> usize {
    (attempt * ((patterns / 2) | 1) + 1) % patterns
}

/// The bits of a pattern at the places of `unknown`.
fn spread(pattern: usize, unknown: u64) -> u64 {
    let places = (0..64).filter(|i| unknown >> i & 1 == 1).enumerate();
    places.filter(|(bit, _)| pattern >> bit & 1 == 1).map(|(_, place)| 1 << place).sum()
}

/// The arm's signs, the unknown ones by a pattern.
fn signed(arm: &Arm, unknown: u64, negative: u64) -> Vec<f64> {
    let of = |(i, sign): (usize, f64)| match (unknown >> i & 1, negative >> i & 1) {
        (0, _) => sign,
        (_, 0) => 1.0,
        _ => -1.0,
    };
    arm.signs().enumerate().map(of).collect()
}

/// An arm that describes the same readings.
pub(crate) struct Twin {
    /// Of every encoder.
    pub signs: Vec<f64>,
    /// All parameters, with these signs.
    pub parameters: Vec<f64>,
    /// What neither the readings nor the nominal arm tell.
    pub undecided: Vec<Undecided>,
}

/// Of all arms that describe the same readings with other signs of some joints, the one nearest to the nominal arm.
pub(crate) fn nearest(
    problem: &Problem,
    free: &[usize],
    signs: &[f64],
    parameters: &[f64],
    unknown: u64,
    zero_offsets_unknown: bool,
) -> Twin {
    let (arm, nominal) = (problem.arm(), problem.parameters());
    let is_free = problem.is_free(free);
    let freedom = Freedom::of(problem, &is_free, zero_offsets_unknown);
    let distance = Distance::new(arm, &nominal, freedom);
    let joints: Vec<usize> = (0..arm.encoders()).filter(|i| unknown >> i & 1 == 1).collect();
    // a base that readings know cannot be turned over
    let turnable: Vec<usize> = joints.iter().copied().filter(|&i| i > 0 || problem.base_free()).collect();
    let with = |turned: &[usize]| {
        let (mut signs, mut twin) = (signs.to_vec(), parameters.to_vec());
        for &joint in turned {
            signs[joint] = -signs[joint];
            turn_over(arm, joint, &mut twin);
        }
        let folded = fold(arm, &twin, &nominal, freedom);
        (distance.of(&folded.parameters).sqrt(), signs, folded)
    };
    let subsets = 1_usize << turnable.len().min(ALL_COMBINATIONS as usize);
    let chosen = |subset: usize| -> Vec<usize> {
        turnable.iter().enumerate().filter(|(bit, _)| subset >> bit & 1 == 1).map(|(_, &joint)| joint).collect()
    };
    let all: Vec<(f64, Vec<f64>, Folded)> = (0..subsets).map(|subset| with(&chosen(subset))).collect();
    let plus = |signs: &[f64]| signs.iter().filter(|sign| **sign > 0.0).count();
    let least = all.iter().map(|(far, _, _)| *far).fold(f64::MAX, f64::min);
    // among equals the one with the most joints that count upwards
    let equal = all.iter().filter(|(far, _, _)| *far <= least * (1.0 + 1e-9) + 1e-9);
    let Some((far, signs, found)) = equal.max_by_key(|(_, signs, _)| plus(signs)) else {
        return Twin { signs: signs.to_vec(), parameters: parameters.to_vec(), undecided: vec![] };
    };
    let near = all.iter().filter(|(other, _, _)| *other < FARTHER * far + FARTHER_MM);
    let reversed = |others: &Vec<f64>| (0..signs.len()).filter(|&i| others[i] != signs[i]).collect::<Vec<_>>();
    let told = |(_, others, twin): &(f64, Vec<f64>, Folded)| Undecided {
        joints: reversed(others),
        mirrored: twin.mirrored() != found.mirrored(),
    };
    let mut undecided: Vec<Undecided> = near.map(told).collect();
    undecided.retain(|set| !set.joints.is_empty());
    undecided.sort_by_key(|set| (set.joints.len(), set.clone()));
    Twin { signs: signs.clone(), parameters: found.parameters.clone(), undecided }
}

/// The same arm, joint `i` counting the other way.
fn turn_over(arm: &Arm, i: usize, p: &mut [f64]) {
    let linked = arm.joints().len();
    if i > 0 {
        p[4 * (i - 1) + 1] += PI;
        if arm.joints()[i - 1].model == JointModel::Hayati {
            p[4 * (i - 1) + 3] = -p[4 * (i - 1) + 3];
        }
    }
    if i < linked {
        p[4 * i] = -p[4 * i];
        p[4 * i + 1] += PI;
        if arm.joints()[i].model == JointModel::Dh {
            p[4 * i + 3] = -p[4 * i + 3];
        }
    } else {
        for probe in 0..arm.probes().len() {
            let at = arm.tip_offset(probe);
            p[at + 1] = -p[at + 1];
            p[at + 2] = -p[at + 2];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::samples;
    use crate::kinematics::tip_mm;

    #[test]
    fn a_joint_that_counts_the_other_way_reaches_the_same_points() {
        let arm = samples::table2(10.0);
        for joint in 1..7 {
            let mut parameters = arm.parameters();
            turn_over(&arm, joint, &mut parameters);
            let mut signs = vec![1.0; 7];
            signs[joint] = -1.0;
            let twin = arm.with_parameters(&parameters).unwrap().with_signs(&signs);
            for seed in 0..20 {
                let q: [f64; 7] = std::array::from_fn(|i| ((seed * 7 + i) as f64 * 0.618).fract() * 5.0 - 2.5);
                assert!((tip_mm(&arm, 0, &q) - tip_mm(&twin, 0, &q)).norm() < 1e-9, "joint {joint}");
            }
        }
    }

    #[test]
    fn every_combination_comes_up_once_in_each_round() {
        for unknown in [0b1, 0b101, 0b1111111] {
            let patterns = 1_usize << u64::count_ones(unknown);
            let mut seen = vec![0; patterns];
            for attempt in 0..2 * patterns {
                seen[combination(attempt, patterns)] += 1;
            }
            assert!(seen.iter().all(|&count| count == 2), "{seen:?}");
            let all: std::collections::HashSet<u64> = (0..patterns).map(|p| spread(p, unknown)).collect();
            assert_eq!(all.len(), patterns);
        }
    }
}
