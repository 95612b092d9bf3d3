//! Which readings are far off, in units of the scatter of their own kind, and what a loss makes of them.
//!
//! A reading's placement follows it, and so does the arm, so that its residual is smaller than its error: lengths are
//! judged against the degrees of freedom that the reading has left. The scatter of each group is taken from the median of its lengths,
//! which half of them could not move (Hampel 1974).

use crate::artefacts::Whitened;
use crate::solver::losses::{Loss, median_length, rare_length};

/// How readings stand, group by group, in the order they were given.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Standing {
    /// Scatter of each group, in units of its stated noise (mm where none is stated).
    pub scales: Vec<f64>,
    /// Length of each reading's residual, in units of the scatter; 0 where it has no freedom.
    pub lengths: Vec<Vec<f64>>,
    /// Dimensions of each residual, 1 to 3.
    pub dimensions: Vec<Vec<f64>>,
}

/// Degrees of freedom below which a residual shows nothing.
const NO_FREEDOM: f64 = 1e-6;
/// A fit of nearly as many parameters as equations leaves residuals that say nothing of the errors.
const LEAST_LEFT: f64 = 1e-3;

impl Standing {
    /// Of the whitened residuals of a fit with so many degrees of freedom. Scatter below `least` is none: rounding.
    pub fn of(whitened: &[Whitened], degrees_of_freedom: f64, least: f64) -> Standing {
        Standing::with_scales(whitened, degrees_of_freedom, |lengths| median(lengths).max(least))
    }

    /// The same, the scatter of each group being known.
    pub fn again(&self, whitened: &[Whitened], degrees_of_freedom: f64) -> Standing {
        let mut scales = self.scales.iter();
        Standing::with_scales(whitened, degrees_of_freedom, |_| scales.next().copied().unwrap_or(1.0))
    }

    fn with_scales(
        whitened: &[Whitened],
        degrees_of_freedom: f64,
        mut scale: impl FnMut(&mut Vec<f64>) -> f64,
    ) -> Standing {
        let mut standing = Standing::default();
        let all: f64 = whitened.iter().flat_map(|group| &group.freedoms).sum();
        // what the fitted parameters take is taken from all readings alike
        let left = if all > 0.0 { (degrees_of_freedom / all).clamp(LEAST_LEFT, 1.0) } else { 1.0 };
        for group in whitened {
            let dimensions: Vec<f64> = group.freedoms.iter().map(|freedom| freedom.clamp(1.0, 3.0)).collect();
            let each = group.norms.iter().zip(&group.freedoms).zip(&dimensions);
            let length = |((norm, freedom), dimension): ((&f64, &f64), &f64)| {
                if *freedom > NO_FREEDOM { norm * (dimension / (freedom * left)).sqrt() } else { 0.0 }
            };
            let mut lengths: Vec<f64> = each.map(length).collect();
            let free = group.freedoms.iter().zip(&lengths).zip(&dimensions);
            let free = free.filter(|((freedom, _), _)| **freedom > NO_FREEDOM);
            let mut of_median: Vec<f64> = free.map(|((_, length), d)| length / median_length(*d)).collect();
            let scale = scale(&mut of_median);
            lengths.iter_mut().for_each(|length| *length /= scale);
            standing.scales.push(scale);
            standing.lengths.push(lengths);
            standing.dimensions.push(dimensions);
        }
        standing
    }

    fn each(&self, of: impl Fn(f64, f64) -> f64) -> Vec<Vec<f64>> {
        let group = |(lengths, dimensions): (&Vec<f64>, &Vec<f64>)| {
            lengths.iter().zip(dimensions).map(|(&t, &d)| of(t, d)).collect()
        };
        self.lengths.iter().zip(&self.dimensions).map(group).collect()
    }

    /// What a loss lets each reading count, 0 to 1.
    pub fn weights(&self, loss: Loss) -> Vec<Vec<f64>> {
        self.each(|t, d| loss.weight(t, loss.tuning(d)))
    }

    /// Which readings of a group are farther off than one normal residual in ten thousand.
    pub fn outliers_of(&self, group: usize) -> impl Iterator<Item = bool> {
        self.lengths[group].iter().zip(&self.dimensions[group]).map(|(&t, &d)| t > rare_length(d))
    }

    /// The share of the equations, placements taken off, that the fitted parameters take.
    pub fn fitted(whitened: &[Whitened], degrees_of_freedom: f64) -> f64 {
        let count: f64 = whitened.iter().flat_map(|group| &group.freedoms).sum();
        (1.0 - degrees_of_freedom / count).clamp(0.0, 1.0 - LEAST_LEFT)
    }

    /// The variance of a whitened residual that gives a robust fit its covariance, `c² E[ψ²] (1 - κ) / κ²`, where the fitted
    /// parameters have the share κ of the equations, and `E[1 / (1 + c ψ')] = 1 - κ` says c: right however many parameters
    /// there are for each equation, as both grow (Bean, Bickel, El Karoui and Yu 2013). With least squares `c = κ / (1 - κ)`
    /// and it is the sum of squares over the degrees of freedom; with few parameters it is Huber's `E[ψ²] / E[ψ']²`.
    pub fn variance(&self, whitened: &[Whitened], loss: Loss, degrees_of_freedom: f64) -> f64 {
        let (mut squares, mut count, mut slopes) = (0.0, 0.0, vec![]);
        for ((group, lengths), dimensions) in whitened.iter().zip(&self.lengths).zip(&self.dimensions) {
            for (((norm, freedom), &t), &d) in group.norms.iter().zip(&group.freedoms).zip(lengths).zip(dimensions) {
                let tuning = loss.tuning(d);
                let (across, slope) = (loss.weight(t, tuning), loss.slope(t, tuning));
                squares += (across * norm).powi(2);
                count += freedom;
                // of the d directions of a residual, one is its own
                slopes.push((freedom * (d - 1.0) / d, across));
                slopes.push((freedom / d, across + slope));
            }
        }
        let fitted = Standing::fitted(whitened, degrees_of_freedom);
        // c over κ: for next to no parameters the limit
        let per_fitted = if fitted < FEW {
            count / slopes.iter().map(|(weight, slope)| weight * slope).sum::<f64>()
        } else {
            shift(fitted, &slopes, count) / fitted
        };
        squares / count * (1.0 - fitted) * per_fitted.powi(2)
    }

    /// Scatter over all groups, by their degrees of freedom.
    pub fn pooled_scale(&self, whitened: &[Whitened]) -> f64 {
        let freedoms = whitened.iter().map(|group| group.freedoms.iter().sum::<f64>());
        let (mut sum, mut count) = (0.0, 0.0);
        for (scale, freedom) in self.scales.iter().zip(freedoms) {
            sum += freedom * scale * scale;
            count += freedom;
        }
        if count > 0.0 { (sum / count).sqrt() } else { 1.0 }
    }
}

/// A share of fitted parameters that changes no digit.
const FEW: f64 = 1e-6;

/// The c with which `E[1 / (1 + c ψ')]` is what is left beside the fitted share, by halving: it falls as c grows. Where a loss
/// lets go of a residual and ψ' is below zero, nothing holds it: as where it is zero.
/// Slopes with their weights, of which `count` is the sum.
fn shift(fitted: f64, slopes: &[(f64, f64)], count: f64) -> f64 {
    let left = |c: f64| slopes.iter().map(|(weight, slope)| weight / (1.0 + c * slope.max(0.0))).sum::<f64>() / count;
    let (mut low, mut high) = (0.0, 1.0);
    while left(high) > 1.0 - fitted && high < MOST_SHIFT {
        high *= 2.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if left(middle) > 1.0 - fitted { low = middle } else { high = middle }
    }
    high
}

const MOST_SHIFT: f64 = 1e6;

/// The middle one; 0 of none.
fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    let upper = *values.select_nth_unstable_by(middle, f64::total_cmp).1;
    if !values.len().is_multiple_of(2) {
        return upper;
    }
    let lower = values[..middle].iter().copied().fold(f64::MIN, f64::max);
    0.5 * (lower + upper)
}
