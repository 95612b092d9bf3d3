//! Losses: how much a reading counts that is far off. Knows no kinematics.

/// A loss of the length t of a residual vector, in units of its scatter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loss {
    /// Squares near, lengths far off: outliers pull with a bounded force (Huber 1964).
    Huber,
    /// `log(1 + (t/c)²)`: outliers pull less the farther they are off.
    Cauchy,
    /// Tukey's biweight: beyond c outliers pull no more (Beaton and Tukey 1974).
    Tukey,
}

/// Constants that make each loss 95 % as efficient as least squares where residuals are normal, in 1, 2 and 3 dimensions
/// (solved numerically; a test holds them to the integral that defines them).
const HUBER: [f64; 3] = [1.3450, 1.5011, 1.6280];
const CAUCHY: [f64; 3] = [2.3849, 2.5486, 2.6656];
const TUKEY: [f64; 3] = [4.6851, 5.1230, 5.4902];

impl Loss {
    /// `"huber"`, `"cauchy"` or `"tukey"`.
    pub fn as_str(self) -> &'static str {
        match self {
            Loss::Huber => "huber",
            Loss::Cauchy => "cauchy",
            Loss::Tukey => "tukey",
        }
    }

    /// By its name.
    pub fn named(name: &str) -> Option<Loss> {
        [Loss::Huber, Loss::Cauchy, Loss::Tukey].into_iter().find(|loss| loss.as_str() == name)
    }

    /// The length that tells near from far, for a residual of so many dimensions, 1 to 3.
    pub fn tuning(self, dimensions: f64) -> f64 {
        match self {
            Loss::Huber => between(HUBER, dimensions),
            Loss::Cauchy => between(CAUCHY, dimensions),
            Loss::Tukey => between(TUKEY, dimensions),
        }
    }

    /// What a residual of length t counts, 1 for a short one: `ρ'(t)/t`.
    pub fn weight(self, t: f64, tuning: f64) -> f64 {
        let far = t / tuning;
        match self {
            Loss::Huber => 1.0 / far.max(1.0),
            Loss::Cauchy => 1.0 / (1.0 + far * far),
            Loss::Tukey => (1.0 - far * far).max(0.0).powi(2),
        }
    }

    /// How fast that falls: `t · dw/dt`.
    pub fn slope(self, t: f64, tuning: f64) -> f64 {
        let far = t / tuning;
        match self {
            Loss::Huber if far > 1.0 => -1.0 / far,
            Loss::Huber => 0.0,
            Loss::Cauchy => -2.0 * far * far / (1.0 + far * far).powi(2),
            Loss::Tukey => -4.0 * far * far * (1.0 - far * far).max(0.0),
        }
    }
}

/// Median length of a normal vector of unit deviation in 1, 2 and 3 dimensions (root of the median of χ²).
const MEDIAN: [f64; 3] = [0.674_490, 1.177_410, 1.538_172];
/// The length that one such vector in ten thousand exceeds.
const RARE: [f64; 3] = [3.890_592, 4.291_932, 4.594_291];

/// Median length of a normal residual of so many dimensions.
pub fn median_length(dimensions: f64) -> f64 {
    between(MEDIAN, dimensions)
}

/// The length that one normal residual of so many dimensions in ten thousand exceeds.
pub fn rare_length(dimensions: f64) -> f64 {
    between(RARE, dimensions)
}

/// Of a table for 1, 2 and 3 dimensions, linearly between them.
fn between(table: [f64; 3], dimensions: f64) -> f64 {
    let at = dimensions.clamp(1.0, 3.0) - 1.0;
    if at < 1.0 { table[0] + at * (table[1] - table[0]) } else { table[1] + (at - 1.0) * (table[2] - table[1]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expectation over the length of a normal vector of d dimensions and unit deviation, by Simpson's rule piecewise
    /// between the points where `of` has an edge.
    fn expected(d: usize, edge: f64, of: impl Fn(f64) -> f64) -> f64 {
        let norm = [(2.0 / std::f64::consts::PI).sqrt(), 1.0, (2.0 / std::f64::consts::PI).sqrt()][d - 1];
        let density = |t: f64| norm * t.powi(d as i32 - 1) * (-0.5 * t * t).exp();
        let simpson = |from: f64, to: f64| {
            let (n, h) = (2000, (to - from) / 2000.0);
            let weight = |k: usize| if k == 0 || k == n { 1.0 } else { [2.0, 4.0][k % 2] };
            (0..=n).map(|k| (k, from + h * k as f64)).map(|(k, t)| weight(k) * of(t) * density(t)).sum::<f64>() * h
                / 3.0
        };
        // just this side and that side of the edge
        simpson(0.0, edge * (1.0 - 1e-12)) + simpson(edge * (1.0 + 1e-12), 14.0)
    }

    #[test]
    fn tuning_costs_five_percent_of_efficiency() {
        for loss in [Loss::Huber, Loss::Cauchy, Loss::Tukey] {
            for d in 1..=3 {
                let c = loss.tuning(d as f64);
                let slope = expected(d, c, |t| loss.weight(t, c) + loss.slope(t, c) / d as f64);
                let square = expected(d, c, |t| (loss.weight(t, c) * t).powi(2)) / d as f64;
                let efficiency = slope * slope / square;
                assert!((efficiency - 0.95).abs() < 5e-5, "{loss:?} in {d} dimensions: {efficiency}");
            }
        }
    }

    #[test]
    fn lengths_of_normal_vectors() {
        for d in 1..=3 {
            let below = |edge: f64| expected(d, edge, |t| f64::from(t < edge));
            assert!((below(median_length(d as f64)) - 0.5).abs() < 1e-5);
            assert!((below(rare_length(d as f64)) - 0.9999).abs() < 1e-8);
        }
    }

    #[test]
    fn slopes_are_those_of_the_weights() {
        for loss in [Loss::Huber, Loss::Cauchy, Loss::Tukey] {
            for t in [0.3, 1.1, 2.2, 4.0, 6.5] {
                let step = 1e-6;
                let numeric = (loss.weight(t + step, 3.0) - loss.weight(t - step, 3.0)) / (2.0 * step);
                assert!((loss.slope(t, 3.0) - t * numeric).abs() < 1e-8, "{loss:?} at {t}");
            }
        }
    }
}
