//! A derivative checker: analytic columns against central differences with Richardson's extrapolation.

/// Largest |analytic - numerical| over all entries of a Jacobian.
///
/// `value` maps `x` to m numbers, `analytic` is row-major m × x.len(), `step` the difference taken in each unknown.
pub fn worst_difference(value: impl Fn(&[f64]) -> Vec<f64>, x: &[f64], step: &[f64], analytic: &[f64]) -> f64 {
    let mut worst = 0.0_f64;
    for j in 0..x.len() {
        let central = |h: f64| -> Vec<f64> {
            let at = |sign: f64| {
                let mut moved = x.to_vec();
                moved[j] += sign * h;
                value(&moved)
            };
            at(1.0).iter().zip(at(-1.0)).map(|(up, down)| (up - down) / (2.0 * h)).collect()
        };
        let (wide, narrow) = (central(step[j]), central(step[j] / 2.0));
        for (i, (w, n)) in wide.iter().zip(&narrow).enumerate() {
            let numerical = n + (n - w) / 3.0;
            worst = worst.max((analytic[i * x.len() + j] - numerical).abs());
        }
    }
    worst
}
