//! Numbers for the tests of this room.

/// As many, of about one, none like another.
pub fn some(count: usize, seed: f64) -> Vec<f64> {
    (0..count).map(|k| ((k * k) as f64 * 0.618 + seed).sin() + 0.3 * (k as f64 * seed * 0.77).cos()).collect()
}

/// `RᵀR` of rows of n numbers, the plain way.
pub fn information(rows: &[f64], n: usize) -> Vec<f64> {
    let mut m = vec![0.0; n * n];
    for row in rows.chunks_exact(n) {
        (0..n * n).for_each(|k| m[k] += row[k / n] * row[k % n]);
    }
    m
}
