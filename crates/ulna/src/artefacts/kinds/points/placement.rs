//! Where an artefact stands: the pose that fits the touches of its features best.

use nalgebra::{
    DMatrix, DVector, Isometry3, Matrix3, Matrix3xX, Point3, Rotation3, Translation3, UnitQuaternion, Vector3,
};

/// Which motions of one standing of an artefact the touched features can show.
#[derive(Debug, Clone)]
pub(super) struct Placement {
    /// centroid of the touched features, in the artefact's frame, mm
    pub anchor: Vector3<f64>,
    /// axes about which a turn moves a touched feature, in the artefact's frame: 3, 2 where they are in line, none for one
    pub axes: Vec<Vector3<f64>>,
    /// dimensions that the touched features span: 0 to 3
    pub span: usize,
}

/// Steps after which what is left to do is done with second derivatives.
const GAUSS_NEWTON_STEPS: usize = 8;
/// A radius this small against the artefact's size is a point on the axis, up to rounding.
const ON_AXIS: f64 = 1e-8;

impl Placement {
    /// From the features touched (with repetitions).
    pub fn new(touched: &[Vector3<f64>]) -> Placement {
        let anchor = touched.iter().sum::<Vector3<f64>>() / touched.len() as f64;
        let arms = touched.iter().map(|f| f - anchor);
        let scatter: Matrix3<f64> = arms.map(|r| r * r.transpose()).sum();
        let eigen = scatter.symmetric_eigen();
        let size = eigen.eigenvalues.max();
        let seen = |value: f64| value > size * ON_AXIS * ON_AXIS && size > 0.0;
        let span = eigen.eigenvalues.iter().filter(|&&value| seen(value)).count();
        let turns = |k: &usize| seen(eigen.eigenvalues.sum() - eigen.eigenvalues[*k]);
        let axes = (0..3).filter(turns).map(|k| eigen.eigenvectors.column(k).into()).collect();
        Placement { anchor, axes, span }
    }

    /// Number of unknowns: 3, 5 or 6.
    pub fn unknowns(&self) -> usize {
        3 + self.axes.len()
    }

    /// The best pose `t_base_artefact` for whitened residuals `W (p - (R f + t))`.
    ///
    /// Where each weight is alike in all directions the closed form is exact (Kabsch 1976); else Gauss-Newton goes on from
    /// it, and where residuals are so large that this takes long, Newton.
    pub fn pose(&self, touches: &[Touch], isotropic: bool) -> Isometry3<f64> {
        let weight: f64 = touches.iter().map(Touch::weight).sum();
        let mean =
            |of: fn(&Touch) -> Vector3<f64>| touches.iter().map(|t| of(t) * t.weight()).sum::<Vector3<f64>>() / weight;
        let (p_mean, f_mean) = (mean(|t| t.p_mm), mean(|t| t.feature_mm));
        let mut rotation = Rotation3::identity();
        if !self.axes.is_empty() {
            let product = |t: &Touch| (t.p_mm - p_mean) * (t.feature_mm - f_mean).transpose() * t.weight();
            let svd = touches.iter().map(product).sum::<Matrix3<f64>>().svd(true, true);
            if let (Some(u), Some(v_t)) = (svd.u, svd.v_t) {
                // singular values descend, so the last column is the free one
                let mut u = u;
                if (u * v_t).determinant() < 0.0 {
                    u.set_column(2, &-u.column(2));
                }
                rotation = Rotation3::from_matrix_unchecked(u * v_t);
            }
        }
        let translation = Translation3::from(p_mean - rotation * f_mean);
        let mut pose = Isometry3::from_parts(translation, UnitQuaternion::from_rotation_matrix(&rotation));
        if !isotropic {
            for step in 0..100 {
                let moved = self.improve(&mut pose, touches, step >= GAUSS_NEWTON_STEPS);
                if moved < 1e-13 {
                    break;
                }
            }
        }
        pose
    }

    /// One step, shortened until it lowers the cost; returns its size relative to the distances involved.
    fn improve(&self, pose: &mut Isometry3<f64>, touches: &[Touch], newton: bool) -> f64 {
        let n = self.unknowns();
        let mut normal = DMatrix::zeros(n, n);
        let mut right = DVector::zeros(n);
        for touch in touches {
            let residual = touch.whiten * touch.residual(pose);
            let columns = Matrix3xX::from_columns(&self.derivatives(pose, touch).collect::<Vec<_>>());
            normal += columns.transpose() * &columns;
            right += columns.transpose() * residual;
        }
        let curved = newton.then(|| &normal + self.curvature(pose, touches)).and_then(|h| h.cholesky());
        let Some(cholesky) = curved.or_else(|| normal.cholesky()) else {
            return 0.0;
        };
        let mut step = -cholesky.solve(&right);
        let cost = |pose: &Isometry3<f64>| -> f64 {
            touches.iter().map(|t| (t.whiten * t.residual(pose)).norm_squared()).sum()
        };
        let before = cost(pose);
        for _ in 0..10 {
            let moved = self.moved(pose, &step);
            if cost(&moved) <= before {
                let shift = step.fixed_rows::<3>(0).norm() / (1.0 + moved.translation.vector.norm());
                *pose = moved;
                return shift + step.rows(3, n - 3).norm();
            }
            step *= 0.5;
        }
        0.0
    }

    /// What the turns' second derivatives add to the normal equations: `(Wᵀ W r) · ∂²r`.
    fn curvature(&self, pose: &Isometry3<f64>, touches: &[Touch]) -> DMatrix<f64> {
        let mut curvature = DMatrix::zeros(self.unknowns(), self.unknowns());
        for touch in touches {
            let pulled = pose.rotation.inverse() * (touch.whiten.transpose() * (touch.whiten * touch.residual(pose)));
            let arm = touch.feature_mm - self.anchor;
            for (i, a) in self.axes.iter().enumerate() {
                for (j, b) in self.axes.iter().enumerate() {
                    let bent = a.cross(&b.cross(&arm)) + b.cross(&a.cross(&arm));
                    curvature[(3 + i, 3 + j)] -= 0.5 * pulled.dot(&bent);
                }
            }
        }
        curvature
    }

    /// The pose after a step of the unknowns: the anchor shifted, the artefact turned about it.
    fn moved(&self, pose: &Isometry3<f64>, step: &DVector<f64>) -> Isometry3<f64> {
        let anchor = (pose * Point3::from(self.anchor)).coords + step.fixed_rows::<3>(0);
        let turn: Vector3<f64> = self.axes.iter().zip(step.iter().skip(3)).map(|(axis, &s)| axis * s).sum();
        let rotation = pose.rotation * UnitQuaternion::from_scaled_axis(turn);
        Isometry3::from_parts((anchor - rotation * self.anchor).into(), rotation)
    }

    /// Derivatives of the whitened residual with respect to the placement's unknowns.
    pub fn derivatives<'a>(
        &'a self,
        pose: &Isometry3<f64>,
        touch: &Touch,
    ) -> impl Iterator<Item = Vector3<f64>> + use<'a> {
        let (pose, touch) = (*pose, *touch);
        let shifts = (0..3).map(move |j| -touch.whiten.column(j));
        let arm = touch.feature_mm - self.anchor;
        let turns = self.axes.iter().map(move |axis| -touch.whiten * (pose.rotation * axis.cross(&arm)));
        shifts.chain(turns)
    }
}

/// The arm on a feature.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    /// the tip, base frame
    pub p_mm: Vector3<f64>,
    /// the feature, artefact frame
    pub feature_mm: Vector3<f64>,
    /// inverse of a root of the covariance
    pub whiten: Matrix3<f64>,
}

impl Touch {
    /// Tip minus the feature's place.
    pub fn residual(&self, pose: &Isometry3<f64>) -> Vector3<f64> {
        self.p_mm - (pose * Point3::from(self.feature_mm)).coords
    }

    fn weight(&self) -> f64 {
        self.whiten.norm_squared() / 3.0
    }
}
