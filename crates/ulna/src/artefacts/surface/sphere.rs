//! A ball, or a hollow sphere, of known or unknown diameter.
//!
//! ```text
//! r = ‖p(q) - c‖ - (D + D_tip)/2      outside;      ‖p(q) - c‖ - (D - D_tip)/2      inside
//! ```

use super::shape::{Contact, Shape, Touched};
use crate::artefacts::dimension::Dimension;
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

/// Which side of a sphere is touched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// A ball.
    Outside,
    /// A hollow.
    Inside,
}

/// A sphere; its diameter is its one dimension where it is not known exactly.
#[derive(Debug, Clone, Copy)]
pub struct Sphere {
    /// Diameter, mm.
    pub diameter_mm: f64,
    /// Which side is touched.
    pub side: Side,
}

/// Steps towards the best centre; some five are enough but for touches that hardly show it.
const STEPS: usize = 60;
/// A step this small against the radius is none.
const STILL: f64 = 1e-14;
/// Residuals beyond this part of the radius are those of a centre on the wrong side.
const WRONG: f64 = 0.05;

impl Sphere {
    fn radius_mm(&self, contact: &Contact, dimensions_mm: &[f64]) -> f64 {
        let diameter = dimensions_mm.first().copied().unwrap_or(self.diameter_mm);
        let ball = match self.side {
            Side::Outside => contact.radius_mm,
            Side::Inside => -contact.radius_mm,
        };
        0.5 * diameter + ball
    }

    /// Gauss-Newton from a centre, each step shortened until it lowers the cost; the centre and its cost.
    fn improved(&self, contacts: &[Contact], dimensions_mm: &[f64], start: Vector3<f64>) -> (Vector3<f64>, f64) {
        let sum = |c: &Vector3<f64>| {
            let (mut normal, mut right, mut cost) = (Matrix3::zeros(), Vector3::zeros(), 0.0);
            for contact in contacts {
                let arm = contact.p_mm - c;
                let distance = arm.norm().max(f64::MIN_POSITIVE);
                let residual = contact.weight * (distance - self.radius_mm(contact, dimensions_mm));
                let direction = arm * (contact.weight / distance);
                normal += direction * direction.transpose();
                right += direction * residual;
                cost += residual * residual;
            }
            (normal, right, cost)
        };
        let size = contacts.iter().map(|contact| self.radius_mm(contact, dimensions_mm).abs()).fold(1.0, f64::max);
        let mut centre = start;
        let (mut normal, mut right, mut cost) = sum(&centre);
        for _ in 0..STEPS {
            // what no touch shows stays as it is
            let shown = normal + Matrix3::from_diagonal_element(1e-12 * normal.trace().max(f64::MIN_POSITIVE));
            let Some(factor) = shown.cholesky() else { break };
            let mut step = factor.solve(&right);
            let mut better = None;
            for _ in 0..30 {
                let next = sum(&(centre + step));
                if next.2 <= cost {
                    better = Some(next);
                    break;
                }
                step *= 0.5;
            }
            let Some(next) = better else { break };
            centre += step;
            (normal, right, cost) = next;
            if step.norm() <= STILL * size {
                break;
            }
        }
        (centre, cost)
    }
}

impl Shape for Sphere {
    type Standing = Vector3<f64>;

    fn place(&self, contacts: &[Contact], dimensions_mm: &[f64]) -> Vector3<f64> {
        let weights: f64 = contacts.iter().map(|contact| contact.weight.powi(2)).sum();
        let mut radius = 0.0;
        for contact in contacts {
            radius += contact.weight.powi(2) / weights * self.radius_mm(contact, dimensions_mm);
        }
        let mut best: Option<(Vector3<f64>, f64)> = None;
        if let Some(start) = algebraic(contacts, weights) {
            let found = self.improved(contacts, dimensions_mm, start);
            if found.1 <= weights * (WRONG * radius).powi(2) {
                return found.0;
            }
            best = Some(found);
        }
        for start in on_both_sides(contacts, weights, radius) {
            let found = self.improved(contacts, dimensions_mm, start);
            if best.is_none_or(|(_, cost)| found.1 < cost) {
                best = Some(found);
            }
        }
        best.map_or_else(Vector3::zeros, |(centre, _)| centre)
    }

    fn touched(&self, centre: &Vector3<f64>, contact: &Contact, dimensions_mm: &[f64]) -> Touched {
        let arm = contact.p_mm - centre;
        let distance = arm.norm();
        let normal = arm / distance.max(f64::MIN_POSITIVE);
        Touched { residual_mm: distance - self.radius_mm(contact, dimensions_mm), normal, local: (-normal).into() }
    }

    fn by_dimensions(&self) -> &[f64] {
        &[-0.5]
    }

    fn growing(&self, dimensions_mm: &[f64], balls_mm: &[f64]) -> Vec<f64> {
        let ball = balls_mm.first().copied().unwrap_or(0.0);
        let whole = |diameter: &f64| match self.side {
            Side::Outside => diameter + ball,
            Side::Inside => diameter - ball,
        };
        dimensions_mm.iter().map(whole).collect()
    }

    fn scale_free(&self, dimensions: &[Dimension], balls_mm: &[f64]) -> bool {
        let unknown = dimensions.first().is_some_and(|diameter| diameter.fitted && diameter.u_mm == 0.0);
        unknown && balls_mm.windows(2).all(|pair| pair[0] == pair[1])
    }
}

/// The centre by linear least squares, `‖p‖² = 2 p·c + k` (Coope 1993), where the touches are enough for it.
fn algebraic(contacts: &[Contact], weights: f64) -> Option<Vector3<f64>> {
    if contacts.len() < 5 {
        return None;
    }
    let mean = mean(contacts, weights);
    let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for contact in contacts {
        let p = contact.p_mm - mean;
        let row = Vector4::new(2.0 * p.x, 2.0 * p.y, 2.0 * p.z, 1.0);
        normal += row * row.transpose() * contact.weight.powi(2);
        right += row * (p.norm_squared() * contact.weight.powi(2));
    }
    let solution = normal.cholesky()?.solve(&right);
    Some(mean + solution.xyz())
}

/// Above and below the touches, as far as the radius demands.
fn on_both_sides(contacts: &[Contact], weights: f64, radius: f64) -> [Vector3<f64>; 2] {
    let mean = mean(contacts, weights);
    let spread = |contact: &Contact| {
        let arm = contact.p_mm - mean;
        arm * arm.transpose() * (contact.weight.powi(2) / weights)
    };
    let scatter: Matrix3<f64> = contacts.iter().map(spread).sum();
    let eigen = scatter.symmetric_eigen();
    let normal: Vector3<f64> = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    let height = (radius * radius - scatter.trace()).max(0.01 * radius * radius).sqrt();
    [mean + normal * height, mean - normal * height]
}

fn mean(contacts: &[Contact], weights: f64) -> Vector3<f64> {
    contacts.iter().map(|contact| contact.p_mm * (contact.weight.powi(2) / weights)).sum()
}
