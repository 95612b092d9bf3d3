//! How far the two touches of a length are off, each from its end.

use nalgebra::{Matrix3, Vector3};

/// Two touches of features that are a length apart.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    /// the tips, base frame
    pub p_mm: [Vector3<f64>; 2],
    pub length_mm: f64,
    /// their covariances; none where both are alike in all directions
    pub sigma: Option<[Matrix3<f64>; 2]>,
}

/// Steps towards the multiplier; some four are enough.
const STEPS: usize = 100;

/// Each tip less its end, where the ends fit best: least squares of the two, weighed by Σ₁⁻¹ and Σ₂⁻¹.
///
/// With δ the difference of the tips, d that of the ends, `‖d‖ = L`, and Σ = Σ₁ + Σ₂: they are `μ Σ₁ d` and `-μ Σ₂ d`, where
/// `(I + μ Σ) d = δ` (Lagrange); μ is found by Newton's method on `1/L - 1/‖d(μ)‖`, which is nearly linear.
pub(super) fn apart(ends: &Ends) -> [Vector3<f64>; 2] {
    let [first, second] = ends.p_mm;
    let (delta, length) = (first - second, ends.length_mm);
    let distance = delta.norm();
    // tips at one place do not say which way the ends lie
    let along = if distance > 0.0 { delta / distance } else { Vector3::x() };
    let Some([sigma_1, sigma_2]) = ends.sigma.filter(|_| distance > 0.0) else {
        let half = along * (0.5 * (distance - length));
        return [half, -half];
    };
    let sigma = sigma_1 + sigma_2;
    let mut mu = (distance - length) / (length * along.dot(&(sigma * along)));
    let (mut good, mut d) = (0.0, delta);
    for _ in 0..STEPS {
        let Some(factor) = (Matrix3::identity() + sigma * mu).cholesky() else {
            // too far: ends on the other side of what is best
            mu = 0.5 * (mu + good);
            continue;
        };
        (good, d) = (mu, factor.solve(&delta));
        let size = d.norm();
        let too_long = size / length - 1.0;
        if too_long.abs() <= 4.0 * f64::EPSILON {
            break;
        }
        mu += too_long * size * size / d.dot(&factor.solve(&(sigma * d)));
    }
    [sigma_1 * d * mu, -(sigma_2 * d * mu)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread(seed: usize) -> f64 {
        ((seed * seed + 7 * seed + 3) as f64 * 0.754_877_666).fract() - 0.5
    }

    #[test]
    fn ends_are_a_length_apart_and_nothing_pulls_them_along() {
        for seed in 0..200 {
            let vector = |k: usize| Vector3::from_fn(|j, _| spread(41 * seed + 5 * k + j));
            let covariance = |k: usize, size: f64| {
                let root = Matrix3::from_fn(|i, j| spread(97 * seed + 31 * k + 3 * i + j));
                (root * root.transpose() + Matrix3::identity() * 0.02) * size
            };
            let sigma = [covariance(1, 1e-4), covariance(2, 4e-4)];
            let p_mm = [vector(0) * 500.0, vector(3) * 500.0];
            let apart_mm = (p_mm[0] - p_mm[1]).norm();
            for length_mm in [apart_mm + 0.02, apart_mm - 0.3, 1.2 * apart_mm, 0.4 * apart_mm] {
                let [a, b] = apart(&Ends { p_mm, length_mm, sigma: Some(sigma) });
                let between = (p_mm[0] - a) - (p_mm[1] - b);
                assert!((between.norm() - length_mm).abs() < 1e-9 * length_mm, "{seed}: {length_mm}");
                let pull = [sigma[0], sigma[1]].map(|s| s.try_inverse().unwrap());
                // both pulls balance, and point along the line: no shift and no turn makes the sum of squares less
                let (first, second) = (pull[0] * a, pull[1] * b);
                assert!((first + second).norm() < 1e-9 * first.norm(), "{seed}: {length_mm}");
                assert!(first.cross(&between).norm() < 1e-9 * first.norm() * between.norm(), "{seed}: {length_mm}");
                // and it is not the farther side
                let least = a.dot(&first) + b.dot(&second);
                let mirrored = p_mm[0] - p_mm[1] + between.normalize() * length_mm;
                let worse = mirrored.dot(&((sigma[0] + sigma[1]).try_inverse().unwrap() * mirrored));
                assert!(least <= worse, "{seed}: {length_mm}");
            }
        }
    }

    #[test]
    fn alike_weights_share_what_is_off() {
        let p_mm = [Vector3::new(0.0, 0.0, 10.0), Vector3::zeros()];
        let one = Matrix3::identity() * 0.3;
        for sigma in [None, Some([one, one])] {
            let [a, b] = apart(&Ends { p_mm, length_mm: 9.0, sigma });
            assert!((a - Vector3::new(0.0, 0.0, 0.5)).norm() < 1e-12 && (a + b).norm() < 1e-12);
        }
    }
}
