//! Runs scenes in worlds of any scalar and dimension, for tests of whole runs.

#![allow(dead_code, reason = "each test uses a part")]

use std::hash::{Hash, Hasher};

use impinge::math::na::{Quaternion, Translation2, Translation3, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Real, Space, Unit, Vector};
use impinge::narrow_phase::{
    CollisionObjectHandle, ContactStream, GeometricQueryType, StreamManifold,
};
use impinge::query::{Contact, ContactManifold, TrackedContact};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Plane, Segment, ShapeHandle,
    Triangle,
};
use impinge::world::{CollisionGroups, CollisionWorld, WorldMark};
use impinge_scenes::{Placement, Scene, SceneGroups, SceneQuery, SceneShape};

pub(crate) type World<N, const D: usize> = CollisionWorld<N, D, usize>;

/// A scalar and dimension in which scenes can be run.
pub(crate) trait Play<const D: usize>: Space<D> {
    /// Returns the pose of a placement whose lengths are multiplied by `scale`.
    fn pose_of(placement: &Placement<D>, scale: f64) -> Self::Isometry;
    /// Returns a shape of a kind that exists in this dimension only; `None` for other kinds.
    fn own_shape(shape: &SceneShape<D>, scale: f64) -> Option<ShapeHandle<Self, D>>;
}

impl<N: Real> Play<2> for N {
    fn pose_of(placement: &Placement<2>, scale: f64) -> Isometry2<N> {
        let [x, y] = placement.translation.map(|x| N::lit(x * scale));
        let [cosine, sine] = placement.complex().map(N::lit);
        let turn = UnitComplex::from_cos_sin_unchecked(cosine, sine);
        Isometry2::from_parts(Translation2::new(x, y), turn)
    }

    fn own_shape(shape: &SceneShape<2>, scale: f64) -> Option<ShapeHandle<N, 2>> {
        match shape {
            SceneShape::Convex { points } => {
                Some(ShapeHandle::new(ConvexPolygon::from_points(&all_points(points, scale))))
            }
            _ => None,
        }
    }
}

impl<N: Real> Play<3> for N {
    fn pose_of(placement: &Placement<3>, scale: f64) -> Isometry3<N> {
        let [x, y, z] = placement.translation.map(|x| N::lit(x * scale));
        let [i, j, k, w] = placement.quaternion().map(N::lit);
        let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        Isometry3::from_parts(Translation3::new(x, y, z), turn)
    }

    fn own_shape(shape: &SceneShape<3>, scale: f64) -> Option<ShapeHandle<N, 3>> {
        let length = |x: f64| N::lit(x * scale);
        match shape {
            SceneShape::Convex { points } => {
                Some(ShapeHandle::new(ConvexHull::from_points(&all_points(points, scale))))
            }
            SceneShape::Cylinder { half_height, radius } => {
                Some(ShapeHandle::new(Cylinder::new(length(*half_height), length(*radius))))
            }
            SceneShape::Cone { half_height, radius } => {
                Some(ShapeHandle::new(Cone::new(length(*half_height), length(*radius))))
            }
            _ => None,
        }
    }
}

fn scaled<N: Real, const D: usize>(coordinates: &[f64; D], scale: f64) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| N::lit(coordinates[axis] * scale))
}

fn all_points<N: Real, const D: usize>(points: &[[f64; D]], scale: f64) -> Vec<Point<N, D>> {
    points.iter().map(|point| Point::from(scaled(point, scale))).collect()
}

/// Returns a shape of a scene whose lengths are multiplied by `scale`.
pub(crate) fn shape_of<N: Play<D>, const D: usize>(
    shape: &SceneShape<D>,
    scale: f64,
) -> ShapeHandle<N, D> {
    if let Some(shape) = N::own_shape(shape, scale) {
        return shape;
    }
    let length = |x: f64| N::lit(x * scale);
    let point = |coordinates: &[f64; D]| Point::from(scaled::<N, D>(coordinates, scale));
    match shape {
        SceneShape::Ball { radius } => ShapeHandle::new(Ball::new(length(*radius))),
        SceneShape::Cuboid { half_extents } => {
            ShapeHandle::new(Cuboid::new(scaled(half_extents, scale)))
        }
        SceneShape::Plane { normal } => {
            ShapeHandle::new(Plane::new(Unit::new_unchecked(scaled(normal, 1.0))))
        }
        SceneShape::Capsule { half_height, radius } => {
            ShapeHandle::new(Capsule::new(length(*half_height), length(*radius)))
        }
        SceneShape::Segment { ends: [a, b] } => ShapeHandle::new(Segment::new(point(a), point(b))),
        SceneShape::Triangle { corners: [a, b, c] } => {
            ShapeHandle::new(Triangle::new(point(a), point(b), point(c)))
        }
        other => unreachable!("{other:?} is of one dimension"),
    }
}

fn query_of<N: Real>(query: SceneQuery, scale: f64) -> GeometricQueryType<N> {
    match query {
        SceneQuery::Contacts { linear, angular } => {
            GeometricQueryType::Contacts(N::lit(linear * scale), N::lit(angular))
        }
        SceneQuery::Proximity { margin } => GeometricQueryType::Proximity(N::lit(margin * scale)),
    }
}

fn groups_of(groups: &SceneGroups) -> CollisionGroups {
    let mut all = CollisionGroups::new();
    all.set_membership(groups.membership);
    all.set_whitelist(groups.whitelist);
    all.set_blacklist(groups.blacklist);
    all
}

/// A scene and the world in which it is played; the data of an object are its index in the scene.
pub(crate) struct Player<N: Play<D>, const D: usize> {
    scene: Scene<D>,
    scale: f64,
    step: u32,
    handles: Vec<Option<CollisionObjectHandle>>,
    pub(crate) world: World<N, D>,
}

/// A saved state of a player.
pub(crate) struct PlayerMark {
    world: WorldMark,
    step: u32,
    handles: Vec<Option<CollisionObjectHandle>>,
}

impl<N: Play<D>, const D: usize> Player<N, D> {
    /// Creates a player before the first step, with a world without objects. All lengths in the
    /// world are the lengths of the scene times `scale`.
    pub(crate) fn new(scene: Scene<D>, scale: f64) -> Self {
        let handles = vec![None; scene.objects.len()];
        let world = World::new(N::lit(scene.margin * scale));
        Self { scene, scale, step: 0, handles, world }
    }

    /// Returns the number of steps played.
    pub(crate) const fn step_number(&self) -> u32 {
        self.step
    }

    /// Marks the present state, for [`Self::rewind`].
    pub(crate) fn mark(&mut self) -> PlayerMark {
        PlayerMark { world: self.world.mark(), step: self.step, handles: self.handles.clone() }
    }

    /// Returns to the state of a mark.
    pub(crate) fn rewind(&mut self, mark: &PlayerMark) {
        self.world.rewind(mark.world);
        self.step = mark.step;
        self.handles.clone_from(&mark.handles);
    }

    /// Continues with `world`, a restored copy of the present world, and converts all handles to
    /// those of the copy.
    pub(crate) fn go_on_with(&mut self, world: World<N, D>) {
        for handle in self.handles.iter_mut().flatten() {
            *handle = world.counterpart(*handle).expect("it has the same objects");
        }
        self.world = world;
    }

    /// Applies the removals, additions and moves of the next step, and updates the world.
    pub(crate) fn step(&mut self) {
        self.apply();
        self.update();
    }

    /// Updates the world and advances to the next step.
    pub(crate) fn update(&mut self) {
        self.world.update();
        self.step += 1;
    }

    /// Applies everything of a step except the update.
    pub(crate) fn apply(&mut self) {
        let mut dead = Vec::new();
        for (object, handle) in self.handles.iter_mut().enumerate() {
            if !self.scene.is_alive(object, self.step) {
                dead.extend(handle.take());
            }
        }
        self.world.remove(&dead);
        for object in 0..self.handles.len() {
            if self.scene.is_alive(object, self.step) {
                self.place(object);
            }
        }
    }

    fn place(&mut self, object: usize) {
        let placement = self.scene.placement(object, self.step);
        match self.handles[object] {
            None => self.add(object, &placement),
            Some(_) if placement == self.scene.placement(object, self.step - 1) => {}
            Some(handle) => {
                self.world.set_position(handle, N::pose_of(&placement, self.scale));
            }
        }
    }

    fn add(&mut self, object: usize, placement: &Placement<D>) {
        let what = &self.scene.objects[object];
        let shape = shape_of(&what.shape, self.scale);
        let (groups, query) = (groups_of(&what.groups), query_of(what.query, self.scale));
        let position = N::pose_of(placement, self.scale);
        self.handles[object] = Some(self.world.add(position, shape, groups, query, object));
    }
}

/// FNV-1a over 64-bit words, each mixed as in `SplitMix64`. The digest is equal on every platform,
/// unlike those of the standard library's hashers, which depend on the width of `usize`.
#[derive(Clone, Debug)]
pub(crate) struct Digest(u64);

impl Digest {
    pub(crate) const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub(crate) fn number<N: Real>(&mut self, x: N) {
        self.write_u64(x.bits());
    }

    fn numbers<N: Real>(&mut self, numbers: &[N]) {
        numbers.iter().for_each(|x| self.number(*x));
    }
}

impl Hasher for Digest {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(u64::from(*byte)));
    }

    fn write_u32(&mut self, word: u32) {
        self.write_u64(u64::from(word));
    }

    fn write_u64(&mut self, word: u64) {
        let mixed = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        self.0 = (self.0 ^ mixed ^ (mixed >> 31)).wrapping_mul(0x0000_0100_0000_01b3);
    }

    fn write_usize(&mut self, word: usize) {
        self.write_u64(word as u64);
    }

    #[expect(clippy::cast_sign_loss, reason = "discriminants are small and positive")]
    fn write_isize(&mut self, word: isize) {
        self.write_u64(word as u64);
    }
}

/// Asserts that the views read in pieces have the pairs, the numbers of contacts and the deepest
/// contacts of the views read at once, in the same order.
fn assert_pieces_agree<N: Space<D>, const D: usize, T: Sync>(world: &CollisionWorld<N, D, T>) {
    for most in [0, 1, 3, 50, usize::MAX] {
        let pieces = world.contact_view_pieces(most);
        assert!((1..=most.max(1)).contains(&pieces.len()), "{} of {most}", pieces.len());
        let mut views = world.contact_views();
        for (one, other, view) in pieces.into_iter().flatten() {
            let expected = views.next().expect("as many in pieces");
            let pair = (one.handle(), other.handle());
            assert_eq!(pair, (expected.0.handle(), expected.1.handle()), "in the same order");
            assert_eq!(view.len(), expected.2.len(), "the same manifold");
            assert_eq!(view.deepest_contact().id, expected.2.deepest_contact().id, "the same");
        }
        assert!(views.next().is_none(), "no fewer in pieces");
    }
}

/// Asserts that a stream has the contacts of the views, to the bit and in order.
pub(crate) fn assert_stream_agrees<N: Space<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    stream: &ContactStream<N, D>,
) {
    let streamed = stream.manifolds().iter().flat_map(|manifold| {
        let points = stream.points()[manifold.range()].iter();
        points.map(move |point| {
            let pair = (manifold.object1, manifold.object2);
            (pair, manifold.id(point), manifold.normal, point.world1, point.depth)
        })
    });
    let viewed = world.contact_views().flat_map(|(object1, object2, view)| {
        let pair = (object1.handle(), object2.handle());
        view.contacts().map(move |point| {
            let Contact { world1, normal, depth, .. } = point.contact;
            (pair, point.id, normal, world1, depth)
        })
    });
    assert!(streamed.eq(viewed), "the stream has the contacts of the views");
    let ranges = stream.manifolds().iter().map(StreamManifold::range);
    let end = ranges.fold(0, |start, range| {
        assert!(
            range.start == start && start < range.end,
            "no gap, and no manifold without points"
        );
        range.end
    });
    assert_eq!(end, stream.points().len(), "each point belongs to a manifold");
}

/// Asserts that each way of reading contacts in place gives the contacts of the manifolds to the
/// bit: views at once and in pieces, and a stream.
pub(crate) fn assert_views_agree<N: Space<D>, const D: usize, T: Sync>(
    world: &CollisionWorld<N, D, T>,
) {
    assert_pieces_agree(world);
    let mut stream = ContactStream::new();
    world.read_contacts(&mut stream);
    assert_stream_agrees(world, &stream);
    let views = world.contact_views();
    let mut views: Vec<_> = views.map(|(a, b, view)| ((a.handle(), b.handle()), view)).collect();
    views.sort_by_key(|(pair, _)| *pair);
    let mut views = views.into_iter();
    for (object1, object2, manifold) in world.contact_manifolds() {
        let (pair, view) = views.next().expect("as many views as manifolds");
        assert_eq!(pair, (object1.handle(), object2.handle()), "the same pairs");
        assert_eq!(view.len(), manifold.len(), "of {pair:?}");
        assert_eq!(view.normal(), manifold.contacts()[0].contact.normal, "of {pair:?}");
        let deepest = manifold.deepest_contact().expect("not empty");
        assert_eq!(view.deepest_contact().id, deepest.id, "of {pair:?}");
        for (point, tracked) in view.contacts().zip(manifold.contacts()) {
            assert_eq!((point.contact, point.id), (tracked.contact, tracked.id), "of {pair:?}");
            let features = [tracked.kinematic.feature1(), tracked.kinematic.feature2()];
            assert_eq!([point.feature1, point.feature2], features, "of {pair:?}");
            assert_eq!([point.part1, point.part2], [tracked.part1, tracked.part2], "of {pair:?}");
        }
    }
    assert!(views.next().is_none(), "as many views as manifolds");
}

/// Digests everything that a world reports after an update: contacts with features and ids,
/// proximities and events, in order.
pub(crate) fn digest_state<N: Space<D>, const D: usize, T: Sync>(
    world: &CollisionWorld<N, D, T>,
    digest: &mut Digest,
) {
    assert_views_agree(world);
    for (object1, object2, manifold) in world.contact_manifolds() {
        (object1.handle(), object2.handle()).hash(digest);
        digest_manifold(manifold, digest);
    }
    for (object1, object2, pair) in world.proximity_pairs() {
        (object1.handle(), object2.handle(), pair.proximity()).hash(digest);
    }
    world.contact_events().hash(digest);
    world.proximity_events().hash(digest);
}

fn digest_manifold<N: Real, const D: usize>(manifold: &ContactManifold<N, D>, digest: &mut Digest) {
    digest.write_usize(manifold.deepest_contact_id());
    for TrackedContact { contact, kinematic, id, .. } in manifold.contacts() {
        digest.numbers(contact.world1.coords.as_slice());
        digest.numbers(contact.world2.coords.as_slice());
        digest.numbers(contact.normal.as_slice());
        digest.number(contact.depth);
        (id, kinematic.feature1(), kinematic.feature2()).hash(digest);
    }
}
