//! Rotation as a rigid-body solver needs it, in 2D and in 3D.

use core::fmt::Debug;
use core::ops::{AddAssign, Mul};

use impinge::math::na::{Quaternion, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Matrix, Point, Real, Space, Vector};

/// The angular half of rigid-body motion in `D` dimensions.
pub trait Turn<const D: usize>: Space<D> {
    /// An angular velocity in radians per second, or a torque, in the world frame: a number in 2D,
    /// counter-clockwise positive, and a vector in 3D.
    type Spin: Copy + Debug + Default + AddAssign + Mul<Self, Output = Self::Spin>;
    /// An inverse inertia tensor: a number in 2D, a symmetric matrix in 3D.
    type Inertia: Copy + Debug + PartialEq;

    /// The spin of three components, of which 2D has the last.
    fn spin(components: [Self; 3]) -> Self::Spin;
    /// The torque `arm × force`.
    fn torque(arm: &Vector<Self, D>, force: &Vector<Self, D>) -> Self::Spin;
    /// The velocity `spin × arm` of the end of an arm.
    fn speed(spin: Self::Spin, arm: &Vector<Self, D>) -> Vector<Self, D>;
    /// The sum of the products of components.
    fn dot(a: Self::Spin, b: Self::Spin) -> Self;
    /// The inverse tensor of the body's own frame, in the world frame.
    fn in_world(own: &Self::Inertia, pose: &Self::Isometry) -> Self::Inertia;
    /// The change of spin that an angular impulse makes.
    fn response(inverse_inertia: &Self::Inertia, impulse: Self::Spin) -> Self::Spin;
    /// The kinetic energy of a spin; zero where the inverse tensor is zero.
    fn energy(inverse_inertia: &Self::Inertia, spin: Self::Spin) -> Self;
    /// A local point in the world.
    fn point(pose: &Self::Isometry, local: &Vector<Self, D>) -> Vector<Self, D>;
    /// A world point in the local frame.
    fn local_point(pose: &Self::Isometry, world: &Vector<Self, D>) -> Vector<Self, D>;
    /// The pose after the local point `center` moved by `shift` and the body turned about it by `angle`,
    /// up to the third power of the angle.
    fn moved(
        pose: &Self::Isometry,
        center: &Vector<Self, D>,
        shift: &Vector<Self, D>,
        angle: Self::Spin,
    ) -> Self::Isometry;
    /// An orthonormal basis whose first vector is `normal`; the others span the plane of contact.
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
