//! Touches of a surface as readings.

use super::shape::{Contact, Shape, Touched, UNKNOWNS};
use crate::arm::Seen;
use crate::artefacts::dimension::{Dimension, Unknowns};
use crate::artefacts::model::At;
use crate::artefacts::noise::{Noise, Weighing, normal};
use crate::artefacts::readings::Readings;
use crate::artefacts::residuals::{Unweighted, Whitened, shared};
use crate::artefacts::rows::{Eliminated, Layout, Place};
use crate::artefacts::tile::{Directions, TILE, Tile};
use crate::artefacts::touches::{TouchRows, Touches};
use crate::artefacts::writer::Writer;
use crate::error::Result;
use crate::kinematics::Sample;
use crate::simd::{Columns, Lanes, padded};
use nalgebra::{DMatrix, Vector3};
use pulp::Simd;
use rand_xoshiro::Xoshiro256PlusPlus;

/// Readings of the surface of one artefact.
#[derive(Debug, Clone)]
pub struct Surface<S: Shape> {
    shape: S,
    dimensions: Vec<Dimension>,
    touches: Touches,
    /// diameter of each probe's ball
    balls_mm: Vec<f64>,
    weight: Vec<f64>,
    /// what a loss makes of each touch
    factor: Option<Vec<f64>>,
}

impl<S: Shape> Surface<S> {
    /// Touches of an arm of `encoders` joints; the features of the rows are not looked at.
    pub fn new(shape: S, dimensions: Vec<Dimension>, balls_mm: &[f64], encoders: usize, rows: TouchRows) -> Surface<S> {
        let touches = Touches::new(rows, encoders, false);
        Surface {
            shape,
            dimensions,
            balls_mm: balls_mm.to_vec(),
            weight: vec![1.0; touches.len()],
            factor: None,
            touches,
        }
    }

    fn weight(&self, row: usize) -> f64 {
        self.weight[row] * self.factor.as_ref().map_or(1.0, |factor| factor[row])
    }

    fn contact(&self, p: &Columns, row: usize) -> Contact {
        Contact {
            p_mm: Vector3::new(p.column(0)[row], p.column(1)[row], p.column(2)[row]),
            radius_mm: 0.5 * self.balls_mm[self.touches.probe[row]],
            weight: self.weight(row),
        }
    }

    /// What is read at each touch, in their order.
    fn touched(&self, at: At) -> Vec<Touched> {
        let p = self.touches.tips(at.model);
        let mut all = Vec::with_capacity(self.touches.len());
        let mut contacts = Vec::new();
        for rows in &self.touches.standings {
            contacts.clear();
            contacts.extend(rows.clone().map(|row| self.contact(&p, row)));
            let standing = self.shape.place(&contacts, at.dimensions_mm);
            all.extend(contacts.iter().map(|contact| self.shape.touched(&standing, contact, at.dimensions_mm)));
        }
        all
    }

    fn balls_used(&self) -> Vec<f64> {
        let used = self.touches.probes_used(self.balls_mm.len());
        self.balls_mm.iter().zip(used).filter(|(_, used)| *used).map(|(&ball, _)| ball).collect()
    }
}

/// The weighted normal of each touch.
struct Normals(Columns);

impl Normals {
    fn new(touched: &[Touched], weight: impl Fn(usize) -> f64) -> Normals {
        let mut normals = Columns::zeros(3, touched.len());
        for (row, touch) in touched.iter().enumerate() {
            for j in 0..3 {
                normals.column_mut(j)[row] = weight(row) * touch.normal[j];
            }
        }
        Normals(normals)
    }
}

impl Directions for Normals {
    const COUNT: usize = 1;

    #[inline(always)]
    fn direction<S: Simd>(&self, simd: S, _: usize, k: usize) -> [Lanes<S>; 3] {
        [0, 1, 2].map(|j| self.0.load(simd, j, k))
    }
}

impl<S: Shape> Readings for Surface<S> {
    fn len(&self) -> usize {
        self.touches.len()
    }

    fn equations(&self) -> usize {
        self.touches.len()
    }

    fn placement_unknowns(&self) -> usize {
        self.touches.standings.iter().map(|rows| UNKNOWNS.min(rows.len())).sum()
    }

    fn scale_free(&self) -> bool {
        self.shape.scale_free(&self.dimensions, &self.balls_used())
    }

    fn growing(&self, at: At) -> Vec<f64> {
        self.shape.growing(at.dimensions_mm, &self.balls_used())
    }

    fn mirror_free(&self) -> bool {
        true
    }

    fn probes_used(&self, probes: usize) -> Vec<bool> {
        self.touches.probes_used(probes)
    }

    fn dimensions(&self) -> &[Dimension] {
        &self.dimensions
    }

    fn sin_cos_bytes(&self) -> usize {
        self.touches.sin_cos_bytes()
    }

    fn keep_sin_cos(&mut self) {
        self.touches.poses.keep_sin_cos();
    }

    fn weigh(&mut self, at: At, noise: Option<&Noise>, _: Weighing) {
        self.factor = None;
        let Some(noise) = noise else {
            self.weight.fill(1.0);
            return;
        };
        let mut variance = vec![noise.seat_mm.powi(2); self.touches.len()];
        if noise.encoder_rad.iter().any(|&sigma| sigma > 0.0) {
            let normals = Normals::new(&self.touched(at), |_| 1.0);
            let chain = &at.model.chain;
            let mut tile = Tile::new(&self.touches, at.model, 1);
            let mut scratch = Vec::new();
            for start in (0..variance.len()).step_by(TILE) {
                tile.fill(&self.touches, chain, &normals, start, &mut scratch);
                for (i, variance) in variance[start..].iter_mut().take(TILE).enumerate() {
                    for (encoder, sigma) in noise.encoder_rad.iter().enumerate() {
                        *variance += (sigma * tile.values(0, chain.encoder_column(encoder))[i]).powi(2);
                    }
                }
            }
        }
        self.weight = variance.iter().map(|&v| if v > 0.0 { v.sqrt().recip() } else { 1.0 }).collect();
    }

    fn discount(&mut self, factors: Option<&[f64]>) {
        self.factor = factors.map(|factors| self.touches.order.iter().map(|&row| factors[row]).collect());
    }

    fn weight_squared_sum(&self) -> f64 {
        (0..self.touches.len()).map(|row| self.weight(row).powi(2)).sum()
    }

    fn stream(&self, at: At, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()> {
        let layout = Layout::new(at.model, self.dimensions.len());
        out.layout(layout.residual, layout.targets(unknowns).filter(|_| jacobian))?;
        let touched = self.touched(at);
        let normals = Normals::new(&touched, |row| self.weight(row));
        let mut tile = Tile::new(&self.touches, at.model, 1);
        let mut eliminated = Eliminated::default();
        let mut current = 0;
        for start in (0..touched.len()).step_by(TILE) {
            let end = touched.len().min(start + TILE);
            if jacobian {
                tile.fill(&self.touches, &at.model.chain, &normals, start, &mut out.scratch[0]);
            }
            let mut row = start;
            while row < end {
                let standing = &self.touches.standings[current];
                let rows = row..end.min(standing.end);
                let length = padded(rows.len());
                out.reserve(length)?;
                let used = out.block.rows..out.block.rows + length;
                out.block.rows = used.end;
                if jacobian {
                    let place = Place {
                        tile: &tile,
                        in_tile: row - start..rows.end - start,
                        probe: &self.touches.probe[rows.clone()],
                        components: 1,
                        used: used.clone(),
                    };
                    place.write_parameters(&mut out.block, at.model, layout);
                }
                let mut write = |column: usize, value: &dyn Fn(usize) -> f64| {
                    let target = &mut out.block.columns.column_mut(column)[used.clone()];
                    target.fill(0.0);
                    rows.clone().zip(target).for_each(|(row, target)| *target = self.weight(row) * value(row));
                };
                write(layout.residual, &|row| touched[row].residual_mm);
                if jacobian {
                    for (k, derivative) in self.shape.by_dimensions().iter().enumerate().take(self.dimensions.len()) {
                        write(layout.dimensions + k, &|_| *derivative);
                    }
                    for k in 0..UNKNOWNS {
                        write(layout.residual + 1 + k, &|row| touched[row].local[k]);
                    }
                    if row == standing.start {
                        eliminated.begin(UNKNOWNS, &out.block);
                    }
                    eliminated.fold(&mut out.block, used);
                }
                row = rows.end;
                if row == standing.end {
                    current += 1;
                }
            }
        }
        out.flush()
    }

    fn unweighted(&self, at: At) -> Unweighted {
        let touched = self.touched(at);
        Unweighted {
            components: 1,
            residuals_mm: self.touches.filed(touched.iter().map(|touch| touch.residual_mm)),
            weights: self.touches.filed((0..touched.len()).map(|row| self.weight(row))),
        }
    }

    fn whitened(&self, at: At) -> Whitened {
        let touched = self.touched(at);
        let weighed = touched.iter().zip(&self.weight);
        let mut norms: Vec<f64> = weighed.map(|(touch, weight)| (weight * touch.residual_mm).abs()).collect();
        let mut freedoms = vec![1.0; norms.len()];
        for rows in self.touches.standings.iter().cloned() {
            let local = |i: usize, k: usize| self.weight[rows.start + i] * touched[rows.start + i].local[k];
            let q = DMatrix::from_fn(rows.len(), UNKNOWNS.min(rows.len()), local).qr().q();
            for (i, freedom) in freedoms[rows.clone()].iter_mut().enumerate() {
                *freedom = (1.0 - q.row(i).norm_squared()).max(0.0);
            }
            shared(&mut norms[rows.clone()], &mut freedoms[rows], 1);
        }
        let filed = |values: Vec<f64>| self.touches.filed(values.into_iter());
        Whitened { norms: filed(norms), freedoms: filed(freedoms) }
    }

    fn samples(&self, most: usize) -> Vec<Sample> {
        self.touches.samples(most)
    }

    fn seen(&self) -> Seen {
        self.touches.poses.seen()
    }

    fn redrawn(&self, truth: At, noise: &Noise, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings> {
        let mut drawn = self.clone();
        // the artefact is what it is; its calibration is drawn anew
        for (dimension, value) in drawn.dimensions.iter_mut().zip(truth.dimensions_mm) {
            dimension.value_mm = value + dimension.u_mm * normal(rng);
        }
        let touched = self.touched(truth);
        let residuals = touched.iter().map(|touch| (touch.normal * touch.residual_mm, noise.seat_mm));
        drawn.touches.redraw(residuals, &noise.encoder_rad, rng);
        Box::new(drawn)
    }

    fn thinned(&self, most: usize) -> Box<dyn Readings> {
        let (touches, picked) = self.touches.thinned(most);
        let of = |values: &[f64]| picked.iter().map(|&row| values[row]).collect::<Vec<_>>();
        Box::new(Surface {
            shape: self.shape.clone(),
            dimensions: self.dimensions.clone(),
            balls_mm: self.balls_mm.clone(),
            weight: of(&self.weight),
            factor: self.factor.as_deref().map(of),
            touches,
        })
    }

    fn boxed(&self) -> Box<dyn Readings> {
        Box::new(self.clone())
    }
}
