//! Householder reflections that fold a block of rows into a triangle above it: the one orthogonal step that
//! eliminates placements, makes the triangular factor and so decides rank.

use crate::kinematics::batch::Columns;
use crate::kinematics::lanes::{Lanes, PAD};
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// Reflects rows `rows` of the columns listed in `order` against `top`, pivot by pivot.
///
/// `top` is row-major, one row a pivot, `order.len()` wide. Afterwards the pivots' columns are gone from the block
/// (their entries are stale) and the others hold what is orthogonal to them. Start and length of `rows` are
/// multiples of the padding, surplus rows zero.
pub fn fold_into(top: &mut [f64], pivots: usize, columns: &mut Columns, order: &[usize], rows: Range<usize>) {
    debug_assert!(rows.start % PAD == 0 && rows.len() % PAD == 0);
    Arch::new().dispatch(ReflectOp {
        top,
        pivots,
        columns,
        order,
        rows,
    });
}

/// Columns reflected together, so that the pivot's column is read once for all of them.
const TOGETHER: usize = 4;

struct ReflectOp<'a> {
    top: &'a mut [f64],
    pivots: usize,
    columns: &'a mut Columns,
    order: &'a [usize],
    rows: Range<usize>,
}

impl WithSimd for ReflectOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let ReflectOp {
            top,
            pivots,
            columns,
            order,
            rows,
        } = self;
        let width = order.len();
        let vectors = rows.len() / S::F64_LANES;
        let mut pivot_column = [0.0; super::BLOCK_ROWS];
        for k in 0..pivots {
            let pivot = &mut pivot_column[..rows.len()];
            pivot.copy_from_slice(&columns.column(order[k])[rows.clone()]);
            let mut below = Lanes::splat(simd, 0.0);
            for i in 0..vectors {
                let v = Lanes::load(simd, pivot, i);
                below = v.mul_add(v, below);
            }
            let below = below.sum();
            if below == 0.0 {
                continue;
            }
            let alpha = top[k * width + k];
            let beta = -(alpha * alpha + below).sqrt().copysign(alpha);
            let head = alpha - beta;
            let tau = 2.0 / (head * head + below);
            top[k * width + k] = beta;
            for j in (k + 1..width).step_by(TOGETHER) {
                let together = TOGETHER.min(width - j);
                let mut dots = [Lanes::splat(simd, 0.0); TOGETHER];
                for (t, dot) in dots.iter_mut().enumerate().take(together) {
                    let column = &columns.column(order[j + t])[rows.clone()];
                    for i in 0..vectors {
                        *dot = Lanes::load(simd, pivot, i).mul_add(Lanes::load(simd, column, i), *dot);
                    }
                }
                for (t, dot) in dots.iter().enumerate().take(together) {
                    let above = &mut top[k * width + j + t];
                    let factor = (*above * head + dot.sum()) * tau;
                    *above -= factor * head;
                    let factor = Lanes::splat(simd, factor);
                    let column = &mut columns.column_mut(order[j + t])[rows.clone()];
                    for i in 0..vectors {
                        let reflected = Lanes::load(simd, pivot, i).neg_mul_add(factor, Lanes::load(simd, column, i));
                        reflected.store(column, i);
                    }
                }
            }
        }
    }
}
