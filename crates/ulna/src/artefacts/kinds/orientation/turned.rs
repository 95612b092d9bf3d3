//! Two rotations that should be one: how far they differ, and the frame in which many pairs differ least.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// How a rotation that should be none differs from it: twice the vector part of its quaternion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Difference {
    w: f64,
    v: Vector3<f64>,
}

impl Difference {
    pub fn of(rotation: &Rotation3<f64>) -> Difference {
        let quaternion = UnitQuaternion::from_rotation_matrix(rotation).into_inner();
        // of the two quaternions of a rotation the one that is nearer to none
        let sense = if quaternion.w < 0.0 { -1.0 } else { 1.0 };
        Difference { w: sense * quaternion.w, v: quaternion.imag() * sense }
    }

    /// The rotation itself.
    pub fn rotation_vector(&self) -> Vector3<f64> {
        UnitQuaternion::from_quaternion(nalgebra::Quaternion::from_parts(self.w, self.v)).scaled_axis()
    }

    pub fn residual(&self) -> Vector3<f64> {
        2.0 * self.v
    }

    /// Its derivative where the rotation is turned further, from its left.
    pub fn by_turn(&self) -> Matrix3<f64> {
        Matrix3::from_diagonal_element(self.w) - self.v.cross_matrix()
    }

    /// Its derivative where the frame that the rotation is measured against is turned.
    pub fn by_frame(&self) -> Matrix3<f64> {
        -self.by_turn().transpose()
    }
}

/// A target as the arm holds it and as the instrument sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Attitude {
    /// R(q) M
    pub held: Rotation3<f64>,
    /// R_m
    pub seen: Rotation3<f64>,
    /// inverse of a root of the covariance
    pub whiten: Matrix3<f64>,
}

impl Attitude {
    pub fn difference(&self, frame: &Rotation3<f64>) -> Difference {
        Difference::of(&(self.held * (frame * self.seen).inverse()))
    }
}

/// Steps of Gauss and Newton, at the most; residuals of a tenth of a radian take some ten.
const MOST_STEPS: usize = 100;
/// A step so small, rad, is none.
const STILL: f64 = 1e-14;

/// The frame that fits best. Where each weighs alike in all directions the closed form is exact (Wahba's problem, by
/// singular values: Markley 1988); else steps go on from it.
pub(super) fn best_frame(attitudes: &[Attitude], isotropic: bool) -> Rotation3<f64> {
    let product = |each: &Attitude| (each.held * each.seen.inverse()).matrix() * (each.whiten.norm_squared() / 3.0);
    let svd = attitudes.iter().map(product).sum::<Matrix3<f64>>().svd(true, true);
    let mut frame = Rotation3::identity();
    if let (Some(mut u), Some(v_t)) = (svd.u, svd.v_t) {
        // singular values descend, so the last column is the free one
        if (u * v_t).determinant() < 0.0 {
            u.set_column(2, &-u.column(2));
        }
        frame = Rotation3::from_matrix_unchecked(u * v_t);
    }
    if !isotropic {
        for _ in 0..MOST_STEPS {
            let mut normal = Matrix3::zeros();
            let mut right = Vector3::zeros();
            for each in attitudes {
                let difference = each.difference(&frame);
                let column = each.whiten * difference.by_frame();
                normal += column.transpose() * column;
                right += column.transpose() * (each.whiten * difference.residual());
            }
            let Some(step) = normal.cholesky().map(|cholesky| -cholesky.solve(&right)) else { break };
            frame = Rotation3::new(step) * frame;
            if step.norm() < STILL {
                break;
            }
        }
    }
    frame
}

/// How a rotation turns, in its own frame, where its rotation vector changes: the right Jacobian of SO(3) (Chirikjian,
/// Stochastic Models, Information Theory, and Lie Groups, vol. 2, 2012, section 10.1).
pub(super) fn by_vector(vector: &Vector3<f64>) -> Matrix3<f64> {
    let angle = vector.norm();
    let cross = vector.cross_matrix();
    // their series where the angle is small
    let (first, second) = if angle < 1e-4 {
        (0.5 - angle * angle / 24.0, 1.0 / 6.0 - angle * angle / 120.0)
    } else {
        ((1.0 - angle.cos()) / angle.powi(2), (angle - angle.sin()) / angle.powi(3))
    };
    Matrix3::identity() - cross * first + cross * cross * second
}
