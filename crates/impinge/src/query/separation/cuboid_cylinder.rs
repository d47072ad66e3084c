//! Box against cylinder.
//!
//! As for two cylinders, directions that may be the answer's, each with its proof: the normals of the
//! faces of the box and of the caps, across an edge of the box and the axis, and from the axis to a
//! corner. Where the solids overlap, the proof is a ball about a point of one within the other, as
//! large as the overlap is deep. What is not proved, such as an edge of the box in the rim, is left to the
//! general algorithm.

use super::cylinder_cylinder::{Attempt, Found, Tried, Verdict, radial};
use super::hulls::{noise, out_of_reach};
use super::{revolved, wrong_kinds};
use crate::convex::{Separation, Units};
use crate::math::{Matrix, Real, Vector, cross, max, min, unit};
use crate::query::Pair;
use crate::shape::{Kind, SupportMap};

/// Cap on the corners tried: each is nearer to the axis than the one before.
const CORNERS: usize = 4;

/// The separation of a box from a cylinder.
///
/// Of equal directions the faces of the box come before the caps, and these before edges and corners.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let (Kind::Cuboid(cuboid), Kind::Cylinder(cylinder, _)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    if !pair.pose12.is_finite() {
        return None;
    }
    let units = Units::of(cuboid.reach(), cylinder.reach(), &pair.pose12.translation);
    let shrink = units.shrink;
    let center = pair.pose12.translation * shrink;
    let meeting = Meeting {
        extents: cuboid.half_extents() * shrink,
        half: cylinder.half_height() * shrink,
        radius: cylinder.radius() * shrink,
        center,
        axis: pair.pose12.rotation.column(1).into_owned(),
        from_cylinder: -pair.pose12.inverse_vector(&center),
        axes: pair.pose12.rotation.transpose(),
    };
    let tries: [(Attempt<'_, N>, bool); 4] = [
        (&|| Some(meeting.face()), false),
        (&|| Some(meeting.cap()), true),
        (&|| meeting.edge(), false),
        (&|| meeting.corner(), true),
    ];
    Verdict::of(&tries, out_of_reach(&units, limit)).answer(
        &units,
        (pair, limit),
        revolved::separation,
    )
}

/// A box and a cylinder, in units of the pair.
struct Meeting<N: Real> {
    extents: Vector<N, 3>,
    half: N,
    radius: N,
    /// The middle of the cylinder and the unit vector along its axis, in the frame of the box.
    center: Vector<N, 3>,
    axis: Vector<N, 3>,
    /// The middle of the box and, as columns, its axes, in the frame of the cylinder.
    from_cylinder: Vector<N, 3>,
    axes: Matrix<N, 3>,
}

impl<N: Real> Meeting<N> {
    /// The normal of the face of the box that the cylinder lies highest above.
    fn face(&self) -> Tried<N> {
        let (mut best, mut height) = (0, -N::INFINITY);
        for along in 0..3 {
            let lean = self.axis[along];
            let sine = max(N::ONE - lean * lean, N::ZERO).sqrt();
            let reach = lean.abs() * self.half + sine * self.radius;
            let found = self.center[along].abs() - self.extents[along] - reach;
            if found > height {
                (best, height) = (along, found);
            }
        }
        let mut normal = Vector::<N, 3>::zeros();
        normal[best] = if self.center[best] < N::ZERO { -N::ONE } else { N::ONE };
        let point = self.lowest(&normal, best);
        // By its lowest point, the height is right to the last bits.
        let height = normal.dot(&point) - self.extents[best];
        let depth = max(-height, N::ZERO);
        let room = |along: usize| {
            let point = if along == best { N::ZERO } else { point[along] };
            self.extents[along] - point.abs()
        };
        let is_above = (0..3).all(|along| room(along) >= depth - noise());
        let found = Found { distance: height, normal, on_other: point };
        Tried { height, found: is_above.then_some(found) }
    }

    /// Of the points of the cylinder that are lowest along the normal of a face, up to noise, one that is
    /// about nearest to the middle of the face, which is across the axis `along`.
    fn lowest(&self, normal: &Vector<N, 3>, along: usize) -> Vector<N, 3> {
        let lean = normal.dot(&self.axis);
        // The normal against the axis, without a difference.
        let mut beside = self.axis;
        beside[along] = N::ZERO;
        let across = beside * lean - normal * beside.norm_squared();
        let end = if lean < N::ZERO { self.axis } else { -self.axis } * self.half;
        let aside = |point: &Vector<N, 3>| point - normal * normal.dot(point);
        match unit(&across) {
            Some((down, sine)) if sine * self.radius > noise() => {
                let low = self.center + down * self.radius;
                if lean.abs() * self.half > noise() {
                    return low + end;
                }
                let at = -aside(&low).dot(&self.axis);
                low + self.axis * max(min(at, self.half), -self.half)
            }
            _ => {
                let middle = self.center + end;
                let inward = unit(&aside(&middle));
                inward.map_or(middle, |(away, length)| middle - away * min(length, self.radius))
            }
        }
    }

    /// The normal of the cap that faces the box.
    fn cap(&self) -> Tried<N> {
        let up = if self.from_cylinder.y < N::ZERO { -N::ONE } else { N::ONE };
        let normal = Vector::<N, 3>::new(N::ZERO, up, N::ZERO);
        let mut point = self.from_cylinder;
        let is_free = |along: usize| (self.axes[(1, along)] * self.extents[along]).abs() <= noise();
        for along in (0..3).filter(|&along| !is_free(along)) {
            let is_down = self.axes[(1, along)] * up < N::ZERO;
            let extent = self.extents[along];
            point += self.axes.column(along) * if is_down { extent } else { -extent };
        }
        // Of lowest edges and faces the point nearest to the axis.
        for along in (0..3).filter(|&along| is_free(along)) {
            let (axis, extent) = (self.axes.column(along), self.extents[along]);
            let at = -(axis.x * point.x + axis.z * point.z);
            point += axis * max(min(at, extent), -extent);
        }
        let height = normal.dot(&point) - self.half;
        let depth = max(-height, N::ZERO);
        let room = min(self.radius - radial(&point).norm(), self.half);
        let found = Found { distance: height, normal, on_other: point };
        Tried { height, found: (room >= depth - noise()).then_some(found) }
    }

    /// Across an edge of the box and the axis of the cylinder: of the three directions of edges the one that
    /// parts the solids most.
    fn edge(&self) -> Option<Tried<N>> {
        let mut best: Option<(N, usize, Vector<N, 3>)> = None;
        for along in 0..3 {
            let mut edge = Vector::<N, 3>::zeros();
            edge[along] = N::ONE;
            let across = cross(&edge, &self.axis);
            let resolved = across.norm_squared() > N::lit(16.0) * N::EPSILON;
            let Some((turned, _)) = unit(&across).filter(|_| resolved) else { continue };
            let away = turned.dot(&self.center);
            let normal = if away < N::ZERO { -turned } else { turned };
            let height = away.abs() - self.extents.dot(&normal.abs()) - self.radius;
            if best.as_ref().is_none_or(|best| height > best.0) {
                best = Some((height, along, normal));
            }
        }
        let (height, along, normal) = best?;
        let is_proved = self
            .at_edge(along, &normal)
            .filter(|(_, room)| *room >= max(-height, N::ZERO) - noise());
        let found = is_proved.map(|(on_other, _)| Found { distance: height, normal, on_other });
        Some(Tried { height, found })
    }

    /// The point of the cylinder's side across from an edge of the box, and how large a ball about the edge's
    /// point may be for its sake; `None` if the place is beyond the ends of the edge.
    fn at_edge(&self, along: usize, normal: &Vector<N, 3>) -> Option<(Vector<N, 3>, N)> {
        let mut from =
            self.extents.zip_map(normal, |extent, n| if n < N::ZERO { -extent } else { extent });
        from[along] = N::ZERO;
        let (away, lean) = (self.center - from, self.axis[along]);
        let squared = N::ONE - lean * lean;
        let toward = away.dot(&self.axis);
        let at_edge = (away[along] - lean * toward) / squared;
        let at_axis = (lean * away[along] - toward) / squared;
        let on_side = self.center + self.axis * at_axis - normal * self.radius;
        let is_beside = at_edge.abs() <= self.extents[along] + noise();
        is_beside.then_some((on_side, min(self.half - at_axis.abs(), self.radius)))
    }

    /// From the axis to the nearest corner of the box.
    fn corner(&self) -> Option<Tried<N>> {
        let mut normal = unit(&radial(&self.from_cylinder))?.0;
        let mut point = self.corner_against(&normal);
        for _ in 0..CORNERS {
            normal = unit(&radial(&point))?.0;
            let next = self.corner_against(&normal);
            if next == point {
                let height = radial(&point).norm() - self.radius;
                let room = self.half - point.y.abs();
                let normal = Vector::<N, 3>::new(normal.x, N::ZERO, normal.y);
                let found = Found { distance: height, normal, on_other: point };
                let is_proved = room >= max(-height, N::ZERO) - noise();
                return Some(Tried { height, found: is_proved.then_some(found) });
            }
            point = next;
        }
        None
    }

    /// The corner of the box that is lowest along a direction away from the axis.
    fn corner_against(&self, normal: &Vector<N, 2>) -> Vector<N, 3> {
        let mut point = self.from_cylinder;
        for along in 0..3 {
            let axis = self.axes.column(along);
            let is_down = axis.x * normal.x + axis.z * normal.y < N::ZERO;
            let extent = self.extents[along];
            point += axis * if is_down { extent } else { -extent };
        }
        point
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::query::separation::cylinder_cylinder::tests::compare;
    use crate::shape::{Cuboid, Cylinder, Shape};

    #[test]
    fn answers_are_those_of_the_general_algorithm() {
        fn solids<N: Real>(sizes: [Vector<N, 3>; 2]) -> [Box<dyn Shape<N, 3>>; 2] {
            let cylinder = Cylinder::new(sizes[1].x, sizes[1].y);
            [Box::new(Cuboid::new(sizes[0])), Box::new(cylinder)]
        }
        compare::<f64>((1, 3000, 1e-12), solids, separation);
        compare::<f32>((2, 3000, 3e-6), solids, separation);
    }
}
