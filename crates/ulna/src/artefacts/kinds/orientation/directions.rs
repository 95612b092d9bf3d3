//! The derivatives of how the last link is turned, from those of three of its points.

use crate::artefacts::tile::Directions;
use crate::simd::{Columns, Lanes};
use nalgebra::{Matrix3, Rotation3, Vector3};
use pulp::Simd;

/// How far the points lie from the tip, mm.
pub(super) const ARM_MM: f64 = 1000.0;

/// Rows of derivatives by a small turn δ of the last link, as directions of three of its points.
///
/// With v the columns of R(q), `d · δ = (d × v₁) · ∂v₁ + (d · v₁) v₃ · ∂v₂`, and each ∂v the difference of what two points
/// move by, over their distance. What shifts all points alike moves nothing.
pub(super) struct Turns(Columns);

const POINTS: usize = 3;

impl Turns {
    /// For each touch: how the last link is turned and by how much it is stretched, and three rows d.
    pub fn new(touches: impl ExactSizeIterator<Item = (Rotation3<f64>, f64, Matrix3<f64>)>) -> Turns {
        let mut columns = Columns::zeros(POINTS * 9, touches.len());
        for (row, (turned, stretch, rows)) in touches.enumerate() {
            let v = |axis: usize| -> Vector3<f64> { turned.matrix().column(axis).into() };
            let per_mm = 1.0 / (ARM_MM * stretch);
            for component in 0..3 {
                let d: Vector3<f64> = rows.row(component).transpose();
                let first = d.cross(&v(0)) * per_mm;
                let second = v(2) * (d.dot(&v(0)) * per_mm);
                for (point, direction) in [-(first + second), first, second].iter().enumerate() {
                    for axis in 0..3 {
                        columns.column_mut((3 * point + component) * 3 + axis)[row] = direction[axis];
                    }
                }
            }
        }
        Turns(columns)
    }
}

impl Directions for Turns {
    const COUNT: usize = 3;
    const POINTS_MM: &'static [[f64; 3]] = &[[0.0; 3], [ARM_MM, 0.0, 0.0], [0.0, ARM_MM, 0.0]];

    #[inline(always)]
    fn direction<S: Simd>(&self, simd: S, point: usize, component: usize, k: usize) -> [Lanes<S>; 3] {
        [0, 1, 2].map(|axis| self.0.load(simd, (3 * point + component) * 3 + axis, k))
    }
}
