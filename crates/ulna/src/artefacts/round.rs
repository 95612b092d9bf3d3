//! What is round: its surface is half a diameter away from a figure, from a point or from an axis.

use super::figure::Figure;
use super::kind::Statement;
use super::readings::Readings;
use super::shape::{Known, Shape};
use super::surface::Surface;
use std::marker::PhantomData;

/// Something round, touched from one side. Its size is its diameter.
#[derive(Debug, Clone)]
pub(super) struct Round<F> {
    inside: bool,
    figure: PhantomData<F>,
}

impl<F> Round<F> {
    /// Readings of it, as its diameter and its side are stated.
    pub fn readings<const U: usize>(statement: &Statement) -> Box<dyn Readings>
    where
        F: Figure<U>,
    {
        let diameter_mm = statement.size("diameter").map_or(0.0, |size| size.value);
        let round = Round::<F> { inside: statement.stated.inside, figure: PhantomData };
        Surface::readings(round, &[diameter_mm], statement)
    }

    /// A size of it with that of the ball: outside of it or inside.
    fn with_ball(&self, size_mm: f64, ball_mm: f64) -> f64 {
        if self.inside { size_mm - ball_mm } else { size_mm + ball_mm }
    }
}

impl<F: Figure<U>, const U: usize> Shape<U> for Round<F> {
    type Figure = F;

    fn apart_mm(&self, sizes: &[f64], ball_radius_mm: f64, _: f64) -> f64 {
        self.with_ball(0.5 * sizes[0], ball_radius_mm)
    }

    fn apart_by(&self, _: usize, _: f64) -> f64 {
        0.5
    }

    fn growing(&self, sizes: &[f64], balls_mm: &[f64]) -> Vec<f64> {
        vec![self.with_ball(sizes[0], balls_mm.first().copied().unwrap_or(0.0))]
    }

    fn scale_free(&self, sizes: &[Known], balls_mm: &[f64]) -> bool {
        sizes[0] == Known::Freely && balls_mm.windows(2).all(|pair| pair[0] == pair[1])
    }
    fn still_free(&self, _: &[Known]) -> bool {
        true
    }
}
