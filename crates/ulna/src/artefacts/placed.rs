//! Readings of artefacts that stand somewhere: what all of them do alike, whatever is read of a touch.

use super::dimension::{Dimension, Unknowns};
use super::model::At;
use super::noise::{Noise, Weighing};
use super::readings::{Again, Readings};
use super::residuals::{Unweighted, Whitened, shared};
use super::rows::{Eliminated, Layout, MOST_OWN, Place};
use super::tile::{Directions, TILE, Tile};
use super::touches::Touches;
use super::writer::Writer;
use crate::arm::Seen;
use crate::error::Result;
use crate::kinematics::Sample;
use nalgebra::{DMatrix, Vector3};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Touches of one artefact, and what of it is not known exactly.
#[derive(Debug, Clone)]
pub(super) struct Group {
    pub touches: Touches,
    pub dimensions: Vec<Dimension>,
}

/// What is read of a touch: `C` numbers, one or three.
pub(super) trait Observed<const C: usize>: std::fmt::Debug + Clone + Send + Sync + 'static {
    /// All touches as they are seen from some parameters.
    type Scene<'a>: Scene<C>;

    /// Puts every standing where it fits best.
    fn scene<'a>(&'a self, group: &'a Group, at: At<'a>) -> Self::Scene<'a>;

    /// Unknowns of a standing that its touches can show.
    fn placement_unknowns(&self, group: &Group, standing: usize) -> usize;

    /// See [`Readings::scale_free`].
    fn scale_free(&self, group: &Group) -> bool;

    /// See [`Readings::tell_places`].
    fn tell_places(&self) -> bool {
        true
    }

    /// See [`Readings::growing`].
    fn growing(&self, group: &Group, at: At) -> Vec<f64>;

    /// See [`Readings::mirror_free`].
    fn mirror_free(&self) -> bool;

    /// See [`Readings::still_free`].
    fn still_free(&self, group: &Group) -> bool;

    /// See [`Readings::weigh`].
    fn weigh(&mut self, group: &Group, at: At, noise: Option<&Noise>, how: Weighing);

    /// See [`Readings::discount`]; one factor for each touch in their order.
    fn discount(&mut self, factors: Option<Vec<f64>>);

    /// Root of the weight of a touch, equal in effect where it differs by direction, 1/mm.
    fn weight(&self, row: usize) -> f64;

    /// Variance of a touch that is not the encoders', mm² in each direction.
    fn variance_mm2(&self, _: &Group, _: usize, noise: &Noise) -> f64 {
        noise.seat_mm.powi(2)
    }

    /// Takes dimensions that were calibrated anew: `group` has those that they were before.
    fn recalibrate(&mut self, _: &Group, _truth: &[f64], _calibrated: &[f64]) {}

    /// The same for some of the touches, which are now those of `touches`.
    fn picked(&self, touches: &Touches, rows: &[usize]) -> Self;

    /// See [`Readings::as_lengths`].
    fn as_lengths(&self, _: &Group) -> Option<Box<dyn Readings>> {
        None
    }
}

/// Touches where the arm and the artefact are.
pub(super) trait Scene<const C: usize> {
    /// Along which directions the derivatives are asked for.
    type Directions<'b>: Directions
    where
        Self: 'b;

    /// The weighed directions of the residuals.
    fn directions(&self) -> Self::Directions<'_>;

    /// The same standings, looked at without what a loss made of the weights.
    fn undiscounted(self) -> Self;

    /// Unknowns of a standing: columns of its own.
    fn unknowns(&self, standing: usize) -> usize;

    /// How far the tip is off, base frame, mm: of an orientation, the turn times the lever.
    fn off_mm(&self, standing: usize, row: usize) -> Vector3<f64>;

    /// A residual as a person reads it, mm.
    fn residual_mm(&self, standing: usize, row: usize) -> [f64; C];

    /// A weighed residual.
    fn residual(&self, standing: usize, row: usize) -> [f64; C];

    /// Its derivative with respect to a dimension.
    fn by_dimension(&self, standing: usize, row: usize, dimension: usize) -> [f64; C];

    /// Its derivatives with respect to the standing's unknowns.
    fn by_standing(&self, standing: usize, row: usize, own: &mut [[f64; C]; MOST_OWN]);
}

/// Readings of one artefact.
#[derive(Debug, Clone)]
pub(super) struct Placed<K, const C: usize> {
    pub group: Group,
    pub kind: K,
}

impl<K: Observed<C>, const C: usize> Placed<K, C> {
    /// Whether it has to be placed anywhere.
    fn stands_freely(&self) -> bool {
        (0..self.group.touches.standings.len()).any(|k| self.kind.placement_unknowns(&self.group, k) > 0)
    }

    /// Numbers of each touch, in the order that the file has them.
    fn filed(&self, scene: &K::Scene<'_>, each: impl Fn(&K::Scene<'_>, usize, usize) -> f64) -> Vec<f64> {
        let of_standing = |(standing, rows): (usize, &std::ops::Range<usize>)| {
            rows.clone().map(|row| each(scene, standing, row)).collect::<Vec<_>>()
        };
        let touches = &self.group.touches;
        touches.filed(touches.standings.iter().enumerate().flat_map(of_standing))
    }
}

impl<K: Observed<C>, const C: usize> Readings for Placed<K, C> {
    fn len(&self) -> usize {
        self.group.touches.len()
    }

    fn equations(&self) -> usize {
        C * self.len()
    }

    fn placement_unknowns(&self) -> usize {
        (0..self.group.touches.standings.len()).map(|k| self.kind.placement_unknowns(&self.group, k)).sum()
    }

    fn standings(&self) -> usize {
        if self.stands_freely() { self.group.touches.standings.len() } else { self.len() }
    }

    fn scale_free(&self) -> bool {
        self.kind.scale_free(&self.group)
    }

    fn tell_places(&self) -> bool {
        self.kind.tell_places()
    }

    fn growing(&self, at: At) -> Vec<f64> {
        self.kind.growing(&self.group, at)
    }

    fn mirror_free(&self) -> bool {
        self.kind.mirror_free()
    }

    fn still_free(&self) -> bool {
        self.kind.still_free(&self.group)
    }

    fn probes_used(&self, probes: usize) -> Vec<bool> {
        self.group.touches.probes_used(probes)
    }

    fn dimensions(&self) -> &[Dimension] {
        &self.group.dimensions
    }

    fn sin_cos_bytes(&self) -> usize {
        self.group.touches.sin_cos_bytes()
    }

    fn keep_sin_cos(&mut self) {
        self.group.touches.poses.keep_sin_cos();
    }

    fn weigh(&mut self, at: At, noise: Option<&Noise>, how: Weighing) {
        self.kind.discount(None);
        self.kind.weigh(&self.group, at, noise, how);
    }

    fn discount(&mut self, factors: Option<&[f64]>) {
        let order = &self.group.touches.order;
        self.kind.discount(factors.map(|factors| order.iter().map(|&row| factors[row]).collect()));
    }

    fn weight_squared_sum(&self) -> f64 {
        (0..self.len()).map(|row| self.kind.weight(row).powi(2)).sum()
    }

    fn stream(&self, at: At, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()> {
        let touches = &self.group.touches;
        let layout = Layout::new(at.model, self.group.dimensions.len());
        out.layout(layout.residual, layout.targets(unknowns).filter(|_| jacobian))?;
        let scene = self.kind.scene(&self.group, at);
        let directions = jacobian.then(|| scene.directions());
        let mut tile = Tile::new(touches, at.model, C);
        let mut eliminated = Eliminated::default();
        let (asked, freely) = (out.standings_asked(), self.stands_freely());
        let mut standing = 0;
        for start in (0..touches.len()).step_by(TILE) {
            let end = touches.len().min(start + TILE);
            if let Some(directions) = &directions {
                tile.fill(touches, &at.model.chain, directions, start, &mut out.scratch[0]);
            }
            let mut row = start;
            while row < end {
                let whole = &touches.standings[standing];
                let rows = row..end.min(whole.end);
                let place = Place::reserve(out, &tile, start, rows.clone(), &touches.probe, C)?;
                let (live, mut gone) = (C * rows.len(), 0);
                let block = &mut out.block;
                place.write(block, layout.residual, |row| scene.residual(standing, row));
                if jacobian {
                    place.write_parameters(block, at.model, layout);
                    for target in 0..block.targets.len() {
                        let (column, _) = block.targets[target];
                        if column >= layout.dimensions {
                            let dimension = column - layout.dimensions;
                            place.write(block, column, |row| scene.by_dimension(standing, row, dimension));
                        }
                    }
                    let own = scene.unknowns(standing);
                    if own > 0 {
                        if row == whole.start {
                            eliminated.begin(own, block);
                        }
                        place.write_own(block, own, |row, own| scene.by_standing(standing, row, own));
                        if asked {
                            gone = eliminated.take_out(block, place.used.clone(), live);
                        } else {
                            eliminated.fold(block, place.used.clone());
                        }
                    }
                }
                // where nothing is to be placed each touch stands for itself
                let count = rows.len();
                let own = |k: usize| if freely { standing } else { touches.order[rows.start + (gone + k) % count] };
                out.tell(place.used.start + gone..place.used.start + live, own);
                row = rows.end;
                standing += usize::from(row == whole.end);
            }
        }
        out.flush()
    }

    fn unweighted(&self, at: At) -> Unweighted {
        let scene = self.kind.scene(&self.group, at);
        let touches = &self.group.touches;
        let mut residuals_mm = vec![0.0; self.equations()];
        for (standing, rows) in touches.standings.iter().enumerate() {
            for row in rows.clone() {
                let first = C * touches.order[row];
                let residual = scene.residual_mm(standing, row);
                residuals_mm[first..first + C].copy_from_slice(&residual);
            }
        }
        let weights = self.filed(&scene, |_, _, row| self.kind.weight(row));
        Unweighted { components: C, residuals_mm, weights }
    }

    fn whitened(&self, at: At) -> Whitened {
        let scene = self.kind.scene(&self.group, at).undiscounted();
        let touches = &self.group.touches;
        let (mut norms, mut freedoms) = (Vec::with_capacity(self.len()), Vec::with_capacity(self.len()));
        for (standing, rows) in touches.standings.iter().enumerate() {
            norms.extend(
                rows.clone().map(|row| nalgebra::SVector::<f64, C>::from(scene.residual(standing, row)).norm()),
            );
            freedoms.extend(left_of::<C>(&scene, standing, rows.clone()));
            if scene.unknowns(standing) > 0 {
                shared(&mut norms[rows.clone()], &mut freedoms[rows.clone()], C);
            }
        }
        let filed = |values: Vec<f64>| touches.filed(values.into_iter());
        Whitened { norms: filed(norms), freedoms: filed(freedoms) }
    }

    fn samples(&self, most: usize) -> Vec<Sample> {
        self.group.touches.samples(most)
    }

    fn seen(&self) -> Seen {
        self.group.touches.poses.seen()
    }

    fn taken_anew(&self, again: &Again, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings> {
        let Again { truth, calibrated, noise } = *again;
        let mut drawn = self.clone();
        drawn.kind.recalibrate(&self.group, truth.dimensions, calibrated);
        drawn.group.dimensions.iter_mut().zip(calibrated).for_each(|(dimension, &value)| dimension.value = value);
        let scene = self.kind.scene(&self.group, truth);
        let mut off = Vec::with_capacity(self.len());
        for (standing, rows) in self.group.touches.standings.iter().enumerate() {
            off.extend(
                rows.clone()
                    .map(|row| (scene.off_mm(standing, row), self.kind.variance_mm2(&self.group, row, noise).sqrt())),
            );
        }
        drawn.group.touches.redraw(off.into_iter(), &noise.encoder_rad, rng);
        Box::new(drawn)
    }

    fn thinned(&self, most: usize) -> Box<dyn Readings> {
        let (touches, picked) = self.group.touches.thinned(most);
        let kind = self.kind.picked(&touches, &picked);
        Box::new(Placed { group: Group { touches, dimensions: self.group.dimensions.clone() }, kind })
    }

    fn as_lengths(&self) -> Option<Box<dyn Readings>> {
        self.kind.as_lengths(&self.group)
    }

    fn boxed(&self) -> Box<dyn Readings> {
        Box::new(self.clone())
    }
}

/// Degrees of freedom that each touch of a standing has left when the placement follows it: its equations less its leverage.
fn left_of<const C: usize>(scene: &impl Scene<C>, standing: usize, rows: std::ops::Range<usize>) -> Vec<f64> {
    let count = rows.len();
    let unknowns = scene.unknowns(standing).min(C * count);
    let mut own = DMatrix::zeros(C * count, unknowns);
    for (i, row) in rows.enumerate() {
        let mut derivatives = [[0.0; C]; MOST_OWN];
        scene.by_standing(standing, row, &mut derivatives);
        for (k, derivative) in derivatives.iter().enumerate().take(unknowns) {
            (0..C).for_each(|c| own[(C * i + c, k)] = derivative[c]);
        }
    }
    // turns move touches by their distance, shifts by one: alike in size for the factorization
    for mut column in own.column_iter_mut() {
        let norm = column.norm();
        column /= if norm > 0.0 { norm } else { 1.0 };
    }
    let q = own.qr().q();
    let left = |i: usize| (C as f64 - q.rows(C * i, C).norm_squared()).max(0.0);
    (0..count).map(left).collect()
}
