//! Orientations where the arm is and the instrument stands: their residuals and derivatives.

use super::attitudes::Attitudes;
use super::directions::{ARM_MM, Turns};
use super::turned::{Attitude, Difference, best_frame, by_vector};
use crate::artefacts::model::At;
use crate::artefacts::placed::{Group, Scene};
use crate::artefacts::rows::MOST_OWN;
use crate::artefacts::stated::Frame;
use crate::artefacts::tile::Directions;
use crate::artefacts::whitening::Whitening;
use crate::simd::Columns;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// All of them, each instrument's frame found.
pub(super) struct Seen<'a> {
    attitudes: &'a Attitudes,
    links: Vec<Link>,
    differences: Vec<Difference>,
    /// how the target turns, in the probe's frame, where a dimension of its mount changes
    by_mount: Matrix3<f64>,
    weights: &'a Whitening,
}

/// The last link of a touch.
struct Link {
    /// R(q)
    turned: Rotation3<f64>,
    stretch: f64,
    /// what the touch is off by for reasons of its own
    off: Rotation3<f64>,
}

impl<'a> Seen<'a> {
    pub fn new(attitudes: &'a Attitudes, group: &'a Group, at: At) -> Seen<'a> {
        let (touches, weights) = (&group.touches, attitudes.weights());
        let points: Vec<Columns> = Turns::POINTS_MM.iter().map(|&away| touches.points(at.model, away)).collect();
        let link = |row: usize| {
            let at = |point: usize| Vector3::from([0, 1, 2].map(|j| points[point].column(j)[row]));
            let (along_x, along_y) = (at(1) - at(0), at(2) - at(0));
            let (x, y) = (along_x.normalize(), along_y.normalize());
            let turned = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, x.cross(&y)]));
            let off = Rotation3::new(-touches.offset_mm(row) / attitudes.lever_mm);
            Link { turned, stretch: along_x.norm() / ARM_MM, off }
        };
        let links: Vec<Link> = (0..touches.len()).map(link).collect();
        let mount_rad = attitudes.mount_at(at.dimensions);
        let mount = Rotation3::new(mount_rad);
        let attitude = |row: usize| Attitude {
            held: links[row].off * links[row].turned * mount,
            seen: attitudes.seen[row],
            whiten: weights.at(row),
        };
        let mut differences = Vec::with_capacity(touches.len());
        let mut of_one = Vec::new();
        for rows in &touches.standings {
            of_one.clear();
            of_one.extend(rows.clone().map(attitude));
            let frame = match attitudes.frame {
                Frame::Free => best_frame(&of_one, weights.is_isotropic()),
                Frame::Arm => Rotation3::identity(),
            };
            differences.extend(of_one.iter().map(|each| each.difference(&frame)));
        }
        let by_mount = mount.matrix() * by_vector(&mount_rad);
        Seen { attitudes, links, differences, by_mount, weights }
    }

    /// Of each touch its last link, and `whiten` times the rows that its residual follows a turn of that by.
    pub fn rows(
        &self,
        whiten: impl Fn(usize) -> Matrix3<f64>,
    ) -> impl ExactSizeIterator<Item = (Rotation3<f64>, f64, Matrix3<f64>)> {
        self.links.iter().enumerate().map(move |(row, link)| {
            let rows = whiten(row) * self.by_turn(row) * link.off.matrix();
            (link.turned, link.stretch, rows)
        })
    }

    /// How a residual, mm, follows a turn of the target.
    fn by_turn(&self, row: usize) -> Matrix3<f64> {
        self.differences[row].by_turn() * self.attitudes.lever_mm
    }
}

impl Scene<3> for Seen<'_> {
    type Directions<'b>
        = Turns
    where
        Self: 'b;

    fn directions(&self) -> Turns {
        Turns::new(self.rows(|row| self.weights.at(row)))
    }

    fn undiscounted(self) -> Self {
        Seen { weights: &self.attitudes.whitening, ..self }
    }

    fn unknowns(&self, _: usize) -> usize {
        match self.attitudes.frame {
            Frame::Free => 3,
            Frame::Arm => 0,
        }
    }

    fn off_mm(&self, _: usize, row: usize) -> Vector3<f64> {
        self.differences[row].rotation_vector() * self.attitudes.lever_mm
    }

    fn residual_mm(&self, _: usize, row: usize) -> [f64; 3] {
        (self.differences[row].residual() * self.attitudes.lever_mm).into()
    }

    fn residual(&self, standing: usize, row: usize) -> [f64; 3] {
        (self.weights.at(row) * Vector3::from(self.residual_mm(standing, row))).into()
    }

    fn by_dimension(&self, _: usize, row: usize, dimension: usize) -> [f64; 3] {
        let link = &self.links[row];
        let turn = link.off * link.turned * self.by_mount.column(self.attitudes.unknown[dimension]);
        (self.weights.at(row) * (self.by_turn(row) * turn)).into()
    }

    fn by_standing(&self, _: usize, row: usize, own: &mut [[f64; 3]; MOST_OWN]) {
        let derivatives = self.weights.at(row) * self.differences[row].by_frame() * self.attitudes.lever_mm;
        own.iter_mut().zip(derivatives.column_iter()).for_each(|(own, column)| *own = column.into_owned().into());
    }
}
