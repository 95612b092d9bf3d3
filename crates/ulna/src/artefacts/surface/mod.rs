//! `sphere`, `plane`: a ball tip on a surface that stands somewhere; one file for each shape.
//!
//! ```text
//! r = w (distance of p(q) from the surface, less the ball's radius)      ∂r = w n · ∂p(q)      w⁻² = nᵀ Σ n
//! ```
//!
//! with n the surface's normal where it is touched, and Σ the covariance of the tip for the stated noise.

mod plane;
mod readings;
mod shape;
mod sphere;

pub use plane::Plane;
pub use readings::Surface;
pub use shape::{Contact, Shape, Touched};
pub use sphere::{Side, Sphere};
