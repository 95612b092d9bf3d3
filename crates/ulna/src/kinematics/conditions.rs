//! What was true at poses beside the angles of the encoders, as far as an arm's effects ask for it.

use crate::arm::effects::{Seen, check_mass};
use crate::error::{Error, Result};
use crate::simd::{Columns, Lanes};
use pulp::Simd;
use std::ops::Range;

/// What a file says of poses beside their angles; empty where it does not.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Conditions<'a> {
    /// Temperature above 20 °C, K: one a pose, or row-major one for each joint; empty where it was 20 °C.
    pub warmth_k: &'a [f64],
    /// From which side each joint was approached, row-major one for each: +1 where the angle of its encoder had been
    /// rising, -1 where it had been falling, 0 where nobody knows; empty where nobody knows of any.
    pub approach: &'a [f64],
    /// What the last joint carried beside the arm's own masses, row-major [`PAYLOAD`] numbers a pose: mass, kg, and where
    /// its centre is in the probe's frame, x, y, z, mm; empty where it carried nothing.
    pub payload: &'a [f64],
}

/// Numbers of a payload.
pub const PAYLOAD: usize = 4;

impl<'a> Conditions<'a> {
    /// Those of some of so many poses.
    pub fn part(self, rows: Range<usize>, of: usize) -> Conditions<'a> {
        let part = |values: &'a [f64]| {
            let width = values.len().checked_div(of).unwrap_or(0);
            &values[rows.start * width..rows.end * width]
        };
        Conditions { warmth_k: part(self.warmth_k), approach: part(self.approach), payload: part(self.payload) }
    }

    /// They are of so many poses and joints, and can be what they are said to be.
    ///
    /// # Errors
    /// Another count, a temperature that is not finite, an approach other than -1, 0 or +1, a payload that no arm carries.
    pub fn check(self, what: &str, rows: usize, encoders: usize) -> Result<()> {
        let of = [
            ("temperatures", self.warmth_k, [0, rows, rows * encoders]),
            ("approaches", self.approach, [0, rows * encoders, rows * encoders]),
            ("payloads", self.payload, [0, rows * PAYLOAD, rows * PAYLOAD]),
        ];
        for (name, values, lengths) in of {
            if !lengths.contains(&values.len()) {
                let what = format!("the {name} of the {what}");
                return Err(Error::Shape { what, got: values.len(), expected: lengths[1] });
            }
        }
        if let Some(&value) = self.warmth_k.iter().find(|warmth| !warmth.is_finite()) {
            return Err(Error::NotFinite { what: format!("a temperature of the {what}"), value });
        }
        for carried in self.payload.chunks_exact(PAYLOAD) {
            check_mass(carried[0], &format!("a payload of the {what}, kg,"))?;
            if let Some(&value) = carried[1..].iter().find(|centre| !centre.is_finite()) {
                return Err(Error::NotFinite { what: format!("the centre of a payload of the {what}"), value });
            }
        }
        match self.approach.iter().find(|approach| ![-1.0, 0.0, 1.0].contains(*approach)) {
            Some(&value) => Err(Error::OutOfRange {
                what: format!("an approach of the {what}"),
                value,
                expected: "+1 (the encoder angle had been rising), -1 (falling) or 0 (unknown)",
            }),
            None => Ok(()),
        }
    }
}

/// The same of many poses, in columns.
#[derive(Debug, Clone, Default)]
pub(super) struct Held {
    /// one column, or one for each joint; none for 20 °C
    warmth_k: Option<Columns>,
    /// one column for each joint; none where nothing is known
    approach: Option<Columns>,
    /// mass, kg, and x, y, z of its centre, mm; none where nothing is carried
    payload: Option<Columns>,
}

impl Held {
    /// Of `rows` poses, with room for more where asked.
    pub fn new(given: Conditions, rows: usize, room: Option<usize>) -> Held {
        let columns = |values: &[f64]| {
            let width = values.len().checked_div(rows).filter(|&width| width > 0)?;
            let mut columns = Columns::zeros(width, room.unwrap_or(rows));
            columns.fill_from_rows(values, width);
            Some(columns)
        };
        let payload = columns(given.payload);
        Held { warmth_k: columns(given.warmth_k), approach: columns(given.approach), payload }
    }

    /// Of some of so many poses.
    pub fn gathered(given: Conditions, of: usize, rows: &[usize]) -> Held {
        let gather = |values: &[f64]| {
            let width = values.len().checked_div(of).filter(|&width| width > 0)?;
            Some(Columns::gathered(values, width, rows))
        };
        Held { warmth_k: gather(given.warmth_k), approach: gather(given.approach), payload: gather(given.payload) }
    }

    /// Some of these.
    pub fn picked(&self, rows: &[usize]) -> Held {
        let pick = |columns: &Columns| columns.picked(rows);
        Held {
            warmth_k: self.warmth_k.as_ref().map(pick),
            approach: self.approach.as_ref().map(pick),
            payload: self.payload.as_ref().map(pick),
        }
    }

    /// Warmth, approach and payload of one pose.
    pub fn row(&self, row: usize) -> [Vec<f64>; 3] {
        let of = |columns: &Columns| (0..columns.width()).map(|j| columns.column(j)[row]).collect();
        [&self.warmth_k, &self.approach, &self.payload].map(|held| held.as_ref().map_or_else(Vec::new, of))
    }

    /// What effects may see in them.
    pub fn seen(&self) -> Seen {
        let range = |columns: &Columns, j: usize| {
            let values = columns.column(j)[..columns.rows()].iter();
            values.fold((f64::MAX, f64::MIN), |(low, high), &value| (low.min(value), high.max(value)))
        };
        let each = |columns: &Columns| (0..columns.width()).map(|j| range(columns, j)).collect::<Vec<_>>();
        let widest = |ranges: Vec<(f64, f64)>| ranges.into_iter().reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        Seen {
            warmth_k: self.warmth_k.as_ref().map(each).and_then(widest),
            approach: self.approach.as_ref().map_or_else(Vec::new, each),
        }
    }

    /// Temperature above 20 °C of the link of joint `i`, for vector `k` of poses.
    #[inline(always)]
    pub fn warmth<S: Simd>(&self, simd: S, i: usize, k: usize) -> Lanes<S> {
        match &self.warmth_k {
            None => Lanes::splat(simd, 0.0),
            Some(warmth) => warmth.load(simd, if warmth.width() == 1 { 0 } else { i }, k),
        }
    }

    /// From which side joint `i` was approached, for vector `k` of poses.
    #[inline(always)]
    pub fn approach<S: Simd>(&self, simd: S, i: usize, k: usize) -> Lanes<S> {
        match &self.approach {
            None => Lanes::splat(simd, 0.0),
            Some(approach) => approach.load(simd, i, k),
        }
    }

    /// What vector `k` of poses carried: mass, kg, and x, y, z of its centre, mm; none where none of all poses carried any.
    #[inline(always)]
    pub fn payload<S: Simd>(&self, simd: S, k: usize) -> Option<[Lanes<S>; PAYLOAD]> {
        self.payload.as_ref().map(|payload| [0, 1, 2, 3].map(|number| payload.load(simd, number, k)))
    }
}
