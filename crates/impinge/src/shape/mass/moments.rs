//! Mass, centre of mass and principal moments in double precision, for bodies of either scalar
//! type.

use crate::math::eigen::symmetric_eigen;
use crate::math::{Matrix, Vector};

/// A moment of at most this fraction of the largest moment counts as a rounding error of the sums
/// and becomes zero.
const THIN: f64 = 16.0 * f64::EPSILON;

/// The mass of a body, its centre of mass, and its principal moments, in the body's frame.
///
/// With the matrix `S = ∫ x xᵀ dm` about the centre, the tensor here is `tr(S) − S` in 2D and in
/// 3D. In 3D this is the inertia tensor. In 2D it is the upper left block of the tensor of a thin
/// plate, and its trace is the moment of inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moments<const D: usize> {
    pub(crate) mass: f64,
    pub(crate) center: Vector<f64, D>,
    /// A rotation whose columns are the principal axes, in the body's frame.
    pub(crate) axes: Matrix<f64, D>,
    /// The eigenvalues of the tensor, in the order of the columns of `axes`; none is negative.
    pub(crate) principal: Vector<f64, D>,
}

/// Returns the matrix of the parallel axis theorem for the offset `d`: `|d|² − d dᵀ`.
fn about<const D: usize>(offset: &Vector<f64, D>) -> Matrix<f64, D> {
    tensor_of(&(offset * offset.transpose()))
}

/// Returns the tensor `tr(S) − S` of a matrix `S` of second moments. Each diagonal element is
/// summed directly, not as a difference from the trace, so that small elements keep their relative
/// precision.
fn tensor_of<const D: usize>(second: &Matrix<f64, D>) -> Matrix<f64, D> {
    Matrix::<f64, D>::from_fn(|row, column| {
        if row != column {
            return -(second[(row, column)] + second[(column, row)]) * 0.5;
        }
        (0..D).filter(|&axis| axis != row).map(|axis| second[(axis, axis)]).sum()
    })
}

impl<const D: usize> Moments<D> {
    /// Returns a body without mass at `center`.
    pub(crate) fn massless(center: Vector<f64, D>) -> Self {
        let (axes, principal) = (Matrix::<f64, D>::identity(), Vector::<f64, D>::zeros());
        Self { mass: 0.0, center, axes, principal }
    }

    /// Returns a body from its second moments `∫ xᵢ² dm` about the centre, one for each principal
    /// axis `i`.
    pub(crate) fn along_axes(
        mass: f64,
        center: Vector<f64, D>,
        axes: Matrix<f64, D>,
        seconds: &Vector<f64, D>,
    ) -> Self {
        let principal = tensor_of(&Matrix::<f64, D>::from_diagonal(seconds)).diagonal();
        Self { mass, center, axes, principal }
    }

    /// Returns a body from its matrix of second moments about the centre.
    pub(crate) fn of_seconds(mass: f64, center: Vector<f64, D>, second: &Matrix<f64, D>) -> Self {
        Self::of_tensor(mass, center, &tensor_of(second))
    }

    /// Returns a body from its tensor about the centre. Moments at or below the rounding error of
    /// the tensor become zero.
    pub(crate) fn of_tensor(mass: f64, center: Vector<f64, D>, tensor: &Matrix<f64, D>) -> Self {
        let (principal, axes) = symmetric_eigen(tensor);
        let least = THIN * principal.amax();
        let principal = principal.map(|moment| if moment > least { moment } else { 0.0 });
        Self { mass, center, axes, principal }
    }

    /// Returns the tensor about the centre of mass, in the axes of the frame.
    pub(crate) fn tensor(&self) -> Matrix<f64, D> {
        self.axes * Matrix::<f64, D>::from_diagonal(&self.principal) * self.axes.transpose()
    }

    /// Returns the body in the frame that the pose (`rotation`, `translation`) maps to.
    pub(crate) fn placed(&self, rotation: &Matrix<f64, D>, translation: &Vector<f64, D>) -> Self {
        let center = rotation * self.center + translation;
        Self { center, axes: rotation * self.axes, ..*self }
    }

    /// Returns the body with its density multiplied by `density`, and so its mass and its moments.
    pub(crate) fn of_density(&self, density: f64) -> Self {
        Self { mass: self.mass * density, principal: self.principal * density, ..*self }
    }

    /// Returns the body at the same density with all lengths multiplied by `scale`, a power of two,
    /// and then moved by `origin`.
    pub(crate) fn grown(&self, scale: f64, origin: &Vector<f64, D>) -> Self {
        let measure = (0..D).fold(self.mass, |measure, _| measure * scale);
        let grown = |moment: f64| (0..D + 2).fold(moment, |moment, _| moment * scale);
        let (center, principal) = (origin + self.center * scale, self.principal.map(grown));
        Self { mass: measure, center, principal, ..*self }
    }

    /// Joins two bodies. If the total mass is zero, the centre is midway between the two centres.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        let offset = other.center - self.center;
        // The centre is computed from the midpoint: then equal centres stay equal, and the order of
        // the bodies does not matter.
        let lead = if mass > 0.0 { (other.mass - self.mass) / mass * 0.5 } else { 0.0 };
        let center = self.center * 0.5 + other.center * 0.5 + offset * lead;
        if mass <= 0.0 {
            return Self::massless(center);
        }
        let reduced = self.mass / mass * other.mass;
        let tensor = self.tensor() + other.tensor() + about(&offset) * reduced;
        Self::of_tensor(mass, center, &tensor)
    }

    /// Returns the body without `part`. The result has no mass if `part` weighs at least as much as
    /// the body.
    pub(crate) fn minus(&self, part: &Self) -> Self {
        let mass = self.mass - part.mass;
        if mass <= 0.0 {
            return Self::massless(self.center);
        }
        let offset = part.center - self.center;
        let center = self.center - offset * (part.mass / mass);
        let reduced = self.mass / mass * part.mass;
        Self::of_tensor(mass, center, &(self.tensor() - part.tensor() - about(&offset) * reduced))
    }
}
