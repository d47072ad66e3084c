//! Boxes (rectangles in 2D).

use crate::bounding_volume::Aabb;
use crate::math::{Mapped, Point, Pose, Real, Vector};
use crate::shape::error::{finite, or_panic, size};
use crate::shape::scale::Scale;
use crate::shape::solids::segment::length_of;
use crate::shape::{
    ConvexPolyhedron, Feature, FeatureId, Geometry, Kind, ScaleError, Shape, ShapeError,
    ShapeHandle, SideOrVertex, SupportMap, tilt::Tilt,
};

/// The points whose coordinate on each axis is at most the half extent in magnitude.
///
/// Half extents may be zero: the box is then a rectangle, a segment or a point.
///
/// Vertices: bit `i` of the index is set if coordinate `i` is positive. Faces: `2 · axis` on the
/// positive side of an axis, `2 · axis + 1` on the negative side. Edges (in 3D): `4 · axis` for the
/// axis along which the edge runs, plus two bits for the signs on the next two axes (x → y → z →
/// x): 1 if the next coordinate is positive, 2 if the coordinate after it is.
///
/// The vertices of a face are counter-clockwise seen from outside; in 2D a face has the box on its
/// left. So in 2D the counter-clockwise outline has faces 0, 2, 1, 3 and vertices 1, 3, 2, 0. A
/// face without width is returned as a segment or a point.
///
/// ```
/// use impinge::dim2::{math::Vector, shape::Cuboid, shape::Shape};
/// let brick = Cuboid::new(Vector::new(2.0_f32, 1.0));
/// assert_eq!(brick.local_aabb().maxs().x, 2.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid<N: Real, const D: usize> {
    half_extents: Vector<N, D>,
}

impl<N: Real, const D: usize> Cuboid<N, D> {
    /// Returns the box with the given half extents, each zero or more.
    ///
    /// # Panics
    /// If a half extent is negative or not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(half_extents: Vector<N, D>) -> Self {
        or_panic(Self::try_new(half_extents))
    }

    /// Returns the box with the given half extents, each zero or more.
    ///
    /// # Errors
    /// If a half extent is negative or not finite.
    pub fn try_new(half_extents: Vector<N, D>) -> Result<Self, ShapeError> {
        finite("a half extent", &half_extents)?;
        for &half_extent in half_extents.iter() {
            size("a half extent", half_extent)?;
        }
        Ok(Self { half_extents })
    }

    /// Returns the box with valid half extents; they are not checked.
    pub(in crate::shape) const fn reaching(half_extents: Vector<N, D>) -> Self {
        Self { half_extents }
    }

    /// Returns the half extents along each axis.
    #[inline]
    #[must_use]
    pub const fn half_extents(&self) -> &Vector<N, D> {
        &self.half_extents
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Cuboid<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let toward = |h: N, d: N| if d < N::ZERO { -h } else { h };
        Point::from(self.half_extents.zip_map(direction, toward))
    }

    fn reach(&self) -> N {
        length_of(&self.half_extents)
    }

    fn core_feature(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        self.fill(CuboidPart::toward(direction, Tilt::default_limit()), out);
    }
}

impl<N: Real, const D: usize> Cuboid<N, D> {
    /// Returns the id of the vertex, edge or face on which a surface point lies, up to `tolerance`.
    /// `None` for a point inside, and for a box with a half extent of at most `4 tolerance`.
    pub(crate) fn part_at(&self, point: &Point<N, D>, tolerance: N) -> Option<FeatureId> {
        let mut free = 0;
        for axis in 0..D {
            let half = self.half_extents[axis];
            if half <= N::lit(4.0) * tolerance {
                return None;
            }
            free |= u32::from(point[axis].abs() < half - tolerance) << axis;
        }
        let part = CuboidPart::<D> { free, corner: signs(&point.coords) };
        (free != CuboidPart::<D>::ALL).then(|| part.id())
    }

    /// Returns the id of a part: `free` is the lower `D` bits of `bits`, `corner` the next `D`.
    #[inline]
    pub(crate) const fn id_of_bits(bits: u8) -> FeatureId {
        CuboidPart::<D>::IDS[bits as usize & ((1 << (2 * D)) - 1)]
    }
}

/// A vertex, edge or face: the points of the box that agree with a corner on all but the `free`
/// axes. Both fields are sets of axes; `corner` has the positive axes of that corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::shape) struct CuboidPart<const D: usize> {
    free: u32,
    corner: u32,
}

/// The supporting feature of a box, without its corners: a vertex, an edge or a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SupportPart<N: Real, const D: usize> {
    part: CuboidPart<D>,
    /// The outward normal; `None` if the feature is not a face.
    pub(crate) normal: Option<Vector<N, D>>,
}

impl<N: Real, const D: usize> SupportPart<N, D> {
    /// Returns the direction of edge `index` of a box in 3D.
    pub(crate) fn edge_direction(index: u32) -> Vector<N, D> {
        axis_vector((index / 4) as usize % D)
    }

    /// Returns the direction of the feature's side that is most nearly perpendicular to `vector`,
    /// the first if there are several; `None` for a vertex.
    pub(crate) fn flattest_side(&self, vector: &Vector<N, D>) -> Option<Vector<N, D>> {
        let first = if self.normal.is_some() { self.part.own_axis() + 1 } else { 0 };
        let axes =
            (first..first + D).map(|axis| axis % D).filter(|&axis| has(self.part.free, axis));
        let tilt = |axis: usize| vector[axis].abs();
        let axis = axes.reduce(|best, axis| if tilt(axis) < tilt(best) { axis } else { best })?;
        Some(axis_vector(axis))
    }
}

/// Returns the unit vector along an axis.
fn axis_vector<N: Real, const D: usize>(axis: usize) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|row, _| if row == axis { N::ONE } else { N::ZERO })
}

const fn has(set: u32, axis: usize) -> bool {
    set >> axis & 1 == 1
}

impl<const D: usize> CuboidPart<D> {
    const ALL: u32 = (1 << D) - 1;

    /// The ids of all features, indexed by [`Self::free`] plus [`Self::corner`] shifted by `D`
    /// bits; for at most three dimensions.
    const IDS: [FeatureId; 64] = {
        let mut ids = [FeatureId::Vertex(0); 64];
        let mut bits = 0;
        while bits < 1 << (2 * D) {
            let free = bits & Self::ALL;
            if free != Self::ALL {
                ids[bits as usize] = Self { free, corner: bits >> D }.id();
            }
            bits += 1;
        }
        ids
    };

    /// Returns the supporting feature for a unit vector. Adds axes to `free`, smallest components
    /// first, while `tilt` admits the sum of their squares (see [`SupportMap::core_feature`]).
    pub(in crate::shape) fn toward<N: Real>(direction: &Vector<N, D>, tilt: Tilt<N>) -> Self {
        let (mut free, mut sine_squared) = (0, N::ZERO);
        for _ in 1..D {
            let Some(axis) = weakest(direction, free) else { break };
            sine_squared += direction[axis] * direction[axis];
            if !tilt.admits(sine_squared) {
                break;
            }
            free |= 1 << axis;
        }
        Self { free, corner: signs(direction) }
    }

    /// Returns the face whose normal is most aligned with a direction.
    fn face_toward<N: Real>(direction: &Vector<N, D>) -> Self {
        let mut strongest = 0;
        for axis in 1..D {
            if direction[axis].abs() > direction[strongest].abs() {
                strongest = axis;
            }
        }
        Self { free: Self::ALL & !(1 << strongest), corner: signs(direction) }
    }

    /// Returns the first fixed axis: for a face the axis of its normal.
    const fn own_axis(self) -> usize {
        (!self.free & Self::ALL).trailing_zeros() as usize
    }

    /// Returns the number of free axes.
    const fn dimension(self) -> usize {
        let (mut axis, mut count) = (0, 0);
        while axis < D {
            count += has(self.free, axis) as usize;
            axis += 1;
        }
        count
    }

    /// Returns the id of the feature by the numbering documented at [`Cuboid`].
    pub(in crate::shape) const fn id(self) -> FeatureId {
        let dimension = self.dimension();
        let index = if dimension == 0 {
            self.corner
        } else if dimension + 1 == D {
            let axis = (!self.free).trailing_zeros();
            2 * axis + !has(self.corner, axis as usize) as u32
        } else {
            let axis = self.free.trailing_zeros();
            let (next, last) = ((axis as usize + 1) % D, (axis as usize + 2) % D);
            4 * axis + has(self.corner, next) as u32 + 2 * has(self.corner, last) as u32
        };
        FeatureId::flat::<D>(dimension, index)
    }

    /// Returns the feature with the given id; `None` if the box has no such feature.
    fn of_id(id: FeatureId) -> Option<Self> {
        let part = match id {
            FeatureId::Vertex(corner) => Self { free: 0, corner },
            FeatureId::Face(index) => {
                let axis = 1_u32.checked_shl(index / 2)?;
                Self { free: Self::ALL & !axis, corner: if index % 2 == 0 { axis } else { 0 } }
            }
            FeatureId::Edge(index) => {
                let (axis, bits) = (index / 4, index % 4);
                let corner = (0..2)
                    .filter(|&bit| has(bits, bit))
                    .fold(0, |set, bit| set | 1 << ((axis as usize + 1 + bit) % D));
                Self { free: 1_u32.checked_shl(axis)?, corner }
            }
        };
        (part.free <= Self::ALL && part.corner <= Self::ALL && part.id() == id).then_some(part)
    }

    /// Returns the corners in the order documented at [`Cuboid`]: a Gray code over the free axes. A
    /// face's free axes follow its own axis cyclically. The loop is then counter-clockwise on the
    /// positive side if this order of the axes is an even permutation.
    const fn ring(self) -> CuboidRing {
        let own = self.own_axis();
        let is_face = self.dimension() + 1 == D;
        let first = if is_face { own + 1 } else { 0 };
        let mut ring = CuboidRing::of_corner(self.corner & !self.free);
        let mut at = first;
        while at < first + D {
            if has(self.free, at % D) {
                ring = ring.reflected(1 << (at % D));
            }
            at += 1;
        }
        let is_odd = (D - 1) * own % 2 == 1;
        if is_face && is_odd == has(self.corner, own) { ring.reversed() } else { ring }
    }

    /// Returns the ids of a ring's sides: none for a point, one for a segment, else four.
    const fn side_ids(ring: &CuboidRing) -> [FeatureId; 4] {
        let (mut ids, mut at) = ([FeatureId::Vertex(0); 4], 0);
        while at < ring.count {
            let (from, to) = (ring.corners[at], ring.corners[(at + 1) % ring.count]);
            ids[at] = Self { free: from ^ to, corner: from }.id();
            at += 1;
        }
        ids
    }

    /// The rings of all faces, by face index, and the ids of their sides.
    pub(in crate::shape) const FACES: [(CuboidRing, [FeatureId; 4]); 6] = {
        let (mut faces, mut index) =
            ([(CuboidRing::of_corner(0), [FeatureId::Vertex(0); 4]); 6], 0);
        while index < 2 * D {
            let axis = 1 << (index / 2);
            let corner = if index % 2 == 0 { axis } else { 0 };
            let ring = Self { free: Self::ALL & !axis, corner }.ring();
            faces[index] = (ring, Self::side_ids(&ring));
            index += 1;
        }
        faces
    };

    /// The ends of all edges, by edge index; `None` in 2D, where sides are faces.
    const EDGES: [Option<[u32; 2]>; 12] = {
        let (mut edges, mut axis) = ([None; 12], 0);
        while axis < D {
            let mut corner = 0;
            while corner < 1 << D {
                let part = Self { free: 1 << axis, corner };
                if let FeatureId::Edge(index) = part.id() {
                    let ring = part.ring();
                    edges[index as usize] = Some([ring.corners[0], ring.corners[1]]);
                }
                corner += 1;
            }
            axis += 1;
        }
        edges
    };

    /// Returns the normalised sum of the normals of the faces around the feature.
    #[inline]
    fn normal<N: Real>(self) -> Vector<N, D> {
        let mut normal = Vector::<N, D>::zeros();
        for axis in 0..D {
            if !has(self.free, axis) {
                normal[axis] = if has(self.corner, axis) { N::ONE } else { -N::ONE };
            }
        }
        // For a face the sum already has unit length.
        if self.dimension() + 1 == D { normal } else { normal / normal.norm() }
    }
}

/// The corners of a feature, at most four, each as the set of its positive axes.
#[derive(Clone, Copy)]
pub(in crate::shape) struct CuboidRing {
    pub(in crate::shape) corners: [u32; 4],
    count: usize,
}

impl CuboidRing {
    const fn of_corner(corner: u32) -> Self {
        Self { corners: [corner; 4], count: 1 }
    }

    /// Appends the corners in reverse order, each moved to the positive side of `axis`.
    const fn reflected(mut self, axis: u32) -> Self {
        let mut back = 0;
        while back < self.count {
            self.corners[self.count + back] = self.corners[self.count - 1 - back] | axis;
            back += 1;
        }
        self.count *= 2;
        self
    }

    const fn reversed(self) -> Self {
        let (mut reversed, mut at) = (self, 0);
        while at < self.count {
            reversed.corners[at] = self.corners[self.count - 1 - at];
            at += 1;
        }
        reversed
    }
}

/// Returns the set of axes along which the component of a direction is not negative.
fn signs<N: Real, const D: usize>(direction: &Vector<N, D>) -> u32 {
    (0..D).fold(0, |set, axis| if direction[axis] < N::ZERO { set } else { set | 1 << axis })
}

/// Returns the axis outside the set `taken` with the smallest component of a direction by
/// magnitude; `None` if all axes are taken.
fn weakest<N: Real, const D: usize>(direction: &Vector<N, D>, taken: u32) -> Option<usize> {
    let mut weakest = None;
    for axis in 0..D {
        let is_weaker = |best: usize| direction[axis].abs() < direction[best].abs();
        if !has(taken, axis) && weakest.is_none_or(is_weaker) {
            weakest = Some(axis);
        }
    }
    weakest
}

impl<N: Real, const D: usize> Cuboid<N, D> {
    #[inline]
    pub(in crate::shape) fn corner(&self, corner: u32) -> Point<N, D> {
        let mut point = Point::from(self.half_extents);
        for axis in 0..D {
            if !has(corner, axis) {
                point[axis] = -point[axis];
            }
        }
        point
    }

    /// Returns the [`SupportMap::core_feature`] without its corners; `None` if the box is flat
    /// along a free axis of the feature.
    pub(crate) fn part_toward(&self, direction: &Vector<N, D>) -> Option<SupportPart<N, D>> {
        let part = CuboidPart::<D>::toward(direction, Tilt::default_limit());
        let is_flat = |axis| has(part.free, axis) && self.half_extents[axis] == N::ZERO;
        if (0..D).any(is_flat) {
            return None;
        }
        let is_face = part.dimension() + 1 == D;
        Some(SupportPart { part, normal: is_face.then(|| part.normal()) })
    }

    fn fill(&self, part: CuboidPart<D>, out: &mut Feature<N, D>) {
        out.clear();
        out.id = part.id();
        let (ring, side_ids) = match out.id {
            FeatureId::Face(index) => CuboidPart::<D>::FACES[index as usize],
            _ => (part.ring(), CuboidPart::<D>::side_ids(&part.ring())),
        };
        for &corner in &ring.corners[..ring.count] {
            out.push(FeatureId::Vertex(corner), self.corner(corner));
        }
        for &id in &side_ids[..if ring.count > 2 { 4 } else { ring.count - 1 }] {
            out.side_ids.push(id);
        }
        out.normal = matches!(out.id, FeatureId::Face(_)).then(|| part.normal());
        // Corners coincide only if the box is flat along a free axis of the feature.
        if (0..D).any(|axis| has(part.free, axis) && self.half_extents[axis] == N::ZERO) {
            out.drop_repeated();
        }
    }

    #[track_caller]
    fn part(id: FeatureId, dimension: usize) -> CuboidPart<D> {
        match CuboidPart::of_id(id) {
            Some(part) if part.dimension() == dimension => part,
            _ => panic!("a cuboid has no {} named {id:?}", FeatureId::word::<D>(dimension)),
        }
    }
}

impl<N: Real> Cuboid<N, 2> {
    /// Implements [`SideOrVertex::of`] for boxes; `None` if the side has no length.
    pub(in crate::shape) fn supporting(&self, direction: &Vector<N, 2>) -> Option<SideOrVertex<N>> {
        let part = CuboidPart::<2>::toward(direction, Tilt::default_limit());
        let with_id = |corner: u32| (FeatureId::Vertex(corner), self.corner(corner));
        let FeatureId::Face(index) = part.id() else {
            let (id, point) = with_id(part.corner);
            return Some(SideOrVertex::vertex(id, point));
        };
        let is_flat = (0..2).any(|axis| has(part.free, axis) && self.half_extents[axis] == N::ZERO);
        let [from, to, ..] = CuboidPart::<2>::FACES[index as usize].0.corners;
        (!is_flat).then(|| SideOrVertex::side(FeatureId::Face(index), [with_id(from), with_id(to)]))
    }
}

impl<N: Real, const D: usize> ConvexPolyhedron<N, D> for Cuboid<N, D> {
    fn vertex(&self, id: FeatureId) -> Point<N, D> {
        self.corner(Self::part(id, 0).corner)
    }

    fn edge(&self, id: FeatureId) -> [(FeatureId, Point<N, D>); 2] {
        let known = match id {
            FeatureId::Edge(index) => CuboidPart::<D>::EDGES.get(index as usize).copied().flatten(),
            FeatureId::Vertex(_) | FeatureId::Face(_) => None,
        };
        let ends = known.unwrap_or_else(|| {
            let [from, to, ..] = Self::part(id, 1).ring().corners;
            [from, to]
        });
        ends.mapped(|corner| (FeatureId::Vertex(corner), self.corner(corner)))
    }

    fn face(&self, id: FeatureId, out: &mut Feature<N, D>) {
        self.fill(Self::part(id, D - 1), out);
    }

    fn feature_normal(&self, id: FeatureId) -> Vector<N, D> {
        match CuboidPart::<D>::of_id(id) {
            Some(part) => part.normal(),
            None => panic!("a cuboid has no feature named {id:?}"),
        }
    }

    fn support_face_toward(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        self.fill(CuboidPart::face_toward(direction), out);
    }

    fn support_feature_toward(&self, direction: &Vector<N, D>, angle: N, out: &mut Feature<N, D>) {
        self.fill(CuboidPart::toward(direction, Tilt::of_angle(angle)), out);
    }

    fn support_feature_id_toward(&self, direction: &Vector<N, D>) -> FeatureId {
        CuboidPart::toward(direction, Tilt::least()).id()
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Cuboid<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Cuboid(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        Aabb::around(Point::origin(), self.half_extents)
    }

    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        Aabb::around_rotated(pose, pose.rotated_extents(&self.half_extents))
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        let half_extents = self.half_extents.component_mul(&Scale::try_new(scale)?.magnitudes());
        Ok(ShapeHandle::new(Self::try_new(half_extents)?))
    }
}
