//! What uncertain parameters do to a measured point.

use crate::arm::Arm;
use crate::kinematics::batch::for_each_derivative;
use crate::kinematics::{Chain, jacobian, tip_mm};
use crate::numdiff;

/// Poses whose derivatives are kept at once.
const TILE: usize = 512;

/// `J C Jᵀ` of each pose: xx, xy, xz, yy, yz, zz in mm², row-major. `columns` names the parameters that the row-major
/// covariance is of.
pub fn tip_covariance(
    arm: &Arm,
    probe: usize,
    tip_mm: [f64; 3],
    q_rad: &[f64],
    columns: &[usize],
    covariance: &[f64],
) -> Vec<f64> {
    let k = columns.len();
    let mut out = Vec::with_capacity(q_rad.len() / arm.encoders() * 6);
    let mut image = vec![0.0; k];
    tiles(arm, probe, tip_mm, q_rad, columns, |rows| {
        let mut full = [[0.0; 3]; 3];
        for a in 0..3 {
            image.fill(0.0);
            for (j, derivative) in rows[a * k..(a + 1) * k].iter().enumerate() {
                for (value, c) in image.iter_mut().zip(&covariance[j * k..(j + 1) * k]) {
                    *value += derivative * c;
                }
            }
            for (b, value) in full[a].iter_mut().enumerate() {
                *value = rows[b * k..(b + 1) * k].iter().zip(&image).map(|(d, i)| d * i).sum();
            }
        }
        out.extend([full[0][0], full[0][1], full[0][2], full[1][1], full[1][2], full[2][2]]);
    });
    out
}

/// How far the tip moves at each pose, mm, for that of the row-major directions (over `columns`) that moves it most.
pub fn direction_effect(
    arm: &Arm,
    probe: usize,
    tip_mm: [f64; 3],
    q_rad: &[f64],
    columns: &[usize],
    directions: &[f64],
) -> Vec<f64> {
    let k = columns.len();
    let mut out = Vec::with_capacity(q_rad.len() / arm.encoders());
    tiles(arm, probe, tip_mm, q_rad, columns, |rows| {
        let effect = |direction: &[f64]| {
            let moved = |a: usize| rows[a * k..(a + 1) * k].iter().zip(direction).map(|(d, v)| d * v).sum::<f64>();
            (0..3).map(|a| moved(a).powi(2)).sum::<f64>().sqrt()
        };
        out.push(directions.chunks_exact(k.max(1)).map(effect).fold(0.0, f64::max));
    });
    out
}

/// Calls `each` with the 3 × columns derivatives of every pose in turn, row-major.
fn tiles(arm: &Arm, probe: usize, tip_mm: [f64; 3], q_rad: &[f64], columns: &[usize], mut each: impl FnMut(&[f64])) {
    let chain = Chain::new(arm);
    let joints = arm.joint_parameter_count();
    let k = columns.len();
    // where each kernel column goes; the parameters of other probes move nothing
    let kernel = |j: usize| if j < joints { j } else { j.wrapping_sub(arm.tip_offset(probe)).saturating_add(joints) };
    let mut place = vec![None; joints + 4];
    for (at, &j) in columns.iter().enumerate() {
        if let Some(slot) = place[..joints + 3].get_mut(kernel(j)) {
            *slot = Some(at);
        }
    }
    let mut rows = vec![0.0; TILE * 3 * k];
    for q in q_rad.chunks(TILE * arm.encoders()) {
        for_each_derivative(&chain, tip_mm, q, |row, component, column, value| {
            if let Some(at) = place[column] {
                rows[(3 * row + component) * k + at] = value;
            }
        });
        let count = q.len() / arm.encoders();
        rows.chunks_exact((3 * k).max(1)).take(count).for_each(&mut each);
        if k == 0 {
            (0..count).for_each(|_| each(&[]));
        }
    }
}

/// Largest |analytic - numerical| derivative of the tip over all parameters and poses, relative to the reach.
pub fn check_jacobian(arm: &Arm, probe: usize, q_rad: &[f64]) -> f64 {
    let x = arm.parameters();
    let step = vec![1e-3; x.len()];
    let reach = arm.reach_mm(probe);
    let worst = |q: &[f64]| {
        let value = |p: &[f64]| match arm.with_parameters(p) {
            Ok(moved) => tip_mm(&moved, probe, q).coords.as_slice().to_vec(),
            Err(_) => vec![f64::NAN; 3],
        };
        let analytic = jacobian(arm, probe, q).transpose();
        numdiff::worst_difference(value, &x, &step, analytic.as_slice())
    };
    q_rad.chunks_exact(arm.encoders()).map(worst).fold(0.0, f64::max) / reach
}
