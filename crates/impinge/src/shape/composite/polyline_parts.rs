//! Implementation of [`CompositeShape`] for polylines: the segments and the seams between them.

use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{Point, Pose, Real, Space, Vector, max_component, perp, unit};
use crate::shape::composite::tri_mesh::{MeshByDimension, aabb_at, sphere_around};
use crate::shape::surface::own_surface::OwnSurface;
use crate::shape::surface::seam::{Seam, slack};
use crate::shape::surface::sidedness::Joining;
use crate::shape::{
    CompositeShape, EnclosedBody, FeatureId, Geometry, Kind, Part, PartSearch, PartSolid, Polyline,
    Revision, ScaleError, Shape, ShapeHandle, Sidedness, Surface, SurfaceAccess,
};

/// Returns the unit normal on the right of the unit vector `along`.
pub(in crate::shape) fn right_of<N: Real>(along: &Vector<N, 2>) -> Vector<N, 2> {
    -perp(along)
}

/// Returns the direction of the component of `vector` that is perpendicular to the unit vector
/// `along`; `vector` may have any length. `None` if this component is zero or only rounding error.
pub(in crate::shape) fn across<N: Real, const D: usize>(
    along: &Vector<N, D>,
    vector: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let without = |v: &Vector<N, D>| v - along * along.dot(v);
    let (own, rest) = unit(&without(vector))?;
    let straight = unit(&without(&own)).filter(|_| rest > slack::<N>() * max_component(vector));
    straight.map(|(own, _)| own)
}

impl<N: Space<D>, const D: usize> CompositeShape<N, D> for Polyline<N, D> {
    fn num_parts(&self) -> u32 {
        u32::try_from(self.segments.len()).expect("32 bits number the segments")
    }

    fn part(&self, part: u32) -> Part<'_, N, D> {
        Part { pose: Pose::identity(), solid: PartSolid::Segment(self.segment(part)) }
    }

    fn search(&self) -> &dyn PartSearch<N, D> {
        &self.tree
    }

    fn surface(&self) -> Option<&dyn Surface<N, D>> {
        (self.is_one_sided() || !self.keeps_internal_edges).then_some(self)
    }

    fn surface_access(&self) -> Option<SurfaceAccess<'_, N, D>> {
        self.surface().map(|_| SurfaceAccess::of_own(self))
    }

    fn each_corner(&self, part: u32, visit: &mut dyn FnMut(u64)) {
        self.segments[part as usize].iter().for_each(|&end| visit(self.joints.of(end).into()));
    }

    fn built_in(&self) -> Option<&dyn Shape<N, D>> {
        Some(self)
    }

    fn revision(&self) -> Option<Revision> {
        let options = [self.front.is_some(), self.is_solid(), self.keeps_internal_edges];
        Some(self.revision.with(&options))
    }

    fn each_body(&self, visit: &mut dyn FnMut(&EnclosedBody<'_, N, D>)) {
        if self.is_solid() {
            visit(&EnclosedBody::within(self));
        }
    }

    fn has_bodies(&self) -> bool {
        self.is_solid()
    }

    fn winds_around(&self, point: &Point<N, D>) -> bool {
        <N::Algorithms>::line_winds_around(self, point)
    }

    fn piece_of(&self, part: u32) -> u32 {
        self.pieces()[part as usize]
    }
}

/// In 2D a segment has two unit normals; in 3D every unit vector perpendicular to it is a normal.
impl<N: Real, const D: usize> Surface<N, D> for Polyline<N, D> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, D>) -> bool {
        if self.keeps_internal_edges {
            return self.height_over(part, normal) >= -slack::<N>();
        }
        let own = self.along(part).map(|along| along.dot(normal).abs() <= slack());
        let is_own = own.is_none_or(|own| own) && self.height_over(part, normal) >= N::ZERO;
        match feature {
            FeatureId::Vertex(end) if own != Some(true) => self.joint_admits(part, end, normal),
            _ => is_own,
        }
    }

    fn snapped(&self, part: u32, normal: &Vector<N, D>) -> Option<Vector<N, D>> {
        let along = self.along(part)?;
        if let Some(front) = self.front {
            return Some(front(&along));
        }
        across(&along, normal)
    }

    fn faces(&self, part: u32, center: &Point<N, D>) -> bool {
        self.height_over(part, &(center - self.ends(part)[0])) >= N::ZERO
    }
}

impl<N: Real, const D: usize> OwnSurface<N, D> for Polyline<N, D> {
    fn is_body(&self, _: u32) -> bool {
        self.is_solid()
    }

    fn sidedness(&self) -> Option<Sidedness> {
        let (is_left, follows_front) = (false, false);
        let (is_one_sided, keeps_internal_edges) = (self.is_one_sided(), self.keeps_internal_edges);
        let joining = if self.is_moved { Joining::Unknown } else { Joining::All };
        Some(Sidedness { is_left, is_one_sided, follows_front, keeps_internal_edges, joining })
    }
}

impl<N: Real, const D: usize> Polyline<N, D> {
    /// Returns the unit vector along a segment; `None` if it has no length.
    fn along(&self, segment: u32) -> Option<Vector<N, D>> {
        let [a, b] = self.ends(segment);
        unit(&(b - a)).map(|(along, _)| along)
    }

    /// Returns the component of `vector` along the front normal of a segment; 0 if the line has two
    /// sides or the segment has no length.
    fn height_over(&self, segment: u32, vector: &Vector<N, D>) -> N {
        let front = self.front.zip(self.along(segment)).map(|(front, along)| front(&along));
        front.map_or(N::ZERO, |front| front.dot(vector))
    }

    /// Returns whether the joint at an end of `part` admits `normal` ([`Seam::admits`]): the
    /// directions of all segments away from the joint have components of at most zero along
    /// `normal`, the segments do not continue each other straight, and on a one-sided line the
    /// segment with the largest component has its front towards `normal`.
    fn joint_admits(&self, part: u32, end: u32, normal: &Vector<N, D>) -> bool {
        let joint = self.joints.of(self.segments[part as usize][end as usize]);
        let own = self.along(part).unwrap_or_else(Vector::<N, D>::zeros);
        let mut seam = Seam::of_segments(own, normal);
        for &segment in self.joints.parts(joint) {
            let Some(along) = self.along(segment) else { continue };
            let starts_here = self.joints.of(self.segments[segment as usize][0]) == joint;
            let away = if starts_here { along } else { -along };
            seam.add_segment(&away, self.height_over(segment, normal));
        }
        seam.admits(self.is_one_sided())
    }
}

impl<N: Space<D>, const D: usize> Shape<N, D> for Polyline<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Composite(self))
    }

    /// Returns the smallest box around the segments. O(1).
    fn local_aabb(&self) -> Aabb<N, D> {
        self.tree.bounds().copied().unwrap_or_else(Aabb::unbounded)
    }

    /// Returns the smallest box around the segments placed at `pose`, up to rounding. O(log n) for
    /// a nearly convex line, up to O(n) if many segments extend almost equally far along an axis.
    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        aabb_at(pose, &self.segments, &self.vertices, &self.tree)
    }

    /// Returns the sphere about the centre of the local box through the farthest vertex. O(n).
    fn local_bounding_sphere(&self) -> BoundingSphere<N, D> {
        sphere_around(&self.local_aabb(), self.segments.as_flattened().iter(), &self.vertices)
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        Ok(ShapeHandle::new(self.try_scaled(scale)?))
    }
}
