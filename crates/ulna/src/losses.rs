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
