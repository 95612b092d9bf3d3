//! The point whose distances from given points come closest to what they should be: the middle of a sphere, the foot of a
//! draw wire.

use super::contact::{Contact, Spread};
use super::descent::{Sum, TO_THE_END, settled};
use nalgebra::{Const, DimMin, Matrix4, SMatrix, SVector, Vector3, Vector4};

/// Residuals beyond this part of the radius are those of a centre on the wrong side.
const WRONG: f64 = 0.05;

/// Contacts whose scatter fills less than this part of a ball's are nearly in a plane.
const FLAT: f64 = 0.05;

/// A point, and what is added to all distances from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Centre {
    /// Where it is, mm.
    pub at_mm: Vector3<f64>,
    /// What is added to the distances that the contacts should have, mm; 0 where they are known.
    pub radius_mm: f64,
}

impl Centre {
    /// How much farther a contact is than it should be, mm, and the direction in which its distance grows.
    #[inline(always)]
    pub fn residual(&self, contact: &Contact) -> (f64, Vector3<f64>) {
        let arm = contact.p_mm - self.at_mm;
        let distance = arm.norm();
        (distance - contact.apart_mm - self.radius_mm, arm / distance.max(f64::MIN_POSITIVE))
    }
}

/// The point with the least sum of squared weighted residuals; the distances are known.
pub fn at_known_distances(contacts: &[Contact]) -> Centre {
    let spread = Spread::of(contacts);
    let mut best: Option<(Centre, f64)> = None;
    if let Some(start) = algebraic(contacts, &spread, |contact| contact.apart_mm) {
        let found = improved::<3>(contacts, Centre { radius_mm: 0.0, ..start });
        let found = on_either_side(contacts, &spread, found);
        if found.1 <= spread.weights * (WRONG * spread.apart_mm).powi(2) {
            return found.0;
        }
        best = Some(found);
    }
    for at_mm in on_both_sides(&spread) {
        let found = improved::<3>(contacts, Centre { at_mm, radius_mm: 0.0 });
        if best.is_none_or(|(_, cost)| found.1 < cost) {
            best = Some(found);
        }
    }
    best.map_or(Centre { at_mm: spread.mean_mm, radius_mm: 0.0 }, |(centre, _)| centre)
}

/// The sphere with the least sum of squared weighted distances of the contacts, each less what it is apart. None where the
/// contacts are fewer than four or lie in a plane.
pub fn sphere(contacts: &[Contact]) -> Option<Centre> {
    let spread = Spread::of(contacts);
    let start = algebraic(contacts, &spread, |_| 0.0)?;
    let start = Centre { radius_mm: start.radius_mm - spread.apart_mm, ..start };
    Some(improved::<4>(contacts, start).0)
}

/// The better of a centre and of what lies on the other side of contacts that are nearly in a plane, which may know little of
/// the side that the centre is on.
fn on_either_side(contacts: &[Contact], spread: &Spread, found: (Centre, f64)) -> (Centre, f64) {
    if spread.scatter.determinant() > FLAT * (spread.scatter.trace() / 3.0).powi(3) {
        return found;
    }
    let normal = spread.thinnest();
    let over = normal * normal.dot(&(found.0.at_mm - spread.mean_mm));
    let other = improved::<3>(contacts, Centre { at_mm: found.0.at_mm - over * 2.0, radius_mm: 0.0 });
    if other.1 < found.1 { other } else { found }
}

/// Gauss-Newton from a centre; with a fourth unknown the radius is one.
fn improved<const N: usize>(contacts: &[Contact], start: Centre) -> (Centre, f64)
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let size = contacts.iter().map(|contact| contact.apart_mm.abs()).fold(1.0, f64::max) + start.radius_mm.abs();
    let sum = |centre: &Centre, newton: bool| {
        let mut sum = Sum::<N>::new();
        for contact in contacts {
            let (residual, direction) = centre.residual(contact);
            let derivative = |k: usize, _| if k < 3 { -contact.weight * direction[k] } else { -contact.weight };
            sum.add(SVector::from_fn(derivative), contact.weight * residual);
            if newton {
                let distance = residual + contact.apart_mm + centre.radius_mm;
                let bent = contact.weight.powi(2) * residual / distance.max(f64::MIN_POSITIVE);
                let across = |i: usize, j: usize| f64::from(u8::from(i == j)) - direction[i] * direction[j];
                sum.bend(SMatrix::from_fn(|i, j| if i < 3 && j < 3 { bent * across(i, j) } else { 0.0 }));
            }
        }
        sum
    };
    let moved = |centre: &Centre, step: &SVector<f64, N>| Centre {
        at_mm: centre.at_mm + step.fixed_rows::<3>(0),
        radius_mm: centre.radius_mm + if N > 3 { step[3] } else { 0.0 },
    };
    settled(start, TO_THE_END, size, sum, moved)
}

/// Centre and radius by linear least squares, `‖p‖² - apart² = 2 p·c + k` (Coope 1993), where the contacts are enough for
/// it.
fn algebraic(contacts: &[Contact], spread: &Spread, apart_mm: impl Fn(&Contact) -> f64) -> Option<Centre> {
    if contacts.len() < 4 {
        return None;
    }
    let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for contact in contacts {
        let p = contact.p_mm - spread.mean_mm;
        let row = Vector4::new(2.0 * p.x, 2.0 * p.y, 2.0 * p.z, 1.0);
        normal += row * row.transpose() * contact.weight.powi(2);
        right += row * ((p.norm_squared() - apart_mm(contact).powi(2)) * contact.weight.powi(2));
    }
    let solution = normal.cholesky()?.solve(&right);
    let radius_mm = (solution.w + solution.xyz().norm_squared()).max(0.0).sqrt();
    Some(Centre { at_mm: spread.mean_mm + solution.xyz(), radius_mm })
}

/// Above and below the contacts, as far as the distances demand.
fn on_both_sides(spread: &Spread) -> [Vector3<f64>; 2] {
    let radius = spread.apart_mm;
    let normal = spread.thinnest();
    let height = (radius * radius - spread.scatter.trace()).max(0.01 * radius * radius).sqrt();
    [spread.mean_mm + normal * height, spread.mean_mm - normal * height]
}
