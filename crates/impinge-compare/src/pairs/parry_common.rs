// Source shared by the modules for both crates of parry; included by `parry.rs`.

use parry::math::{Pose, Rotation, Vector};
use parry::query::details::ShapeCastOptions;
use parry::query::{
    ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher, Unsupported, cast_shapes,
    contact, distance, intersection_test,
};
use parry::shape::{Shape, SharedShape};

use super::super::form::{Form, up};
use super::super::placement::Placement;
use super::super::question::{
    Answer, Contender, LONGEST_TIME, PREDICTION, Question, Stand, stand,
};
use super::super::regime::{Pair, Poses};

/// The manifolds and the workspace that parry keeps for a pair.
#[derive(Default)]
struct Kept {
    manifolds: Vec<ContactManifold<(), ()>>,
    workspace: Option<ContactManifoldsWorkspace>,
}

/// The contender: all placements of a case, and the state of the pairs.
pub struct Parry {
    shapes: [SharedShape; 2],
    first: Vec<Pose>,
    second: [Vec<Pose>; 2],
    moved: Vec<Vec<Pose>>,
    velocities: Vec<Vector>,
    kept: Vec<Kept>,
    answers: Vec<Answer>,
    round: usize,
}

fn cloud(points: &[[f64; DIM]]) -> Vec<Vector> {
    points.iter().map(vector).collect()
}

fn shape(form: &Form<DIM>) -> Option<SharedShape> {
    Some(match form {
        Form::Ball(radius) => SharedShape::ball(*radius as f32),
        Form::Cuboid(half_extents) => {
            SharedShape::new(parry::shape::Cuboid::new(vector(half_extents)))
        }
        Form::Capsule { half_height, radius } => {
            SharedShape::capsule_y(*half_height as f32, *radius as f32)
        }
        Form::Segment([a, b]) => SharedShape::segment(vector(a), vector(b)),
        Form::Triangle([a, b, c]) => SharedShape::triangle(vector(a), vector(b), vector(c)),
        Form::Convex(points) => SharedShape::convex_hull(&cloud(points))?,
        Form::HalfSpace => SharedShape::halfspace(vector(&up::<DIM>())),
        other => return particular(other),
    })
}

impl Parry {
    /// Creates the contender; `None` if parry lacks one of the shapes.
    pub fn new(pair: &Pair<DIM>, poses: &Poses<DIM>) -> Option<Self> {
        let [first, second] = pair.forms().map(shape);
        let all = |set: &Vec<Placement<DIM>>| set.iter().map(pose).collect::<Vec<_>>();
        Some(Self {
            shapes: [first?, second?],
            first: all(&poses.first),
            second: poses.second.each_ref().map(all),
            moved: poses.moved.iter().map(all).collect(),
            velocities: poses.velocities.iter().map(vector).collect(),
            kept: Vec::new(),
            answers: Vec::new(),
            round: 0,
        })
    }

    fn ask_all(
        &mut self,
        ask: impl Fn(&Pose, &dyn Shape, &Pose, &dyn Shape) -> Result<Answer, Unsupported>,
    ) {
        let [shape1, shape2] = &self.shapes;
        self.answers.clear();
        for (at1, at2) in self.first.iter().zip(&self.second[0]) {
            let answer = ask(at1, &**shape1, at2, &**shape2);
            self.answers.push(answer.unwrap_or(Answer::UNSUPPORTED));
        }
    }

    fn impacts(&mut self) {
        let [shape1, shape2] = &self.shapes;
        let options = ShapeCastOptions::with_max_time_of_impact(LONGEST_TIME);
        self.answers.clear();
        for ((at1, at2), velocity) in self.first.iter().zip(&self.second[0]).zip(&self.velocities) {
            let still = Vector::ZERO;
            let found = cast_shapes(at1, still, &**shape1, at2, *velocity, &**shape2, options);
            let time = found.map(|hit| hit.map_or(Answer::NONE, |hit| Answer(hit.time_of_impact)));
            self.answers.push(time.unwrap_or(Answer::UNSUPPORTED));
        }
    }

    fn manifolds(&mut self, question: Question) {
        let at2 = match stand(question, self.round) {
            Stand::Set(n) => &self.second[n],
            Stand::Moved(n) => &self.moved[n],
        };
        let [shape1, shape2] = &self.shapes;
        self.answers.clear();
        for ((at1, at2), kept) in self.first.iter().zip(at2).zip(&mut self.kept) {
            if question == Question::ManifoldCold {
                *kept = Kept::default();
            }
            let (pos12, Kept { manifolds, workspace }) = (at1.inv_mul(at2), kept);
            let (g1, g2) = (&**shape1, &**shape2);
            let found = DefaultQueryDispatcher
                .contact_manifolds(&pos12, g1, g2, PREDICTION, manifolds, workspace);
            self.answers.extend(found.err().map(|_| Answer::UNSUPPORTED));
        }
        self.round += 1;
    }
}

impl Contender for Parry {
    fn name(&self) -> &'static str {
        "parry"
    }

    fn treats(&self, _: Question) -> bool {
        true
    }

    fn reset(&mut self, _: Question) {
        self.kept = self.first.iter().map(|_| Kept::default()).collect();
        self.round = 0;
    }

    fn ask(&mut self, question: Question) {
        match question {
            Question::Distance => self.ask_all(|at1, g1, at2, g2| {
                distance(at1, g1, at2, g2).map(|found| Answer(found.distance))
            }),
            Question::Contact => self.ask_all(|at1, g1, at2, g2| {
                let found = contact(at1, g1, at2, g2, PREDICTION)?;
                Ok(found.map_or(Answer::NONE, |found| Answer(found.dist)))
            }),
            Question::Proximity => self.ask_all(|at1, g1, at2, g2| {
                let found = intersection_test(at1, g1, at2, g2)?;
                Ok(Answer::touching(found.intersecting))
            }),
            Question::Impact => self.impacts(),
            _ => self.manifolds(question),
        }
    }

    fn answers(&self, question: Question) -> Vec<Answer> {
        if !question.is_manifold() || !self.answers.is_empty() {
            return self.answers.clone();
        }
        let of = |kept: &Kept| {
            let points = kept.manifolds.iter().flat_map(|manifold| &manifold.points);
            Answer::deepest(points.map(|point| point.dist))
        };
        self.kept.iter().map(of).collect()
    }
}
