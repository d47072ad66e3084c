//! Surfaces of 3D shapes.

use super::TriangleSurface;
use super::circle::{direction, parts_of_turn};
use super::revolution::{RevolutionFrame, Stop, revolve};
use crate::math::{Point, Real, Vector, min, unit_or};
use crate::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolyhedron, Cuboid, Cylinder, Ellipsoid, Feature,
    FeatureId, TaperedCapsule, Tetrahedron, Triangle,
};

/// Returns a surface with vertices on the ball, where meridians and parallels cross. There are
/// `n = subdivisions` meridians from pole to pole, each in `2 k` equal parts, `k = ⌈n / 4⌉`.
///
/// There are `2 + n (2 k − 1)` vertices and `2 n (2 k − 1)` triangles; the first vertex is the pole
/// on the positive side of y, the last vertex the opposite pole. The gap is at most
/// `radius · sin²(π / n)`.
///
/// ```
/// use impinge::procedural::space::ball;
/// use impinge::shape::Ball;
///
/// let octahedron = ball(&Ball::new(3.0_f64), 4);
/// assert_eq!((octahedron.vertices.len(), octahedron.triangles.len()), (6, 8));
/// assert!(octahedron.vertices.iter().all(|vertex| vertex.coords.norm() == 3.0));
/// ```
#[must_use]
pub fn ball<N: Real>(ball: &Ball<N>, subdivisions: u32) -> TriangleSurface<N> {
    // Two meridians and two parallels bound a flat trapezoid, which is farther from the centre the
    // higher its latitude. A trapezoid centred on the equator would have the distance cos(π / n) ·
    // cos(π / 4k) times the radius, which is at least cos²(π / n) times the radius. None is centred
    // there, since the equator is a parallel; so all are farther away.
    let count = parts_of_turn(subdivisions);
    let quarter = count.div_ceil(4);
    let sphere =
        Sphere { radius: ball.radius(), frame: RevolutionFrame::around(up()), axis: up(), quarter };
    let profile: Vec<_> =
        (0..=2 * quarter).map(|index| sphere.stop(&Point::origin(), index)).collect();
    revolve(&sphere.frame, count, &profile)
}

/// Returns a half ball at each end, each like half of [`ball`], and `n = subdivisions` rectangles
/// between them, also if the length is zero.
///
/// There are `2 + 2 n k` vertices and `4 n k` triangles, with `k = ⌈n / 4⌉`; the first vertex is
/// the pole beyond the second end of the segment, the last vertex the pole beyond the first end.
/// The gap is at most `radius · sin²(π / n)`.
#[must_use]
pub fn capsule<N: Real>(capsule: &Capsule<N, 3>, subdivisions: u32) -> TriangleSurface<N> {
    let count = parts_of_turn(subdivisions);
    let quarter = count.div_ceil(4);
    let (a, b) = (capsule.segment().a(), capsule.segment().b());
    let axis = unit_or(&(b - a), up());
    let sphere =
        Sphere { radius: capsule.radius(), frame: RevolutionFrame::around(axis), axis, quarter };
    let far = (0..=quarter).map(|index| sphere.stop(b, index));
    let near = (quarter..=2 * quarter).map(|index| sphere.stop(a, index));
    let profile: Vec<_> = far.chain(near).collect();
    revolve(&sphere.frame, count, &profile)
}

/// Returns the surface of [`ball`] scaled along the axes, with as many vertices and triangles.
///
/// The gap is at most `sin²(π / n)` times the longest half axis, with `n = subdivisions`.
#[must_use]
pub fn ellipsoid<N: Real>(ellipsoid: &Ellipsoid<N, 3>, subdivisions: u32) -> TriangleSurface<N> {
    let half_axes = ellipsoid.half_axes();
    let mut surface = ball(&Ball::new(N::ONE), subdivisions);
    for vertex in &mut surface.vertices {
        vertex.coords.component_mul_assign(half_axes);
    }
    let is_flat = half_axes.iter().any(|&half| half == N::ZERO);
    let least = half_axes.iter().fold(N::INFINITY, |least, &half| min(half, least));
    for normal in surface.normals.iter_mut().flatten() {
        // If a half axis is zero, the normal keeps only its components along the axes with half
        // axis zero; else its components are divided by the half axes.
        let steep = normal.zip_map(half_axes, |x, half| match (is_flat, half == N::ZERO) {
            (true, false) => N::ZERO,
            (true, true) => x,
            (false, _) => x * (least / half),
        });
        *normal = unit_or(&steep, *normal);
    }
    surface
}

/// Returns a part of a ball at each end, with those parallels of [`ball`] that lie on the surface,
/// and `n = subdivisions` quadrilaterals between the two circles where the side begins.
///
/// There are at most `2 + n (2 k + 1)` vertices, with `k = ⌈n / 4⌉`; the first vertex is the pole
/// beyond the second end of the segment, the last vertex the pole beyond the first end. The gap is
/// at most `sin²(π / n)` times the larger radius. If one ball contains the other, the result is the
/// surface of the larger ball.
#[must_use]
pub fn tapered_capsule<N: Real>(
    capsule: &TaperedCapsule<N, 3>,
    subdivisions: u32,
) -> TriangleSurface<N> {
    let count = parts_of_turn(subdivisions);
    let quarter = count.div_ceil(4);
    let axis = capsule.taper().map_or_else(up, |taper| taper.along);
    let frame = RevolutionFrame::around(axis);
    let sphere = |end: usize| Sphere { radius: capsule.radii()[end], frame, axis, quarter };
    let parallels = |end: usize| {
        let sphere = sphere(end);
        (0..=2 * quarter).map(move |index| sphere.stop(capsule.end(end), index))
    };
    let Some(taper) = capsule.taper() else {
        let profile: Vec<_> = parallels(capsule.larger_end()).collect();
        return revolve(&frame, count, &profile);
    };
    let normal = Vector::<N, 2>::new(taper.cosine, taper.sine);
    let circle = |end: usize| {
        let radius = capsule.radii()[end];
        let center = capsule.end(end) + axis * (taper.sine * radius);
        Stop::smooth(center, taper.cosine * radius, normal)
    };
    let mut profile: Vec<_> = parallels(1).filter(|stop| stop.after.y > taper.sine).collect();
    profile.extend([circle(1), circle(0)]);
    profile.extend(parallels(0).filter(|stop| stop.after.y < taper.sine));
    revolve(&frame, count, &profile)
}

/// Returns the four faces of a tetrahedron: triangle `i` is `Face(i)`, vertex `i` is `Vertex(i)`.
#[must_use]
pub fn tetrahedron<N: Real>(tetrahedron: &Tetrahedron<N>) -> TriangleSurface<N> {
    let mut surface = TriangleSurface::of_vertices(tetrahedron.corners().to_vec());
    for index in 0..4 {
        let (id, mut face) = (FeatureId::Face(index), Feature::default());
        tetrahedron.face(id, &mut face);
        let number = |id: &FeatureId| match id {
            FeatureId::Vertex(number) => *number,
            _ => unreachable!("the vertices of a face are vertices"),
        };
        let ring: Vec<u32> = face.vertex_ids.iter().map(number).collect();
        surface.push_face(&ring, tetrahedron.feature_normal(id));
    }
    surface
}

/// Returns the side as `n = subdivisions` rectangles of two triangles each, and each cap as `n`
/// triangles that meet at its centre.
///
/// There are `2 + 2 n` vertices and `4 n` triangles; the first vertex is the centre of the cap on
/// the positive side of y, the last vertex the centre of the opposite cap. The gap is at most
/// `radius · (1 − cos(π / n))`.
#[must_use]
pub fn cylinder<N: Real>(cylinder: &Cylinder<N>, subdivisions: u32) -> TriangleSurface<N> {
    let (radius, top, bottom) =
        (cylinder.radius(), cylinder.half_height(), -cylinder.half_height());
    let [above, beside, below] = [(N::ZERO, N::ONE), (N::ONE, N::ZERO), (N::ZERO, -N::ONE)]
        .map(|(away, along)| Vector::<N, 2>::new(away, along));
    let profile = [
        Stop::smooth(on_axis(top), N::ZERO, above),
        Stop { center: on_axis(top), radius, before: above, after: beside },
        Stop { center: on_axis(bottom), radius, before: beside, after: below },
        Stop::smooth(on_axis(bottom), N::ZERO, below),
    ];
    revolve(&RevolutionFrame::around(up()), parts_of_turn(subdivisions), &profile)
}

/// Returns the side as `n = subdivisions` triangles that meet at the apex, and the base as `n`
/// triangles that meet at its centre.
///
/// There are `2 + n` vertices and `2 n` triangles; the first vertex is the apex, the last vertex
/// the centre of the base. The gap is at most `radius · (1 − cos(π / n))`.
#[must_use]
pub fn cone<N: Real>(cone: &Cone<N>, subdivisions: u32) -> TriangleSurface<N> {
    let (radius, half_height) = (cone.radius(), cone.half_height());
    let below = Vector::<N, 2>::new(N::ZERO, -N::ONE);
    // Halves the radius instead of doubling the half height, which could overflow.
    let slope = Vector::<N, 2>::new(half_height, radius * N::HALF);
    let slope = unit_or(&slope, Vector::<N, 2>::new(N::ONE, N::ZERO));
    let base = on_axis(-half_height);
    let profile = [
        Stop::smooth(on_axis(half_height), N::ZERO, slope),
        Stop { center: base, radius, before: slope, after: below },
        Stop::smooth(base, N::ZERO, below),
    ];
    revolve(&RevolutionFrame::around(up()), parts_of_turn(subdivisions), &profile)
}

/// Returns twelve triangles between the 8 vertices of a box.
///
/// Vertex `i` is the box's `Vertex(i)`; the triangles `2 i` and `2 i + 1` are its `Face(i)`.
///
/// ```
/// use impinge::math::Vector;
/// use impinge::procedural::space::cuboid;
/// use impinge::shape::Cuboid;
///
/// let surface = cuboid(&Cuboid::new(Vector::<f32, 3>::new(1.0, 2.0, 3.0)));
/// assert_eq!((surface.vertices.len(), surface.triangles.len()), (8, 12));
/// assert!(surface.corners().take(2).flatten().all(|corner| corner.x == 1.0));
/// ```
#[must_use]
pub fn cuboid<N: Real>(cuboid: &Cuboid<N, 3>) -> TriangleSurface<N> {
    let corner = |index| cuboid.vertex(FeatureId::Vertex(index));
    let mut surface = TriangleSurface::of_vertices((0..8).map(corner).collect());
    for face in 0..6_u32 {
        let [axis, next, after] = [0, 1, 2].map(|turn| 1 << ((face / 2 + turn) % 3));
        // Counter-clockwise seen from the positive side of the axis.
        let mut ring = [0, next, next | after, after];
        if face % 2 == 0 {
            ring = ring.map(|corner| corner | axis);
        } else {
            ring.reverse();
        }
        surface.push_face(&ring, cuboid.feature_normal(FeatureId::Face(face)));
    }
    surface
}

/// Returns the faces of a convex hull in their order, each divided into triangles that meet at the
/// face's first vertex.
///
/// Vertex `i` is the hull's `Vertex(i)`. A hull of `v` vertices gives `2 v − 4` triangles.
#[must_use]
pub fn convex_hull<N: Real>(hull: &ConvexHull<N>) -> TriangleSurface<N> {
    let mut surface = TriangleSurface::of_vertices(hull.vertices().to_vec());
    for face in hull.faces() {
        surface.push_face(hull.face_vertices(face), face.normal);
    }
    surface
}

/// Returns the two sides of a triangle, `Face(0)` first: a closed surface without volume.
#[must_use]
pub fn triangle<N: Real>(triangle: &Triangle<N, 3>) -> TriangleSurface<N> {
    let mut surface = TriangleSurface::of_vertices(triangle.corners().to_vec());
    surface.push_face(&[0, 1, 2], triangle.feature_normal(FeatureId::Face(0)));
    surface.push_face(&[0, 2, 1], triangle.feature_normal(FeatureId::Face(1)));
    surface
}

/// The parallels of a sphere about an axis, with `quarter` parts to a quarter turn.
#[derive(Clone, Copy)]
struct Sphere<N: Real> {
    radius: N,
    frame: RevolutionFrame<N>,
    axis: Vector<N, 3>,
    quarter: u32,
}

impl<N: Real> Sphere<N> {
    /// Returns the parallel at `index` parts from the pole towards which the axis points.
    fn stop(&self, center: &Point<N, 3>, index: u32) -> Stop<N> {
        let toward = direction::<N>(index, 4 * self.quarter);
        let center = center + self.axis * (toward.x * self.radius);
        Stop::smooth(center, toward.y * self.radius, Vector::<N, 2>::new(toward.y, toward.x))
    }
}

/// Returns the unit vector of the y axis.
fn up<N: Real>() -> Vector<N, 3> {
    Vector::<N, 3>::new(N::ZERO, N::ONE, N::ZERO)
}

/// Returns the point of the y axis at height `y`.
fn on_axis<N: Real>(y: N) -> Point<N, 3> {
    Point::<N, 3>::new(N::ZERO, y, N::ZERO)
}
