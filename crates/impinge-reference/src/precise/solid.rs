//! Convex solids as hulls of points, disks and ellipsoids.

use super::number::Quad;
use super::vector::{Vector, add, dot, exact, negate, norm, rounded, scale, sub, unit, zero};
use crate::geometry::vector::{axis, norm as norm64};

/// A convex solid in its own frame: all points within a radius of the hull of some parts.
///
/// All input numbers are taken as exact.
#[derive(Clone, Debug)]
pub struct Solid<const D: usize> {
    pub(super) kind: Kind<D>,
    pub(super) radius: f64,
}

#[derive(Clone, Debug)]
pub(super) enum Kind<const D: usize> {
    /// All points behind a plane through the local origin; the normal need not be unit.
    HalfSpace([f64; D]),
    /// The hull of some points.
    Points(Vec<[f64; D]>),
    /// The hull of some parts, at least one of which is a disk or ellipsoid.
    Parts(Vec<Part<D>>),
}

/// The image of the unit ball under `x ↦ columns · x`, translated to `center`: without columns a
/// point, with two columns in 3D a disk, with D columns an ellipsoid.
#[derive(Clone, Debug)]
pub(super) struct Part<const D: usize> {
    pub(super) center: [f64; D],
    pub(super) columns: Vec<[f64; D]>,
}

impl<const D: usize> Solid<D> {
    /// A ball about the local origin.
    #[must_use]
    pub fn ball(radius: f64) -> Self {
        Self::round_polytope(vec![[0.0; D]], radius)
    }

    /// All points within `radius` of a segment.
    #[must_use]
    pub fn capsule(a: [f64; D], b: [f64; D], radius: f64) -> Self {
        Self::round_polytope(vec![a, b], radius)
    }

    /// All points within `radius` of the box with corners at plus and minus `half_extents`.
    #[must_use]
    pub fn round_cuboid(half_extents: [f64; D], radius: f64) -> Self {
        let corner = |index: usize| {
            std::array::from_fn(|i| half_extents[i] * if index >> i & 1 == 1 { 1.0 } else { -1.0 })
        };
        Self::round_polytope((0..1 << D).map(corner).collect(), radius)
    }

    /// The convex hull of some points.
    #[must_use]
    pub fn polytope(vertices: Vec<[f64; D]>) -> Self {
        Self::round_polytope(vertices, 0.0)
    }

    /// All points within `radius` of the convex hull of some points. Coincident points count once.
    ///
    /// # Panics
    /// If there are no points.
    #[must_use]
    pub fn round_polytope(vertices: Vec<[f64; D]>, radius: f64) -> Self {
        assert!(!vertices.is_empty(), "a solid has at least one vertex");
        let mut apart: Vec<[f64; D]> = Vec::new();
        for vertex in vertices {
            if !apart.contains(&vertex) {
                apart.push(vertex);
            }
        }
        Self { kind: Kind::Points(apart), radius }
    }

    /// All points behind the plane through the local origin with this normal, of any length.
    #[must_use]
    pub fn half_space(normal: [f64; D]) -> Self {
        Self { kind: Kind::HalfSpace(normal), radius: 0.0 }
    }

    /// The ellipsoid with these half axes along the axes of the local frame; flat if a half axis is
    /// zero.
    #[must_use]
    pub fn ellipsoid(half_axes: [f64; D]) -> Self {
        let axes = (0..D).filter(|&i| half_axes[i] > 0.0);
        let columns = axes.map(|i| along(i, half_axes[i])).collect();
        Self { kind: Kind::Parts(vec![Part { center: [0.0; D], columns }]), radius: 0.0 }
    }

    /// The hull of a ball about `a` and a ball about `b`.
    #[must_use]
    pub fn tapered_capsule(a: [f64; D], radius_a: f64, b: [f64; D], radius_b: f64) -> Self {
        let ball = |center, radius: f64| Part {
            center,
            columns: (0..D).filter(|_| radius > 0.0).map(|i| along(i, radius)).collect(),
        };
        let parts = vec![ball(a, radius_a), ball(b, radius_b)];
        Self { kind: Kind::Parts(parts), radius: 0.0 }
    }

    /// Returns all points within `radius` of the solid.
    #[must_use]
    pub fn inflated(mut self, radius: f64) -> Self {
        self.radius += radius;
        self
    }

    /// Returns the radius of a ball about the local origin that contains the solid; infinite for a
    /// half-space.
    #[must_use]
    pub fn bounding_radius(&self) -> f64 {
        let core = match &self.kind {
            Kind::HalfSpace(_) => f64::INFINITY,
            Kind::Points(points) => points.iter().map(norm64).fold(0.0, f64::max),
            Kind::Parts(parts) => parts.iter().map(Part::bounding_radius).fold(0.0, f64::max),
        };
        core + self.radius
    }

    /// Returns the parts of the core (the solid without its radius).
    ///
    /// # Panics
    /// For a half-space.
    pub(super) fn parts(&self) -> Vec<Part<D>> {
        let point = |center: &[f64; D]| Part { center: *center, columns: Vec::new() };
        match &self.kind {
            Kind::HalfSpace(_) => panic!("a half-space has no parts"),
            Kind::Points(points) => points.iter().map(point).collect(),
            Kind::Parts(parts) => parts.clone(),
        }
    }
}

impl Solid<3> {
    /// All points with `|y| <= half_height` that are within `radius` of the y axis.
    #[must_use]
    pub fn cylinder(half_height: f64, radius: f64) -> Self {
        let parts = [half_height, -half_height].map(|y| Part::disk(y, radius));
        Self { kind: Kind::Parts(parts.to_vec()), radius: 0.0 }
    }

    /// The hull of the apex at `y = half_height` and the disk at `y = -half_height`.
    #[must_use]
    pub fn cone(half_height: f64, radius: f64) -> Self {
        let apex = Part { center: [0.0, half_height, 0.0], columns: Vec::new() };
        let parts = vec![apex, Part::disk(-half_height, radius)];
        Self { kind: Kind::Parts(parts), radius: 0.0 }
    }
}

impl Part<3> {
    /// Returns the disk about the y axis at the height `y`.
    fn disk(y: f64, radius: f64) -> Self {
        Self { center: [0.0, y, 0.0], columns: vec![along(0, radius), along(2, radius)] }
    }
}

impl<const D: usize> Part<D> {
    fn bounding_radius(&self) -> f64 {
        norm64(&self.center) + self.columns.iter().map(norm64).fold(0.0, f64::max)
    }
}

fn along<const D: usize>(index: usize, length: f64) -> [f64; D] {
    axis(index).map(|x: f64| x * length)
}

/// A position of a solid: `world = rotation · local + translation`.
#[derive(Clone, Copy, Debug)]
pub struct Pose<const D: usize> {
    /// The rows of the rotation matrix.
    rotation: [Vector<D>; D],
    pub(super) translation: [f64; D],
}

impl<const D: usize> Pose<D> {
    /// Returns a pose without rotation.
    #[must_use]
    pub fn at(translation: [f64; D]) -> Self {
        Self { rotation: std::array::from_fn(|row| exact(&axis(row))), translation }
    }

    /// Rotates the vector `v` from the local to the world frame.
    pub(super) fn rotate(&self, v: &Vector<D>) -> Vector<D> {
        std::array::from_fn(|row| dot(&self.rotation[row], v))
    }
}

impl Pose<2> {
    /// Returns the pose with the rotation of the complex number `[cosine, sine]`, normalized with
    /// all digits.
    ///
    /// # Panics
    /// If the complex number is zero.
    #[must_use]
    pub fn from_complex(translation: [f64; 2], complex: [f64; 2]) -> Self {
        let [c, s] = unit(&exact(&complex)).expect("a rotation is not zero");
        Self { rotation: [[c, -s], [s, c]], translation }
    }
}

impl Pose<3> {
    /// Returns the pose with the rotation of the quaternion `[x, y, z, w]`, normalized with all
    /// digits.
    ///
    /// # Panics
    /// If the quaternion is zero.
    #[must_use]
    pub fn from_quaternion(translation: [f64; 3], quaternion: [f64; 4]) -> Self {
        let [x, y, z, w] = unit(&exact(&quaternion)).expect("a rotation is not zero");
        let (one, two) = (Quad::ONE, Quad::new(2.0));
        let rotation = [
            [one - two * (y * y + z * z), two * (x * y - z * w), two * (x * z + y * w)],
            [two * (x * y + z * w), one - two * (x * x + z * z), two * (y * z - x * w)],
            [two * (x * z - y * w), two * (y * z + x * w), one - two * (x * x + y * y)],
        ];
        Self { rotation, translation }
    }
}

/// A part of a placed solid, with world axes, relative to the origin of the first solid of its
/// pair. The numbers are kept with all digits and in `f64`.
#[derive(Clone, Debug)]
pub(super) struct Placed<const D: usize> {
    pub(super) center: Vector<D>,
    pub(super) columns: Vec<Vector<D>>,
    center64: [f64; D],
    columns64: Vec<[f64; D]>,
}

impl<const D: usize> Placed<D> {
    /// Transforms a part of a solid at `pose` to world axes, relative to the point `origin`.
    pub(super) fn new(part: &Part<D>, pose: &Pose<D>, origin: &[f64; D]) -> Self {
        let offset = sub(&exact(&pose.translation), &exact(origin));
        let center = add(&pose.rotate(&exact(&part.center)), &offset);
        let columns: Vec<Vector<D>> =
            part.columns.iter().map(|column| pose.rotate(&exact(column))).collect();
        let columns64 = columns.iter().map(rounded).collect();
        Self { center64: rounded(&center), center, columns, columns64 }
    }

    /// Returns the part translated by a vector.
    pub(super) fn moved(&self, by: &Vector<D>) -> Self {
        let center = add(&self.center, by);
        Self { center64: rounded(&center), center, ..self.clone() }
    }

    /// Returns `columnsᵀ · normal`.
    pub(super) fn components(&self, normal: &Vector<D>) -> Vec<Quad> {
        self.columns.iter().map(|column| dot(column, normal)).collect()
    }

    /// Returns the extent of the part along `normal`: the maximum of `normal · x` over its points.
    pub(super) fn extent(&self, normal: &Vector<D>) -> Quad {
        let squared = self.components(normal).iter().fold(Quad::ZERO, |sum, x| sum + *x * *x);
        dot(&self.center, normal) + squared.sqrt()
    }

    /// Returns the support point along `normal`; the centre if all points have the same height.
    pub(super) fn support(&self, normal: &Vector<D>) -> Vector<D> {
        let components = self.components(normal);
        let length = components.iter().fold(Quad::ZERO, |sum, x| sum + *x * *x).sqrt();
        let mut point = self.center;
        if length > Quad::ZERO {
            for (column, component) in self.columns.iter().zip(components) {
                point = add(&point, &scale(column, component / length));
            }
        }
        point
    }

    /// Returns the support point along `normal` in `f64`.
    pub(super) fn support64(&self, normal: &[f64; D]) -> [f64; D] {
        use crate::geometry::vector::{add, dot, scale};
        let mut components = [0.0; D];
        for (component, column) in components.iter_mut().zip(&self.columns64) {
            *component = dot(column, normal);
        }
        let length = norm64(&components);
        let mut point = self.center64;
        if length > 0.0 {
            for (column, component) in self.columns64.iter().zip(components) {
                point = add(&point, &scale(column, component / length));
            }
        }
        point
    }

    /// Returns the point of a disk that is nearest to `point`, measured in the plane of the disk;
    /// the centre if the part is a single point. Ellipsoids are not supported.
    pub(super) fn nearest_in_disk(&self, point: &Vector<D>) -> Vector<D> {
        let offset = sub(point, &self.center);
        let mut shares: Vec<Quad> =
            self.columns.iter().map(|c| dot(c, &offset) / dot(c, c)).collect();
        let length = shares.iter().fold(Quad::ZERO, |sum, x| sum + *x * *x).sqrt();
        if length > Quad::ONE {
            shares.iter_mut().for_each(|share| *share = *share / length);
        }
        let moved = |at, (column, share): (&Vector<D>, &Quad)| add(&at, &scale(column, *share));
        self.columns.iter().zip(&shares).fold(self.center, moved)
    }

    /// Returns the two unit normals of a disk; `None` for other parts.
    pub(super) fn axes(&self) -> Option<[Vector<D>; 2]> {
        if D != 3 || self.columns.len() != 2 {
            return None;
        }
        let axis = unit(&super::vector::perpendicular(&self.columns))?;
        Some([axis, negate(&axis)])
    }

    /// Whether the part is a single point.
    pub(super) fn is_point(&self) -> bool {
        self.columns.iter().all(|column| norm(column) == Quad::ZERO)
    }
}

/// Returns the placed parts of the core of a solid (without its radius).
pub(super) fn placed<const D: usize>(
    solid: &Solid<D>,
    pose: &Pose<D>,
    origin: &[f64; D],
) -> Vec<Placed<D>> {
    solid.parts().iter().map(|part| Placed::new(part, pose, origin)).collect()
}

/// Returns the extent along `normal` of the hull of some parts.
pub(super) fn extent<const D: usize>(parts: &[Placed<D>], normal: &Vector<D>) -> Quad {
    let mut extents = parts.iter().map(|part| part.extent(normal));
    let first = extents.next().expect("a solid has a part");
    extents.fold(first, Quad::max)
}

/// Returns the support point along `normal` of the hull of some parts, in `f64`.
pub(super) fn support64<const D: usize>(parts: &[Placed<D>], normal: &[f64; D]) -> [f64; D] {
    use crate::geometry::vector::dot;
    let (mut best, mut height) = ([0.0; D], f64::NEG_INFINITY);
    for part in parts {
        let point = part.support64(normal);
        let along = dot(&point, normal);
        if along > height {
            (best, height) = (point, along);
        }
    }
    best
}

/// Returns the separation of the hulls of some parts along a unit normal: `min n·b − max n·a`.
pub(super) fn height<const D: usize>(
    parts1: &[Placed<D>],
    parts2: &[Placed<D>],
    normal: &Vector<D>,
) -> Quad {
    -extent(parts2, &negate(normal)) - extent(parts1, normal)
}

/// Returns the sum of the points, multiplied by their weights.
pub(super) fn mixed<const D: usize>(points: &[Vector<D>], weights: &[Quad]) -> Vector<D> {
    points
        .iter()
        .zip(weights)
        .fold(zero(), |sum, (point, weight)| add(&sum, &scale(point, *weight)))
}
