//! A virtual arm's hand: encoder angles that put the tip on a point, within the joints' limits.
//!
//! Damped least squares on the encoder angles (Wampler 1986) from random postures; an arm has more joints than a point has
//! coordinates, so each random start ends with another elbow and wrist.

use crate::arm::Arm;
use crate::kinematics::{encoder_jacobian, tip_mm};
use nalgebra::{DVector, Matrix3, Point3, Vector3};
use rand::{Rng, RngExt};

/// What a posture may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Limits {
    /// Lowest and highest encoder angle of each joint, rad.
    pub range_rad: Vec<(f64, f64)>,
}

/// A tip this close to the point is on it, mm.
const REACHED_MM: f64 = 1e-9;
/// Steps from one posture before another is tried.
const STEPS: usize = 60;

/// A posture with the tip on `point_mm` (base frame) to 1e-9 mm, or none in `tries` random starts.
pub fn posture_for_point(
    arm: &Arm,
    probe: usize,
    point_mm: Point3<f64>,
    limits: &Limits,
    tries: usize,
    rng: &mut impl Rng,
) -> Option<Vec<f64>> {
    if point_mm.coords.norm() > arm.reach_mm(probe) {
        return None;
    }
    (0..tries).find_map(|_| {
        let start = limits.range_rad.iter().map(|&(low, high)| low + (high - low) * rng.random::<f64>());
        descend(arm, probe, point_mm, limits, start.collect())
    })
}

fn descend(arm: &Arm, probe: usize, point_mm: Point3<f64>, limits: &Limits, mut q_rad: Vec<f64>) -> Option<Vec<f64>> {
    let mut damping = 1e-4;
    let mut miss = point_mm - tip_mm(arm, probe, &q_rad);
    for _ in 0..STEPS {
        if miss.norm() <= REACHED_MM {
            return Some(q_rad);
        }
        let jacobian = encoder_jacobian(arm, probe, &q_rad);
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
            .map(|((q, s), &(low, high))| (q + shorten * s).clamp(low, high))
            .collect();
        let next_miss = point_mm - tip_mm(arm, probe, &next);
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
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn reached_points_are_reached_within_limits() {
        let arm = samples::table2(10.0);
        let limits = Limits { range_rad: vec![(-2.5, 2.5); 7] };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
        let mut reached = 0;
        for k in 0..200 {
            let angle = k as f64 * 0.7;
            let point = Point3::new(500.0 * angle.cos(), 500.0 * angle.sin(), 100.0 + 2.0 * k as f64);
            if let Some(q) = posture_for_point(&arm, 0, point, &limits, 40, &mut rng) {
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
        assert!(posture_for_point(&arm, 0, Point3::new(2000.0, 0.0, 0.0), &limits, 40, &mut rng).is_none());
    }
}
