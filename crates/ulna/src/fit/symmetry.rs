//! Parameter sets that describe the same readings, and the one among them nearest to the nominal arm.
//!
//! A joint flip turns the frame after joint i by π about the axis of joint i+1:
//! `theta0_i + π, alpha_i → -alpha_i, a_i → -a_i, theta0_{i+1} + π` (Hayati: beta as well), for the last link with the
//! tips' x and y negated. The mirror image negates all alpha, beta, d and the tips' z. (MODEL section 4)

use crate::arm::{Arm, JointModel, Unit};
use crate::problem::Problem;
use std::f64::consts::PI;

/// The twin nearest to a nominal arm.
#[derive(Debug, Clone, PartialEq)]
pub struct Folded {
    /// Its parameters.
    pub parameters: Vec<f64>,
    /// What led there: "flip of joint 3", "mirror".
    pub steps: Vec<String>,
}

impl<'a> Freedom<'a> {
    /// That of a problem whose readings are as they are. free: of each parameter.
    pub(crate) fn of(problem: &Problem, free: &'a [bool], zero_offsets_unknown: bool) -> Freedom<'a> {
        let (base_free, mirror_free) = (problem.base_free(), problem.mirror_free());
        Freedom { free, base_free, mirror_free, zero_offsets_unknown }
    }
}

/// What a step to the mirror image is called.
const MIRROR: &str = "mirror";

impl Folded {
    /// Whether the mirror image was taken.
    pub fn mirrored(&self) -> bool {
        self.steps.iter().any(|step| step == MIRROR)
    }
}

/// Above this many joints twins are sought one flip at a time instead of in all combinations.
const ALL_COMBINATIONS: usize = 12;

/// What may be changed on the way to a twin.
#[derive(Debug, Clone, Copy)]
pub struct Freedom<'a> {
    /// Parameters that are held must come out as they were.
    pub free: &'a [bool],
    /// The base frame is arbitrary: theta0 and d of joint 1 change nothing.
    pub base_free: bool,
    /// The mirror image explains the readings as well.
    pub mirror_free: bool,
    /// Nothing is known of the zero offsets: those of the nominal arm do not count.
    pub zero_offsets_unknown: bool,
}

/// Folds `parameters` to the twin nearest to `nominal`; angles come out within π of nominal where they are free.
pub fn fold(arm: &Arm, parameters: &[f64], nominal: &[f64], freedom: Freedom) -> Folded {
    let twins = Twins { arm, parameters, freedom };
    let mirrors: &[bool] = if freedom.mirror_free { &[false, true] } else { &[false] };
    let distance = Distance::new(arm, nominal, freedom);
    let mut best = (distance.of(parameters), 0, false);
    for &mirror in mirrors {
        for flips in twins.candidates() {
            let p = twins.twin(flips, mirror);
            let d = distance.of(&p);
            if d < best.0 * (1.0 - 1e-12) && twins.allowed(&p) {
                best = (d, flips, mirror);
            }
        }
    }
    let (_, flips, mirror) = best;
    let mut folded = twins.twin(flips, mirror);
    let units = arm.parameter_units();
    for (j, value) in folded.iter_mut().enumerate() {
        if !freedom.free[j] || (freedom.base_free && matters_not(arm, j)) {
            *value = parameters[j];
        } else if j < arm.geometry_count() && units[j] == Unit::Rad {
            *value = nominal[j] + wrap(*value - nominal[j]);
        }
    }
    let joints = arm.joints().len();
    let mut steps: Vec<String> =
        (0..joints).filter(|i| flips >> i & 1 == 1).map(|i| format!("flip of joint {}", i + 1)).collect();
    if mirror {
        steps.push(MIRROR.into());
    }
    Folded { parameters: folded, steps }
}

/// The arm mirrored, whatever the readings say of that, as an arm with the held parameters as they are; none where they tell it from its mirror image.
pub(crate) fn mirror_image(arm: &Arm, parameters: &[f64], freedom: Freedom) -> Option<Vec<f64>> {
    let twins = Twins { arm, parameters, freedom };
    let mut image = twins.candidates().map(|flips| twins.twin(flips, true)).find(|p| twins.allowed(p))?;
    for (value, (old, free)) in image.iter_mut().zip(parameters.iter().zip(freedom.free)) {
        if !free {
            *value = *old;
        }
    }
    Some(image)
}

/// Arms that describe the same readings.
struct Twins<'a> {
    arm: &'a Arm,
    parameters: &'a [f64],
    freedom: Freedom<'a>,
}

impl Twins<'_> {
    /// Sets of joints to flip, a bit each.
    fn candidates(&self) -> impl Iterator<Item = u64> + use<> {
        let joints = self.arm.joints().len();
        let all = joints <= ALL_COMBINATIONS;
        let count = if all { 1 << joints } else { joints.min(63) as u64 + 1 };
        (0..count).map(move |k| if all || k == 0 { k } else { 1 << (k - 1) })
    }

    fn twin(&self, flips: u64, mirror: bool) -> Vec<f64> {
        let mut p = self.parameters.to_vec();
        (0..self.arm.joints().len()).filter(|i| flips >> i & 1 == 1).for_each(|i| flip(self.arm, i, &mut p));
        if mirror {
            reflect(self.arm, &mut p);
        }
        p
    }

    /// Whether held parameters come out as they were; what is beyond the geometry has no twin.
    fn allowed(&self, p: &[f64]) -> bool {
        let units = &self.arm.parameter_units()[..self.arm.geometry_count()];
        p.iter().zip(self.parameters).zip(units).enumerate().all(|(j, ((new, old), unit))| {
            let moved = if *unit == Unit::Rad { wrap(new - old).abs() } else { (new - old).abs() };
            self.freedom.free[j] || moved < 1e-12 || (self.freedom.base_free && matters_not(self.arm, j))
        })
    }
}

/// How far arms are from a nominal one, mm²: lengths as they are, angles at the end of the arm's reach.
pub(crate) struct Distance<'a> {
    nominal: &'a [f64],
    /// of each parameter of the geometry: mm for a unit of it, and whether it is an angle; 0 for what does not matter
    scale: Vec<(f64, bool)>,
}

impl<'a> Distance<'a> {
    pub fn new(arm: &Arm, nominal: &'a [f64], freedom: Freedom) -> Distance<'a> {
        let reach = (0..arm.probes().len()).map(|p| arm.reach_mm(p)).fold(f64::MIN_POSITIVE, f64::max);
        let zero_offset = |j: usize| j < arm.joint_parameter_count() && j.is_multiple_of(4) && !arm.slides(j / 4);
        let matters = |j: usize| {
            let base = freedom.base_free && matters_not(arm, j);
            !(base || freedom.zero_offsets_unknown && zero_offset(j))
        };
        let units = arm.parameter_units().into_iter().take(arm.geometry_count()).enumerate();
        let scale = units.map(|(j, unit)| match unit {
            _ if !matters(j) => (0.0, false),
            Unit::Rad => (reach, true),
            _ => (1.0, false),
        });
        Distance { nominal, scale: scale.collect() }
    }

    pub fn of(&self, parameters: &[f64]) -> f64 {
        let each = parameters.iter().zip(self.nominal).zip(&self.scale);
        each.map(|((value, start), &(scale, angle))| {
            let off = value - start;
            (scale * if angle { wrap(off) } else { off }).powi(2)
        })
        .sum()
    }
}

/// theta0 and d of the first joint only move the base.
fn matters_not(arm: &Arm, parameter: usize) -> bool {
    parameter == 0 || (parameter == 3 && arm.joints()[0].model == JointModel::Dh)
}

/// An angle within (-π, π].
pub(crate) fn wrap(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}

fn flip(arm: &Arm, joint: usize, p: &mut [f64]) {
    p[4 * joint] += PI;
    p[4 * joint + 1] = -p[4 * joint + 1];
    p[4 * joint + 2] = -p[4 * joint + 2];
    if arm.joints()[joint].model == JointModel::Hayati {
        p[4 * joint + 3] = -p[4 * joint + 3];
    }
    if joint + 1 < arm.joints().len() {
        p[4 * (joint + 1)] += PI;
    } else {
        for probe in 0..arm.probes().len() {
            let at = arm.tip_offset(probe);
            p[at] = -p[at];
            p[at + 1] = -p[at + 1];
        }
    }
}

fn reflect(arm: &Arm, p: &mut [f64]) {
    for joint in 0..arm.joints().len() {
        p[4 * joint + 1] = -p[4 * joint + 1];
        // d or beta
        p[4 * joint + 3] = -p[4 * joint + 3];
    }
    for probe in 0..arm.probes().len() {
        let at = arm.tip_offset(probe) + 2;
        p[at] = -p[at];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::samples;
    use crate::kinematics::tip_mm;

    fn spread(seed: usize) -> [f64; 7] {
        std::array::from_fn(|i| (((seed * 7 + i) as f64 * 0.754_877_666).fract() - 0.5) * 5.0)
    }

    #[test]
    fn flips_leave_the_tip_and_mirrors_keep_lengths() {
        let arm = samples::table2(10.0);
        for joint in 0..6 {
            let mut p = arm.parameters();
            flip(&arm, joint, &mut p);
            let twin = arm.with_parameters(&p).unwrap();
            for seed in 0..20 {
                let q = spread(seed);
                assert!((tip_mm(&arm, 0, &q) - tip_mm(&twin, 0, &q)).norm() < 1e-12 * 1300.0);
            }
        }
        let mut p = arm.parameters();
        reflect(&arm, &mut p);
        let twin = arm.with_parameters(&p).unwrap();
        let length = |a: &Arm, s: usize| (tip_mm(a, 0, &spread(s)) - tip_mm(a, 0, &spread(s + 1))).norm();
        for seed in 0..20 {
            assert!((length(&arm, seed) - length(&twin, seed)).abs() < 1e-12 * 1300.0);
        }
    }

    #[test]
    fn every_twin_folds_back() {
        let arm = samples::table2(10.0);
        let nominal = arm.parameters();
        let all = Freedom { free: &[true; 27], base_free: true, mirror_free: true, zero_offsets_unknown: false };
        for flips in 0..64 {
            let mut p = nominal.clone();
            (0..6).filter(|i| flips >> i & 1 == 1).for_each(|i| flip(&arm, i, &mut p));
            reflect(&arm, &mut p);
            p[0] = nominal[0];
            p[3] = nominal[3];
            let folded = fold(&arm, &p, &nominal, all).parameters;
            for (a, b) in folded.iter().zip(&nominal) {
                assert!((a - b).abs() < 1e-12, "{a} {b}");
            }
        }
    }
}
