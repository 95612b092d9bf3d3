//! A virtual arm's hand: encoder angles that put the tip on a point, within the joints' limits.
//!
//! Damped least squares on the encoder angles (Wampler 1986) from random postures; an arm has more joints than a point has
//! coordinates, so each random start ends with another elbow and wrist.

use crate::arm::Arm;
use crate::kinematics::conditions::Conditions;
use crate::kinematics::plain::{encoder_jacobian, tip_mm};
use crate::kinematics::pose::Pose;
use crate::monitor::Monitor;
use crate::seeds::mix;
use nalgebra::{DVector, Matrix3, Point3, Vector3};
use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a posture may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Limits {
    /// Lowest and highest encoder angle of each joint, rad; of one that slides mm.
    pub range_rad: Vec<(f64, f64)>,
}

/// A tip this close to the point is on it, mm.
const REACHED_MM: f64 = 1e-9;
/// Steps from one posture before another is tried.
const STEPS: usize = 60;

/// A posture with the tip on `point_mm` (base frame) to 1e-9 mm under some conditions, or none in `tries` random starts.
pub fn posture_for_point(
    arm: &Arm,
    probe: usize,
    (point_mm, conditions): (Point3<f64>, Conditions),
    limits: &Limits,
    tries: usize,
    rng: &mut impl Rng,
) -> Option<Vec<f64>> {
    if point_mm.coords.norm() > arm.reach_mm(probe) {
        return None;
    }
    (0..tries).find_map(|_| {
        let start = limits.range_rad.iter().map(|&(low, high)| low + (high - low) * rng.random::<f64>());
        descend(arm, probe, (point_mm, conditions), limits, start.collect())
    })
}

/// Postures for many points, three coordinates each, and what is true at them: row-major, NaN where none was found. None
/// where it was interrupted.
///
/// Point k draws from (seed, k), so that the answer does not depend on how the work is cut.
pub fn postures_for_points(
    arm: &Arm,
    probe: usize,
    (points_mm, conditions): (&[f64], Conditions),
    limits: &Limits,
    tries: usize,
    seed: u64,
    monitor: &dyn Monitor,
) -> Option<Vec<f64>> {
    let encoders = arm.encoders();
    let count = points_mm.len() / 3;
    let mut postures = vec![f64::NAN; count * encoders];
    let stopped = AtomicBool::new(false);
    postures.par_chunks_exact_mut(encoders).zip(points_mm.par_chunks_exact(3)).enumerate().for_each(
        |(k, (posture, point))| {
            if stopped.load(Ordering::Relaxed) {
                return;
            }
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(mix(seed, k as u64));
            let wanted = (Point3::new(point[0], point[1], point[2]), conditions.part(k..k + 1, count));
            if let Some(q_rad) = posture_for_point(arm, probe, wanted, limits, tries, &mut rng) {
                posture.copy_from_slice(&q_rad);
            }
            if !monitor.keep_going() {
                stopped.store(true, Ordering::Relaxed);
            }
        },
    );
    (!stopped.into_inner()).then_some(postures)
}

fn descend(
    arm: &Arm,
    probe: usize,
    (point_mm, conditions): (Point3<f64>, Conditions),
    limits: &Limits,
    mut q_rad: Vec<f64>,
) -> Option<Vec<f64>> {
    let mut damping = 1e-4;
    // what slides goes as far in a step as what turns: its travel stands for half a turn
    let unit = |(i, &(low, high)): (usize, &(f64, f64))| if arm.slides(i) { (high - low) / PI } else { 1.0 };
    let units: Vec<f64> = limits.range_rad.iter().enumerate().map(unit).collect();
    let miss_of = |q_rad: &[f64]| point_mm - tip_mm(arm, probe, Pose { q_rad, conditions });
    let mut miss = miss_of(&q_rad);
    for _ in 0..STEPS {
        if miss.norm() <= REACHED_MM {
            return Some(q_rad);
        }
        let mut jacobian = encoder_jacobian(arm, probe, Pose { q_rad: &q_rad, conditions });
        jacobian.column_iter_mut().zip(&units).for_each(|(mut column, unit)| column *= *unit);
        let square: Matrix3<f64> = &jacobian * jacobian.transpose();
        let damped = square + Matrix3::from_diagonal_element(damping * square.trace() / 3.0);
        let weights: Vector3<f64> = damped.cholesky()?.solve(&miss);
        let step: DVector<f64> = jacobian.transpose() * weights;
        // a step of more than a quarter turn leaves the region where the Jacobian means anything
        let shorten = (0.8 / step.amax()).min(1.0);
        let next: Vec<f64> = q_rad
            .iter()
            .zip(step.iter())
            .zip(&limits.range_rad)
            .zip(&units)
            .map(|(((q, s), &(low, high)), unit)| (q + shorten * s * unit).clamp(low, high))
            .collect();
        let next_miss = miss_of(&next);
        if next_miss.norm() < miss.norm() {
            (q_rad, miss) = (next, next_miss);
            damping = (damping * 0.1).max(1e-15);
        } else {
            damping *= 30.0;
            if damping > 1e3 {
                return None;
            }
        }
    }
    (miss.norm() <= REACHED_MM).then_some(q_rad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::samples;
    use crate::monitor::Unwatched;

    #[test]
    fn reached_points_are_reached_within_limits() {
        let arm = samples::table2(10.0);
        let limits = Limits { range_rad: vec![(-2.5, 2.5); 7] };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
        let mut reached = 0;
        for k in 0..200 {
            let angle = k as f64 * 0.7;
            let point = Point3::new(500.0 * angle.cos(), 500.0 * angle.sin(), 100.0 + 2.0 * k as f64);
            if let Some(q) = posture_for_point(&arm, 0, (point, Conditions::default()), &limits, 40, &mut rng) {
                assert!((tip_mm(&arm, 0, &q) - point).norm() <= 1e-9);
                assert!(q.iter().all(|v| v.abs() <= 2.5));
                reached += 1;
            }
        }
        assert!(reached >= 195, "{reached}");
    }

    #[test]
    fn a_point_out_of_reach_is_refused() {
        let arm = samples::table2(10.0);
        let limits = Limits { range_rad: vec![(-3.0, 3.0); 7] };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
        let far = (Point3::new(2000.0, 0.0, 0.0), Conditions::default());
        assert!(posture_for_point(&arm, 0, far, &limits, 40, &mut rng).is_none());
    }

    #[test]
    fn many_points_do_not_depend_on_how_they_are_cut() {
        let arm = samples::table2(10.0);
        let limits = Limits { range_rad: vec![(-2.5, 2.5); 7] };
        let points: Vec<f64> = (0..150).flat_map(|k| [400.0 + f64::from(k), 3.0 * f64::from(k), 200.0]).collect();
        let found = |points: &[f64]| {
            let wanted = (points, Conditions::default());
            postures_for_points(&arm, 0, wanted, &limits, 40, 3, &Unwatched).unwrap()
        };
        let (whole, first) = (found(&points), found(&points[..90]));
        assert_eq!(whole[..first.len()], first);
        for (q, point) in whole.chunks(7).zip(points.chunks(3)) {
            assert!((tip_mm(&arm, 0, q) - Point3::new(point[0], point[1], point[2])).norm() <= 1e-9);
        }
    }
}
