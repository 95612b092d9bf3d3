//! The straight line whose distances from given points come closest to what they should be: the axis of a cylinder.
//!
//! The sum of squares has several minima over the directions of the line. So it is looked at along all of them: for each
//! the best centre of a circle in the plane across it, by linear least squares; the best directions are then improved.

use super::contact::{Contact, Spread};
use super::descent::{Sum, TO_THE_END, settled};
use nalgebra::{Const, DimMin, Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3};

/// Directions looked at, less than 20 degrees apart.
const DIRECTIONS: usize = 80;
/// Of these so many are improved by a few steps: more of them where the contacts are few.
const BEST: usize = 8;
const BEST_OF_FEW: usize = 32;
/// Contacts so few leave room for lines that have nothing to do with them.
const FEW: usize = 12;
/// Steps that tell whether a direction leads somewhere.
const SOME_STEPS: usize = 6;
/// A principal axis of the contacts whose residuals are smaller than this part of the radius is the line's.
const NEAR: f64 = 2e-3;

/// A line, and what is added to all distances from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// The point on it that is nearest to the middle of the contacts, mm.
    pub foot_mm: Vector3<f64>,
    /// Unit vector along it.
    pub direction: Vector3<f64>,
    /// Two unit vectors across it.
    pub across: [Vector3<f64>; 2],
    /// What is added to the distances that the contacts should have, mm; 0 where they are known.
    pub radius_mm: f64,
}

impl Axis {
    fn new(near_mm: Vector3<f64>, direction: Vector3<f64>, radius_mm: f64, middle_mm: &Vector3<f64>) -> Axis {
        let direction = direction.normalize();
        let first = direction.cross(&Vector3::ith(direction.iamin(), 1.0)).normalize();
        Axis {
            foot_mm: near_mm + direction * direction.dot(&(middle_mm - near_mm)),
            direction,
            across: [first, direction.cross(&first)],
            radius_mm,
        }
    }

    /// How much farther a contact is than it should be, mm; the direction in which its distance grows; and how far along
    /// the line it is from the foot, mm.
    #[inline(always)]
    pub fn residual(&self, contact: &Contact) -> (f64, Vector3<f64>, f64) {
        let arm = contact.p_mm - self.foot_mm;
        let along = self.direction.dot(&arm);
        let beside = arm - self.direction * along;
        let distance = beside.norm();
        (distance - contact.apart_mm - self.radius_mm, beside / distance.max(f64::MIN_POSITIVE), along)
    }

    /// Derivatives of a residual with respect to two shifts and two tilts about the foot.
    #[inline(always)]
    pub fn derivatives(&self, normal: &Vector3<f64>, along_mm: f64) -> [f64; 4] {
        let [first, second] = self.across.map(|across| -normal.dot(&across));
        [first, second, along_mm * first, along_mm * second]
    }

    /// Second derivatives of a distance `√(‖b - s - h τ‖² - (b·τ)²)`, with b across the line, for shifts s and tilts τ that
    /// are measured over `length_mm`.
    fn curvature(&self, normal: &Vector3<f64>, distance_mm: f64, along_mm: f64, length_mm: f64) -> [[f64; 4]; 4] {
        let n = self.across.map(|across| normal.dot(&across));
        let lever = [1.0, 1.0, along_mm / length_mm, along_mm / length_mm];
        let mut bent = [[0.0; 4]; 4];
        for (i, row) in bent.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                let (a, b) = (i % 2, j % 2);
                let across = f64::from(u8::from(a == b)) - n[a] * n[b];
                *value = lever[i] * lever[j] * across / distance_mm.max(f64::MIN_POSITIVE);
                if i > 1 && j > 1 {
                    *value -= distance_mm * n[a] * n[b] / length_mm.powi(2);
                }
            }
        }
        bent
    }
}

/// The line with the least sum of squared weighted residuals; the distances are known.
pub fn at_known_distances(contacts: &[Contact]) -> Axis {
    best::<4>(contacts)
}

/// The cylinder with the least sum of squared weighted distances of the contacts, each less what it is apart. None where the
/// contacts are fewer than five, or show no circle from any side.
pub fn cylinder(contacts: &[Contact]) -> Option<Axis> {
    let axis = best::<5>(contacts);
    (contacts.len() >= 5 && axis.radius_mm.is_finite()).then_some(axis)
}

/// With a fifth unknown the radius is one.
fn best<const N: usize>(contacts: &[Contact]) -> Axis
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let spread = Spread::of(contacts);
    let principal = spread.scatter.symmetric_eigen().eigenvectors;
    let axes = (0..3).map(|k| principal.column(k).into_owned());
    let mut starts: Vec<(Axis, f64)> = axes.map(|along| started(contacts, &spread, along, N > 4)).collect();
    starts.sort_by(|a, b| a.1.total_cmp(&b.1));
    let quick = improved::<N>(contacts, &spread, TO_THE_END, starts[0].0);
    let radius = spread.apart_mm + quick.0.radius_mm;
    if contacts.len() > N && quick.1 <= spread.weights * (NEAR * radius).powi(2) {
        return quick.0;
    }
    starts.extend(hemisphere().map(|along| started(contacts, &spread, along, N > 4)));
    starts.sort_by(|a, b| a.1.total_cmp(&b.1));
    let many = if contacts.len() > FEW { BEST } else { BEST_OF_FEW };
    let tried = starts.iter().take(many).map(|(start, _)| improved::<N>(contacts, &spread, SOME_STEPS, *start));
    let least = |best: (Axis, f64), found: (Axis, f64)| if found.1 < best.1 { found } else { best };
    let (best, _) = tried.fold((quick.0, f64::INFINITY), least);
    least(quick, improved::<N>(contacts, &spread, TO_THE_END, best)).0
}

/// Directions evenly over half a sphere: a spiral by the golden angle.
fn hemisphere() -> impl Iterator<Item = Vector3<f64>> {
    (0..DIRECTIONS).map(|k| {
        let up = (k as f64 + 0.5) / DIRECTIONS as f64;
        let (sin, cos) = (k as f64 * 2.399_963_229_728_653).sin_cos();
        let flat = (1.0 - up * up).sqrt();
        Vector3::new(flat * cos, flat * sin, up)
    })
}

/// The best line along a direction, nearly, and its cost.
fn started(contacts: &[Contact], spread: &Spread, direction: Vector3<f64>, free: bool) -> (Axis, f64) {
    let axis = Axis::new(spread.mean_mm, direction, 0.0, &spread.mean_mm);
    let flat = |contact: &Contact| {
        let arm = contact.p_mm - spread.mean_mm;
        Vector2::new(arm.dot(&axis.across[0]), arm.dot(&axis.across[1]))
    };
    let (mut normal, mut right, mut scatter) = (Matrix3::zeros(), Vector3::zeros(), Matrix2::zeros());
    for contact in contacts {
        let (x, square) = (flat(contact), contact.weight.powi(2));
        let row = Vector3::new(2.0 * x.x, 2.0 * x.y, 1.0);
        let apart = if free { 0.0 } else { contact.apart_mm };
        normal += row * row.transpose() * square;
        right += row * ((x.norm_squared() - apart * apart) * square);
        scatter += x * x.transpose() * (square / spread.weights);
    }
    let mut centres = Vec::with_capacity(3);
    if let Some(cholesky) = normal.cholesky() {
        let found = cholesky.solve(&right);
        let radius = (found.z + found.xy().norm_squared()).max(0.0).sqrt();
        centres.push((found.xy(), if free { radius - spread.apart_mm } else { 0.0 }));
    }
    if !free {
        let eigen = scatter.symmetric_eigen();
        let thin: Vector2<f64> = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
        let square = spread.apart_mm.powi(2);
        let height = (square - scatter.trace()).max(0.01 * square).sqrt();
        centres.extend([(thin * height, 0.0), (thin * -height, 0.0)]);
    }
    let mut best = (axis, f64::INFINITY);
    for (centre, radius_mm) in centres {
        let off = |contact: &Contact| {
            let distance = (flat(contact) - centre).norm();
            (contact.weight * (distance - contact.apart_mm - radius_mm)).powi(2)
        };
        let cost: f64 = contacts.iter().map(off).sum();
        if cost < best.1 {
            let foot_mm = axis.foot_mm + axis.across[0] * centre.x + axis.across[1] * centre.y;
            best = (Axis { foot_mm, radius_mm, ..axis }, cost);
        }
    }
    best
}

/// So many steps of Gauss-Newton from a line.
fn improved<const N: usize>(contacts: &[Contact], spread: &Spread, steps: usize, start: Axis) -> (Axis, f64)
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    // tilts are measured by how far they move a contact
    let length = spread.scatter.trace().sqrt().max(f64::MIN_POSITIVE);
    let sum = |axis: &Axis, newton: bool| {
        let mut sum = Sum::<N>::new();
        for contact in contacts {
            let (residual, normal, along) = axis.residual(contact);
            let own = axis.derivatives(&normal, along / length);
            let derivative = |k: usize, _| contact.weight * own.get(k).copied().unwrap_or(-1.0);
            sum.add(SVector::from_fn(derivative), contact.weight * residual);
            if newton {
                let own = contact.weight.powi(2) * residual;
                let distance = residual + contact.apart_mm + axis.radius_mm;
                let bent = axis.curvature(&normal, distance, along, length);
                sum.bend(SMatrix::from_fn(|i, j| if i < 4 && j < 4 { own * bent[i][j] } else { 0.0 }));
            }
        }
        sum
    };
    let moved = |axis: &Axis, step: &SVector<f64, N>| {
        let [first, second] = axis.across;
        let foot_mm = axis.foot_mm + first * step[0] + second * step[1];
        let direction = axis.direction + (first * step[2] + second * step[3]) / length;
        Axis::new(foot_mm, direction, axis.radius_mm + if N > 4 { step[4] } else { 0.0 }, &spread.mean_mm)
    };
    settled(start, steps, length + spread.apart_mm.abs() + start.radius_mm.abs(), sum, moved)
}
