//! The contenders of impinge: queries and manifolds of single pairs, and the manifolds of a world.

use impinge::math::na::{Quaternion, Translation, Unit, UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Space, Vector};
use impinge::narrow_phase::{
    CollisionObjectHandle, ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher,
    DefaultNarrowPhase, GeometricQueryType, IdAllocator, PairManifoldGenerator,
};
use impinge::query::{ImpactOptions, Moving, Proximity, contact, distance, impact, proximity};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Diagonals, HeightField,
    Plane, Polyline, Rounded, Segment, Shape, ShapeHandle, TriMesh, Triangle,
};
use impinge::world::{CollisionGroups, CollisionWorld};

use super::clocked::{Clock, Clocked};
use super::form::{Form, up};
use super::placement::Placement;
use super::question::{Answer, Contender, LONGEST_TIME, PREDICTION, Question, Stand, stand};
use super::regime::{Pair, Poses};
use super::target::{ALONE, ALONE_REUSING, PART, REUSING_PART};
use crate::measure::Times;

/// The margin of boxes, so large that all pairs stay pairs of the broad phase in all regimes.
const MARGIN: f32 = 2.5;

/// The relative motion up to which pairs keep their contacts in the "reusing" contenders.
const TOLERANCE: f32 = PREDICTION / 20.0;

/// The functions that differ by dimension.
pub trait Dimension<const D: usize>: AbstractRotation<f32, D> + Copy + 'static {
    fn isometry(placement: &Placement<D>) -> Isometry<f32, Self, D>;
    fn particular(form: &Form<D>) -> ShapeHandle<f32, D>;
}

impl Dimension<2> for UnitComplex<f32> {
    fn isometry(placement: &Placement<2>) -> Isometry2<f32> {
        let [cosine, sine] = placement.complex().map(|x| x as f32);
        let rotation = UnitComplex::from_cos_sin_unchecked(cosine, sine);
        Isometry2::from_parts(Translation::from(vector(&placement.translation)), rotation)
    }

    fn particular(form: &Form<2>) -> ShapeHandle<f32, 2> {
        match form {
            Form::Convex(points) => ShapeHandle::new(ConvexPolygon::from_points(&cloud(points))),
            Form::Polyline(terrain) => ShapeHandle::new(Polyline::open(cloud(&terrain.line()))),
            other => unreachable!("{other:?} is not of the plane"),
        }
    }
}

impl Dimension<3> for UnitQuaternion<f32> {
    fn isometry(placement: &Placement<3>) -> Isometry3<f32> {
        let [i, j, k, w] = placement.rotation.map(|x| x as f32);
        let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        Isometry3::from_parts(Translation::from(vector(&placement.translation)), rotation)
    }

    fn particular(form: &Form<3>) -> ShapeHandle<f32, 3> {
        match form {
            Form::Convex(points) => ShapeHandle::new(ConvexHull::from_points(&cloud(points))),
            Form::Cylinder { half_height, radius } => {
                ShapeHandle::new(Cylinder::new(*half_height as f32, *radius as f32))
            }
            Form::Cone { half_height, radius } => {
                ShapeHandle::new(Cone::new(*half_height as f32, *radius as f32))
            }
            Form::Mesh(terrain) => {
                ShapeHandle::new(TriMesh::new(cloud(&terrain.vertices()), terrain.triangles()))
            }
            Form::HeightField(terrain) => {
                let heights = terrain.heights().iter().map(|&height| height as f32).collect();
                let row = terrain.cells as usize + 1;
                let extent = terrain.extent() as f32;
                let scale = Vector::<f32, 3>::new(extent, 1.0, extent);
                let field = HeightField::<f32, 3>::new(row, row, heights, scale);
                // This option selects the diagonals that the height fields of the rivals have.
                ShapeHandle::new(field.with_diagonals(Diagonals::Backward))
            }
            other => unreachable!("{other:?} is not of space"),
        }
    }
}

fn vector<const D: usize>(v: &[f64; D]) -> Vector<f32, D> {
    Vector::from(v.map(|x| x as f32))
}

fn cloud<const D: usize>(points: &[[f64; D]]) -> Vec<Point<f32, D>> {
    points.iter().map(|point| Point::from(vector(point))).collect()
}

fn shape<R: Dimension<D>, const D: usize>(form: &Form<D>) -> ShapeHandle<f32, D>
where
    f32: Space<D>,
{
    let point = |at: &[f64; D]| Point::from(vector(at));
    match form {
        Form::Ball(radius) => ShapeHandle::new(Ball::new(*radius as f32)),
        Form::Cuboid(half_extents) => ShapeHandle::new(Cuboid::new(vector(half_extents))),
        Form::RoundCuboid { half_extents, radius } => {
            ShapeHandle::new(Rounded::new(Cuboid::new(vector(half_extents)), *radius as f32))
        }
        Form::Capsule { half_height, radius } => {
            ShapeHandle::new(Capsule::new(*half_height as f32, *radius as f32))
        }
        Form::Segment([a, b]) => ShapeHandle::new(Segment::new(point(a), point(b))),
        Form::Triangle([a, b, c]) => ShapeHandle::new(Triangle::new(point(a), point(b), point(c))),
        Form::HalfSpace => ShapeHandle::new(Plane::new(Unit::new_unchecked(vector(&up::<D>())))),
        other => R::particular(other),
    }
}

/// Returns a function that computes the signed distance of two placed solids. The placements for
/// all contenders are found with it.
pub fn judge<R: Dimension<D>, const D: usize>(
    pair: &Pair<D>,
) -> impl Fn(&Placement<D>, &Placement<D>) -> f64 + use<R, D>
where
    f32: Space<D, Isometry = Isometry<f32, R, D>>,
{
    let [shape1, shape2] = pair.forms().map(shape::<R, D>);
    move |at1, at2| {
        let (at1, at2) = (R::isometry(at1), R::isometry(at2));
        let found = contact(&at1, &*shape1, &at2, &*shape2, 0.0);
        let apart = || distance(&at1, &*shape1, &at2, &*shape2);
        f64::from(found.map_or_else(apart, |found| -found.depth))
    }
}

/// The two shapes of a case and all of their placements.
struct Data<R: Dimension<D>, const D: usize> {
    shapes: [ShapeHandle<f32, D>; 2],
    is_ground: bool,
    first: Vec<Isometry<f32, R, D>>,
    second: [Vec<Isometry<f32, R, D>>; 2],
    moved: Vec<Vec<Isometry<f32, R, D>>>,
    velocities: Vec<Vector<f32, D>>,
}

impl<R: Dimension<D>, const D: usize> Data<R, D>
where
    f32: Space<D>,
{
    fn new(pair: &Pair<D>, poses: &Poses<D>) -> Self {
        let all = |set: &Vec<Placement<D>>| set.iter().map(R::isometry).collect::<Vec<_>>();
        Self {
            shapes: pair.forms().map(shape::<R, D>),
            is_ground: poses.is_ground,
            first: all(&poses.first),
            second: poses.second.each_ref().map(all),
            moved: poses.moved.iter().map(all).collect(),
            velocities: poses.velocities.iter().map(vector).collect(),
        }
    }

    fn second(&self, stand: Stand) -> &[Isometry<f32, R, D>] {
        match stand {
            Stand::Set(n) => &self.second[n],
            Stand::Moved(n) => &self.moved[n],
        }
    }
}

/// The contender with single calls: the queries, and manifolds of a generator for each pair.
pub struct Alone<R: Dimension<D>, const D: usize> {
    data: Data<R, D>,
    /// An empty generator, which is copied where a case begins with new generators.
    fresh: PairManifoldGenerator<f32, D>,
    is_reusing: bool,
    generators: Vec<PairManifoldGenerator<f32, D>>,
    ids: IdAllocator,
    answers: Vec<Answer>,
    round: usize,
}

impl<R: Dimension<D>, const D: usize> Alone<R, D>
where
    f32: Space<D, Isometry = Isometry<f32, R, D>>,
{
    pub fn new(pair: &Pair<D>, poses: &Poses<D>) -> Self {
        Self {
            data: Data::new(pair, poses),
            fresh: PairManifoldGenerator::default(),
            is_reusing: false,
            generators: Vec::new(),
            ids: IdAllocator::new(),
            answers: Vec::new(),
            round: 0,
        }
    }

    /// Creates the contender in which a pair keeps its contacts until it has moved by
    /// [`TOLERANCE`].
    pub fn reusing(pair: &Pair<D>, poses: &Poses<D>) -> Self {
        let fresh = PairManifoldGenerator::default().reusing(TOLERANCE);
        Self { fresh, is_reusing: true, ..Self::new(pair, poses) }
    }

    fn ask_all(
        &mut self,
        ask: impl Fn(
            &Isometry<f32, R, D>,
            &dyn Shape<f32, D>,
            &Isometry<f32, R, D>,
            &dyn Shape<f32, D>,
        ) -> Answer,
    ) {
        let Data { shapes: [shape1, shape2], first, second, .. } = &self.data;
        self.answers.clear();
        let placed = first.iter().zip(&second[0]);
        self.answers.extend(placed.map(|(at1, at2)| ask(at1, &**shape1, at2, &**shape2)));
    }

    fn impacts(&mut self) {
        let Data { shapes: [shape1, shape2], first, second, velocities, .. } = &self.data;
        let options = ImpactOptions::new().with_max_time(LONGEST_TIME);
        self.answers.clear();
        for ((at1, at2), velocity) in first.iter().zip(&second[0]).zip(velocities) {
            let still = Moving::still(at1, &**shape1);
            let moving = Moving::new(at2, velocity, &**shape2);
            let found = impact(&still, &moving, &options);
            self.answers.push(found.map_or(Answer::NONE, |found| Answer(found.toi)));
        }
    }

    fn manifolds(&mut self, question: Question) {
        let at2 = self.data.second(stand(question, self.round));
        let [shape1, shape2] = &self.data.shapes;
        let dispatcher = DefaultContactDispatcher::<D>::new();
        let prediction = ContactPrediction::new(PREDICTION, 0.0, 0.0);
        for ((at1, at2), generator) in self.data.first.iter().zip(at2).zip(&mut self.generators) {
            if question == Question::ManifoldCold {
                *generator = PairManifoldGenerator::default();
            }
            let (ids, shapes) = (&mut self.ids, (&**shape1, &**shape2));
            generator.update(&dispatcher, at1, shapes.0, at2, shapes.1, &prediction, ids);
        }
        self.round += 1;
    }
}

impl<R: Dimension<D>, const D: usize> Contender for Alone<R, D>
where
    f32: Space<D, Isometry = Isometry<f32, R, D>>,
{
    fn name(&self) -> &'static str {
        if self.is_reusing { ALONE_REUSING } else { ALONE }
    }

    fn treats(&self, question: Question) -> bool {
        !self.is_reusing || question == Question::ManifoldWarm
    }

    fn reset(&mut self, _: Question) {
        self.generators = vec![self.fresh.clone(); self.data.first.len()];
        self.round = 0;
    }

    fn ask(&mut self, question: Question) {
        match question {
            Question::Distance => self.ask_all(|m1, g1, m2, g2| Answer(distance(m1, g1, m2, g2))),
            Question::Contact => self.ask_all(|m1, g1, m2, g2| {
                let found = contact(m1, g1, m2, g2, PREDICTION);
                found.map_or(Answer::NONE, |found| Answer(-found.depth))
            }),
            Question::Proximity => self.ask_all(|m1, g1, m2, g2| {
                Answer::touching(proximity(m1, g1, m2, g2, 0.0) == Proximity::Intersecting)
            }),
            Question::Impact => self.impacts(),
            _ => self.manifolds(question),
        }
    }

    fn answers(&self, question: Question) -> Vec<Answer> {
        if !question.is_manifold() {
            return self.answers.clone();
        }
        let of = |generator: &PairManifoldGenerator<f32, D>| {
            let mut manifolds = Vec::new();
            generator.contacts(&mut manifolds);
            let contacts = manifolds.iter().flat_map(|manifold| manifold.contacts());
            Answer::deepest(contacts.map(|tracked| -tracked.contact.depth))
        };
        self.generators.iter().map(of).collect()
    }
}

/// The contender with one world that contains all pairs of a case.
pub struct World<R: Dimension<D>, const D: usize>
where
    f32: Space<D, Isometry = Isometry<f32, R, D>>,
{
    data: Data<R, D>,
    world: CollisionWorld<f32, D, usize>,
    second: Vec<CollisionObjectHandle>,
    is_reusing: bool,
    round: usize,
    /// The clock of the narrow phase, and its time in each round.
    clock: Clock,
    narrow: Times,
}

impl<R: Dimension<D>, const D: usize> World<R, D>
where
    f32: Space<D, Isometry = Isometry<f32, R, D>>,
{
    pub fn new(pair: &Pair<D>, poses: &Poses<D>) -> Self {
        let data = Data::new(pair, poses);
        let clock = Clock::default();
        let (world, second) = filled(&data, &clock, DefaultNarrowPhase::new());
        let narrow = Times::default();
        Self { data, world, second, is_reusing: false, round: 0, clock, narrow }
    }

    /// Creates the contender in which a pair keeps its contacts until it has moved by
    /// [`TOLERANCE`].
    pub fn reusing(pair: &Pair<D>, poses: &Poses<D>) -> Self {
        Self { is_reusing: true, ..Self::new(pair, poses) }
    }
}

/// Creates a world with the first solids, and with the second solids at the first set of their
/// placements. By their groups, first solids collide with second solids only. Returns the world and
/// the handles of the second solids.
fn filled<R: Dimension<D>, const D: usize>(
    data: &Data<R, D>,
    clock: &Clock,
    narrow_phase: DefaultNarrowPhase<f32, D>,
) -> (CollisionWorld<f32, D, usize>, Vec<CollisionObjectHandle>)
where
    f32: Space<D, Isometry = Isometry<f32, R, D>>,
{
    let mut world = CollisionWorld::new(MARGIN);
    world.set_narrow_phase(Box::new(Clocked::new(narrow_phase, clock.clone())));
    let query = GeometricQueryType::Contacts(PREDICTION / 2.0, 0.0);
    let groups = |own: usize| {
        let mut groups = CollisionGroups::new();
        groups.set_membership(&[own]);
        groups.set_whitelist(&[1 - own]);
        groups
    };
    let firsts = if data.is_ground { 1 } else { data.first.len() };
    for (n, at) in data.first.iter().take(firsts).enumerate() {
        world.add(*at, data.shapes[0].clone(), groups(0), query, n);
    }
    let mut add = |(n, at): (usize, &Isometry<f32, R, D>)| {
        world.add(*at, data.shapes[1].clone(), groups(1), query, n)
    };
    let second = data.second[0].iter().enumerate().map(&mut add).collect();
    world.update();
    (world, second)
}

impl<R: Dimension<D>, const D: usize> Contender for World<R, D>
where
    f32: Space<D, Isometry = Isometry<f32, R, D>>,
{
    fn name(&self) -> &'static str {
        if self.is_reusing { "impinge reusing" } else { "impinge world" }
    }

    fn treats(&self, question: Question) -> bool {
        question.is_manifold() && (!self.is_reusing || question == Question::ManifoldWarm)
    }

    fn reset(&mut self, _: Question) {
        let mut narrow_phase = DefaultNarrowPhase::new();
        if self.is_reusing {
            narrow_phase = narrow_phase.reusing(TOLERANCE);
        }
        (self.world, self.second) = filled(&self.data, &self.clock, narrow_phase);
        self.round = 0;
        self.narrow = Times::default();
    }

    fn ask(&mut self, question: Question) {
        let at2 = self.data.second(stand(question, self.round));
        for (handle, at) in self.second.iter().zip(at2) {
            self.world.set_position(*handle, *at);
        }
        self.world.update();
        if self.round > 0 {
            self.narrow.push(self.clock.read() / self.second.len() as f64);
        }
        self.round += 1;
    }

    fn part(&self) -> Option<(&'static str, Times)> {
        let part = if self.is_reusing { REUSING_PART } else { PART };
        Some((part, self.narrow.clone()))
    }

    fn answers(&self, _: Question) -> Vec<Answer> {
        let mut answers = vec![Answer::NONE; self.second.len()];
        for (_, second, manifold) in self.world.contact_manifolds() {
            let distances = manifold.contacts().iter().map(|tracked| -tracked.contact.depth);
            let answer = &mut answers[*second.data()];
            *answer = Answer::deepest(distances.chain([answer.0]));
        }
        answers
    }
}
