//! Rotational motion for a rigid-body solver, in 2D and 3D.

use core::fmt::Debug;
use core::ops::{AddAssign, Mul};

use impinge::math::na::{Quaternion, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Matrix, Point, Real, Space, Vector};

/// The rotational part of rigid-body motion in `D` dimensions.
pub trait Turn<const D: usize>: Space<D> {
    /// An angular velocity in radians per second, or a torque, in the world frame: a number in 2D,
    /// counter-clockwise positive, and a vector in 3D.
    type Spin: Copy + Debug + Default + AddAssign + Mul<Self, Output = Self::Spin>;
    /// An inverse inertia tensor: a number in 2D, a symmetric matrix in 3D.
    type Inertia: Copy + Debug + PartialEq;

    /// Returns the spin with three components, of which 2D uses the last.
    fn spin(components: [Self; 3]) -> Self::Spin;
    /// Returns the torque `arm × force`.
    fn torque(arm: &Vector<Self, D>, force: &Vector<Self, D>) -> Self::Spin;
    /// Returns the velocity `spin × arm` at the end of an arm.
    fn speed(spin: Self::Spin, arm: &Vector<Self, D>) -> Vector<Self, D>;
    /// Returns the dot product of two spins.
    fn dot(a: Self::Spin, b: Self::Spin) -> Self;
    /// Rotates an inverse inertia tensor from the body frame to the world frame.
    fn in_world(own: &Self::Inertia, pose: &Self::Isometry) -> Self::Inertia;
    /// Returns the change of angular velocity by an angular impulse.
    fn response(inverse_inertia: &Self::Inertia, impulse: Self::Spin) -> Self::Spin;
    /// Returns the kinetic energy of a rotation; zero if the inverse tensor is zero.
    fn energy(inverse_inertia: &Self::Inertia, spin: Self::Spin) -> Self;
    /// Transforms a point from the local to the world frame.
    fn point(pose: &Self::Isometry, local: &Vector<Self, D>) -> Vector<Self, D>;
    /// Transforms a point from the world to the local frame.
    fn local_point(pose: &Self::Isometry, world: &Vector<Self, D>) -> Vector<Self, D>;
    /// Returns the pose after a translation of the local point `center` by `shift` and a rotation
    /// about this point by `angle`. The error of the angle grows with its third power.
    fn moved(
        pose: &Self::Isometry,
        center: &Vector<Self, D>,
        shift: &Vector<Self, D>,
        angle: Self::Spin,
    ) -> Self::Isometry;
    /// Returns an orthonormal basis whose first vector is `normal`; the other vectors span the
    /// contact plane.
    fn basis(normal: &Vector<Self, D>) -> [Vector<Self, D>; D];
}

impl<N: Real> Turn<2> for N {
    type Spin = N;
    type Inertia = N;

    fn spin([_, _, spin]: [N; 3]) -> N {
        spin
    }

    fn torque(arm: &Vector<N, 2>, force: &Vector<N, 2>) -> N {
        arm.x * force.y - arm.y * force.x
    }

    fn speed(spin: N, arm: &Vector<N, 2>) -> Vector<N, 2> {
        Vector::<N, 2>::new(-spin * arm.y, spin * arm.x)
    }

    fn dot(a: N, b: N) -> N {
        a * b
    }

    fn in_world(own: &N, _: &Isometry2<N>) -> N {
        *own
    }

    fn response(inverse_inertia: &N, impulse: N) -> N {
        *inverse_inertia * impulse
    }

    fn energy(inverse_inertia: &N, spin: N) -> N {
        if *inverse_inertia == N::ZERO { N::ZERO } else { N::HALF * spin * spin / *inverse_inertia }
    }

    fn point(pose: &Isometry2<N>, local: &Vector<N, 2>) -> Vector<N, 2> {
        (pose * Point::from(*local)).coords
    }

    fn local_point(pose: &Isometry2<N>, world: &Vector<N, 2>) -> Vector<N, 2> {
        pose.inverse_transform_point(&Point::from(*world)).coords
    }

    fn moved(
        pose: &Isometry2<N>,
        center: &Vector<N, 2>,
        shift: &Vector<N, 2>,
        angle: N,
    ) -> Isometry2<N> {
        let middle = Self::point(pose, center) + shift;
        let (re, im) = (pose.rotation.re, pose.rotation.im);
        let length = (N::ONE + angle * angle).sqrt();
        let (cosine, sine) = (N::ONE / length, angle / length);
        let (re, im) = (re * cosine - im * sine, re * sine + im * cosine);
        let norm = (re * re + im * im).sqrt();
        let rotation = UnitComplex::from_cos_sin_unchecked(re / norm, im / norm);
        Isometry2::from_parts((middle - rotation * center).into(), rotation)
    }

    fn basis(normal: &Vector<N, 2>) -> [Vector<N, 2>; 2] {
        [*normal, Vector::<N, 2>::new(-normal.y, normal.x)]
    }
}

impl<N: Real> Turn<3> for N {
    type Spin = Vector<N, 3>;
    type Inertia = Matrix<N, 3>;

    fn spin(components: [N; 3]) -> Vector<N, 3> {
        components.into()
    }

    fn torque(arm: &Vector<N, 3>, force: &Vector<N, 3>) -> Vector<N, 3> {
        arm.cross(force)
    }

    fn speed(spin: Vector<N, 3>, arm: &Vector<N, 3>) -> Vector<N, 3> {
        spin.cross(arm)
    }

    fn dot(a: Vector<N, 3>, b: Vector<N, 3>) -> N {
        a.dot(&b)
    }

    fn in_world(own: &Matrix<N, 3>, pose: &Isometry3<N>) -> Matrix<N, 3> {
        let turn = N::pose(pose).rotation;
        turn * own * turn.transpose()
    }

    fn response(inverse_inertia: &Matrix<N, 3>, impulse: Vector<N, 3>) -> Vector<N, 3> {
        inverse_inertia * impulse
    }

    fn energy(inverse_inertia: &Matrix<N, 3>, spin: Vector<N, 3>) -> N {
        inverse_inertia
            .try_inverse()
            .map_or(N::ZERO, |inertia| N::HALF * spin.dot(&(inertia * spin)))
    }

    fn point(pose: &Isometry3<N>, local: &Vector<N, 3>) -> Vector<N, 3> {
        (pose * Point::from(*local)).coords
    }

    fn local_point(pose: &Isometry3<N>, world: &Vector<N, 3>) -> Vector<N, 3> {
        pose.inverse_transform_point(&Point::from(*world)).coords
    }

    fn moved(
        pose: &Isometry3<N>,
        center: &Vector<N, 3>,
        shift: &Vector<N, 3>,
        angle: Vector<N, 3>,
    ) -> Isometry3<N> {
        let middle = Self::point(pose, center) + shift;
        let half = Quaternion::from_parts(N::ONE, angle * N::HALF);
        let rotation = UnitQuaternion::new_normalize(half * pose.rotation.into_inner());
        Isometry3::from_parts((middle - rotation * center).into(), rotation)
    }

    fn basis(normal: &Vector<N, 3>) -> [Vector<N, 3>; 3] {
        let mut axis = Vector::<N, 3>::zeros();
        axis[normal.iamin()] = N::ONE;
        let tangent = normal.cross(&axis).normalize();
        [*normal, tangent, normal.cross(&tangent)]
    }
}
