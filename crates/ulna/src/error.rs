//! What a caller can have done wrong. Every message names the thing, the value and what was expected.

/// A question the core cannot answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An arm needs two joints at least.
    #[error("an arm has {0} joint(s); at least 2 are needed, the last of which carries the probe")]
    TooFewJoints(usize),
    /// An arm without a probe touches nothing.
    #[error("the arm has no probe; at least one is needed")]
    NoProbe,
    /// A number that must be finite is not.
    #[error("{what} is {value}; a finite number was expected")]
    NotFinite {
        /// What the number is.
        what: String,
        /// What it was.
        value: f64,
    },
    /// An array has another length than the model asks for.
    #[error("{what} has {got} values, expected {expected}")]
    Shape {
        /// Which array.
        what: String,
        /// Its length.
        got: usize,
        /// The length it should have.
        expected: usize,
    },
    /// An index points at a probe, feature or joint that does not exist.
    #[error("{what} {index} does not exist; there are {count}")]
    NoSuch {
        /// Which kind of thing.
        what: &'static str,
        /// The index given.
        index: i64,
        /// How many there are.
        count: usize,
    },
    /// A standard deviation or a length that must be positive (or not negative) is not.
    #[error("{what} is {value:?}; {expected} was expected")]
    OutOfRange {
        /// Which quantity.
        what: String,
        /// What it was.
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// No kind of artefact has this name.
    #[error("artefact {artefact} is of kind {kind:?}; one of {known} was expected")]
    NoSuchKind {
        /// The artefact's name.
        artefact: String,
        /// The kind given.
        kind: String,
        /// The kinds that there are.
        known: String,
    },
    /// A kind of artefact needs more than was stated.
    #[error("artefact {artefact} is of kind {kind:?}, which needs {what}; it is not given")]
    Lacking {
        /// The artefact's name.
        artefact: String,
        /// Its kind.
        kind: &'static str,
        /// What is missing.
        what: String,
    },
    /// Something was stated that says nothing of a kind of artefact.
    #[error("artefact {artefact} is of kind {kind:?}, which has no use for {what}; leave it out")]
    Unused {
        /// The artefact's name.
        artefact: String,
        /// Its kind.
        kind: &'static str,
        /// What was stated.
        what: String,
    },
    /// Two things that were stated of an artefact cannot both be.
    #[error("artefact {artefact}: {why}")]
    Contradiction {
        /// The artefact's name.
        artefact: String,
        /// What they are.
        why: String,
    },
    /// An array has another shape than the model asks for.
    #[error("{what} has the shape {got:?}, expected {expected:?}")]
    Dimensions {
        /// Which array.
        what: String,
        /// Its lengths.
        got: Vec<usize>,
        /// The lengths it should have.
        expected: Vec<usize>,
    },
    /// Something that must be stated is not.
    #[error("{what} is not stated")]
    Missing {
        /// What.
        what: String,
    },
    /// Something is stated that nobody asked for.
    #[error("{what} has no {name:?}")]
    Unknown {
        /// Of what.
        what: String,
        /// What it was called.
        name: String,
    },
    /// Something is stated twice.
    #[error("{what} is stated twice")]
    Twice {
        /// What.
        what: String,
    },
    /// An effect beyond the geometry that does not exist.
    #[error("there is no effect {given:?}; expected one of {known:?}")]
    NoSuchEffect {
        /// The word given.
        given: String,
        /// Those that there are.
        known: &'static [&'static str],
    },
    /// Orders of harmonics that are none, or come twice.
    #[error("the orders of harmonics are {0:?}; expected 1 or more, ascending")]
    Orders(Vec<u32>),
    /// There is nothing to fit to.
    #[error("there are no readings")]
    NoReadings,
    /// The equations are fewer than the unknowns: no fit can be judged.
    #[error(
        "the readings give {observations} equations for {unknowns} unknowns \
         ({parameters} parameters that these readings could determine and {placement_unknowns} of placements): \
         take more readings (at least {missing}), or hold parameters"
    )]
    TooFewObservations {
        /// Scalar equations.
        observations: usize,
        /// Parameters and placement unknowns together.
        unknowns: usize,
        /// Free parameters whose columns do not vanish.
        parameters: usize,
        /// Unknowns of the placements.
        placement_unknowns: usize,
        /// How many equations are missing.
        missing: usize,
    },
    /// Too many coordinates of an artefact are uncertain and touched more than once: each is a column of its own.
    #[error(
        "artefact {artefact} has {dimensions} coordinates that are uncertain and touched more than once; at most {most} \
         can be told apart: state u only for the features that matter, or no u, or split the artefact"
    )]
    TooManyDimensions {
        /// The artefact's name.
        artefact: String,
        /// How many.
        dimensions: usize,
        /// How many there may be.
        most: usize,
    },
    /// Noise has to be drawn but none was stated.
    #[error("the study states no noise, so none can be drawn: give [noise] encoder or seat")]
    NoNoise,
    /// The monitor asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// The core's result type.
pub type Result<T> = std::result::Result<T, Error>;
