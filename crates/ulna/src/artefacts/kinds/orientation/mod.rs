//! `orientation`: how a target on the last link is turned, as an instrument sees it: a laser tracker's probe of six
//! degrees of freedom, a camera, a gyroscope.
//!
//! ```text
//! r = W · lever · 2 v      (w, v) the quaternion of R(q) M (F R_m)ᵀ with w ≥ 0,    WᵀW = Σ⁻¹
//! ```
//!
//! R(q) is the orientation of the last link, M how the target is mounted on it, F that of the instrument's frame (one for
//! each standing; none with `frame = "arm"`), R_m what was measured. Twice the vector part is the angle to third order, and
//! half its square is what Frobenius' norm of the difference of two rotations has: so F has a closed form. The lever, mm,
//! says how much an angle counts beside a length.

mod attitudes;
mod directions;
mod observed;
mod scene;
mod stated;
mod turned;

pub(super) use stated::KIND;
