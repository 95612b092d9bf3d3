//! Units of parameters.

/// What a parameter is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// radian
    Rad,
    /// millimetre
    Mm,
    /// part of a length for each kelvin
    PerKelvin,
    /// radian for each newton metre
    RadPerNewtonMetre,
    /// a plain number: the scale of an instrument
    One,
}

impl Unit {
    /// `"rad"`, `"mm"`, `"1/K"`, `"rad/(N m)"` or `"1"`.
    pub fn as_str(self) -> &'static str {
        match self {
            Unit::Rad => "rad",
            Unit::Mm => "mm",
            Unit::PerKelvin => "1/K",
            Unit::RadPerNewtonMetre => "rad/(N m)",
            Unit::One => "1",
        }
    }
}
