//! Numbers that carry their derivatives: models are written as they are printed, and no derivative by hand can be wrong.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Most unknowns of a problem.
pub const MOST: usize = 9;

/// A value and its derivatives with respect to the unknowns.
#[derive(Debug, Clone, Copy)]
pub struct Dual {
    pub value: f64,
    pub slopes: [f64; MOST],
}

impl Dual {
    /// A number that no unknown moves.
    pub fn constant(value: f64) -> Dual {
        Dual { value, slopes: [0.0; MOST] }
    }

    /// The unknowns themselves.
    pub fn unknowns(x: &[f64]) -> Vec<Dual> {
        let unknown = |j: usize| Dual { value: x[j], slopes: std::array::from_fn(|k| f64::from(u8::from(j == k))) };
        (0..x.len()).map(unknown).collect()
    }

    /// A function of this number, given its value and its derivative.
    fn by(self, value: f64, slope: f64) -> Dual {
        Dual { value, slopes: self.slopes.map(|s| if s == 0.0 { 0.0 } else { slope * s }) }
    }

    fn product(self, other: Dual) -> Dual {
        let slope = |k: usize| self.slopes[k] * other.value + self.value * other.slopes[k];
        Dual { value: self.value * other.value, slopes: std::array::from_fn(slope) }
    }

    pub fn exp(self) -> Dual {
        self.by(self.value.exp(), self.value.exp())
    }

    pub fn sin(self) -> Dual {
        self.by(self.value.sin(), self.value.cos())
    }

    pub fn cos(self) -> Dual {
        self.by(self.value.cos(), -self.value.sin())
    }

    pub fn atan(self) -> Dual {
        self.by(self.value.atan(), 1.0 / (1.0 + self.value * self.value))
    }

    pub fn ln(self) -> Dual {
        self.by(self.value.ln(), 1.0 / self.value)
    }

    pub fn sqrt(self) -> Dual {
        self.by(self.value.sqrt(), 0.5 / self.value.sqrt())
    }

    pub fn squared(self) -> Dual {
        self * self
    }

    /// To a power that is an unknown too; of positive numbers.
    pub fn power(self, exponent: Dual) -> Dual {
        (self.ln() * exponent).exp()
    }
}

impl From<f64> for Dual {
    fn from(value: f64) -> Dual {
        Dual::constant(value)
    }
}

impl<T: Into<Dual>> Add<T> for Dual {
    type Output = Dual;
    fn add(self, other: T) -> Dual {
        let other = other.into();
        Dual { value: self.value + other.value, slopes: std::array::from_fn(|k| self.slopes[k] + other.slopes[k]) }
    }
}

impl<T: Into<Dual>> Sub<T> for Dual {
    type Output = Dual;
    fn sub(self, other: T) -> Dual {
        self + -other.into()
    }
}

impl<T: Into<Dual>> Mul<T> for Dual {
    type Output = Dual;
    fn mul(self, other: T) -> Dual {
        self.product(other.into())
    }
}

impl<T: Into<Dual>> Div<T> for Dual {
    type Output = Dual;
    fn div(self, other: T) -> Dual {
        let other = other.into();
        self * other.by(1.0 / other.value, -1.0 / (other.value * other.value))
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        self * -1.0
    }
}
