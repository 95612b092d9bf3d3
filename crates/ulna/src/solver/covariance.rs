//! Covariance of the parameters: from the noise, and from what is not known of the artefacts.

use super::decomposition::Decomposition;
use super::triangle::Triangle;

/// `s² (JᵀJ)⁺ + Σ_c (J⁺ ∂r/∂c) u_c² (J⁺ ∂r/∂c)ᵀ`, row-major over the unknowns.
///
/// The second part is that of the considered dimensions (a bar's length, a plate's features): known with `u`, common
/// to all readings and not fitted (consider covariance, Schmidt 1966). Directions that the readings do not
/// determine are held at their values.
pub fn covariance(decomposition: &Decomposition, triangle: &Triangle, variance: f64, considered_u: &[f64]) -> Vec<f64> {
    let mut covariance = decomposition.covariance();
    covariance.iter_mut().for_each(|c| *c *= variance);
    let n = covariance.len().isqrt();
    for (c, u) in considered_u.iter().enumerate() {
        let sensitivity = decomposition.pseudo_solve(triangle, n + c);
        for i in 0..n {
            for j in 0..n {
                covariance[i * n + j] += sensitivity[i] * sensitivity[j] * u * u;
            }
        }
    }
    covariance
}
