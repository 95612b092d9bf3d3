//! How long work says how far it is, and is told to stop.

/// What the core is busy with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Iterations of a fit.
    Fit,
    /// Starts of a search.
    Search,
    /// Repeated calibrations.
    MonteCarlo,
    /// Rounds of an exchange.
    Plan,
}

impl Stage {
    /// `"fit"`, `"search"`, `"monte carlo"` or `"plan"`.
    pub fn as_str(self) -> &'static str {
        match self {
            Stage::Fit => "fit",
            Stage::Search => "search",
            Stage::MonteCarlo => "monte carlo",
            Stage::Plan => "plan",
        }
    }
}

/// Watches long work. Called from any thread, at the least every few ten thousand readings.
pub trait Monitor: Sync {
    /// `done` of `total` steps of a stage are finished. To go on, return true.
    fn progress(&self, stage: Stage, done: usize, total: usize) -> bool;

    /// Called between pieces of one step. To go on, return true.
    fn keep_going(&self) -> bool {
        true
    }
}

/// Watches nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unwatched;

impl Monitor for Unwatched {
    fn progress(&self, _: Stage, _: usize, _: usize) -> bool {
        true
    }
}
