//! Separation of two cylinders.
//!
//! Tries the directions that can be the normal, each with a cheap proof: normals of caps, the
//! common perpendicular of both axes, the direction from an axis to the rim of the other solid, and
//! the direction from rim to rim. If the solids are apart, the proof is two points as far apart as
//! a pair of supporting planes. If they overlap, the proof is a ball: if a ball centred at a point
//! of one solid lies within the other, no separating translation is shorter than its radius. A
//! point below a cap is the centre of such a ball if its distance from the side is at least its
//! depth; for a side, the distance from the caps counts. Other cases, such as two overlapping rims,
//! fall back to the general algorithm.

use super::coaxial;
use crate::collide::Pair;
use crate::collide::separation::hulls::{beyond_limit, in_first_frame, rounding_error};
use crate::collide::separation::wrong_kinds;
use crate::convex::{Separation, Units};
use crate::math::{Mapped, Point, Pose, Real, Vector, cross, max, min, orthonormal_basis, unit};
use crate::shape::{Cylinder, Kind, SupportMap};

/// Largest number of steps of Newton's method; about four are enough, starting from the direction
/// between the centres.
const STEPS: usize = 10;

/// Returns the separation of two cylinders; `None` above `limit`, and if the pose is not finite.
///
/// In a tie, caps come before sides, and the first solid comes before the second.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let (Kind::Cylinder(first, _), Kind::Cylinder(second, _)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    if !pair.pose12.is_finite() {
        return None;
    }
    let units = Units::of(first.reach(), second.reach(), &pair.pose12.translation);
    let cylinders = CylinderPair::new(first, second, &pair.pose12, units.shrink);
    let result = cylinders.resolve(beyond_limit(&units, limit));
    match result.answer(&units, &pair.pose12) {
        Some(found) => found.filter(|found| found.distance <= limit),
        None => coaxial::separation(pair, limit),
    }
}

/// Result of the search for the separation of two solids.
pub(in crate::collide::separation) enum RevolvedResult<N: Real> {
    /// The solids are farther apart than the limit.
    Beyond,
    /// The separation; `true` if it is in the frame of the second solid.
    Found(RevolvedFound<N>, bool),
    Undecided,
}

impl<N: Real> RevolvedResult<N> {
    /// Tries directions until one gives the separation, or separates the solids by more than
    /// `beyond`; `Undecided` if none does. The flag of each direction is `true` if it is in the
    /// frame of the second solid.
    fn of(tries: &[(Attempt<'_, N>, bool)], beyond: N) -> Self {
        for (attempt, is_second) in tries {
            let Some(tried) = attempt() else { continue };
            if tried.height > beyond {
                return Self::Beyond;
            }
            if let Some(found) = tried.found {
                return Self::Found(found, *is_second);
            }
        }
        Self::Undecided
    }

    /// Returns the separation in the frame of the first solid and in the caller's unit of length.
    /// An inner `None` is a pair beyond the limit; an outer `None` is an undecided pair.
    pub(in crate::collide::separation) fn answer(
        &self,
        units: &Units<N>,
        pose12: &Pose<N, 3>,
    ) -> Option<Option<Separation<N, 3>>> {
        match self {
            Self::Beyond => Some(None),
            Self::Undecided => None,
            Self::Found(found, false) => Some(Some(found.restored(units.scale))),
            Self::Found(found, true) => {
                Some(Some(in_first_frame(&found.restored(units.scale), pose12)))
            }
        }
    }
}

/// A separation in the frame of one solid and in units of the pair; `normal` points from this solid
/// to the other one.
#[derive(Clone, Copy)]
pub(in crate::collide::separation) struct RevolvedFound<N: Real> {
    pub(in crate::collide::separation) distance: N,
    pub(in crate::collide::separation) normal: Vector<N, 3>,
    /// Point of the other solid; the point of this solid faces it along `normal`.
    pub(in crate::collide::separation) on_other: Vector<N, 3>,
}

impl<N: Real> RevolvedFound<N> {
    fn restored(&self, scale: N) -> Separation<N, 3> {
        let on_own = self.on_other - self.normal * self.distance;
        Separation {
            distance: self.distance * scale,
            normal: self.normal,
            point1: Point::from(on_own * scale),
            point2: Point::from(self.on_other * scale),
        }
    }
}

/// Half height and radius of a cylinder, in units of the pair.
#[derive(Clone, Copy)]
struct Size<N> {
    half: N,
    radius: N,
}

/// A cylinder about the y axis, and the other cylinder in its frame, in units of the pair.
struct CylinderView<N: Real> {
    own: Size<N>,
    other: Size<N>,
    /// Centre of the other cylinder.
    center: Vector<N, 3>,
    /// Unit vector along the axis of the other cylinder.
    axis: Vector<N, 3>,
}

/// Result for one direction between the solids: the signed gap along it, and the separation if it
/// is proved.
struct Tried<N: Real> {
    height: N,
    found: Option<RevolvedFound<N>>,
}

/// Function that computes the result for one direction; `None` if there is no such direction.
type Attempt<'a, N> = &'a dyn Fn() -> Option<Tried<N>>;

/// Two cylinders, each in the frame of the other.
struct CylinderPair<N: Real> {
    views: [CylinderView<N>; 2],
}

impl<N: Real> CylinderPair<N> {
    /// Places each cylinder in the frame of the other, in units of the pair.
    fn new(first: &Cylinder<N>, second: &Cylinder<N>, pose12: &Pose<N, 3>, shrink: N) -> Self {
        let [size1, size2] = [first, second].mapped(|solid| Size {
            half: solid.half_height() * shrink,
            radius: solid.radius() * shrink,
        });
        let center = pose12.translation * shrink;
        let axis = pose12.rotation.column(1).into_owned();
        let from_second = -pose12.inverse_vector(&center);
        let axis_from_second = pose12.inverse_vector(&Vector::<N, 3>::y());
        Self {
            views: [
                CylinderView { own: size1, other: size2, center, axis },
                CylinderView {
                    own: size2,
                    other: size1,
                    center: from_second,
                    axis: axis_from_second,
                },
            ],
        }
    }

    /// Tries the directions in order: caps, the common perpendicular of the axes, sides, rims.
    fn resolve(&self, beyond: N) -> RevolvedResult<N> {
        let [first, second] = &self.views;
        let tries: [(Attempt<'_, N>, bool); 6] = [
            (&|| Some(first.cap()), false),
            (&|| Some(second.cap()), true),
            (&|| first.across(), false),
            (&|| first.side(), false),
            (&|| second.side(), true),
            (&|| first.rims(), false),
        ];
        RevolvedResult::of(&tries, beyond)
    }
}

impl<N: Real> CylinderView<N> {
    /// Tries the normal of the cap that faces the other solid.
    fn cap(&self) -> Tried<N> {
        let up = if self.center.y < N::ZERO { -N::ONE } else { N::ONE };
        let normal = Vector::<N, 3>::new(N::ZERO, up, N::ZERO);
        let (cosine, sine) = (self.axis.y, radial(&self.axis).norm());
        let height = self.center.y * up
            - cosine.abs() * self.other.half
            - sine * self.other.radius
            - self.own.half;
        let point = self.lowest_above_cap(&normal, sine);
        let margin = self.own.radius - radial(&point).norm();
        let is_above = if height > N::ZERO {
            margin >= -rounding_error::<N>()
        } else {
            min(margin, self.own.half) >= -height - rounding_error()
        };
        let found = RevolvedFound { distance: height, normal, on_other: point };
        Tried { height, found: is_above.then_some(found) }
    }

    /// Returns the lowest point of the other solid along the normal of a cap. If several are lowest
    /// up to `rounding_error`, returns the result of [`Self::over_disk`] for parallel caps, else
    /// the point of the lowest line nearest to the axis of this solid. `sine` is the sine of the
    /// angle between the axes.
    fn lowest_above_cap(&self, normal: &Vector<N, 3>, sine: N) -> Vector<N, 3> {
        let cosine = normal.dot(&self.axis);
        let end = if cosine < N::ZERO { self.axis } else { -self.axis } * self.other.half;
        if sine * self.other.radius <= rounding_error() {
            return self.over_disk(&(self.center + end));
        }
        // Vector from the centre of the other cap to its lowest point: opposite to the component of
        // the normal perpendicular to the other axis, with the radius as length. It is computed
        // without a difference of nearly equal numbers.
        let aside = radial(&self.axis) * (cosine / sine * self.other.radius);
        let down = lifted(&aside) - normal * (sine * self.other.radius);
        if cosine.abs() * self.other.half <= rounding_error() {
            let middle = self.center + down;
            let along = radial(&self.axis);
            let nearest = -radial(&middle).dot(&along) / along.norm_squared();
            let half = self.other.half;
            return middle + self.axis * max(min(nearest, half), -half);
        }
        self.center + end + down
    }

    /// For parallel caps, returns the middle of the segment that both disks cover on the line
    /// through their centres; `middle` is the centre of the other disk.
    fn over_disk(&self, middle: &Vector<N, 3>) -> Vector<N, 3> {
        let Some((away, distance)) = unit(&radial(middle)) else { return *middle };
        let (low, high) = (
            max(distance - self.other.radius, -self.own.radius),
            min(distance + self.other.radius, self.own.radius),
        );
        // If the disks do not overlap, this is the nearest point of the other disk.
        let at = if low > high { low } else { (low + high) * N::HALF };
        middle + lifted(&away) * (at - distance)
    }

    /// Tries the common perpendicular of both axes, side against side; `None` for nearly parallel
    /// axes.
    fn across(&self) -> Option<Tried<N>> {
        let squared = radial(&self.axis).norm_squared();
        let is_resolved = squared > N::lit(16.0) * N::EPSILON;
        if !is_resolved {
            return None;
        }
        let across = cross(&Vector::<N, 3>::y(), &self.axis) / squared.sqrt();
        let away = self.center.dot(&across);
        let normal = if away < N::ZERO { -across } else { across };
        let (away, sizes) = (away.abs(), self.own.radius + self.other.radius);
        let height = away - sizes;
        // Points where the common perpendicular meets the axes, from the parts across the own axis:
        // the dot product of whole vectors would cancel for nearly parallel axes.
        let at_other = -radial(&self.center).dot(&radial(&self.axis)) / squared;
        let at_own = self.center.y + self.axis.y * at_other;
        let (margin1, margin2) = (self.own.half - at_own.abs(), self.other.half - at_other.abs());
        let is_between = margin1 >= -rounding_error::<N>() && margin2 >= -rounding_error::<N>();
        // The proof for an overlap: two balls around one point between the axes, one in each solid,
        // whose radii add up to the depth.
        let entry = away - self.other.radius;
        let least = max(self.own.radius - margin1, max(entry, N::ZERO));
        let most = min(entry + margin2, min(away, self.own.radius));
        let is_proved = height > N::ZERO || least <= most + rounding_error();
        let on_other = self.center + self.axis * at_other - normal * self.other.radius;
        let found = RevolvedFound { distance: height, normal, on_other };
        Some(Tried { height, found: (is_between && is_proved).then_some(found) })
    }

    /// Tries the direction from the axis to the nearest point of the other rim or, for parallel
    /// axes, of the other side. `None` if the centre of the other solid is on the axis, or if
    /// [`Self::toward_rim`] returns `None`, as for a solid that extends to the axis.
    fn side(&self) -> Option<Tried<N>> {
        let start = unit(&radial(&self.center))?.0;
        let (normal, point) = self.toward_rim(start)?;
        let margin = self.own.half - point.y.abs();
        let height = radial(&point).dot(&normal) - self.own.radius;
        let is_beside = if height > N::ZERO {
            margin >= -rounding_error::<N>()
        } else {
            min(margin, self.own.radius) >= -height - rounding_error()
        };
        let found = RevolvedFound { distance: height, normal: lifted(&normal), on_other: point };
        Some(Tried { height, found: is_beside.then_some(found) })
    }

    /// Returns, by Newton's method, the direction away from the axis along which the lowest point
    /// of the other solid lies, and that point. `None` if the lowest point is not unique, is not on
    /// the outer side of the axis, or the method does not converge.
    fn toward_rim(&self, start: Vector<N, 2>) -> Option<(Vector<N, 2>, Vector<N, 3>)> {
        let mut normal = start;
        for _ in 0..STEPS {
            let (point, bend) = self.lowest_beside(&normal)?;
            let across = Vector::<N, 2>::new(-normal.y, normal.x);
            let (slope, height) = (radial(&point).dot(&across), radial(&point).dot(&normal));
            let is_peak = height > rounding_error();
            if !is_peak {
                return None;
            }
            if slope.abs() <= N::HALF * rounding_error() {
                return Some((normal, point));
            }
            normal = unit(&(normal + across * (slope / (bend + height))))?.0;
        }
        None
    }

    /// Returns the lowest point of the other solid along a direction away from the axis, and its
    /// derivative as the direction rotates. `None` if a whole cap is lowest, or a line of the side
    /// unless the axes are parallel.
    fn lowest_beside(&self, normal: &Vector<N, 2>) -> Option<(Vector<N, 3>, N)> {
        let (out, across) = (lifted(normal), lifted(&Vector::<N, 2>::new(-normal.y, normal.x)));
        let (axial, turn) = (self.axis.dot(&out), self.axis.dot(&across));
        let squared = turn * turn + self.axis.y * self.axis.y;
        let is_resolved = squared > N::lit(16.0) * N::EPSILON;
        if !is_resolved {
            return None;
        }
        let (cosine, radius) = (squared.sqrt(), self.other.radius);
        let aside = across * turn + Vector::<N, 3>::y() * self.axis.y;
        let down = aside * (axial * radius / cosine) - out * (cosine * radius);
        let ratio = axial * turn / cosine;
        let bend = radius * (N::ONE - turn * turn - ratio * ratio) / cosine;
        if axial.abs() * self.other.half <= rounding_error() {
            return self.beside_parallel(&down).map(|point| (point, bend));
        }
        let end = if axial < N::ZERO { self.axis } else { -self.axis } * self.other.half;
        Some((self.center + end + down, bend))
    }

    /// Returns the middle of that part of the other solid's lowest line that is beside this solid;
    /// `None` unless the axes are parallel.
    fn beside_parallel(&self, down: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let extent = self.other.half * self.axis.y.abs();
        let is_parallel = radial(&self.axis).norm() * self.other.half <= rounding_error();
        let (low, high) = (
            max(self.center.y - extent, -self.own.half),
            min(self.center.y + extent, self.own.half),
        );
        let at = ((low + high) * N::HALF - self.center.y) / self.axis.y;
        // Clamped to the ends, because a disk, whose axis may have any direction, has no line.
        let half = self.other.half;
        is_parallel.then(|| self.center + down + self.axis * max(min(at, half), -half))
    }

    /// Tries rim against rim, for solids that are apart, by Newton's method on the sphere of
    /// directions. `None` if they overlap or the method fails.
    fn rims(&self) -> Option<Tried<N>> {
        let mut normal = unit(&self.center)?.0;
        for _ in 0..STEPS {
            let (own, other) = (self.rim(&normal, true)?, self.rim(&-normal, false)?);
            let away = other.point - own.point;
            let height = away.dot(&normal);
            let slope = away - normal * height;
            let is_apart = height > rounding_error();
            if !is_apart {
                return None;
            }
            if slope.norm_squared() <= rounding_error::<N>() * rounding_error() {
                let found = RevolvedFound { distance: height, normal, on_other: other.point };
                return Some(Tried { height, found: Some(found) });
            }
            normal = unit(&(normal + step(&normal, &slope, height, &[own, other])?))?.0;
        }
        None
    }

    /// Returns the point of a rim that is farthest along a direction: on this solid's rim if
    /// `is_own`, else on the other solid's. `None` if the direction is along the axis of that
    /// solid.
    fn rim(&self, direction: &Vector<N, 3>, is_own: bool) -> Option<Rim<N>> {
        let (size, center, axis) = if is_own {
            (self.own, Vector::<N, 3>::zeros(), Vector::<N, 3>::y())
        } else {
            (self.other, self.center, self.axis)
        };
        let axial = axis.dot(direction);
        let (out, cosine) = unit(&(direction - axis * axial))?;
        let (out, _) = unit(&(out - axis * axis.dot(&out)))?;
        let end = if axial < N::ZERO { -axis } else { axis } * size.half;
        let along = cross(&axis, &out);
        Some(Rim { point: center + end + out * size.radius, along, bend: size.radius / cosine })
    }
}

/// A point of a rim, the tangent there, and the derivative of the point along the tangent as the
/// direction rotates.
struct Rim<N: Real> {
    point: Vector<N, 3>,
    along: Vector<N, 3>,
    bend: N,
}

/// Returns the change of `normal` by one step of Newton's method towards a slope of zero; at most
/// half a radian. `None` if the change is zero or not finite.
fn step<N: Real>(
    normal: &Vector<N, 3>,
    slope: &Vector<N, 3>,
    height: N,
    rims: &[Rim<N>; 2],
) -> Option<Vector<N, 3>> {
    let (u, v) = orthonormal_basis(normal);
    let (mut uu, mut uv, mut vv) = (height, N::ZERO, height);
    for rim in rims {
        let (a, b) = (rim.along.dot(&u), rim.along.dot(&v));
        uu += rim.bend * a * a;
        uv += rim.bend * a * b;
        vv += rim.bend * b * b;
    }
    let determinant = uu * vv - uv * uv;
    let (p, q) = (slope.dot(&u), slope.dot(&v));
    let turn = u * ((vv * p - uv * q) / determinant) + v * ((uu * q - uv * p) / determinant);
    let (along, length) = unit(&turn)?;
    Some(along * min(length, N::HALF))
}

/// Returns the part of a vector perpendicular to the y axis, as (x, z).
pub(in crate::collide::separation) fn radial<N: Real>(v: &Vector<N, 3>) -> Vector<N, 2> {
    Vector::<N, 2>::new(v.x, v.z)
}

/// Returns the 3D vector (v.x, 0, v.y), which is perpendicular to the y axis.
fn lifted<N: Real>(v: &Vector<N, 2>) -> Vector<N, 3> {
    Vector::<N, 3>::new(v.x, N::ZERO, v.y)
}

#[cfg(test)]
pub(in crate::collide::separation) mod tests {
    use super::*;
    use crate::collide::separation::general;
    use crate::collide::separation::hulls::tests::{Random, error};
    use crate::shape::Shape;

    type Solids<N> = [Box<dyn Shape<N, 3>>; 2];

    /// Asserts that `separation` agrees with the general algorithm within `accuracy` times the size
    /// of the pair. `solids` makes the pairs from random sizes between 0 and 1.
    pub(in crate::collide::separation) fn compare<N: Real>(
        seed: u64,
        rounds: usize,
        accuracy: f64,
        solids: fn([Vector<N, 3>; 2]) -> Solids<N>,
        separation: fn(&Pair<'_, N, 3>, N) -> Option<Separation<N, 3>>,
    ) {
        let random = &mut Random(seed);
        for round in 0..rounds {
            let shapes = solids([(); 2].mapped(|()| random.vector::<N>().abs()));
            let [first, second] = shapes.each_ref().mapped(|shape| shape.geometry().0);
            let mut pair = Pair { first, second, pose12: random.turn() };
            pair.pose12.translation = random.vector::<N>() * N::lit([4.0, 0.3][round % 2]);
            let truth = general::separation(&pair, N::INFINITY).expect("no limit");
            let gap = [1.0, 0.1, 1e-3, 1e-6, 0.0, -1e-6, -1e-3, -0.1][random.pick(8)];
            if round % 4 != 1 {
                pair.pose12.translation += truth.normal * (N::lit(gap) - truth.distance);
            }
            let truth = general::separation(&pair, N::INFINITY).expect("no limit");
            let found = separation(&pair, N::INFINITY).expect("no limit");
            let size = 4.0 + truth.distance.as_f64().abs();
            let error = error(&pair, &found, &truth);
            assert!(
                error <= accuracy * size,
                "round {round}, gap {gap}: off by {error}: {shapes:?} {:?}: {found:?}, not {truth:?}",
                pair.pose12
            );
        }
    }

    #[test]
    fn answers_are_those_of_the_general_algorithm() {
        fn solids<N: Real>(sizes: [Vector<N, 3>; 2]) -> Solids<N> {
            [
                Box::new(Cylinder::new(sizes[0].x, sizes[0].y)),
                Box::new(Cylinder::new(sizes[1].x, sizes[1].y)),
            ]
        }
        compare::<f64>(1, 3000, 1e-12, solids, separation);
        compare::<f32>(2, 3000, 3e-6, solids, separation);
    }

    #[test]
    fn most_pairs_are_proved() {
        let random = &mut Random(3);
        let mut undecided = 0;
        for _ in 0..1000 {
            let [first, second] = [(); 2].mapped(|()| {
                let sizes = random.vector::<f64>().abs();
                Cylinder::new(sizes.x + 0.1, sizes.y + 0.1)
            });
            let mut pose12 = random.turn();
            pose12.translation = random.vector() * 1.5;
            let units = Units::of(first.reach(), second.reach(), &pose12.translation);
            let cylinders = CylinderPair::new(&first, &second, &pose12, units.shrink);
            undecided +=
                usize::from(matches!(cylinders.resolve(f64::INFINITY), RevolvedResult::Undecided));
        }
        assert!(undecided < 400, "{undecided} of 1000 are left to the general algorithm");
    }
}
