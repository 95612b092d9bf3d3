//! Householder reflections that fold a block of rows into a triangle above it: the one orthogonal step that
//! eliminates placements, makes the triangular factor and so decides rank.

use crate::simd::Columns;
use crate::simd::{Lanes, PAD};
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// Reflects rows `rows` of the columns listed in `order` against `top`, pivot by pivot.
///
/// `top` is row-major, one row a pivot, `order.len()` wide. Afterwards the pivots' columns are gone from the block
/// (their entries are stale) and the others hold what is orthogonal to them. Start and length of `rows` are
/// multiples of the padding, surplus rows zero.
pub fn fold_into(top: &mut [f64], pivots: usize, columns: &mut Columns, order: &[usize], rows: Range<usize>) {
    debug_assert!(rows.start.is_multiple_of(PAD) && rows.len().is_multiple_of(PAD));
    Arch::new().dispatch(ReflectOp { top, pivots, columns, order, rows });
}

/// A sum of squares of less is nothing: its entries are a hundred decades below any that matter.
const NOTHING: f64 = 1e-280;

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
        let ReflectOp { top, pivots, columns, order, rows } = self;
        let width = order.len();
        let vectors = rows.len() / S::F64_LANES;
        let mut pivot_column = [0.0; super::equations::BLOCK_ROWS];
        for k in 0..pivots {
            let pivot = &mut pivot_column[..rows.len()];
            pivot.copy_from_slice(&columns.column(order[k])[rows.clone()]);
            let mut below = Lanes::splat(simd, 0.0);
            for i in 0..vectors {
                let v = Lanes::load(simd, pivot, i);
                below = v.mul_add(v, below);
            }
            let below = below.sum();
            // what rounding leaves of a few rows shrinks from pivot to pivot, until its square has no reciprocal
            if below < NOTHING {
                continue;
            }
            let alpha = top[k * width + k];
            let beta = -(alpha * alpha + below).sqrt().copysign(alpha);
            let head = alpha - beta;
            let tau = 2.0 / (head * head + below);
            top[k * width + k] = beta;
            let mut j = k + 1;
            while j < width {
                let together = if width - j >= TOGETHER { TOGETHER } else { 1 };
                let range: [usize; TOGETHER] = std::array::from_fn(|t| order[(j + t).min(width - 1)]);
                let above = &mut top[k * width + j..][..together];
                let head = Head { simd, pivot, first: rows.start / S::F64_LANES, head, tau };
                if together == TOGETHER {
                    head.reflect::<TOGETHER>(columns, range, above);
                } else {
                    head.reflect::<1>(columns, [range[0]], above);
                }
                j += together;
            }
        }
    }
}

/// One reflection, ready to be applied.
#[derive(Clone, Copy)]
struct Head<'a, S> {
    simd: S,
    pivot: &'a [f64],
    /// first vector of the rows
    first: usize,
    head: f64,
    tau: f64,
}

impl<S: Simd> Head<'_, S> {
    /// Reflects `N` columns at once, with a chain of sums for each.
    #[inline(always)]
    fn reflect<const N: usize>(self, columns: &mut Columns, which: [usize; N], above: &mut [f64]) {
        let Head { simd, pivot, first, head, tau } = self;
        let vectors = pivot.len() / S::F64_LANES;
        let mut dots = [Lanes::splat(simd, 0.0); N];
        for i in 0..vectors {
            let p = Lanes::load(simd, pivot, i);
            for t in 0..N {
                dots[t] = p.mul_add(columns.load(simd, which[t], first + i), dots[t]);
            }
        }
        let mut factors = [Lanes::splat(simd, 0.0); N];
        for t in 0..N {
            let factor = (above[t] * head + dots[t].sum()) * tau;
            above[t] -= factor * head;
            factors[t] = Lanes::splat(simd, factor);
        }
        for i in 0..vectors {
            let p = Lanes::load(simd, pivot, i);
            for t in 0..N {
                let value = p.neg_mul_add(factors[t], columns.load(simd, which[t], first + i));
                columns.store(which[t], first + i, value);
            }
        }
    }
}
