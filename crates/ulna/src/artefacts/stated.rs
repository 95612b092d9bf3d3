//! What a study says of an artefact and of its readings, whatever its kind.

use crate::kinematics::Angles;

/// Where an artefact's coordinates hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// In its own frame: each placement has an unknown pose.
    Free,
    /// In the arm's base frame.
    Arm,
}

/// A dimension as it is stated: a diameter, the length of a bar, the scale of an instrument.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size<'a> {
    /// Its name, as the kind calls it.
    pub name: &'a str,
    /// Its calibrated value, in the kind's unit.
    pub value: f64,
    /// Standard uncertainty of that.
    pub u: f64,
    /// Whether it is an unknown of the fit: within `u`, or freely where that is 0.
    pub fitted: bool,
}

/// An artefact as it is stated. What a kind does not take must be left out; see [`super::Kind`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Stated<'a> {
    /// The artefact's name.
    pub name: &'a str,
    /// Its dimensions.
    pub dimensions: &'a [Size<'a>],
    /// Coordinates of its features, mm.
    pub features_mm: Option<&'a [[f64; 3]]>,
    /// The name of each feature; else they are counted from 1.
    pub labels: Option<&'a [String]>,
    /// Standard uncertainty of the coordinates of each feature, mm.
    pub feature_u_mm: Option<&'a [f64]>,
    /// Whether features may move within that: then they are unknowns of the fit.
    pub features_fitted: bool,
    /// Where the coordinates hold; [`Frame::Free`] where it is not said.
    pub frame: Option<Frame>,
    /// Whether a hollow is touched, not a body.
    pub inside: bool,
    /// Diameter of each probe's ball, mm.
    pub balls_mm: Option<&'a [f64]>,
}

/// What the rows of a file say.
#[derive(Debug, Clone, Copy, Default)]
pub struct Rows<'a> {
    /// The poses.
    pub poses: Angles<'a>,
    /// Which probe took each row.
    pub probe: &'a [usize],
    /// A second pose of each row.
    pub second: Option<Angles<'a>>,
    /// Which feature was touched.
    pub feature: Option<&'a [usize]>,
    /// Which standing of the artefact: any labels.
    pub placement: Option<&'a [i64]>,
    /// What an instrument or a calibration says of each row, mm.
    pub measured_mm: Option<&'a [f64]>,
    /// How an instrument says that the target was turned, a rotation vector in the instrument's frame, rad.
    pub rotation_rad: Option<&'a [[f64; 3]]>,
    /// Standard uncertainty of that about each axis, rad.
    pub rotation_u_rad: Option<&'a [f64]>,
}

/// A part of what can be stated, by the name that the skin gives it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// `features_mm`
    Features,
    /// `labels`
    Labels,
    /// `feature_u_mm`
    FeatureUncertainty,
    /// `features_fitted`
    FeaturesFitted,
    /// `frame`
    Frame,
    /// `inside`
    Inside,
    /// `balls_mm`
    Balls,
    /// `p_rad`
    SecondPose,
    /// `feature`
    Feature,
    /// `placement`
    Placement,
    /// `measured_mm`
    Measured,
    /// `rotation_rad`
    Rotation,
    /// `rotation_u_rad`
    RotationUncertainty,
}

impl Column {
    /// All of them.
    pub const ALL: [Column; 13] = [
        Column::Features,
        Column::Labels,
        Column::FeatureUncertainty,
        Column::FeaturesFitted,
        Column::Frame,
        Column::Inside,
        Column::Balls,
        Column::SecondPose,
        Column::Feature,
        Column::Placement,
        Column::Measured,
        Column::Rotation,
        Column::RotationUncertainty,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Column::Features => "features_mm",
            Column::Labels => "labels",
            Column::FeatureUncertainty => "feature_u_mm",
            Column::FeaturesFitted => "features_fitted",
            Column::Frame => "frame",
            Column::Inside => "inside",
            Column::Balls => "balls_mm",
            Column::SecondPose => "p_rad",
            Column::Feature => "feature",
            Column::Placement => "placement",
            Column::Measured => "measured_mm",
            Column::Rotation => "rotation_rad",
            Column::RotationUncertainty => "rotation_u_rad",
        }
    }

    /// Whether it is stated.
    pub(super) fn is_given(self, stated: &Stated, rows: &Rows) -> bool {
        match self {
            Column::Features => stated.features_mm.is_some(),
            Column::Labels => stated.labels.is_some(),
            Column::FeatureUncertainty => stated.feature_u_mm.is_some(),
            Column::FeaturesFitted => stated.features_fitted,
            Column::Frame => stated.frame.is_some(),
            Column::Inside => stated.inside,
            Column::Balls => stated.balls_mm.is_some(),
            Column::SecondPose => rows.second.is_some(),
            Column::Feature => rows.feature.is_some(),
            Column::Placement => rows.placement.is_some(),
            Column::Measured => rows.measured_mm.is_some(),
            Column::Rotation => rows.rotation_rad.is_some(),
            Column::RotationUncertainty => rows.rotation_u_rad.is_some(),
        }
    }
}
