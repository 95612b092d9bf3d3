//! What uncertain parameters do to a measured point.

use crate::arm::Arm;
use crate::kinematics::batch::{forward, gradient, scratch_len};
use crate::kinematics::{Angles, Chain, Poses, jacobian, tip_mm};
use crate::simd::{Columns, Lanes};
use crate::solver::numdiff;
use pulp::{Arch, Simd, WithSimd};

/// Poses whose derivatives are kept at once.
const TILE: usize = 256;

/// `J C Jᵀ` of each pose: xx, xy, xz, yy, yz, zz in mm², row-major. `columns` names the parameters that the row-major
/// covariance is of.
pub fn tip_covariance(arm: &Arm, probe: usize, poses: Angles, columns: &[usize], covariance: &[f64]) -> Vec<f64> {
    over_tiles::<6>(arm, probe, poses, columns, Quantity::Covariance(covariance))
}

/// How far the tip moves at each pose, mm, for that of the row-major directions (over `columns`) that moves it most.
pub fn direction_effect(arm: &Arm, probe: usize, poses: Angles, columns: &[usize], directions: &[f64]) -> Vec<f64> {
    over_tiles::<1>(arm, probe, poses, columns, Quantity::Directions(directions))
}

/// What is asked of a pose's derivatives.
#[derive(Clone, Copy)]
enum Quantity<'a> {
    /// six numbers
    Covariance(&'a [f64]),
    /// one number
    Directions(&'a [f64]),
}

fn over_tiles<const N: usize>(
    arm: &Arm,
    probe: usize,
    poses: Angles,
    columns: &[usize],
    quantity: Quantity,
) -> Vec<f64> {
    let chain = Chain::new(arm);
    let n = arm.encoders();
    // which of the columns asked about each derivative of the kernel is; the tips of other probes move nothing
    let asked = |column: usize| {
        let parameter = chain.parameter_of(column, probe, arm.probes().len())?;
        columns.iter().position(|&c| c == parameter)
    };
    let place: Vec<Option<usize>> = (0..=chain.turn_column()).map(asked).collect();
    let mut derivatives = Columns::zeros(3 * columns.len(), TILE);
    let mut answers = Columns::zeros(N, TILE);
    let mut scratch = vec![0.0; scratch_len(&chain)];
    let mut out = Vec::with_capacity(poses.q_rad.len() / n * N);
    for part in poses.chunks(TILE, n) {
        let rows = part.q_rad.len() / n;
        Arch::new().dispatch(PropagateOp {
            chain: &chain,
            poses: &Poses::new(part, n),
            tip_mm: arm.probes()[probe].tip_mm,
            place: &place,
            count: columns.len(),
            quantity,
            derivatives: &mut derivatives,
            answers: &mut answers,
            scratch: &mut scratch,
        });
        out.extend((0..rows).flat_map(|row| (0..N).map(move |k| (row, k))).map(|(row, k)| answers.column(k)[row]));
    }
    out
}

struct PropagateOp<'a> {
    chain: &'a Chain,
    poses: &'a Poses,
    tip_mm: [f64; 3],
    place: &'a [Option<usize>],
    count: usize,
    quantity: Quantity<'a>,
    derivatives: &'a mut Columns,
    answers: &'a mut Columns,
    scratch: &'a mut [f64],
}

impl WithSimd for PropagateOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let PropagateOp { chain, poses, tip_mm, place, count, quantity, derivatives, answers, scratch } = self;
        let zero = Lanes::splat(simd, 0.0);
        let tip = tip_mm.map(|t| Lanes::splat(simd, t));
        for k in 0..poses.q_rad().padded_rows() / S::F64_LANES {
            forward(simd, chain, poses, k, tip, scratch);
            for component in 0..3 {
                let mut axis = [zero; 3];
                axis[component] = Lanes::splat(simd, 1.0);
                gradient(
                    simd,
                    chain,
                    scratch,
                    axis,
                    #[inline(always)]
                    |column, value| {
                        if let Some(at) = place[column] {
                            derivatives.store(component * count + at, k, value);
                        }
                    },
                );
            }
            match quantity {
                Quantity::Covariance(covariance) => {
                    let mut sums = [zero; 6];
                    for j in 0..count {
                        let mut image = [zero; 3];
                        for (i, &c) in covariance[j * count..(j + 1) * count].iter().enumerate() {
                            let c = Lanes::splat(simd, c);
                            for (a, sum) in image.iter_mut().enumerate() {
                                *sum = derivatives.load(simd, a * count + i, k).mul_add(c, *sum);
                            }
                        }
                        let pairs = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
                        for (sum, (a, b)) in sums.iter_mut().zip(pairs) {
                            *sum = derivatives.load(simd, a * count + j, k).mul_add(image[b], *sum);
                        }
                    }
                    for (at, sum) in sums.into_iter().enumerate() {
                        answers.store(at, k, sum);
                    }
                }
                Quantity::Directions(directions) => {
                    let mut most = zero;
                    for direction in directions.chunks_exact(count.max(1)) {
                        let mut moved = [zero; 3];
                        for (j, &weight) in direction.iter().enumerate() {
                            let weight = Lanes::splat(simd, weight);
                            for (a, sum) in moved.iter_mut().enumerate() {
                                *sum = derivatives.load(simd, a * count + j, k).mul_add(weight, *sum);
                            }
                        }
                        let squared = moved[2].mul_add(moved[2], moved[1].mul_add(moved[1], moved[0] * moved[0]));
                        most = most.max(squared);
                    }
                    answers.store(0, k, most.sqrt());
                }
            }
        }
    }
}

/// Largest |analytic - numerical| derivative of the tip over all parameters and poses, relative to the reach (per rad and
/// mm; for effects, per unit of what moves the tip as far).
pub fn check_jacobian(arm: &Arm, probe: usize, poses: Angles) -> f64 {
    let x = arm.parameters();
    let reach = arm.reach_mm(probe);
    // a step that moves the tip by about as much as a thousandth of a radian or millimetre does
    let geometry = arm.geometry_count();
    let moves = arm.moves_mm(reach);
    let size = |(j, moves): (usize, &f64)| if j < geometry { 1.0 } else { reach / moves };
    let sizes: Vec<f64> = moves.iter().enumerate().map(size).collect();
    let scaled: Vec<f64> = x.iter().zip(&sizes).map(|(x, size)| x / size).collect();
    let step = vec![1e-3; x.len()];
    let worst = |row: usize| {
        let pose = poses.pose(row, arm.encoders());
        let value = |p: &[f64]| {
            let parameters: Vec<f64> = p.iter().zip(&sizes).map(|(p, size)| p * size).collect();
            match arm.with_parameters(&parameters) {
                Ok(moved) => tip_mm(&moved, probe, pose).coords.as_slice().to_vec(),
                Err(_) => vec![f64::NAN; 3],
            }
        };
        let mut analytic = jacobian(arm, probe, pose);
        analytic.column_iter_mut().zip(&sizes).for_each(|(mut column, size)| column *= *size);
        numdiff::worst_difference(value, &scaled, &step, analytic.transpose().as_slice())
    };
    (0..poses.q_rad.len() / arm.encoders()).map(worst).fold(0.0, f64::max) / reach
}
