//! Figures that lie at given distances from given points: the least squares behind spheres, planes and cylinders.
//!
//! Knows no arm. A figure is the point, line or plane whose distances from the points come closest to what each should be
//! apart; where nothing is known of a radius, the same is added to all of them and found as well.

mod contact;
mod descent;
pub mod line;
pub mod plane;
pub mod point;

pub use contact::Contact;
