// Source shared by the modules for both crates of ncollide; included by `ncollide.rs`.

use std::time::{Duration, Instant};

use ncollide::math::{Isometry, Point, Translation, Vector};
use ncollide::na::Unit;
use ncollide::narrow_phase::{
    ContactAlgorithm, ContactDispatcher, DefaultContactDispatcher,
};
use ncollide::query::{
    ContactManifold, ContactPrediction, DefaultTOIDispatcher, Proximity, contact, distance,
    proximity, time_of_impact,
};
use ncollide::shape::{Ball, Capsule, Cuboid, Plane, Segment, Shape, ShapeHandle};

use super::super::form::{Form, up};
use super::super::placement::Placement;
use super::super::question::{
    Answer, Contender, LONGEST_TIME, PREDICTION, Question, Stand, stand,
};
use super::super::regime::{Pair, Poses};

/// The time limit of a round of single queries. For two terrains ncollide takes minutes in some
/// cases; such a round is aborted.
const PATIENCE: Duration = Duration::from_millis(500);

/// The number of pairs between two checks of the time limit. The first check follows the first
/// pair.
const AT_A_LOOK: usize = 16;

/// A solid with its position.
type Placed<'a> = (&'a Isometry<f32>, &'a dyn Shape<f32>);

/// The contact algorithm and the manifold that ncollide keeps for a pair.
struct Kept {
    algorithm: ContactAlgorithm<f32>,
    manifold: ContactManifold<f32>,
}

/// The contender: all placements of a case, and the state of the pairs.
pub struct Ncollide {
    shapes: [ShapeHandle<f32>; 2],
    first: Vec<Isometry<f32>>,
    second: [Vec<Isometry<f32>>; 2],
    moved: Vec<Vec<Isometry<f32>>>,
    velocities: Vec<Vector<f32>>,
    kept: Vec<Option<Kept>>,
    answers: Vec<Answer>,
    round: usize,
}

fn point(at: &[f64; DIM]) -> Point<f32> {
    Point::from(vector(at))
}

fn cloud(points: &[[f64; DIM]]) -> Vec<Point<f32>> {
    points.iter().map(point).collect()
}

fn shape(form: &Form<DIM>) -> Option<ShapeHandle<f32>> {
    Some(match form {
        Form::Ball(radius) => ShapeHandle::new(Ball::new(*radius as f32)),
        Form::Cuboid(half_extents) => ShapeHandle::new(Cuboid::new(vector(half_extents))),
        Form::Capsule { half_height, radius } => {
            ShapeHandle::new(Capsule::new(*half_height as f32, *radius as f32))
        }
        Form::Segment([a, b]) => ShapeHandle::new(Segment::new(point(a), point(b))),
        Form::HalfSpace => ShapeHandle::new(Plane::new(Unit::new_unchecked(vector(&up::<DIM>())))),
        other => return particular(other),
    })
}

/// Returns the algorithm for two shapes with an empty manifold, as the narrow phase of ncollide
/// creates it. `None` if there is no algorithm.
fn fresh(shape1: &dyn Shape<f32>, shape2: &dyn Shape<f32>) -> Option<Kept> {
    let algorithm = DefaultContactDispatcher::new().get_contact_algorithm(shape1, shape2)?;
    let manifold = algorithm.init_manifold();
    Some(Kept { algorithm, manifold })
}

impl Ncollide {
    /// Creates the contender; `None` if ncollide lacks one of the shapes.
    pub fn new(pair: &Pair<DIM>, poses: &Poses<DIM>) -> Option<Self> {
        let [first, second] = pair.forms().map(shape);
        let all = |set: &Vec<Placement<DIM>>| set.iter().map(isometry).collect::<Vec<_>>();
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

    /// Computes the results of all pairs. After [`PATIENCE`] the remaining pairs are reported as
    /// unsupported.
    fn ask_all(&mut self, ask: impl Fn(&Self, usize) -> Answer) {
        let (begun, all) = (Instant::now(), self.first.len());
        let mut next = 1;
        self.answers.clear();
        while self.answers.len() < all && begun.elapsed() < PATIENCE {
            for n in self.answers.len()..next {
                let answer = ask(self, n);
                self.answers.push(answer);
            }
            next = all.min(next + AT_A_LOOK);
        }
        self.answers.resize(all, Answer::UNSUPPORTED);
    }

    /// Runs a query that depends only on the shapes and positions of two solids.
    fn ask_of_places(&mut self, ask: impl Fn(&Placed<'_>, &Placed<'_>) -> Answer) {
        self.ask_all(|own, n| {
            let [shape1, shape2] = &own.shapes;
            ask(&(&own.first[n], &**shape1), &(&own.second[0][n], &**shape2))
        });
    }

    fn impacts(&mut self) {
        let (still, by) = (Vector::zeros(), &DefaultTOIDispatcher);
        self.ask_all(|own, n| {
            let (g1, g2) = (&*own.shapes[0], &*own.shapes[1]);
            let (at1, at2, velocity) = (&own.first[n], &own.second[0][n], &own.velocities[n]);
            let longest = LONGEST_TIME;
            let found = time_of_impact(by, at1, &still, g1, at2, velocity, g2, longest, 0.0);
            let time = found.map(|hit| hit.map_or(Answer::NONE, |hit| Answer(hit.toi)));
            time.unwrap_or(Answer::UNSUPPORTED)
        });
    }

    fn manifolds(&mut self, question: Question) {
        let at2 = match stand(question, self.round) {
            Stand::Set(n) => &self.second[n],
            Stand::Moved(n) => &self.moved[n],
        };
        let (g1, g2) = (&*self.shapes[0], &*self.shapes[1]);
        let (dispatcher, prediction) =
            (DefaultContactDispatcher::new(), ContactPrediction::new(PREDICTION, 0.0, 0.0));
        for ((at1, at2), kept) in self.first.iter().zip(at2).zip(&mut self.kept) {
            if question == Question::ManifoldCold {
                *kept = fresh(g1, g2);
            }
            let Some(Kept { algorithm, manifold }) = kept else { continue };
            manifold.save_cache_and_clear();
            algorithm
                .generate_contacts(&dispatcher, at1, g1, None, at2, g2, None, &prediction, manifold);
        }
        self.round += 1;
    }
}

impl Contender for Ncollide {
    fn name(&self) -> &'static str {
        "ncollide"
    }

    fn treats(&self, _: Question) -> bool {
        true
    }

    fn reset(&mut self, _: Question) {
        let [shape1, shape2] = &self.shapes;
        self.kept = self.first.iter().map(|_| fresh(&**shape1, &**shape2)).collect();
        self.round = 0;
    }

    fn ask(&mut self, question: Question) {
        match question {
            Question::Distance => {
                self.ask_of_places(|(at1, g1), (at2, g2)| Answer(distance(at1, *g1, at2, *g2)));
            }
            Question::Contact => self.ask_of_places(|(at1, g1), (at2, g2)| {
                let found = contact(at1, *g1, at2, *g2, PREDICTION);
                found.map_or(Answer::NONE, |found| Answer(-found.depth))
            }),
            Question::Proximity => self.ask_of_places(|(at1, g1), (at2, g2)| {
                Answer::touching(proximity(at1, *g1, at2, *g2, 0.0) == Proximity::Intersecting)
            }),
            Question::Impact => self.impacts(),
            _ => self.manifolds(question),
        }
    }

    fn answers(&self, question: Question) -> Vec<Answer> {
        if !question.is_manifold() {
            return self.answers.clone();
        }
        let of = |kept: &Option<Kept>| {
            let Some(kept) = kept else { return Answer::UNSUPPORTED };
            Answer::deepest(kept.manifold.contacts().map(|tracked| -tracked.contact.depth))
        };
        self.kept.iter().map(of).collect()
    }
}
