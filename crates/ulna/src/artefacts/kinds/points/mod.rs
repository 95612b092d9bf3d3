//! `points`, `bar`, `seat`: the tip on a feature with known coordinates, of an artefact that stands somewhere.
//!
//! ```text
//! r = W (p(q) - (R f + t))       WᵀW = Σ⁻¹,  Σ = J_q Σ_encoder J_qᵀ + σ_seat² I + u_f² I (a feature touched once)
//! ```
//!
//! A seat is an artefact of one feature, a bar of two. With `frame = "arm"` R and t are known (none).

mod apart;
mod bars;
mod features;
mod lengths;
mod observed;
mod placement;
mod scene;
mod stated;
mod touched;
mod weigh;

pub(super) use stated::KIND;
