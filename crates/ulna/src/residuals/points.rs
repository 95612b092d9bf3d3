//! `points`, `bar`, `seat`: the tip on a feature with known coordinates, of an artefact that stands somewhere.
//!
//! ```text
//! r = W (p(q) - (R f + t))       WᵀW = Σ⁻¹,  Σ = J_q Σ_encoder J_qᵀ + σ_seat² I
//! ```
//!
//! A seat is an artefact of one feature, a bar of two. With `frame = "arm"` R and t are known (none).

use super::length::normal;
use super::placement::{Placement, Touch};
use super::{Considered, Model, Noise, Readings, Unknowns, Unweighted, Writer};
use crate::error::Result;
use crate::kinematics::batch::{Chain, Columns, Poses, forward, gradient, tips_mm};
use crate::kinematics::lanes::{Lanes, padded};
use crate::solver::reflect::fold_into;
use nalgebra::{Isometry3, Matrix3, Vector3};
use pulp::{Arch, Simd, WithSimd};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Where an artefact's coordinates hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// In its own frame: each placement has an unknown pose.
    Free,
    /// In the arm's base frame.
    Arm,
}

/// Readings of the features of one artefact.
#[derive(Debug, Clone)]
pub struct Points {
    features_mm: Vec<Vector3<f64>>,
    frame: Frame,
    placements: Vec<Placement>,
    /// which row of the file each reading is; readings are sorted by placement and feature
    order: Vec<usize>,
    poses: Poses,
    probe: Vec<usize>,
    feature: Vec<usize>,
    /// what the tip is off by for reasons of its own, taken away before the residual (used by simulation)
    offset_mm: Option<Columns>,
    whitening: Whitening,
    considered: Vec<Considered>,
    /// for each considered dimension, the feature and the direction in which it would move, artefact frame
    considered_moves: Vec<(usize, Vector3<f64>)>,
}

#[derive(Debug, Clone)]
enum Whitening {
    Same(f64),
    /// lower triangle of W, row by row: six columns
    Each(Columns),
}

/// What rows of a file say.
#[derive(Debug, Clone, Copy)]
pub struct PointRows<'a> {
    /// Row-major angles, rad.
    pub q_rad: &'a [f64],
    /// Which probe took each row.
    pub probe: &'a [usize],
    /// Which feature was touched.
    pub feature: &'a [usize],
    /// Which standing of the artefact: any labels.
    pub placement: &'a [i64],
}

/// An artefact's features: coordinates, and which of them are uncertain.
#[derive(Debug, Clone)]
pub struct Features<'a> {
    /// The artefact's name.
    pub name: &'a str,
    /// Coordinates, mm.
    pub coordinates_mm: &'a [[f64; 3]],
    /// Standard uncertainty of each feature's coordinates, mm; of a bar, that of its length.
    pub u_mm: f64,
    /// Where the coordinates hold.
    pub frame: Frame,
}

/// Readings whose rows are computed together.
const TILE: usize = 32;

impl Points {
    /// Readings of an arm of `encoders` joints.
    pub fn new(features: &Features, encoders: usize, data: PointRows) -> Points {
        let features_mm: Vec<Vector3<f64>> = features.coordinates_mm.iter().map(|&f| f.into()).collect();
        let mut first_seen = std::collections::HashMap::new();
        let placement: Vec<usize> = data
            .placement
            .iter()
            .map(|&label| {
                let next = first_seen.len();
                let label = if features.frame == Frame::Arm { 0 } else { label };
                *first_seen.entry(label).or_insert(next)
            })
            .collect();
        let mut order: Vec<usize> = (0..data.feature.len()).collect();
        order.sort_by_key(|&r| (placement[r], data.feature[r], r));
        let feature: Vec<usize> = order.iter().map(|&r| data.feature[r]).collect();
        let of_placement: Vec<usize> = order.iter().map(|&r| placement[r]).collect();
        let mut placements = Vec::new();
        for rows in equal_runs(&of_placement) {
            let touched: Vec<_> = feature[rows.clone()].iter().map(|&f| features_mm[f]).collect();
            placements.push(Placement::new(rows, &touched));
        }
        let mut points = Points {
            features_mm,
            frame: features.frame,
            placements,
            poses: Poses::gathered(data.q_rad, encoders, &order),
            probe: order.iter().map(|&r| data.probe[r]).collect(),
            order,
            feature,
            offset_mm: None,
            whitening: Whitening::Same(1.0),
            considered: vec![],
            considered_moves: vec![],
        };
        points.consider(features);
        points
    }

    /// Of a bar, the length; of other artefacts with more than one feature, every coordinate of every feature.
    fn consider(&mut self, features: &Features) {
        if features.u_mm <= 0.0 {
            return;
        }
        let name = features.name;
        match (features.coordinates_mm.len(), self.frame) {
            (1, Frame::Free) => {}
            (2, Frame::Free) => {
                let along = (self.features_mm[1] - self.features_mm[0]).normalize();
                self.considered_moves.push((1, along));
                self.considered.push(Considered {
                    name: format!("artefact.{name}.length"),
                    u_mm: features.u_mm,
                });
            }
            (count, _) => {
                for feature in 0..count {
                    for (axis, letter) in ["x", "y", "z"].iter().enumerate() {
                        self.considered_moves.push((feature, Vector3::ith(axis, 1.0)));
                        self.considered.push(Considered {
                            name: format!("artefact.{name}.feature.{}.{letter}", feature + 1),
                            u_mm: features.u_mm,
                        });
                    }
                }
            }
        }
    }

    fn whiten(&self, row: usize) -> Matrix3<f64> {
        match &self.whitening {
            Whitening::Same(w) => Matrix3::from_diagonal_element(*w),
            Whitening::Each(w) => {
                let at = |k: usize| w.column(k)[row];
                Matrix3::new(at(0), 0.0, 0.0, at(1), at(2), 0.0, at(3), at(4), at(5))
            }
        }
    }

    /// Tips of all readings, base frame, mm.
    fn tips(&self, model: &Model) -> Columns {
        let mut p = Columns::zeros(3, self.order.len());
        tips_mm(&model.chain, &self.poses, &self.tip_of_each(model), &mut p);
        if let Some(offset) = &self.offset_mm {
            for j in 0..3 {
                for (value, o) in p.column_mut(j).iter_mut().zip(offset.column(j)) {
                    *value -= o;
                }
            }
        }
        p
    }

    fn tip_of_each(&self, model: &Model) -> Columns {
        let mut tips = Columns::zeros(3, self.order.len());
        for j in 0..3 {
            for (value, &probe) in tips.column_mut(j).iter_mut().zip(&self.probe) {
                *value = model.tips_mm[probe][j];
            }
        }
        tips
    }

    fn touch(&self, p: &Columns, row: usize) -> Touch {
        Touch {
            p_mm: Vector3::new(p.column(0)[row], p.column(1)[row], p.column(2)[row]),
            feature_mm: self.features_mm[self.feature[row]],
            whiten: self.whiten(row),
        }
    }

    /// Where each placement stands.
    fn placement_poses(&self, p: &Columns) -> Vec<Isometry3<f64>> {
        if self.frame == Frame::Arm {
            return vec![Isometry3::identity(); self.placements.len()];
        }
        let isotropic = matches!(self.whitening, Whitening::Same(_));
        let pose = |placement: &Placement| {
            let touches: Vec<Touch> = placement.rows.clone().map(|row| self.touch(p, row)).collect();
            placement.pose(&touches, isotropic)
        };
        self.placements.iter().map(pose).collect()
    }

    /// Whitened derivatives of readings `start..` with respect to joints, tip and last turn, into three times
    /// `columns` columns, one third for each component.
    fn tile(&self, model: &Model, tips: &Columns, start: usize, columns: usize, tile: &mut Columns, scratch: &mut [f64]) {
        Arch::new().dispatch(TileOp {
            chain: &model.chain,
            points: self,
            tips,
            start,
            columns,
            tile,
            scratch,
        });
    }
}

/// Maximal runs of equal values.
fn equal_runs(values: &[usize]) -> Vec<std::ops::Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for end in 1..=values.len() {
        if end == values.len() || values[end] != values[start] {
            runs.push(start..end);
            start = end;
        }
    }
    runs
}

impl Readings for Points {
    fn len(&self) -> usize {
        self.order.len()
    }

    fn equations(&self) -> usize {
        3 * self.order.len()
    }

    fn placement_unknowns(&self) -> usize {
        match self.frame {
            Frame::Free => self.placements.iter().map(Placement::unknowns).sum(),
            Frame::Arm => 0,
        }
    }

    fn scale_free(&self) -> bool {
        self.frame == Frame::Free && self.placements.iter().all(|p| p.span == 0)
    }

    fn mirror_free(&self) -> bool {
        self.frame == Frame::Free && self.placements.iter().all(|p| p.span < 3)
    }

    fn probes_used(&self, probes: usize) -> Vec<bool> {
        (0..probes).map(|p| self.probe.contains(&p)).collect()
    }

    fn considered(&self) -> &[Considered] {
        &self.considered
    }

    fn sin_cos_bytes(&self) -> usize {
        self.order.len() * self.poses.encoders() * 2 * size_of::<f64>()
    }

    fn keep_sin_cos(&mut self) {
        self.poses.keep_sin_cos();
    }

    fn weigh(&mut self, model: &Model, noise: Option<&Noise>) {
        self.whitening = Whitening::Same(1.0);
        let Some(noise) = noise else { return };
        if noise.encoder_rad.iter().all(|&sigma| sigma == 0.0) {
            if noise.seat_mm > 0.0 {
                self.whitening = Whitening::Same(noise.seat_mm.recip());
            }
            return;
        }
        let tips = self.tip_of_each(model);
        let joint_columns = model.chain.joint_parameter_count();
        let columns = joint_columns + 4;
        let mut tile = Columns::zeros(3 * columns, TILE);
        let mut scratch = vec![0.0; model.chain.scratch_len()];
        let mut whitening = Columns::zeros(6, self.order.len());
        for start in (0..self.order.len()).step_by(TILE) {
            self.tile(model, &tips, start, columns, &mut tile, &mut scratch);
            for i in 0..TILE.min(self.order.len() - start) {
                let mut sigma = Matrix3::from_diagonal_element(noise.seat_mm.powi(2));
                for (encoder, s) in noise.encoder_rad.iter().enumerate() {
                    let column = if 4 * encoder < joint_columns { 4 * encoder } else { joint_columns + 3 };
                    let moved = Vector3::from_fn(|c, _| s * tile.column(c * columns + column)[i]);
                    sigma += moved * moved.transpose();
                }
                for (k, value) in whitener(sigma).into_iter().enumerate() {
                    whitening.column_mut(k)[start + i] = value;
                }
            }
        }
        self.whitening = Whitening::Each(whitening);
    }

    fn weight_squared_sum(&self) -> f64 {
        (0..self.order.len()).map(|row| self.whiten(row).norm_squared() / 3.0).sum()
    }

    fn stream(&self, model: &Model, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()> {
        let joint_columns = model.chain.joint_parameter_count();
        let probes = model.tips_mm.len();
        let parameters = joint_columns + 3 * probes;
        let residual = parameters + self.considered.len();
        let unknown = |column: usize| match column {
            c if c < parameters => unknowns.parameters[c],
            c => unknowns.considered[c - parameters],
        };
        let targets = (0..residual).filter_map(|c| Some((c, unknown(c)?)));
        out.layout(residual, targets.filter(|_| jacobian))?;
        let p = self.tips(model);
        let poses = self.placement_poses(&p);
        let tips = self.tip_of_each(model);
        let columns = joint_columns + 4;
        let mut tile = Columns::zeros(3 * columns, TILE);
        let mut eliminated = Eliminated::default();
        let mut at = 0;
        for start in (0..self.order.len()).step_by(TILE) {
            let end = self.order.len().min(start + TILE);
            if jacobian {
                self.tile(model, &tips, start, columns, &mut tile, &mut out.scratch[0]);
            }
            let mut row = start;
            while row < end {
                let (placement, pose) = (&self.placements[at], &poses[at]);
                let rows = row..end.min(placement.rows.end);
                let base = self.write_segment(out, &p, pose, rows.clone(), &tile, row - start, columns, jacobian)?;
                if jacobian && self.frame == Frame::Free {
                    if rows.start == placement.rows.start {
                        eliminated.begin(placement.unknowns(), &out.block.targets, residual);
                    }
                    self.write_local(out, &p, placement, pose, rows.clone(), base);
                    let used = base..out.block.rows;
                    fold_into(
                        &mut eliminated.top,
                        placement.unknowns(),
                        &mut out.block.columns,
                        &eliminated.order,
                        used,
                    );
                }
                row = rows.end;
                if row == placement.rows.end {
                    at += 1;
                }
            }
        }
        out.flush()
    }

    fn unweighted(&self, model: &Model) -> Unweighted {
        let p = self.tips(model);
        let poses = self.placement_poses(&p);
        let mut residuals_mm = vec![0.0; 3 * self.order.len()];
        let mut weights = vec![0.0; self.order.len()];
        for (placement, pose) in self.placements.iter().zip(&poses) {
            for row in placement.rows.clone() {
                let touch = self.touch(&p, row);
                let at = self.order[row];
                residuals_mm[3 * at..3 * at + 3].copy_from_slice(touch.residual(pose).as_slice());
                weights[at] = (touch.whiten.norm_squared() / 3.0).sqrt();
            }
        }
        Unweighted {
            components: 3,
            residuals_mm,
            weights,
        }
    }

    fn sample_poses(&self, most: usize) -> Vec<(usize, Vec<f64>)> {
        let step = self.order.len().div_ceil(most.max(1)).max(1);
        let rows = (0..self.order.len()).step_by(step);
        rows.map(|row| (self.probe[row], self.poses.pose(row))).collect()
    }

    fn redrawn(&self, truth: &Model, noise: &Noise, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings> {
        let mut drawn = self.clone();
        let p = self.tips(truth);
        let poses = self.placement_poses(&p);
        for (considered, (feature, direction)) in self.considered.iter().zip(&self.considered_moves) {
            drawn.features_mm[*feature] += direction * (considered.u_mm * normal(rng));
        }
        let mut offset = self.offset_mm.clone().unwrap_or_else(|| Columns::zeros(3, self.order.len()));
        for (placement, pose) in self.placements.iter().zip(&poses) {
            for row in placement.rows.clone() {
                let residual = self.touch(&p, row).residual(pose);
                for j in 0..3 {
                    offset.column_mut(j)[row] += residual[j] + noise.seat_mm * normal(rng);
                }
            }
        }
        drawn.offset_mm = Some(offset);
        drawn.poses.add_noise(&noise.encoder_rad, rng);
        Box::new(drawn)
    }

    fn thinned(&self, most: usize) -> Box<dyn Readings> {
        let mut picked = Vec::new();
        let mut placements = Vec::new();
        for placement in &self.placements {
            let rows = placement.rows.len();
            let share = (most * rows).div_ceil(self.order.len()).clamp(4.min(rows), rows);
            let begin = picked.len();
            picked.extend((0..share).map(|i| placement.rows.start + i * (rows - 1) / (share - 1).max(1)));
            let touched: Vec<_> = picked[begin..].iter().map(|&row| self.features_mm[self.feature[row]]).collect();
            placements.push(Placement::new(begin..picked.len(), &touched));
        }
        let pick_columns = |from: &Columns, count: usize| {
            let mut columns = Columns::zeros(count, picked.len());
            for k in 0..count {
                for (value, &row) in columns.column_mut(k).iter_mut().zip(&picked) {
                    *value = from.column(k)[row];
                }
            }
            columns
        };
        Box::new(Points {
            features_mm: self.features_mm.clone(),
            frame: self.frame,
            placements,
            order: (0..picked.len()).collect(),
            poses: self.poses.picked(&picked),
            probe: picked.iter().map(|&row| self.probe[row]).collect(),
            feature: picked.iter().map(|&row| self.feature[row]).collect(),
            offset_mm: self.offset_mm.as_ref().map(|o| pick_columns(o, 3)),
            whitening: match &self.whitening {
                Whitening::Same(w) => Whitening::Same(*w),
                Whitening::Each(w) => Whitening::Each(pick_columns(w, 6)),
            },
            considered: self.considered.clone(),
            considered_moves: self.considered_moves.clone(),
        })
    }

    fn boxed(&self) -> Box<dyn Readings> {
        Box::new(self.clone())
    }
}

/// Lower triangle of `L⁻¹` with `Σ = L Lᵀ`, row by row. Where the stated noise leaves a direction without any, the
/// direction gets a millionth of the others' variance: a weight must stay finite.
fn whitener(sigma: Matrix3<f64>) -> [f64; 6] {
    let sigma = sigma + Matrix3::from_diagonal_element(1e-6 * sigma.trace() / 3.0);
    let inverse = sigma
        .cholesky()
        .and_then(|c| c.l().try_inverse())
        .unwrap_or_else(Matrix3::identity);
    [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)].map(|at| inverse[at])
}

/// What of the placement being streamed has been folded away so far.
#[derive(Default)]
struct Eliminated {
    top: Vec<f64>,
    order: Vec<usize>,
}

impl Eliminated {
    fn begin(&mut self, unknowns: usize, targets: &[(usize, usize)], residual: usize) {
        self.order.clear();
        self.order.extend(residual + 1..residual + 1 + unknowns);
        self.order.extend(targets.iter().map(|&(column, _)| column));
        self.order.push(residual);
        self.top.clear();
        self.top.resize(unknowns * self.order.len(), 0.0);
    }
}

impl Points {
    /// Writes the equations of some readings of one placement into the block, component after component; returns
    /// the first row used.
    #[allow(clippy::too_many_arguments)]
    fn write_segment(
        &self,
        out: &mut Writer,
        p: &Columns,
        pose: &Isometry3<f64>,
        rows: std::ops::Range<usize>,
        tile: &Columns,
        tile_row: usize,
        columns: usize,
        jacobian: bool,
    ) -> Result<usize> {
        let m = rows.len();
        let used = padded(3 * m);
        out.reserve(used)?;
        let base = out.block.rows;
        out.block.rows += used;
        let block = &mut out.block;
        let joint_columns = columns - 4;
        let residual = block.columns.column_mut(block.residual);
        residual[base..base + used].fill(0.0);
        for (i, row) in rows.clone().enumerate() {
            let touch = self.touch(p, row);
            let whitened = touch.whiten * touch.residual(pose);
            for c in 0..3 {
                residual[base + c * m + i] = whitened[c];
            }
        }
        if !jacobian {
            return Ok(base);
        }
        for &(column, _) in &block.targets {
            let target = &mut block.columns.column_mut(column)[base..base + used];
            target.fill(0.0);
            if column < joint_columns {
                for c in 0..3 {
                    let source = &tile.column(c * columns + column)[tile_row..tile_row + m];
                    target[c * m..(c + 1) * m].copy_from_slice(source);
                }
            } else if column < block.residual - self.considered.len() {
                let (probe, axis) = ((column - joint_columns) / 3, (column - joint_columns) % 3);
                for (i, row) in rows.clone().enumerate().filter(|(_, row)| self.probe[*row] == probe) {
                    debug_assert!(row < self.order.len());
                    for c in 0..3 {
                        target[c * m + i] = tile.column(c * columns + joint_columns + axis)[tile_row + i];
                    }
                }
            } else {
                let (feature, direction) = self.considered_moves[column + self.considered.len() - block.residual];
                for (i, row) in rows.clone().enumerate().filter(|(_, row)| self.feature[*row] == feature) {
                    let moved = -self.whiten(row) * (pose.rotation * direction);
                    for c in 0..3 {
                        target[c * m + i] = moved[c];
                    }
                }
            }
        }
        Ok(base)
    }

    /// Writes the placement's own columns beside the equations of some readings.
    fn write_local(
        &self,
        out: &mut Writer,
        p: &Columns,
        placement: &Placement,
        pose: &Isometry3<f64>,
        rows: std::ops::Range<usize>,
        base: usize,
    ) {
        let m = rows.len();
        let end = out.block.rows;
        let first = out.block.residual + 1;
        for k in 0..placement.unknowns() {
            out.block.columns.column_mut(first + k)[base..end].fill(0.0);
        }
        for (i, row) in rows.enumerate() {
            let touch = self.touch(p, row);
            for (k, derivative) in placement.derivatives(pose, &touch).into_iter().enumerate() {
                let column = out.block.columns.column_mut(first + k);
                for c in 0..3 {
                    column[base + c * m + i] = derivative[c];
                }
            }
        }
    }
}

struct TileOp<'a> {
    chain: &'a Chain,
    points: &'a Points,
    tips: &'a Columns,
    start: usize,
    columns: usize,
    tile: &'a mut Columns,
    scratch: &'a mut [f64],
}

impl WithSimd for TileOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let stride = padded(self.points.order.len());
        let rows = TILE.min(stride - self.start);
        let zero = Lanes::splat(simd, 0.0);
        for v in 0..rows / S::F64_LANES {
            let k = self.start / S::F64_LANES + v;
            let tip = [0, 1, 2].map(|j| Lanes::load(simd, self.tips.column(j), k));
            forward(simd, self.chain, &self.points.poses, k, tip, self.scratch);
            for component in 0..3 {
                let mut direction = [zero; 3];
                match &self.points.whitening {
                    Whitening::Same(w) => direction[component] = Lanes::splat(simd, *w),
                    Whitening::Each(w) => {
                        let row = component * (component + 1) / 2;
                        for (j, value) in direction.iter_mut().enumerate().take(component + 1) {
                            *value = Lanes::load(simd, w.column(row + j), k);
                        }
                    }
                }
                gradient(simd, self.chain, self.scratch, direction, |column, value| {
                    value.store(self.tile.column_mut(component * self.columns + column), v);
                });
            }
        }
    }
}
