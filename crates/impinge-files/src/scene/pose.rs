//! Positions and motions of scenes in `f64`, before they are converted to the scalar of a world.

use impinge::math::na::{
    Isometry2, Isometry3, Quaternion, Translation2, Translation3, UnitComplex, UnitQuaternion,
    Vector3,
};
use impinge_record::Recordable;

use crate::error::{Fault, Within};
use crate::format::{AngularVelocity, MotionFile, PoseFile, RotationFile};
use crate::{Dimension, Problem};

/// A position in 2D or 3D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Placement {
    Two(Isometry2<f64>),
    Three(Isometry3<f64>),
}

/// Constant velocities of an object. Angular velocities are in radians per second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion {
    velocity: Vector3<f64>,
    /// The angular velocity, a vector along the axis of the rotation; along z in 2D.
    angular: Vector3<f64>,
}

impl Placement {
    /// Converts a position of a scene file.
    pub(crate) fn read(pose: &PoseFile, dimension: Dimension) -> Result<Self, Fault> {
        let translation = pose.translation.as_ref();
        let translation = translation.map_or(Ok(Vector3::zeros()), |numbers| {
            vector(numbers, dimension).within("translation")
        })?;
        let rotation = pose.rotation.as_ref();
        match dimension {
            Dimension::Two => {
                let turn = rotation.map_or(Ok(UnitComplex::identity()), turn2);
                let to = Translation2::new(translation.x, translation.y);
                Ok(Self::Two(Isometry2::from_parts(to, turn.within("rotation")?)))
            }
            Dimension::Three => {
                let turn = rotation.map_or(Ok(UnitQuaternion::identity()), turn3);
                let to = Translation3::from(translation);
                Ok(Self::Three(Isometry3::from_parts(to, turn.within("rotation")?)))
            }
        }
    }

    /// Converts the position to the scalar of a world, which has the dimension of the scene. Values
    /// beyond the range of `N` become infinite, which the world rejects. An error if `D` is not the
    /// dimension of the scene.
    pub(crate) fn isometry<N: Recordable<D>, const D: usize>(
        &self,
    ) -> Result<N::Isometry, Problem> {
        let (scene, numbers) = match self {
            Self::Two(at) => (Dimension::Two, <f64 as Recordable<2>>::isometry_numbers(at)),
            Self::Three(at) => (Dimension::Three, <f64 as Recordable<3>>::isometry_numbers(at)),
        };
        let numbers: Vec<N> = numbers.into_iter().map(N::lit).collect();
        N::isometry_of(&numbers).ok_or(Problem::OtherWorld { scene, asked: D })
    }

    /// Returns the position, translated by a vector in the frame of the world.
    pub(crate) fn translated(mut self, by: Vector3<f64>) -> Self {
        match &mut self {
            Self::Two(at) => at.translation.vector += by.xy(),
            Self::Three(at) => at.translation.vector += by,
        }
        self
    }

    /// Returns the position after `seconds` of a motion that starts at this position. No rounding
    /// errors accumulate, since callers pass the time from the start.
    pub(crate) fn after(self, motion: &Motion, seconds: f64) -> Self {
        let mut moved = self.translated(motion.velocity * seconds);
        let angle = motion.angular * seconds;
        match &mut moved {
            Self::Two(at) => at.rotation = turn_by(angle.z) * at.rotation,
            Self::Three(at) => at.rotation = about(angle, angle.norm()) * at.rotation,
        }
        moved
    }
}

impl Motion {
    /// Converts a motion of a scene file; `None` if both velocities are zero.
    pub(crate) fn read(motion: &MotionFile, dimension: Dimension) -> Result<Option<Self>, Fault> {
        let velocity = motion.velocity.as_ref();
        let velocity = velocity.map_or(Ok(Vector3::zeros()), |numbers| {
            vector(numbers, dimension).within("velocity")
        })?;
        let wrong = |needed, given| {
            Fault::from(Problem::WrongLength { needed, given }).within("angular_velocity")
        };
        let angular = match (&motion.angular_velocity, dimension) {
            (None, _) => Vector3::zeros(),
            (Some(AngularVelocity::Two(speed)), Dimension::Two) => Vector3::new(0.0, 0.0, *speed),
            (Some(AngularVelocity::Three(speed)), Dimension::Three) => Vector3::from(*speed),
            (Some(AngularVelocity::Two(_)), Dimension::Three) => return Err(wrong(3, 1)),
            (Some(AngularVelocity::Three(_)), Dimension::Two) => return Err(wrong(1, 3)),
        };
        let is_at_rest = velocity == Vector3::zeros() && angular == Vector3::zeros();
        Ok((!is_at_rest).then_some(Self { velocity, angular }))
    }
}

/// Converts coordinates to a vector, whose z is 0 in 2D. An error if their number differs from the
/// dimension.
pub(crate) fn vector(numbers: &[f64], dimension: Dimension) -> Result<Vector3<f64>, Problem> {
    match (numbers, dimension) {
        (&[x, y], Dimension::Two) => Ok(Vector3::new(x, y, 0.0)),
        (&[x, y, z], Dimension::Three) => Ok(Vector3::new(x, y, z)),
        _ => Err(Problem::WrongLength { needed: dimension.number(), given: numbers.len() }),
    }
}

fn turn2(rotation: &RotationFile) -> Result<UnitComplex<f64>, Fault> {
    match rotation {
        RotationFile::Degrees(degrees) => {
            let [sine, cosine] = sine_cosine(*degrees);
            Ok(UnitComplex::from_cos_sin_unchecked(cosine, sine))
        }
        RotationFile::Radians(radians) => Ok(turn_by(*radians)),
        _ => {
            let what = "a 3D rotation";
            Err(Problem::WrongDimension { what, dimension: Dimension::Two }.into())
        }
    }
}

fn turn3(rotation: &RotationFile) -> Result<UnitQuaternion<f64>, Fault> {
    match rotation {
        RotationFile::Quaternion([x, y, z, w]) => {
            let quaternion = Quaternion::new(*w, *x, *y, *z);
            let unit = UnitQuaternion::try_new(quaternion, 0.0);
            let unit = unit.filter(|unit| unit.coords.iter().all(|x| x.is_finite()));
            unit.ok_or_else(|| not_a_direction(quaternion.norm())).within("quaternion")
        }
        RotationFile::Euler { order, degrees } => {
            let (axes, is_reversed) = order.fixed_axes();
            let mut angles = *degrees;
            if is_reversed {
                angles.reverse();
            }
            let turns = axes.into_iter().zip(angles);
            let turns = turns.map(|(axis, angle)| {
                turn_by_half(Vector3::ith(axis, 1.0), sine_cosine(0.5 * angle))
            });
            Ok(turns.fold(UnitQuaternion::identity(), |before, turn| turn * before))
        }
        RotationFile::AxisAngle { axis, degrees } => {
            let unit = unit(Vector3::from(*axis)).within("axis_angle.axis")?;
            Ok(turn_by_half(unit, sine_cosine(0.5 * degrees)))
        }
        RotationFile::Degrees(_) | RotationFile::Radians(_) => {
            let what = "a 2D rotation";
            Err(Problem::WrongDimension { what, dimension: Dimension::Three }.into())
        }
    }
}

/// Returns the vector scaled to length 1; an error if it is zero or not finite.
pub(crate) fn unit(vector: Vector3<f64>) -> Result<Vector3<f64>, Problem> {
    // Dividing by the largest component first avoids overflow and underflow of the squares.
    let scaled = vector / vector.amax();
    let unit = scaled.normalize();
    let is_usable = unit.iter().all(|x| x.is_finite());
    if is_usable { Ok(unit) } else { Err(not_a_direction(vector.norm())) }
}

/// Returns the error of a vector without a direction.
pub(crate) const fn not_a_direction(length: f64) -> Problem {
    Problem::BadValue { what: "the length must be finite and not zero", value: length }
}

/// Returns the 2D rotation by an angle. `libm` returns the same bits on every platform.
fn turn_by(radians: f64) -> UnitComplex<f64> {
    UnitComplex::from_cos_sin_unchecked(libm::cos(radians), libm::sin(radians))
}

/// Returns the rotation by an angle in radians about a vector of any length; the identity if the
/// vector is zero or not finite.
pub(crate) fn about(axis: Vector3<f64>, radians: f64) -> UnitQuaternion<f64> {
    let Ok(axis) = unit(axis) else { return UnitQuaternion::identity() };
    let half = 0.5 * radians;
    turn_by_half(axis, [libm::sin(half), libm::cos(half)])
}

/// Returns the rotation about a unit vector by twice the angle that has this sine and cosine.
fn turn_by_half(axis: Vector3<f64>, [sine, cosine]: [f64; 2]) -> UnitQuaternion<f64> {
    let vector = axis * sine;
    UnitQuaternion::new_normalize(Quaternion::new(cosine, vector.x, vector.y, vector.z))
}

/// Returns the sine and the cosine of an angle in degrees, exact for multiples of a quarter turn.
/// The angle is reduced to at most an eighth of a turn. The removed quarter turns exchange and
/// negate the two values.
fn sine_cosine(degrees: f64) -> [f64; 2] {
    let rest = degrees % 360.0;
    let quarters = libm::round(rest / 90.0);
    let angle = (rest - quarters * 90.0).to_radians();
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let quarter = (quarters + 4.0) % 4.0;
    if quarter == 1.0 {
        [cosine, -sine]
    } else if quarter == 2.0 {
        [-sine, -cosine]
    } else if quarter == 3.0 {
        [-cosine, sine]
    } else {
        [sine, cosine]
    }
}
