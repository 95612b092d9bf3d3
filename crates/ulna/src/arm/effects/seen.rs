//! What readings show of what effects depend on, and what an effect says of a direction that they lost.

/// What readings show of what effects depend on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Seen {
    /// Lowest and highest temperature above 20 °C, K, where it is known.
    pub warmth_k: Option<(f64, f64)>,
    /// Lowest and highest approach of each joint; empty where none is known.
    pub approach: Vec<(f64, f64)>,
}

impl Seen {
    /// The readings of both. Where one does not say how joints were approached it counts as 0.
    pub fn and(self, other: Seen) -> Seen {
        let widest = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        let joints = self.approach.len().max(other.approach.len());
        let of = |seen: &Seen, joint: usize| seen.approach.get(joint).copied().unwrap_or_default();
        Seen {
            approach: (0..joints).map(|joint| widest(of(&self, joint), of(&other, joint))).collect(),
            warmth_k: match (self.warmth_k, other.warmth_k) {
                (Some(one), Some(another)) => Some(widest(one, another)),
                (one, another) => one.or(another),
            },
        }
    }
}

/// A lost direction, as one effect sees it.
#[derive(Debug, Clone, Copy)]
pub struct Lost<'a> {
    /// Joints of which parameters of this effect take part.
    pub joints: &'a [usize],
    /// Whether a single parameter takes part, and no other.
    pub alone: bool,
    /// The last joint, where turning it moves no tip that was read with.
    pub hidden: Option<usize>,
    /// What the readings show.
    pub seen: &'a Seen,
}

/// Why a parameter did not show, and what would help.
#[derive(Debug, Clone, PartialEq)]
pub struct Unseen {
    /// The word for it in files.
    pub cause: &'static str,
    /// In words.
    pub because: String,
    /// What would help.
    pub remedy: String,
}
