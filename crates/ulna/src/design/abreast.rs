//! What some candidates are worth, a vector's lane each.

use super::blocks::LEAST_PIVOT;
use crate::simd::{Lanes, PAD};
use pulp::{Arch, Simd, WithSimd};

/// Tiles of products are so many rows by so many columns: their sums stay in registers.
const TILE: usize = 4;

/// What a candidate's rows are asked.
pub(super) struct Question {
    /// Rows of a candidate.
    pub each: usize,
    /// Its columns.
    pub unknowns: usize,
    /// `R⁻¹ V`, a row for each unknown, of `width` numbers.
    map: Vec<f64>,
    /// The unknowns, to whole tiles.
    width: usize,
    /// Singular values of what is asked for, without those that are rounding.
    sizes: Vec<f64>,
}

impl Question {
    /// map: `R⁻¹ V`, row and column; sizes: of the first columns.
    pub fn new(each: usize, unknowns: usize, map: impl Fn(usize, usize) -> f64, sizes: Vec<f64>) -> Question {
        let width = unknowns.next_multiple_of(TILE);
        let number = |k: usize| if k % width < unknowns { map(k / width, k % width) } else { 0.0 };
        Question { each, unknowns, map: (0..unknowns * width).map(number).collect(), width, sizes }
    }
}

/// Room for [`PAD`] candidates: numbers of the same place in each stand together.
pub(super) struct Abreast<'a> {
    of: &'a Question,
    rows: Vec<f64>,
    /// `W`, whose columns beyond the unknowns are zero; then `L⁻¹ W S` in the first ones.
    seen: Vec<f64>,
    /// `I + W Wᵀ`, then its factor: whole rows, of which the lower triangle is meant.
    inner: Vec<f64>,
    /// Each pivot, and the diagonal that it is left of.
    pivots: Vec<[f64; PAD]>,
    given: Vec<[f64; PAD]>,
    sums: [f64; PAD],
}

impl Abreast<'_> {
    pub fn new(of: &Question) -> Abreast<'_> {
        let (each, zeros) = (of.each, |count: usize| vec![0.0; count * PAD]);
        Abreast {
            of,
            rows: zeros(each * of.unknowns),
            seen: zeros(each * of.width),
            inner: zeros(each * each),
            pivots: vec![[0.0; PAD]; each],
            given: vec![[0.0; PAD]; each],
            sums: [0.0; PAD],
        }
    }

    /// The gains of up to [`PAD`] candidates, times the number of directions asked for; whether their rows are finite.
    pub fn gains(&mut self, rows: &[f64], gains: &mut [f64]) -> bool {
        let size = self.of.each * self.of.unknowns;
        if gains.len() < PAD {
            self.rows.fill(0.0);
        }
        let mut finite = true;
        for (lane, block) in rows.chunks_exact(size).enumerate() {
            for (value, numbers) in block.iter().zip(self.rows.chunks_exact_mut(PAD)) {
                numbers[lane] = *value;
                finite &= value.is_finite();
            }
        }
        Arch::new().dispatch(GainOp(self));
        for (lane, gain) in gains.iter_mut().enumerate() {
            // I + W Wᵀ is positive definite whatever W is: where it does not look so, W is beyond all numbers
            let definite = |(pivot, given): (&[f64; PAD], &[f64; PAD])| pivot[lane] > LEAST_PIVOT * given[lane];
            let sound = self.pivots.iter().zip(&self.given).all(definite);
            *gain = if sound { self.sums[lane] } else { 0.0 };
        }
        finite
    }
}

struct GainOp<'a, 'b>(&'a mut Abreast<'b>);

impl WithSimd for GainOp<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for part in 0..PAD / S::F64_LANES {
            self.0.see(simd, part);
            self.0.square(simd, part);
            self.0.factor(simd, part);
            self.0.solve(simd, part);
        }
    }
}

impl Abreast<'_> {
    /// `W = Z R⁻¹ V`.
    #[inline(always)]
    fn see<S: Simd>(&mut self, simd: S, part: usize) {
        let Abreast { of, rows, seen, .. } = self;
        let (parts, n, width) = (PAD / S::F64_LANES, of.unknowns, of.width);
        for (first, count) in tiles(of.each) {
            for column in (0..width).step_by(TILE) {
                sums::<S, TILE>(
                    simd,
                    (count, n),
                    #[inline(always)]
                    |i, k| Lanes::load(simd, rows, ((first + i) * n + k) * parts + part),
                    #[inline(always)]
                    |j, k| Lanes::splat(simd, of.map[k * width + column + j]),
                    #[inline(always)]
                    |i, j, sum| sum.store(seen, ((first + i) * width + column + j) * parts + part),
                );
            }
        }
    }

    /// `I + W Wᵀ`.
    #[inline(always)]
    fn square<S: Simd>(&mut self, simd: S, part: usize) {
        let Abreast { of, seen, inner, .. } = self;
        let (parts, each, width) = (PAD / S::F64_LANES, of.each, of.width);
        let at = |i: usize, k: usize| Lanes::load(simd, seen, (i * width + k) * parts + part);
        for (below, count) in tiles(each) {
            for (first, across) in tiles(each).take_while(|&(first, _)| first <= below) {
                let mut store = |i: usize, j: usize, sum: Lanes<S>| {
                    let own = Lanes::splat(simd, if below + i == first + j { 1.0 } else { 0.0 });
                    (sum + own).store(inner, ((below + i) * each + first + j) * parts + part);
                };
                let (left, right) = (|i: usize, k: usize| at(below + i, k), |j: usize, k: usize| at(first + j, k));
                let shape = (count, of.unknowns);
                match across {
                    4 => sums::<S, 4>(simd, shape, left, right, &mut store),
                    3 => sums::<S, 3>(simd, shape, left, right, &mut store),
                    2 => sums::<S, 2>(simd, shape, left, right, &mut store),
                    _ => sums::<S, 1>(simd, shape, left, right, &mut store),
                }
            }
        }
    }

    /// The factor `L` of `I + W Wᵀ`, with the reciprocals of its diagonal in that one's place.
    #[inline(always)]
    fn factor<S: Simd>(&mut self, simd: S, part: usize) {
        let (parts, each) = (PAD / S::F64_LANES, self.of.each);
        let inner = &mut self.inner;
        let place = |i: usize, j: usize| (i * each + j) * parts + part;
        for j in 0..each {
            let mut reciprocal = Lanes::splat(simd, 0.0);
            for i in j..each {
                let given = Lanes::load(simd, inner, place(i, j));
                let mut left = given;
                for k in 0..j {
                    let (a, b) = (Lanes::load(simd, inner, place(i, k)), Lanes::load(simd, inner, place(j, k)));
                    left = a.neg_mul_add(b, left);
                }
                if i == j {
                    left.store(&mut self.pivots[j], part);
                    given.store(&mut self.given[j], part);
                    reciprocal = left.sqrt().reciprocal_or_zero();
                    reciprocal.store(inner, place(j, j));
                } else {
                    (left * reciprocal).store(inner, place(i, j));
                }
            }
        }
    }

    /// The sum of the squares of `L⁻¹ W S`.
    #[inline(always)]
    fn solve<S: Simd>(&mut self, simd: S, part: usize) {
        let Abreast { of, seen, inner, .. } = self;
        let (parts, each, width) = (PAD / S::F64_LANES, of.each, of.width);
        let mut total = Lanes::splat(simd, 0.0);
        for column in (0..of.sizes.len()).step_by(TILE) {
            let place = |i: usize, j: usize| (i * width + column + j) * parts + part;
            let mut squares = [Lanes::splat(simd, 0.0); TILE];
            for i in 0..each {
                let mut left: [_; TILE] = std::array::from_fn(
                    #[inline(always)]
                    |j| Lanes::load(simd, seen, place(i, j)),
                );
                for k in 0..i {
                    let factor = Lanes::load(simd, inner, (i * each + k) * parts + part);
                    for (j, value) in left.iter_mut().enumerate() {
                        *value = factor.neg_mul_add(Lanes::load(simd, seen, place(k, j)), *value);
                    }
                }
                let reciprocal = Lanes::load(simd, inner, (i * each + i) * parts + part);
                for (j, value) in left.iter().enumerate() {
                    let solved = *value * reciprocal;
                    solved.store(seen, place(i, j));
                    squares[j] = solved.mul_add(solved, squares[j]);
                }
            }
            for (square, size) in squares.iter().zip(&of.sizes[column..]) {
                total = square.mul_add(Lanes::splat(simd, size * size), total);
            }
        }
        total.store(&mut self.sums, part);
    }
}

/// So many rows in tiles that are as even as can be: where each begins, and its rows.
#[inline(always)]
fn tiles(rows: usize) -> impl Iterator<Item = (usize, usize)> {
    let count = rows.div_ceil(TILE);
    (0..count).map(move |k| (k * rows / count, (k + 1) * rows / count - k * rows / count))
}

/// Sums over k of `left(i, k) right(j, k)`, of up to [`TILE`] rows i and so many columns j. shape: of rows, and of k.
#[inline(always)]
fn sums<S: Simd, const COLUMNS: usize>(
    simd: S,
    (rows, length): (usize, usize),
    left: impl Fn(usize, usize) -> Lanes<S>,
    right: impl Fn(usize, usize) -> Lanes<S>,
    store: impl FnMut(usize, usize, Lanes<S>),
) {
    match rows {
        4 => tile::<S, 4, COLUMNS>(simd, length, left, right, store),
        3 => tile::<S, 3, COLUMNS>(simd, length, left, right, store),
        2 => tile::<S, 2, COLUMNS>(simd, length, left, right, store),
        _ => tile::<S, 1, COLUMNS>(simd, length, left, right, store),
    }
}

#[inline(always)]
fn tile<S: Simd, const ROWS: usize, const COLUMNS: usize>(
    simd: S,
    length: usize,
    left: impl Fn(usize, usize) -> Lanes<S>,
    right: impl Fn(usize, usize) -> Lanes<S>,
    mut store: impl FnMut(usize, usize, Lanes<S>),
) {
    let mut sums = [[Lanes::splat(simd, 0.0); COLUMNS]; ROWS];
    for k in 0..length {
        let l: [_; ROWS] = std::array::from_fn(
            #[inline(always)]
            |i| left(i, k),
        );
        let r: [_; COLUMNS] = std::array::from_fn(
            #[inline(always)]
            |j| right(j, k),
        );
        for i in 0..ROWS {
            for j in 0..COLUMNS {
                sums[i][j] = l[i].mul_add(r[j], sums[i][j]);
            }
        }
    }
    for (i, row) in sums.iter().enumerate() {
        for (j, sum) in row.iter().enumerate() {
            store(i, j, *sum);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::samples::some;

    /// Vectors of one number are what a machine without any has: each part of the room is worked on by itself.
    #[test]
    fn gains_are_the_same_whatever_vectors_the_machine_has() {
        for (each, n) in [(1, 1), (5, 3), (13, 27)] {
            let map = some(n * n, 0.2);
            let question = Question::new(each, n, |i, j| map[i * n + j], some(n, 1.3));
            let rows = some(PAD * each * n, 0.7);
            let (mut here, mut found) = (Abreast::new(&question), vec![0.0; PAD]);
            assert!(here.gains(&rows, &mut found));
            here.sums.fill(0.0);
            GainOp(&mut here).with_simd(pulp::Scalar);
            for (one, other) in here.sums.iter().zip(&found) {
                assert!(*other > 0.0 && (one - other).abs() < 1e-11 * other, "{one} {other}");
            }
        }
    }

    #[test]
    fn rows_beyond_all_numbers_are_worth_nothing_and_tell_nothing_of_their_neighbours() {
        let question = Question::new(2, 2, |i, j| if i == j { 1.0 } else { 0.0 }, vec![1.0, 1.0]);
        let plain = [1.0, 0.0, 0.0, 1.0];
        let rows = [plain, [1e200, 1e200, 1e200, 1e200], plain].concat();
        let mut found = [0.0; 3];
        assert!(Abreast::new(&question).gains(&rows, &mut found));
        assert_eq!(found[1], 0.0);
        assert!((found[0] - 1.0).abs() < 1e-15 && found[0] == found[2]);
        assert!(!Abreast::new(&question).gains(&[f64::NAN, 0.0, 0.0, 1.0], &mut found[..1]));
    }
}
