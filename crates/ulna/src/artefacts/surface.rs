//! Touches of a shape that stands somewhere: one number each.
//!
//! ```text
//! r = w (distance of p(q) from the shape's figure - apart)      ∂r = w n · ∂p(q)      w⁻² = nᵀ Σ n
//! ```
//!
//! with n the direction in which the distance grows, and Σ the covariance of the tip for the stated noise.

use super::figure::{Figure, Touched};
use super::kind::Statement;
use super::model::At;
use super::noise::{Noise, Weighing};
use super::placed::{Group, Observed, Placed, Scene};
use super::readings::Readings;
use super::rows::MOST_OWN;
use super::shape::{Known, Shape};
use super::standings::Standings;
use super::tile::{Directions, TILE, Tile};
use super::touches::Touches;
use crate::geometry::Contact;
use crate::simd::{Columns, Lanes};
use nalgebra::Vector3;
use pulp::Simd;

/// A shape, and how its touches weigh.
#[derive(Debug, Clone)]
pub(super) struct Surface<S, const U: usize> {
    shape: S,
    /// its sizes where they are known exactly
    sizes: Vec<f64>,
    /// which size each dimension of the group is
    unknown: Vec<usize>,
    /// diameter of each probe's ball; empty where no ball touches
    balls_mm: Vec<f64>,
    /// what was measured at each touch; empty where nothing is
    measured_mm: Vec<f64>,
    weight: Vec<f64>,
    /// what a loss makes of each touch
    factor: Option<Vec<f64>>,
}

impl<S: Shape<U>, const U: usize> Surface<S, U> {
    /// Readings of a shape with the sizes of its kind, of which those count that are not known exactly.
    pub fn readings(shape: S, sizes: &[f64], statement: &Statement) -> Box<dyn Readings> {
        let standings = Standings::new(statement.rows);
        let touches = Touches::new(statement.rows, statement.arm.encoders(), standings, |row| row);
        let asked = statement.kind.dimensions.iter().enumerate();
        let (unknown, dimensions) = asked.filter_map(|(k, asked)| Some((k, statement.dimension(asked.name)?))).unzip();
        let measured = statement.rows.measured_mm;
        let surface = Surface {
            shape,
            sizes: sizes.to_vec(),
            unknown,
            balls_mm: statement.stated.balls_mm.unwrap_or_default().to_vec(),
            measured_mm: measured.map_or(vec![], |each| touches.order.iter().map(|&row| each[row]).collect()),
            weight: vec![1.0; touches.len()],
            factor: None,
        };
        Box::new(Placed { group: Group { touches, dimensions }, kind: surface })
    }

    fn sizes_at(&self, at: At) -> Vec<f64> {
        let mut sizes = self.sizes.clone();
        self.unknown.iter().zip(at.dimensions).for_each(|(&size, &value)| sizes[size] = value);
        sizes
    }

    fn contact(&self, touches: &Touches, p: &Columns, sizes: &[f64], row: usize) -> Contact {
        let ball_radius_mm = self.balls_mm.get(touches.probe[row]).map_or(0.0, |ball| 0.5 * ball);
        Contact {
            p_mm: Vector3::new(p.column(0)[row], p.column(1)[row], p.column(2)[row]),
            apart_mm: self.shape.apart_mm(sizes, ball_radius_mm, self.measured(row)),
            weight: self.weight(row),
        }
    }

    fn measured(&self, row: usize) -> f64 {
        self.measured_mm.get(row).copied().unwrap_or(0.0)
    }

    /// What a fit may do with each size.
    fn known(&self, group: &Group) -> Vec<Known> {
        let known = |size: usize| match self.unknown.iter().position(|&unknown| unknown == size) {
            None => Known::Held(self.sizes[size]),
            Some(k) if group.dimensions[k].is_free() => Known::Freely,
            Some(k) if group.dimensions[k].fitted => Known::Within,
            Some(k) => Known::Held(group.dimensions[k].value),
        };
        (0..self.sizes.len()).map(known).collect()
    }

    fn balls_used(&self, group: &Group) -> Vec<f64> {
        let used = group.touches.probes_used(self.balls_mm.len());
        self.balls_mm.iter().zip(used).filter(|(_, used)| *used).map(|(&ball, _)| ball).collect()
    }
}

impl<S: Shape<U>, const U: usize> Observed<1> for Surface<S, U> {
    type Scene<'a> = Seen<'a, S, U>;

    fn scene<'a>(&'a self, group: &'a Group, at: At<'a>) -> Seen<'a, S, U> {
        let (touches, sizes) = (&group.touches, self.sizes_at(at));
        let p = touches.tips(at.model);
        let mut touched = Vec::with_capacity(touches.len());
        let mut contacts = Vec::new();
        for rows in &touches.standings {
            contacts.clear();
            contacts.extend(rows.clone().map(|row| self.contact(touches, &p, &sizes, row)));
            let figure = S::Figure::nearest(&contacts);
            touched.extend(contacts.iter().map(|contact| figure.touched(contact)));
        }
        Seen { surface: self, touched, factor: self.factor.as_deref() }
    }

    fn placement_unknowns(&self, group: &Group, standing: usize) -> usize {
        U.min(group.touches.standings[standing].len())
    }

    fn scale_free(&self, group: &Group) -> bool {
        self.shape.scale_free(&self.known(group), &self.balls_used(group))
    }

    fn still_free(&self, group: &Group) -> bool {
        self.shape.still_free(&self.known(group))
    }

    fn growing(&self, group: &Group, at: At) -> Vec<f64> {
        let growing = self.shape.growing(&self.sizes_at(at), &self.balls_used(group));
        self.unknown.iter().map(|&size| growing[size]).collect()
    }

    fn mirror_free(&self) -> bool {
        true
    }

    fn weigh(&mut self, group: &Group, at: At, noise: Option<&Noise>, _: Weighing) {
        let Some(noise) = noise else {
            self.weight.fill(1.0);
            return;
        };
        let mut variance = vec![noise.seat_mm.powi(2); group.touches.len()];
        if noise.encoder_rad.iter().any(|&sigma| sigma > 0.0) {
            let normals = Normals::new(&self.scene(group, at).touched, |_| 1.0);
            let chain = &at.model.chain;
            let mut tile = Tile::new(&group.touches, at.model, 1);
            let mut scratch = Vec::new();
            for start in (0..variance.len()).step_by(TILE) {
                tile.fill(&group.touches, chain, &normals, start, &mut scratch);
                for (i, variance) in variance[start..].iter_mut().take(TILE).enumerate() {
                    let by_turn = |encoder: usize| tile.values(0, chain.encoder_column(encoder))[i];
                    let mut along: Vec<f64> = (0..noise.encoder_rad.len()).map(by_turn).collect();
                    chain.by_encoders(&mut along, |own, of_other, ratio| own + of_other * ratio);
                    *variance +=
                        along.iter().zip(&noise.encoder_rad).map(|(along, s)| (s * along).powi(2)).sum::<f64>();
                }
            }
        }
        self.weight = variance.iter().map(|&v| if v > 0.0 { v.sqrt().recip() } else { 1.0 }).collect();
    }

    fn discount(&mut self, factors: Option<Vec<f64>>) {
        self.factor = factors;
    }

    fn weight(&self, row: usize) -> f64 {
        self.weight[row] * self.factor.as_ref().map_or(1.0, |factor| factor[row])
    }

    fn picked(&self, _: &Touches, rows: &[usize]) -> Surface<S, U> {
        let of = |values: &[f64]| rows.iter().map(|&row| values[row]).collect::<Vec<_>>();
        Surface {
            measured_mm: if self.measured_mm.is_empty() { vec![] } else { of(&self.measured_mm) },
            weight: of(&self.weight),
            factor: self.factor.as_deref().map(of),
            ..self.clone()
        }
    }
}

/// A shape's touches where it stands.
pub(super) struct Seen<'a, S, const U: usize> {
    surface: &'a Surface<S, U>,
    touched: Vec<Touched<U>>,
    factor: Option<&'a [f64]>,
}

impl<S, const U: usize> Seen<'_, S, U> {
    fn weight(&self, row: usize) -> f64 {
        self.surface.weight[row] * self.factor.map_or(1.0, |factor| factor[row])
    }
}

impl<S: Shape<U>, const U: usize> Scene<1> for Seen<'_, S, U> {
    type Directions<'b>
        = Normals
    where
        Self: 'b;

    fn directions(&self) -> Normals {
        Normals::new(&self.touched, |row| self.weight(row))
    }

    fn undiscounted(self) -> Self {
        Seen { factor: None, ..self }
    }

    fn unknowns(&self, _: usize) -> usize {
        U
    }

    fn off_mm(&self, _: usize, row: usize) -> Vector3<f64> {
        self.touched[row].normal * self.touched[row].residual_mm
    }

    fn residual_mm(&self, _: usize, row: usize) -> [f64; 1] {
        [self.touched[row].residual_mm]
    }

    fn residual(&self, _: usize, row: usize) -> [f64; 1] {
        [self.weight(row) * self.touched[row].residual_mm]
    }

    fn by_dimension(&self, _: usize, row: usize, dimension: usize) -> [f64; 1] {
        let size = self.surface.unknown[dimension];
        [-self.weight(row) * self.surface.shape.apart_by(size, self.surface.measured(row))]
    }

    fn by_standing(&self, _: usize, row: usize, own: &mut [[f64; 1]; MOST_OWN]) {
        let weight = self.weight(row);
        own.iter_mut().zip(self.touched[row].own).for_each(|(own, value)| own[0] = weight * value);
    }
}

/// The weighted normal of each touch.
pub(super) struct Normals(Columns);

impl Normals {
    fn new<const U: usize>(touched: &[Touched<U>], weight: impl Fn(usize) -> f64) -> Normals {
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
    fn direction<S: Simd>(&self, simd: S, _: usize, _: usize, k: usize) -> [Lanes<S>; 3] {
        [0, 1, 2].map(|j| self.0.load(simd, j, k))
    }
}
