//! Boxes (rectangles in the plane).

use smallvec::SmallVec;

use super::error::{finite, or_panic, size};
use super::segment::length_of;
use super::tilt::Tilt;
use super::{ConvexPolyhedron, Feature, FeatureId, Geometry, Kind, Shape, ShapeError, SupportMap};
use crate::bounding_volume::Aabb;
use crate::math::{Point, Real, Vector};

/// The points whose coordinate on each axis is within the half extent of zero.
///
/// Half extents may be zero: the box is then flat, a segment or a point.
///
/// Vertices: bit `i` of the number says that coordinate `i` is positive. Faces: `2 · axis` on the
/// positive side of an axis, one more on the negative side. Edges (in space): `4 · axis` of the
/// direction plus two bits, the signs on the next axis and the one after (x → y → z → x): 1 if the
/// next coordinate is positive, 2 if the one after is.
///
/// Faces are given with their vertices counter-clockwise seen from outside (in the plane with the
/// box on the left), so in the plane the outline counter-clockwise is faces 0, 2, 1, 3 and vertices
/// 1, 3, 2, 0. A face without width is given as the segment or the point that it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid<N: Real, const D: usize> {
    half_extents: Vector<N, D>,
}

impl<N: Real, const D: usize> Cuboid<N, D> {
    /// The box of given half extents, each zero or more.
    ///
    /// # Panics
    /// If a half extent is negative or not finite; [`Self::try_new`] returns these.
    #[must_use]
    #[track_caller]
    pub fn new(half_extents: Vector<N, D>) -> Self {
        or_panic(Self::try_new(half_extents))
    }

    /// The box of given half extents, each zero or more.
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

    /// Half the size along each axis.
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
        self.fill(Part::facing(direction, Tilt::usual()), out);
    }
}

/// A vertex, edge or face: the points of the box whose coordinates on the `free` axes range, while
/// the others are those of `corner`. Both are sets of axes as bits, `corner` of those with the
/// positive sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part<const D: usize> {
    free: u32,
    corner: u32,
}

const fn has(set: u32, axis: usize) -> bool {
    set >> axis & 1 == 1
}

impl<const D: usize> Part<D> {
    const ALL: u32 = (1 << D) - 1;

    /// The part that faces a unit vector: as many axes as the tilt admits are free, the weakest
    /// first, which is the rule for the flattest edge and the most aligned face beside it.
    fn facing<N: Real>(direction: &Vector<N, D>, tilt: Tilt<N>) -> Self {
        let (mut free, mut leans) = (0, N::ZERO);
        for _ in 1..D {
            let Some(axis) = weakest(direction, free) else { break };
            leans += direction[axis] * direction[axis];
            if !tilt.admits(leans) {
                break;
            }
            free |= 1 << axis;
        }
        Self { free, corner: signs(direction) }
    }

    /// The face whose normal is most aligned with a direction.
    fn face_facing<N: Real>(direction: &Vector<N, D>) -> Self {
        let mut strongest = 0;
        for axis in 1..D {
            if direction[axis].abs() > direction[strongest].abs() {
                strongest = axis;
            }
        }
        Self { free: Self::ALL & !(1 << strongest), corner: signs(direction) }
    }

    fn dimension(self) -> usize {
        self.free.count_ones() as usize
    }

    /// A point has no side, a segment one and a rectangle four.
    fn side_count(self) -> usize {
        self.dimension() * self.dimension()
    }

    /// The number documented at [`Cuboid`].
    fn name(self) -> FeatureId {
        let sign = |axis: usize| u32::from(has(self.corner, axis % D));
        let index = match self.dimension() {
            0 => self.corner,
            dimension if dimension + 1 == D => {
                let axis = (!self.free).trailing_zeros();
                2 * axis + u32::from(!has(self.corner, axis as usize))
            }
            _ => {
                let axis = self.free.trailing_zeros();
                let next = axis as usize + 1;
                4 * axis + sign(next) + 2 * sign(next + 1)
            }
        };
        FeatureId::flat::<D>(self.dimension(), index)
    }

    /// The part of a name, if there is one.
    fn named(id: FeatureId) -> Option<Self> {
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
        (part.free <= Self::ALL && part.corner <= Self::ALL && part.name() == id).then_some(part)
    }

    /// The corners in the order documented at [`Cuboid`]: a Gray code over the free axes, which
    /// changes one coordinate at a time. Taken in the cyclic order after a face's own axis it runs
    /// counter-clockwise on the positive side if that order is an even permutation of the axes.
    fn corners(self) -> SmallVec<[u32; 4]> {
        let axis = (!self.free & Self::ALL).trailing_zeros() as usize;
        let is_face = self.dimension() + 1 == D;
        let first = if is_face { axis + 1 } else { 0 };
        let is_odd = (D - 1) * axis % 2 == 1;
        let is_reversed = is_face && is_odd == has(self.corner, axis);
        let fixed = self.corner & !self.free;
        let mut corners = SmallVec::from_slice(&[fixed]);
        for axis in (first..first + D).map(|axis| axis % D).filter(|&axis| has(self.free, axis)) {
            for at in (0..corners.len()).rev() {
                corners.push(corners[at] | 1 << axis);
            }
        }
        if is_reversed {
            corners.reverse();
        }
        corners
    }

    /// The outward unit vector in the middle of the normals of the faces around the part.
    fn normal<N: Real>(self) -> Vector<N, D> {
        let mut normal = Vector::<N, D>::zeros();
        for axis in (0..D).filter(|&axis| !has(self.free, axis)) {
            normal[axis] = if has(self.corner, axis) { N::ONE } else { -N::ONE };
        }
        normal / normal.norm()
    }
}

/// The axes along which a direction does not point to the negative side.
fn signs<N: Real, const D: usize>(direction: &Vector<N, D>) -> u32 {
    (0..D).fold(0, |set, axis| if direction[axis] < N::ZERO { set } else { set | 1 << axis })
}

/// The axis, not yet taken, along which a direction has its least component.
fn weakest<N: Real, const D: usize>(direction: &Vector<N, D>, taken: u32) -> Option<usize> {
    let mut axes = (0..D).filter(|&axis| !has(taken, axis));
    let first = axes.next()?;
    let weaker = |a: usize, b: usize| if direction[b].abs() < direction[a].abs() { b } else { a };
    Some(axes.fold(first, weaker))
}

impl<N: Real, const D: usize> Cuboid<N, D> {
    fn corner(&self, corner: u32) -> Point<N, D> {
        let mut point = Point::from(self.half_extents);
        for axis in (0..D).filter(|&axis| !has(corner, axis)) {
            point[axis] = -point[axis];
        }
        point
    }

    fn fill(&self, part: Part<D>, out: &mut Feature<N, D>) {
        out.clear();
        out.id = part.name();
        let corners = part.corners();
        for (at, &from) in corners.iter().enumerate() {
            out.push(FeatureId::Vertex(from), self.corner(from));
            if at < part.side_count() {
                let to = corners[(at + 1) % corners.len()];
                out.side_ids.push(Part::<D> { free: from ^ to, corner: from }.name());
            }
        }
        out.normal = matches!(out.id, FeatureId::Face(_)).then(|| part.normal());
        out.drop_repeated();
    }

    #[track_caller]
    fn part(id: FeatureId, dimension: usize) -> Part<D> {
        match Part::named(id) {
            Some(part) if part.dimension() == dimension => part,
            _ => panic!("a cuboid has no {} named {id:?}", FeatureId::word::<D>(dimension)),
        }
    }
}

impl<N: Real, const D: usize> ConvexPolyhedron<N, D> for Cuboid<N, D> {
    fn vertex(&self, id: FeatureId) -> Point<N, D> {
        self.corner(Self::part(id, 0).corner)
    }

    fn edge(&self, id: FeatureId) -> [(FeatureId, Point<N, D>); 2] {
        let corners = Self::part(id, 1).corners();
        [corners[0], corners[1]].map(|corner| (FeatureId::Vertex(corner), self.corner(corner)))
    }

    fn face(&self, id: FeatureId, out: &mut Feature<N, D>) {
        self.fill(Self::part(id, D - 1), out);
    }

    fn feature_normal(&self, id: FeatureId) -> Vector<N, D> {
        match Part::<D>::named(id) {
            Some(part) => part.normal(),
            None => panic!("a cuboid has no feature named {id:?}"),
        }
    }

    fn support_face_toward(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        self.fill(Part::face_facing(direction), out);
    }

    fn support_feature_toward(&self, direction: &Vector<N, D>, angle: N, out: &mut Feature<N, D>) {
        self.fill(Part::facing(direction, Tilt::of_angle(angle)), out);
    }

    fn support_feature_id_toward(&self, direction: &Vector<N, D>) -> FeatureId {
        Part::facing(direction, Tilt::least()).name()
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Cuboid<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Cuboid(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        Aabb::around(Point::origin(), self.half_extents)
    }
}
