//! What touches.

/// A probe: a name and the tip, a point that turns with the last joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Its name in files and parameter names.
    pub name: String,
    /// x, y, z of the tip in the frame of the last joint, mm.
    pub tip_mm: [f64; 3],
}
