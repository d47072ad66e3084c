//! Shapes of every kind from bytes.

use impinge::bounding_volume::Aabb;
use impinge::math::{Point, Real, Space, Unit, Vector};
use impinge::shape::{
    Ball, Capsule, CompositeShape, Compound, Cuboid, Ellipsoid, Geometry, Plane, Polyline, Rounded,
    Segment, Shape, ShapeHandle, SupportMap, TaperedCapsule, TriMesh, Triangle,
};

use crate::Bytes;
use crate::place::Dimension;

/// The number of kinds that exist in both dimensions.
const COMMON_KINDS: usize = 13;

/// The largest depth of nested compounds.
const MAX_NESTED: usize = 3;

/// Returns a shape of the kind that the next byte selects; a ball if a constructor rejects the
/// numbers.
pub(crate) fn shape<N: Space<D>, M: Dimension<N, D>, const D: usize>(
    bytes: &mut Bytes<'_>,
) -> ShapeHandle<N, D> {
    nested::<N, M, D>(bytes, 0).unwrap_or_else(|| ShapeHandle::new(Ball::new(N::ONE)))
}

/// Returns the shape, if the constructor accepted the numbers.
pub(crate) fn made<N: Real, S: Shape<N, D>, E: std::error::Error, const D: usize>(
    shape: Result<S, E>,
) -> Option<ShapeHandle<N, D>> {
    match shape {
        Ok(shape) => Some(ShapeHandle::new(shape)),
        Err(error) => {
            assert!(!error.to_string().is_empty(), "an error says what is wrong");
            None
        }
    }
}

fn nested<N: Space<D>, M: Dimension<N, D>, const D: usize>(
    bytes: &mut Bytes<'_>,
    depth: usize,
) -> Option<ShapeHandle<N, D>> {
    let kind = bytes.choice(COMMON_KINDS + M::OWN_KINDS);
    if let Some(own) = kind.checked_sub(COMMON_KINDS) {
        return M::own_shape(own, bytes);
    }
    match kind {
        0 => made(Ball::try_new(bytes.size())),
        1 => made(Cuboid::<N, D>::try_new(bytes.sizes())),
        2 => made(Segment::<N, D>::try_new(bytes.point(), bytes.point())),
        3 => made(Capsule::<N, D>::try_from_ends(bytes.point(), bytes.point(), bytes.size())),
        4 => made(Triangle::<N, D>::try_new(bytes.point(), bytes.point(), bytes.point())),
        5 => Some(ShapeHandle::new(Plane::new(normal::<N, D>(bytes)))),
        6 => made(Ellipsoid::<N, D>::try_new(bytes.sizes())),
        7 => {
            let (a, b, radii) = (bytes.point(), bytes.point(), [bytes.size(), bytes.size()]);
            made(TaperedCapsule::<N, D>::try_from_ends(a, b, radii))
        }
        8 => {
            let inner = if depth < MAX_NESTED { nested::<N, M, D>(bytes, depth + 1) } else { None };
            made(Rounded::try_from_handle(inner?, bytes.size()))
        }
        9 => {
            let vertices = bytes.points::<N, D>();
            let triangles = bytes.indices(vertices.len());
            made(TriMesh::try_new(vertices, triangles))
        }
        10 => polyline::<N, D>(bytes),
        11 => Cloud::from_bytes(bytes).map(ShapeHandle::new),
        _ => compound::<N, M, D>(bytes, depth),
    }
}

fn polyline<N: Space<D>, const D: usize>(bytes: &mut Bytes<'_>) -> Option<ShapeHandle<N, D>> {
    let vertices = bytes.points::<N, D>();
    match bytes.choice(3) {
        0 => made(Polyline::try_open(vertices)),
        1 => made(Polyline::try_closed(vertices)),
        _ => {
            let segments = bytes.indices(vertices.len());
            made(Polyline::try_new(vertices, segments))
        }
    }
}

/// Returns a compound of up to seven children, which may be compounds.
fn compound<N: Space<D>, M: Dimension<N, D>, const D: usize>(
    bytes: &mut Bytes<'_>,
    depth: usize,
) -> Option<ShapeHandle<N, D>> {
    if depth == MAX_NESTED {
        return None;
    }
    let count = bytes.choice(8);
    let mut children = Vec::new();
    for _ in 0..count {
        let position = M::stored(M::position(bytes));
        if let Some(child) = nested::<N, M, D>(bytes, depth + 1) {
            children.push((position, child));
        }
    }
    made(Compound::try_new(children))
}

/// Returns a unit vector, which is along an axis at least half of the time.
fn normal<N: Real, const D: usize>(bytes: &mut Bytes<'_>) -> Unit<Vector<N, D>> {
    let mut axis = Vector::<N, D>::zeros();
    axis[bytes.choice(D)] = if bytes.coin() { N::ONE } else { -N::ONE };
    if bytes.coin() {
        return Unit::new_normalize(axis);
    }
    let any = Vector::<N, D>::from_fn(|_, _| bytes.finite::<N>());
    let is_usable = any.norm_squared() > N::lit(1e-6) && any.norm_squared() < N::lit(1e6);
    Unit::new_normalize(if is_usable { any } else { axis })
}

/// A user-defined support map: the hull of points, inflated.
#[derive(Clone, Debug)]
pub(crate) struct Cloud<N: Real, const D: usize> {
    points: Vec<Point<N, D>>,
    rounding: N,
}

impl<N: Real, const D: usize> Cloud<N, D> {
    fn from_bytes(bytes: &mut Bytes<'_>) -> Option<Self> {
        let (points, rounding) = (bytes.points(), bytes.size());
        (!points.is_empty()).then_some(Self { points, rounding })
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Cloud<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let along = |point: &Point<N, D>| point.coords.dot(direction);
        let farther = |best: Point<N, D>, point: &Point<N, D>| {
            if along(point) > along(&best) { *point } else { best }
        };
        self.points.iter().fold(self.points[0], farther)
    }

    fn rounding(&self) -> N {
        self.rounding
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Cloud<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::support_map(self)
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        let core = Aabb::from_points(&self.points).unwrap_or_else(Aabb::unbounded);
        let around = Vector::<N, D>::repeat(self.rounding);
        Aabb::try_new(core.mins() - around, core.maxs() + around).unwrap_or(Aabb::unbounded())
    }
}

/// Returns the geometry of a shape as text; for a composite, the geometry of each part.
pub(crate) fn anatomy<N: Real, const D: usize>(shape: &dyn Shape<N, D>) -> String {
    let Some(parts) = shape.geometry().as_composite() else { return format!("{shape:?}") };
    (0..parts.num_parts()).map(|part| format!("{:?}\n", parts.part(part))).collect()
}

/// Returns whether the shape or a part of it is unbounded.
pub(crate) fn is_unbounded<N: Real, const D: usize>(shape: &dyn Shape<N, D>) -> bool {
    let aabb = shape.local_aabb();
    !(0..D).all(|axis| aabb.mins()[axis].is_finite_number() && aabb.maxs()[axis].is_finite_number())
}

/// Returns the number of parts of the shape; `None` if it is convex.
pub(crate) fn parts_of<N: Real, const D: usize>(shape: &dyn Shape<N, D>) -> Option<u32> {
    shape.geometry().as_composite().map(CompositeShape::num_parts)
}

/// Returns an upper bound of the distance from the origin of the shape to its farthest point, to
/// which rounding errors are proportional. The positions of parts are included; unbounded parts are
/// ignored.
pub(crate) fn reach<N: Real, const D: usize>(shape: &dyn Shape<N, D>) -> N {
    if let Some(parts) = shape.geometry().as_composite() {
        let one = |part| {
            let part = parts.part(part);
            part.pose.translation.abs().sum() + reach(part.solid.as_shape())
        };
        return (0..parts.num_parts()).map(one).fold(N::ZERO, impinge::math::max);
    }
    let aabb = shape.local_aabb();
    let corners = aabb.mins().iter().chain(aabb.maxs().iter());
    corners.filter(|x| x.is_finite_number()).fold(N::ZERO, |sum, x| sum + x.abs())
}
