//! The table of the algorithms that differ between 2D and 3D.

use super::Here;
use crate::batch::{SolidGroup, update_group2, update_group3};
use crate::bounding_volume::Ray;
use crate::collide::mesh::{
    Arena, CompositeContacts, CulledParts, PartContacts, Query, Scene, ball_contacts,
    chain_contacts, face_contacts, over2, over3,
};
use crate::collide::packet::{LANES, PartPacket};
use crate::collide::parts::{
    AxisSlabs, Between, PairMasks, PartPairs, part_gaps2, part_gaps3, part_pairs2, part_pairs3,
};
use crate::collide::separation::{
    Projection, distance_2d, distance_3d, project_on_solid_2d, project_on_solid_3d, separation_2d,
    separation_3d,
};
use crate::collide::{
    ConvexPair, ManifoldRequest, OnFace, Pair, PairQuestion, RawManifold, Solid, between2, build3,
    contacts_in_lanes, contacts_of_separation2, contacts_of_separation3, distances2, distances3,
    on_face2, on_face3, separations2, separations3, tangents2, tangents3, update_pair2,
    update_pair3, witness_feature2, witness_feature3, witness_features2, witness_features3,
};
use crate::convex::Separation;
#[cfg(feature = "debug_render")]
use crate::debug_render::{Sketch, sketch2, sketch3};
use crate::math::{Point, Real, Space, Vector};
use crate::narrow_phase::{DirtyContacts, Revolved, update_lanes2, update_lanes3};
use crate::query::composite::RayQuestion;
use crate::query::mass::MassByDimension;
use crate::query::point::{SurfacePoint, point2, point3};
use crate::query::ray::{Answers, Span, first_that, mesh3, ray2, ray3};
use crate::query::{RayBatch, RayIntersection};
use crate::shape::{
    ConvexHull, ConvexPolygon, FeatureId, Kind, MeshByDimension, ShapeHandle, TriMesh, Triangle,
};

/// The algorithms that differ by dimension. They are methods of [`Here`] rather than of the scalar,
/// so that they are not visible on a user's `N`.
#[expect(unnameable_types, private_interfaces, reason = "for this crate alone")]
pub trait ByDimension<N: Real, const D: usize>:
    MassByDimension<N, D> + MeshByDimension<N, D>
{
    /// Computes the separation of two convex solids; `None` above `limit`. All queries derive from
    /// it; see [`crate::query`].
    fn separation(pair: &Pair<'_, N, D>, limit: N) -> Option<Separation<N, D>>;

    /// Appends the contacts of a box or a convex hull with the triangles of a surface, in SIMD
    /// lanes. Returns `false` for other pairs, and always in 2D.
    fn face_contacts(
        query: &Query<'_, N, D>,
        scene: &Scene<'_, N, D>,
        culled: &CulledParts<N>,
        prediction: N,
        contacts: &mut PartContacts<N, D>,
        arena: &mut Arena<N, D>,
    ) -> bool;

    /// Computes a lower bound of the distance of each of 8 parts from the solid that lies inside
    /// `slabs`; negative for overlaps.
    fn part_gaps(slabs: &AxisSlabs<N, D>, tiles: &PartPacket<N, D>, limit: N) -> [N; LANES];

    /// Classifies up to 8 pairs of parts: certainly farther apart than `limit`, certainly within
    /// it, or undecided.
    fn part_pairs(pairs: &PartPairs<N, D>, limit: N) -> PairMasks;

    /// Appends the contacts of a convex solid and the segments of a chain (2D), or of a ball and
    /// the triangles of a surface (3D). Returns the reference point and the centre of the solid;
    /// `None` if the pair needs the generic path.
    fn quick_contacts(
        contacts: &mut CompositeContacts<N, D>,
        between: &Between<'_, N, D>,
        request: &ManifoldRequest<N>,
        out: (&mut PartContacts<N, D>, &mut Arena<N, D>),
    ) -> Option<[Point<N, D>; 2]>;

    /// Computes the distance of two convex solids; `None` above `limit`. For solids that clearly
    /// overlap, returns an arbitrary number that is zero or negative.
    fn distance(pair: &Pair<'_, N, D>, limit: N) -> Option<N>;

    /// Computes the distances of many pairs of convex solids. Writes each to the slot of its pair
    /// in `out`, `None` above `limit`.
    fn distances(pairs: &mut [ConvexPair<'_, N, D>], limit: N, out: &mut [Option<N>]);

    /// Computes the separations of many pairs of convex solids. Writes each to the slot of its pair
    /// in `out`, `None` above `limit`.
    fn separations(
        pairs: &mut [ConvexPair<'_, N, D>],
        limit: N,
        out: &mut [Option<Separation<N, D>>],
    );

    /// Projects a point onto a solid; `None` if there is no closed form.
    fn project_on_solid(solid: Kind<'_, N, D>, point: &Point<N, D>) -> Option<Projection<N, D>>;

    /// Computes the contact points of a pair: by the SIMD kernel of its kinds if there is one, else
    /// from the separation.
    fn contacts(pair: &Pair<'_, N, D>, request: &ManifoldRequest<N>, out: &mut RawManifold<N, D>)
    where
        N: Space<D>,
    {
        if !contacts_in_lanes(pair, request, out) {
            Self::contacts_of_separation(pair, request, out);
        }
    }

    /// Computes the contact points of a pair from its separation.
    fn contacts_of_separation(
        pair: &Pair<'_, N, D>,
        request: &ManifoldRequest<N>,
        out: &mut RawManifold<N, D>,
    );

    /// Computes the contact points of one pair by the SIMD kernel of its kinds. Returns `false` if
    /// there is no kernel or the kernel does not support the pair.
    fn update_pair(question: &PairQuestion<'_, N, D>, out: &mut RawManifold<N, D>) -> bool
    where
        N: Space<D>;

    /// Computes the contact points of a pair from its separation, which the caller has computed.
    fn between(
        pair: &Pair<'_, N, D>,
        separation: &Separation<N, D>,
        request: &ManifoldRequest<N>,
        out: &mut RawManifold<N, D>,
    );

    /// Computes the contacts of two solids along the normal in `query`. Returns `false` if they
    /// must be computed from the separation instead.
    fn on_face(pair: &Pair<'_, N, D>, query: &OnFace<N, D>, out: &mut RawManifold<N, D>) -> bool;

    /// Updates the dirty pairs of a group in SIMD lanes. Returns `false` if there is no kernel for
    /// the kinds of `solids`.
    fn update_lanes(solids: [&Solid<N, D>; 2], due: &mut DirtyContacts<'_, '_, N, D>) -> bool
    where
        N: Space<D>;

    /// Computes the pairs of a group of a batch in SIMD lanes. Returns `false` if there is no
    /// kernel for the kinds of `solids`.
    fn update_group(solids: [&Solid<N, D>; 2], group: &mut SolidGroup<'_, '_, N, D>) -> bool;

    /// Returns two unit vectors perpendicular to a normal; the second is zero in 2D.
    fn tangents(normal: &Vector<N, D>) -> [Vector<N, D>; 2];

    /// Returns the features that contain the nearest points of two convex solids.
    fn witness_features(pair: &Pair<'_, N, D>, separation: &Separation<N, D>) -> [FeatureId; 2];

    /// Returns the feature of one solid that contains its nearest point: of the second solid if
    /// `is_second` is true, else of the first.
    fn witness_feature(
        pair: &Pair<'_, N, D>,
        separation: &Separation<N, D>,
        tolerance: N,
        is_second: bool,
    ) -> FeatureId;

    /// Returns the feature of a triangle whose Voronoi region contains the centre of a ball. `None`
    /// in 2D, for a thin triangle, and where `tolerance` leaves the region uncertain.
    fn over(triangle: &Triangle<N, D>, center: &Point<N, D>, tolerance: N) -> Option<FeatureId>;

    /// Returns the interval of times in which the line of a ray is inside a solid. If the ray
    /// enters the solid at time zero or later, the end of the interval may be infinite. `None` if
    /// the line misses the solid, and for a composite; possibly also if the line is inside the
    /// solid only at times before zero.
    fn ray_span(solid: Kind<'_, N, D>, ray: &Ray<N, D>) -> Option<Span<N, D>>;

    /// Returns the first hit of a ray on a mesh; `None` if there is none by the maximum time.
    fn first_on_mesh(
        mesh: &TriMesh<N, D>,
        question: &RayQuestion<N, D>,
    ) -> Option<RayIntersection<N, D>>
    where
        N: Space<D>;

    /// Computes the first hits of many rays on a mesh. Returns `false` if there is no algorithm for
    /// many rays.
    fn first_hits_on_mesh(
        mesh: &TriMesh<N, D>,
        batch: &RayBatch<'_, N, D>,
        answer: Answers<'_, N, D>,
    ) -> bool
    where
        N: Space<D>;

    /// Returns the point of the boundary of a solid that is nearest to a point.
    fn surface_point(solid: Kind<'_, N, D>, point: &Point<N, D>) -> SurfacePoint<N, D>;

    /// Converts a solid of revolution to a `Kind`. The 2D implementation is unreachable.
    fn revolved(solid: &Revolved<N>) -> Kind<'_, N, D>;

    /// Returns the convex hull of points; `None` if the hull has no area (2D) or volume (3D).
    fn hull(points: &[Point<N, D>]) -> Option<ShapeHandle<N, D>>;

    /// Adds the lines and triangles of a convex solid to a sketch.
    #[cfg(feature = "debug_render")]
    fn sketch(solid: Kind<'_, N, D>, sketch: &mut Sketch<N, D>);
}

#[expect(private_interfaces, reason = "for this crate alone")]
impl<N: Real> ByDimension<N, 2> for Here {
    fn separation(pair: &Pair<'_, N, 2>, limit: N) -> Option<Separation<N, 2>> {
        separation_2d(pair, limit)
    }

    fn face_contacts(
        _: &Query<'_, N, 2>,
        _: &Scene<'_, N, 2>,
        _: &CulledParts<N>,
        _: N,
        _: &mut PartContacts<N, 2>,
        _: &mut Arena<N, 2>,
    ) -> bool {
        false
    }

    fn part_gaps(slabs: &AxisSlabs<N, 2>, tiles: &PartPacket<N, 2>, limit: N) -> [N; LANES] {
        part_gaps2(slabs, tiles, limit)
    }

    fn part_pairs(pairs: &PartPairs<N, 2>, limit: N) -> PairMasks {
        part_pairs2(pairs, limit)
    }

    fn quick_contacts(
        contacts: &mut CompositeContacts<N, 2>,
        between: &Between<'_, N, 2>,
        request: &ManifoldRequest<N>,
        out: (&mut PartContacts<N, 2>, &mut Arena<N, 2>),
    ) -> Option<[Point<N, 2>; 2]> {
        chain_contacts(contacts, between, request, out)
    }

    fn distance(pair: &Pair<'_, N, 2>, limit: N) -> Option<N> {
        distance_2d(pair, limit)
    }

    fn distances(pairs: &mut [ConvexPair<'_, N, 2>], limit: N, out: &mut [Option<N>]) {
        distances2(pairs, limit, out);
    }

    fn separations(
        pairs: &mut [ConvexPair<'_, N, 2>],
        limit: N,
        out: &mut [Option<Separation<N, 2>>],
    ) {
        separations2(pairs, limit, out);
    }

    fn project_on_solid(solid: Kind<'_, N, 2>, point: &Point<N, 2>) -> Option<Projection<N, 2>> {
        project_on_solid_2d(solid, point)
    }

    fn contacts_of_separation(
        pair: &Pair<'_, N, 2>,
        request: &ManifoldRequest<N>,
        out: &mut RawManifold<N, 2>,
    ) {
        contacts_of_separation2(pair, request, out);
    }

    fn update_pair(question: &PairQuestion<'_, N, 2>, out: &mut RawManifold<N, 2>) -> bool {
        update_pair2(question, out)
    }

    fn between(
        pair: &Pair<'_, N, 2>,
        separation: &Separation<N, 2>,
        request: &ManifoldRequest<N>,
        out: &mut RawManifold<N, 2>,
    ) {
        between2(pair, separation, request, out);
    }

    fn on_face(pair: &Pair<'_, N, 2>, query: &OnFace<N, 2>, out: &mut RawManifold<N, 2>) -> bool {
        on_face2(pair, query, out)
    }

    fn update_lanes(solids: [&Solid<N, 2>; 2], due: &mut DirtyContacts<'_, '_, N, 2>) -> bool {
        update_lanes2(solids, due)
    }

    fn update_group(solids: [&Solid<N, 2>; 2], group: &mut SolidGroup<'_, '_, N, 2>) -> bool {
        update_group2(solids, group)
    }

    fn tangents(normal: &Vector<N, 2>) -> [Vector<N, 2>; 2] {
        tangents2(normal)
    }

    fn witness_features(pair: &Pair<'_, N, 2>, separation: &Separation<N, 2>) -> [FeatureId; 2] {
        witness_features2(pair, separation)
    }

    fn witness_feature(
        pair: &Pair<'_, N, 2>,
        separation: &Separation<N, 2>,
        tolerance: N,
        is_second: bool,
    ) -> FeatureId {
        witness_feature2(pair, separation, tolerance, is_second)
    }

    fn over(triangle: &Triangle<N, 2>, center: &Point<N, 2>, tolerance: N) -> Option<FeatureId> {
        over2(triangle, center, tolerance)
    }

    fn first_on_mesh(
        mesh: &TriMesh<N, 2>,
        question: &RayQuestion<N, 2>,
    ) -> Option<RayIntersection<N, 2>>
    where
        N: Space<2>,
    {
        first_that(mesh, question, |_| true)
    }

    fn first_hits_on_mesh(_: &TriMesh<N, 2>, _: &RayBatch<'_, N, 2>, _: Answers<'_, N, 2>) -> bool
    where
        N: Space<2>,
    {
        false
    }

    fn ray_span(solid: Kind<'_, N, 2>, ray: &Ray<N, 2>) -> Option<Span<N, 2>> {
        ray2::span(solid, ray)
    }

    fn surface_point(solid: Kind<'_, N, 2>, point: &Point<N, 2>) -> SurfacePoint<N, 2> {
        point2::surface_point(solid, point)
    }

    fn revolved(_: &Revolved<N>) -> Kind<'_, N, 2> {
        unreachable!("cylinders and cones are solids of space")
    }

    fn hull(points: &[Point<N, 2>]) -> Option<ShapeHandle<N, 2>> {
        ConvexPolygon::try_from_points(points).ok().map(ShapeHandle::new)
    }

    #[cfg(feature = "debug_render")]
    fn sketch(solid: Kind<'_, N, 2>, sketch: &mut Sketch<N, 2>) {
        sketch2(solid, sketch);
    }
}

#[expect(private_interfaces, reason = "for this crate alone")]
impl<N: Real> ByDimension<N, 3> for Here {
    fn separation(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
        separation_3d(pair, limit)
    }

    fn face_contacts(
        query: &Query<'_, N, 3>,
        scene: &Scene<'_, N, 3>,
        culled: &CulledParts<N>,
        prediction: N,
        contacts: &mut PartContacts<N, 3>,
        arena: &mut Arena<N, 3>,
    ) -> bool {
        face_contacts(query, scene, culled, prediction, contacts, arena)
    }

    fn part_gaps(slabs: &AxisSlabs<N, 3>, tiles: &PartPacket<N, 3>, limit: N) -> [N; LANES] {
        part_gaps3(slabs, tiles, limit)
    }

    fn part_pairs(pairs: &PartPairs<N, 3>, limit: N) -> PairMasks {
        part_pairs3(pairs, limit)
    }

    fn quick_contacts(
        contacts: &mut CompositeContacts<N, 3>,
        between: &Between<'_, N, 3>,
        request: &ManifoldRequest<N>,
        out: (&mut PartContacts<N, 3>, &mut Arena<N, 3>),
    ) -> Option<[Point<N, 3>; 2]> {
        ball_contacts(contacts, between, request, out)
    }

    fn distance(pair: &Pair<'_, N, 3>, limit: N) -> Option<N> {
        distance_3d(pair, limit)
    }

    fn distances(pairs: &mut [ConvexPair<'_, N, 3>], limit: N, out: &mut [Option<N>]) {
        distances3(pairs, limit, out);
    }

    fn separations(
        pairs: &mut [ConvexPair<'_, N, 3>],
        limit: N,
        out: &mut [Option<Separation<N, 3>>],
    ) {
        separations3(pairs, limit, out);
    }

    fn project_on_solid(solid: Kind<'_, N, 3>, point: &Point<N, 3>) -> Option<Projection<N, 3>> {
        project_on_solid_3d(solid, point)
    }

    fn contacts_of_separation(
        pair: &Pair<'_, N, 3>,
        request: &ManifoldRequest<N>,
        out: &mut RawManifold<N, 3>,
    ) {
        contacts_of_separation3(pair, request, out);
    }

    fn update_pair(question: &PairQuestion<'_, N, 3>, out: &mut RawManifold<N, 3>) -> bool {
        update_pair3(question, out)
    }

    fn between(
        pair: &Pair<'_, N, 3>,
        separation: &Separation<N, 3>,
        request: &ManifoldRequest<N>,
        out: &mut RawManifold<N, 3>,
    ) {
        build3(pair, separation, request, out);
    }

    fn on_face(pair: &Pair<'_, N, 3>, query: &OnFace<N, 3>, out: &mut RawManifold<N, 3>) -> bool {
        on_face3(pair, query, out)
    }

    fn update_lanes(solids: [&Solid<N, 3>; 2], due: &mut DirtyContacts<'_, '_, N, 3>) -> bool {
        update_lanes3(solids, due)
    }

    fn update_group(solids: [&Solid<N, 3>; 2], group: &mut SolidGroup<'_, '_, N, 3>) -> bool {
        update_group3(solids, group)
    }

    fn tangents(normal: &Vector<N, 3>) -> [Vector<N, 3>; 2] {
        tangents3(normal)
    }

    fn witness_features(pair: &Pair<'_, N, 3>, separation: &Separation<N, 3>) -> [FeatureId; 2] {
        witness_features3(pair, separation)
    }

    fn witness_feature(
        pair: &Pair<'_, N, 3>,
        separation: &Separation<N, 3>,
        tolerance: N,
        is_second: bool,
    ) -> FeatureId {
        witness_feature3(pair, separation, tolerance, is_second)
    }

    fn over(triangle: &Triangle<N, 3>, center: &Point<N, 3>, tolerance: N) -> Option<FeatureId> {
        over3(triangle, center, tolerance)
    }

    fn first_on_mesh(
        mesh: &TriMesh<N, 3>,
        question: &RayQuestion<N, 3>,
    ) -> Option<RayIntersection<N, 3>>
    where
        N: Space<3>,
    {
        mesh3::first_on_mesh(mesh, question)
    }

    fn first_hits_on_mesh(
        mesh: &TriMesh<N, 3>,
        batch: &RayBatch<'_, N, 3>,
        answer: Answers<'_, N, 3>,
    ) -> bool
    where
        N: Space<3>,
    {
        mesh3::first_hits_on_mesh(mesh, batch, answer);
        true
    }

    fn ray_span(solid: Kind<'_, N, 3>, ray: &Ray<N, 3>) -> Option<Span<N, 3>> {
        ray3::span(solid, ray)
    }

    fn surface_point(solid: Kind<'_, N, 3>, point: &Point<N, 3>) -> SurfacePoint<N, 3> {
        point3::surface_point(solid, point)
    }

    fn revolved(solid: &Revolved<N>) -> Kind<'_, N, 3> {
        match solid {
            Revolved::Cylinder(cylinder) => Kind::Cylinder(cylinder, cylinder),
            Revolved::Cone(cone) => Kind::Cone(cone, cone),
        }
    }

    fn hull(points: &[Point<N, 3>]) -> Option<ShapeHandle<N, 3>> {
        ConvexHull::try_from_points(points).ok().map(ShapeHandle::new)
    }

    #[cfg(feature = "debug_render")]
    fn sketch(solid: Kind<'_, N, 3>, sketch: &mut Sketch<N, 3>) {
        sketch3(solid, sketch);
    }
}
