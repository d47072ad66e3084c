//! A scene with every shape and all kinds of calls, the same in every run.

use std::num::NonZeroU64;

use impinge::bounding_volume::{Aabb, Ray};
use impinge::math::{Isometry2, Isometry3, Point, Unit, Vector};
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::query::{ImpactOptions, ManifoldView};
use impinge::shape::{
    Ball, Capsule, Compound, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Diagonal,
    Ellipsoid, HeightField, Plane, Polyline, Rounded, Segment, ShapeHandle, TaperedCapsule,
    Tetrahedron, TriMesh, Triangle,
};
use impinge::world::{CollisionGroups, CollisionObject, CollisionWorld};
use impinge_record::{
    CastQuestion, PlacedShape, Query, Question, RayQuestion, RecordError, Recordable, Recorder,
    Registry, Scalar,
};

/// The parts of the scene that differ by dimension.
pub(crate) trait Stage<const D: usize>: Recordable<D> {
    /// Returns shapes that exist in this dimension only.
    fn own_shapes() -> Vec<ShapeHandle<Self, D>>;
    /// Returns a registry with the filter `odd`.
    fn registry() -> Registry<Self, D, u32>;
    /// Returns a rotated pose at a position.
    fn placed(x: f64, y: f64) -> Self::Isometry;
}

impl<N: Scalar> Stage<2> for N {
    fn own_shapes() -> Vec<ShapeHandle<N, 2>> {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let square = square.map(|[x, y]| Point::<N, 2>::new(N::lit(x), N::lit(y)));
        let heights = [0.0, 1.0, 0.5, -1.0].map(N::lit).to_vec();
        let field = HeightField::<N, 2>::new(heights, Vector::<N, 2>::new(N::TWO, N::ONE));
        vec![
            ShapeHandle::new(ConvexPolygon::new(&square)),
            ShapeHandle::new(field.with_holes(|cell| cell == 1).one_sided()),
            ShapeHandle::new(Polyline::closed(square.to_vec()).one_sided()),
        ]
    }

    fn registry() -> Registry<N, 2, u32> {
        type Object<N> = CollisionObject<N, 2, u32>;
        let odd = |a: &Object<N>, b: &Object<N>| (a.data() + b.data()) % 2 == 1;
        Registry::new().with_filter("odd", odd)
    }

    fn placed(x: f64, y: f64) -> Isometry2<N> {
        let turn = impinge::math::na::UnitComplex::from_cos_sin_unchecked(N::lit(0.6), N::lit(0.8));
        Isometry2::from_parts(Vector::<N, 2>::new(N::lit(x), N::lit(y)).into(), turn)
    }
}

impl<N: Scalar> Stage<3> for N {
    fn own_shapes() -> Vec<ShapeHandle<N, 3>> {
        let cube = [0_u8, 1, 2, 3, 4, 5, 6, 7].map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from));
        let cube = cube.map(|[x, y, z]| Point::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z)));
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2]];
        let quads = [&quads[..], &[[1, 3, 7, 5]]].concat();
        let heights = [0.0, 1.0, 0.5, -1.0, 0.25, 0.0].map(N::lit).to_vec();
        let scale = Vector::<N, 3>::repeat(N::TWO);
        let mut field = HeightField::<N, 3>::new(2, 3, heights, scale);
        field.set_diagonal(0, 1, Diagonal::Backward);
        field.set_part_hole(1, true);
        let stone = ConvexHull::from_points(&[&cube[..6], &[Point::<N, 3>::origin()]].concat());
        vec![
            ShapeHandle::new(ConvexHull::new(&cube, &quads)),
            ShapeHandle::new(stone),
            ShapeHandle::new(Cylinder::new(N::ONE, N::HALF)),
            ShapeHandle::new(Cone::new(N::HALF, N::ONE)),
            ShapeHandle::new(Tetrahedron::new([cube[0], cube[1], cube[2], cube[4]])),
            ShapeHandle::new(field),
            ShapeHandle::new(
                TriMesh::new(cube[..4].to_vec(), vec![[0, 1, 2], [1, 3, 2]]).one_sided(),
            ),
        ]
    }

    fn registry() -> Registry<N, 3, u32> {
        type Object<N> = CollisionObject<N, 3, u32>;
        let odd = |a: &Object<N>, b: &Object<N>| (a.data() + b.data()) % 2 == 1;
        Registry::new().with_filter("odd", odd)
    }

    fn placed(x: f64, y: f64) -> Isometry3<N> {
        use impinge::math::na::{Quaternion, UnitQuaternion};
        let [w, i, j, k] = [0.8, 0.36, 0.48, 0.0].map(N::lit);
        let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        Isometry3::from_parts(Vector::<N, 3>::new(N::lit(x), N::lit(y), N::ZERO).into(), turn)
    }
}

/// Returns one shape of each kind.
pub(crate) fn shapes<N: Stage<D>, const D: usize>() -> Vec<ShapeHandle<N, D>> {
    let point =
        |x: f64, y: f64| Point::from(Vector::<N, D>::from_fn(|axis, _| N::lit([x, y, 0.25][axis])));
    let [a, b, c, d] = [point(-1.0, 0.0), point(1.0, -0.25), point(0.5, 1.0), point(2.0, 1.5)];
    let sizes = Vector::<N, D>::from_fn(|axis, _| N::lit([1.0, 0.5, 0.75][axis]));
    let mut up = Vector::<N, D>::zeros();
    up[1] = N::ONE;
    let ball = ShapeHandle::new(Ball::new(N::HALF));
    let children = vec![(N::placed(1.0, 0.0), ball.clone()), (N::placed(0.0, 1.0), ball.clone())];
    let mut all = vec![
        ball,
        ShapeHandle::new(Segment::new(a, b)),
        ShapeHandle::new(Capsule::<N, D>::new(N::ONE, N::HALF)),
        ShapeHandle::new(Triangle::<N, D>::new(a, b, c)),
        ShapeHandle::new(Cuboid::new(sizes)),
        ShapeHandle::new(Ellipsoid::new(sizes)),
        ShapeHandle::new(TaperedCapsule::<N, D>::new(N::ONE, N::HALF, N::ONE)),
        ShapeHandle::new(Plane::<N, D>::new(Unit::new_unchecked(up))),
        ShapeHandle::new(Rounded::new(Cuboid::new(sizes), N::HALF)),
        ShapeHandle::new(Polyline::open(vec![a, b, c, d]).with_internal_edges_kept()),
        ShapeHandle::new(TriMesh::new(vec![a, b, c, d], vec![[0, 1, 2], [2, 1, 3]])),
        ShapeHandle::new(Compound::new(children)),
    ];
    all.extend(N::own_shapes());
    all
}

/// A recorder with the handles of its present objects, and the shapes from which objects are made.
pub(crate) struct Scene<N: Stage<D>, const D: usize> {
    pub(crate) recorder: Recorder<N, D, u32>,
    handles: Vec<CollisionObjectHandle>,
    shapes: Vec<ShapeHandle<N, D>>,
}

impl<N: Stage<D>, const D: usize> Scene<N, D> {
    /// Creates a scene without objects.
    pub(crate) fn new() -> Self {
        let recorder = Recorder::new(N::lit(0.02), N::registry()).expect("a usable margin");
        Self { recorder, handles: Vec::new(), shapes: shapes::<N, D>() }
    }

    /// Creates a scene that continues with a world that has objects.
    pub(crate) fn of_world(world: CollisionWorld<N, D, u32>) -> Self {
        let handles = world.collision_objects().map(CollisionObject::handle).collect();
        let recorder = Recorder::of_world(world, N::lit(0.02), N::registry());
        Self { recorder: recorder.expect("it can be recorded"), handles, shapes: shapes::<N, D>() }
    }

    pub(crate) fn with_key_frames(mut self, every: u64) -> Self {
        let every = NonZeroU64::new(every).expect("not zero");
        self.recorder = self.recorder.with_key_frames(every);
        self
    }

    /// Adds one object of each shape, in rows of four in which neighbours overlap.
    pub(crate) fn fill(&mut self) -> Result<(), RecordError> {
        for (shape, id) in self.shapes.clone().into_iter().zip(0_u32..) {
            let at = N::placed(f64::from(id % 4) * 1.25, f64::from(id / 4));
            let (groups, linear) = (CollisionGroups::new(), N::lit(0.01));
            let query = match id % 5 {
                0 => GeometricQueryType::Proximity(N::HALF),
                _ => GeometricQueryType::Contacts(linear, N::ZERO),
            };
            self.handles.push(self.recorder.add(at, shape, groups, query, id)?);
        }
        Ok(())
    }

    /// Moves a third of the objects, makes the other calls of step `step`, of which there are eight
    /// sets in turn, and updates.
    pub(crate) fn step(&mut self, step: u32) -> Result<(), RecordError> {
        let moved =
            self.handles.iter().zip(0_u32..).filter(|(_, id)| (id + step).is_multiple_of(3));
        let moved = moved.map(|(handle, id)| {
            let wave = f64::from((id * 7 + step * 5) % 11) / 8.0;
            (*handle, N::placed(f64::from(id % 4) + wave, f64::from(id / 4) - wave))
        });
        self.recorder.set_positions(&moved.collect::<Vec<_>>())?;
        match step % 8 {
            1 => self.replace()?,
            2 => self.recorder.register_broad_phase_pair_filter("odd")?,
            3 => self.change()?,
            5 => self.recorder.unregister_broad_phase_pair_filter("odd"),
            6 => self.remove_some()?,
            _ => {}
        }
        self.ask()?;
        self.recorder.update();
        Ok(())
    }

    /// Removes two objects and adds a ball.
    fn replace(&mut self) -> Result<(), RecordError> {
        let gone: Vec<_> = self.handles.drain(1..3).collect();
        self.recorder.remove(&gone)?;
        let (groups, query) = (CollisionGroups::new(), GeometricQueryType::Proximity(N::ZERO));
        let shape = ShapeHandle::new(Ball::new(N::ONE));
        self.handles.push(self.recorder.add(N::placed(1.0, 1.0), shape, groups, query, 99)?);
        Ok(())
    }

    fn change(&mut self) -> Result<(), RecordError> {
        let mut groups = CollisionGroups::new().with_membership(&[1, 4]).with_blacklist(&[2]);
        groups.enable_self_collision();
        self.recorder.set_collision_groups(self.handles[0], groups)?;
        self.recorder.set_shape(self.handles[1], self.shapes[2].clone())?;
        let query = GeometricQueryType::Contacts(N::HALF, N::ZERO);
        self.recorder.set_query_type(self.handles[2], query)?;
        self.recorder.set_data(self.handles[3], 17)
    }

    fn remove_some(&mut self) -> Result<(), RecordError> {
        let last = self.handles.pop().expect("there are objects");
        self.recorder.retain(|object| object.handle() != last);
        Ok(())
    }

    /// Runs each kind of query, once with and once without a filter.
    fn ask(&mut self) -> Result<(), RecordError> {
        let far = N::lit(10.0);
        let mut right = Vector::<N, D>::zeros();
        right[0] = N::ONE;
        let origin = Point::<N, D>::origin();
        let start =
            || PlacedShape { position: N::placed(-6.0, 1.0), shape: self.shapes[0].clone() };
        let ray = Ray::new(origin - right * N::lit(5.0), right);
        let ray = RayQuestion { ray, max_time: far, solid: true };
        let options = ImpactOptions::new().with_max_time(far).with_tolerance(N::lit(0.001));
        let cast = || CastQuestion { start: start(), velocity: right, options };
        let questions = [
            Question::FirstRayHit(ray),
            Question::RayHits(ray),
            Question::Containing(origin),
            Question::ProjectPoint { point: origin + right, max_distance: far, solid: false },
            Question::InAabb(Aabb::new(origin, origin + Vector::<N, D>::repeat(N::ONE))),
            Question::InAabb(Aabb::unbounded()),
            Question::Overlapping(start()),
            Question::Nearest { from: start(), count: 3, max_distance: far },
            Question::CastShape(cast()),
            Question::CastShapeAll(cast()),
        ];
        let groups = CollisionGroups::new().with_membership(&[4]);
        for question in questions {
            self.recorder.ask(&Query::new(question.clone()))?;
            let excluded = self.handles[..2].to_vec();
            self.recorder.ask(&Query { question, groups: Some(groups), excluded })?;
        }
        Ok(())
    }
}

/// Returns the state of a world as text, with all bits of its numbers.
pub(crate) fn words<N: Recordable<D>, const D: usize>(
    world: &CollisionWorld<N, D, u32>,
) -> Vec<String> {
    let objects = world.collision_objects().map(|object| {
        let (index, at, data) = (object.handle().uid(), object.position(), object.data());
        format!("{index} {at:?} {:?} {:?} {data}", object.collision_groups(), object.query_type())
    });
    let pairs = world.contact_pairs().map(|(one, two, pair)| {
        let points = pair.views().flat_map(ManifoldView::contacts);
        let points = points.map(|point| (point.contact, point.feature1, point.feature2));
        format!("{} {} {:?}", one.handle().uid(), two.handle().uid(), points.collect::<Vec<_>>())
    });
    let near = world.proximity_pairs().map(|(one, two, pair)| {
        format!("{} {} {:?}", one.handle().uid(), two.handle().uid(), pair.proximity())
    });
    let events = world.contact_events().iter().map(|event| {
        let (one, two) = event.handles();
        let name = format!("{event:?}").split('(').next().map(str::to_owned);
        format!("{name:?} {} {}", one.uid(), two.uid())
    });
    objects.chain(pairs).chain(near).chain(events).collect()
}
