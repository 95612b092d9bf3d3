//! Readings of one artefact told in several ways, each row of the file in one of them.

use super::dimension::{Dimension, Unknowns};
use super::model::At;
use super::noise::{Noise, Weighing};
use super::readings::{Again, Readings};
use super::residuals::{Unweighted, Whitened};
use super::writer::Writer;
use crate::arm::Seen;
use crate::error::Result;
use crate::kinematics::Sample;
use rand_xoshiro::Xoshiro256PlusPlus;

/// All parts; their dimensions are the same, and a reading has as many numbers in each.
#[derive(Debug)]
pub(super) struct Parts(Vec<Part>);

/// Some of the rows.
#[derive(Debug)]
pub(super) struct Part {
    pub readings: Box<dyn Readings>,
    /// Which row of the file each row of the readings is.
    pub rows: Vec<u32>,
    /// Which standing each of theirs is.
    pub standings: Vec<u32>,
}

impl Parts {
    /// At least one part; one alone is itself.
    pub fn together(mut parts: Vec<Part>) -> Box<dyn Readings> {
        if parts.len() == 1 { parts.remove(0).readings } else { Box::new(Parts(parts)) }
    }

    fn sum(&self, of: impl Fn(&dyn Readings) -> usize) -> usize {
        self.0.iter().map(|part| of(part.readings.as_ref())).sum()
    }

    fn all(&self, of: impl Fn(&dyn Readings) -> bool) -> bool {
        self.0.iter().all(|part| of(part.readings.as_ref()))
    }

    /// The same rows told by other readings.
    fn with(&self, of: impl FnMut(&Part) -> Box<dyn Readings>) -> Box<dyn Readings> {
        let readings = self.0.iter().map(of);
        let told = |(part, readings): (&Part, Box<dyn Readings>)| Part {
            readings,
            rows: part.rows.clone(),
            standings: part.standings.clone(),
        };
        Box::new(Parts(self.0.iter().zip(readings).map(told).collect()))
    }

    /// Other readings of fewer rows, which are counted anew.
    fn counted(readings: impl Iterator<Item = Box<dyn Readings>>) -> Box<dyn Readings> {
        let (mut row, mut standing) = (0, 0);
        let mut part = |readings: Box<dyn Readings>| {
            let (rows, standings) = (row + readings.len() as u32, standing + readings.standings() as u32);
            let part = Part { rows: (row..rows).collect(), standings: (standing..standings).collect(), readings };
            (row, standing) = (rows, standings);
            part
        };
        Box::new(Parts(readings.map(&mut part).collect()))
    }

    /// Numbers of every part's readings, `components` each, in the order of the file.
    fn filed(&self, components: usize, of: impl Fn(usize) -> Vec<f64>) -> Vec<f64> {
        let mut filed = vec![0.0; components * self.len()];
        for (number, part) in self.0.iter().enumerate() {
            for (values, &row) in of(number).chunks_exact(components).zip(&part.rows) {
                filed[components * row as usize..][..components].copy_from_slice(values);
            }
        }
        filed
    }
}

impl Readings for Parts {
    fn len(&self) -> usize {
        self.sum(|part| part.len())
    }

    fn equations(&self) -> usize {
        self.sum(|part| part.equations())
    }

    fn placement_unknowns(&self) -> usize {
        self.sum(|part| part.placement_unknowns())
    }

    fn standings(&self) -> usize {
        self.sum(|part| part.standings())
    }

    fn scale_free(&self) -> bool {
        self.all(|part| part.scale_free())
    }

    fn growing(&self, at: At) -> Vec<f64> {
        self.0[0].readings.growing(at)
    }

    fn mirror_free(&self) -> bool {
        self.all(|part| part.mirror_free())
    }

    fn still_free(&self) -> bool {
        self.all(|part| part.still_free())
    }

    fn probes_used(&self, probes: usize) -> Vec<bool> {
        let each: Vec<Vec<bool>> = self.0.iter().map(|part| part.readings.probes_used(probes)).collect();
        (0..probes).map(|probe| each.iter().any(|used| used[probe])).collect()
    }

    fn dimensions(&self) -> &[Dimension] {
        self.0[0].readings.dimensions()
    }

    fn sin_cos_bytes(&self) -> usize {
        self.sum(|part| part.sin_cos_bytes())
    }

    fn keep_sin_cos(&mut self) {
        self.0.iter_mut().for_each(|part| part.readings.keep_sin_cos());
    }

    fn weigh(&mut self, at: At, noise: Option<&Noise>, how: Weighing) {
        self.0.iter_mut().for_each(|part| part.readings.weigh(at, noise, how));
    }

    fn weighs_directions(&self) -> bool {
        !self.all(|part| !part.weighs_directions())
    }

    fn discount(&mut self, factors: Option<&[f64]>) {
        for part in &mut self.0 {
            let of_part = |factors: &[f64]| part.rows.iter().map(|&row| factors[row as usize]).collect::<Vec<_>>();
            let factors = factors.map(of_part);
            part.readings.discount(factors.as_deref());
        }
    }

    fn weight_squared_sum(&self) -> f64 {
        self.0.iter().map(|part| part.readings.weight_squared_sum()).sum()
    }

    fn stream(&self, at: At, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()> {
        let stream =
            |part: &Part| out.calling(&part.standings, |out| part.readings.stream(at, unknowns, jacobian, out));
        self.0.iter().try_for_each(stream)
    }

    fn unweighted(&self, at: At) -> Unweighted {
        let each: Vec<Unweighted> = self.0.iter().map(|part| part.readings.unweighted(at)).collect();
        let components = each[0].components;
        Unweighted {
            components,
            residuals_mm: self.filed(components, |part| each[part].residuals_mm.clone()),
            weights: self.filed(1, |part| each[part].weights.clone()),
        }
    }

    fn whitened(&self, at: At) -> Whitened {
        let each: Vec<Whitened> = self.0.iter().map(|part| part.readings.whitened(at)).collect();
        Whitened {
            norms: self.filed(1, |part| each[part].norms.clone()),
            freedoms: self.filed(1, |part| each[part].freedoms.clone()),
        }
    }

    fn samples(&self, most: usize) -> Vec<Sample> {
        self.0.iter().flat_map(|part| part.readings.samples(most * part.readings.len() / self.len())).collect()
    }

    fn seen(&self) -> Seen {
        self.0.iter().map(|part| part.readings.seen()).reduce(Seen::and).unwrap_or_default()
    }

    fn taken_anew(&self, again: &Again, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings> {
        self.with(|part| part.readings.taken_anew(again, rng))
    }

    fn thinned(&self, most: usize) -> Box<dyn Readings> {
        let share = |part: &Part| (most * part.readings.len()).div_ceil(self.len());
        Parts::counted(self.0.iter().map(|part| part.readings.thinned(share(part))))
    }

    fn as_lengths(&self) -> Option<Box<dyn Readings>> {
        let each: Option<Vec<Box<dyn Readings>>> = self.0.iter().map(|part| part.readings.as_lengths()).collect();
        Some(Parts::counted(each?.into_iter()))
    }

    fn boxed(&self) -> Box<dyn Readings> {
        self.with(|part| part.readings.boxed())
    }
}
