//! A least-squares cone by the solver: from many directions, since nobody says where the axis points.

use crate::dual::Dual;
use crate::equations::Equations;
use nalgebra::{DMatrix, DVector, Vector3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use ulna::solver::lm::Options;

/// A point of the axis, where it points (towards growing radius), how far the surface is from that point, and half the
/// angle at the apex.
#[derive(Debug, Clone)]
pub struct Cone {
    pub on_mm: Vector3<f64>,
    pub along: Vector3<f64>,
    pub to_surface_mm: f64,
    pub half_angle_rad: f64,
}

impl Cone {
    /// The sum of squared distances.
    pub fn cost(&self, points: &[Vector3<f64>]) -> f64 {
        let (sin, cos) = self.half_angle_rad.sin_cos();
        let residual = |p: &Vector3<f64>| {
            let arm = p - self.on_mm;
            arm.cross(&self.along).norm() * cos - arm.dot(&self.along) * sin - self.to_surface_mm
        };
        points.iter().map(|p| residual(p).powi(2)).sum()
    }

    /// The same cone as it would be read: half the angle at its apex within a quarter turn, the axis towards growing
    /// radius.
    fn opening(mut self) -> Cone {
        self.half_angle_rad -= (self.half_angle_rad / TAU).round() * TAU;
        if self.half_angle_rad.abs() > FRAC_PI_2 {
            self.half_angle_rad -= PI.copysign(self.half_angle_rad);
            self.to_surface_mm = -self.to_surface_mm;
        }
        if self.half_angle_rad < 0.0 {
            (self.along, self.half_angle_rad) = (-self.along, -self.half_angle_rad);
        }
        self
    }
}

/// Directions looked at, and how many of the cones guessed from them are improved.
const DIRECTIONS: usize = 200;
const IMPROVED: usize = 8;

/// A calibration's tolerance leaves a micrometre open of an axis that little is seen of; this is as near as numbers go.
const TO_ROUNDING: Options = Options { max_iterations: 200, cost_tolerance: 1e-20 };

/// The best cone through points.
pub fn cone(points: &[Vector3<f64>]) -> Cone {
    let middle_mm = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let guess = |k: usize| {
        let z = (k as f64 + 0.5) / DIRECTIONS as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        guessed(points, middle_mm, Vector3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vector3::z() * z)
    };
    let mut guesses: Vec<Cone> = (0..DIRECTIONS).map(guess).collect();
    guesses.sort_by(|one, other| one.cost(points).total_cmp(&other.cost(points)));
    let improved = guesses.into_iter().take(IMPROVED).map(|guess| improved(points, improved(points, guess)));
    improved.min_by(|one, other| one.cost(points).total_cmp(&other.cost(points))).unwrap().opening()
}

/// Two directions across another.
fn across(along: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let first = along.cross(&Vector3::ith(along.iamin(), 1.0)).normalize();
    [first, along.cross(&first)]
}

/// Given the direction, `|q - c|² = (α + β t)²` is linear in c, `α² - c²`, `2αβ` and `β²`.
fn guessed(points: &[Vector3<f64>], middle_mm: Vector3<f64>, along: Vector3<f64>) -> Cone {
    let e = across(&along);
    let own = |p: &Vector3<f64>| [(p - middle_mm).dot(&e[0]), (p - middle_mm).dot(&e[1]), (p - middle_mm).dot(&along)];
    let own: Vec<[f64; 3]> = points.iter().map(own).collect();
    let a = DMatrix::from_fn(points.len(), 5, |i, j| {
        let [u, v, t] = own[i];
        [2.0 * u, 2.0 * v, 1.0, t, t * t][j]
    });
    let squares = DVector::from_fn(points.len(), |i, _| own[i][0].powi(2) + own[i][1].powi(2));
    let k = a.svd(true, true).solve(&squares, 1e-12).unwrap();
    let radius = (k[2] + k[0] * k[0] + k[1] * k[1]).max(1e-12).sqrt();
    let half_angle_rad = (k[3] / (2.0 * radius)).atan();
    let on_mm = middle_mm + e[0] * k[0] + e[1] * k[1];
    Cone { on_mm, along, to_surface_mm: radius * half_angle_rad.cos(), half_angle_rad }
}

/// By the solver, the axis turned by two unknowns and shifted by two.
fn improved(points: &[Vector3<f64>], start: Cone) -> Cone {
    let [e, f] = across(&start.along);
    let arms: Vec<[f64; 3]> =
        points.iter().map(|p| p - start.on_mm).map(|arm| [arm.dot(&e), arm.dot(&f), arm.dot(&start.along)]).collect();
    let residual = |x: &[Dual], row: usize| {
        let [u, v, t] = arms[row];
        let size = (x[0].squared() + x[1].squared() + 1.0).sqrt();
        let (along, arm) = ([x[0] / size, x[1] / size, Dual::from(1.0) / size], [-x[2] + u, -x[3] + v, Dual::from(t)]);
        let turned = |i: usize, j: usize| (arm[i] * along[j] - arm[j] * along[i]).squared();
        let radius = (turned(1, 2) + turned(2, 0) + turned(0, 1)).sqrt();
        let height = arm[0] * along[0] + arm[1] * along[1] + arm[2] * along[2];
        radius * x[5].cos() - height * x[5].sin() - x[4]
    };
    let size_mm = points.iter().map(|p| p.amax()).fold(0.0, f64::max);
    let mut x = [0.0, 0.0, 0.0, 0.0, start.to_surface_mm, start.half_angle_rad];
    Equations::new(6, points.len(), f64::EPSILON * size_mm, residual).minimize(&mut x, &TO_ROUNDING);
    Cone {
        on_mm: start.on_mm + e * x[2] + f * x[3],
        along: (start.along + e * x[0] + f * x[1]).normalize(),
        to_surface_mm: x[4],
        half_angle_rad: x[5],
    }
}
