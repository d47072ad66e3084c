//! Queries of Coal, in `f64`, its only scalar here.
//!
//! All pairs of a round are computed in one call from C++, with functors (`ComputeDistance` and
//! others) that are created once for the two shapes. A contact comes from `collide` with the
//! prediction as security margin; for a mesh all contacts are computed. For a manifold,
//! `ComputeContactPatch` also computes the contact polygons.

use impinge_compare_c::{CoalPairs, CoalPose, CoalSolid};

use super::form::{Form, up};
use super::placement::Placement;
use super::question::{Answer, Contender, PREDICTION, Question, Stand, stand};
use super::regime::{Pair, Poses};

/// Converts a solid. `None` for segments and polylines, which Coal lacks, for triangles, which it
/// has only as parts of meshes, and for height fields, whose frame differs.
fn solid(form: &Form<3>) -> Option<CoalSolid> {
    Some(match form {
        Form::Ball(radius) => CoalSolid::ball(*radius),
        Form::Cuboid(half_extents) => CoalSolid::cuboid(half_extents, 0.0),
        Form::RoundCuboid { half_extents, radius } => CoalSolid::cuboid(half_extents, *radius),
        Form::Capsule { half_height, radius } => CoalSolid::capsule(*half_height, *radius),
        Form::Cylinder { half_height, radius } => CoalSolid::cylinder(*half_height, *radius),
        Form::Cone { half_height, radius } => CoalSolid::cone(*half_height, *radius),
        Form::Convex(points) => CoalSolid::hull(points),
        Form::HalfSpace => CoalSolid::half_space(&up()),
        Form::Mesh(terrain) => CoalSolid::mesh(&terrain.vertices(), &terrain.triangles()),
        Form::Segment(_) | Form::Triangle(_) | Form::HeightField(_) | Form::Polyline(_) => {
            return None;
        }
    })
}

fn pose(Placement { translation: [x, y, z], rotation: [i, j, k, w] }: &Placement<3>) -> CoalPose {
    [*x, *y, *z, *i, *j, *k, *w]
}

/// The contender Coal with the pairs of a case. The sets of placements of the second solid are
/// numbered: first the two unrelated sets, then the slightly moved ones.
pub struct Coal {
    pairs: CoalPairs,
    found: Vec<f32>,
    round: usize,
}

impl Coal {
    /// Creates the contender; `None` if Coal lacks one of the shapes.
    pub fn new(pair: &Pair<3>, poses: &Poses<3>) -> Option<Self> {
        let [first, second] = pair.forms().map(solid);
        let all = |set: &Vec<Placement<3>>| set.iter().map(pose).collect::<Vec<_>>();
        let sets: Vec<_> = poses.second.iter().chain(&poses.moved).map(all).collect();
        let pairs = CoalPairs::new(&[first?, second?], &all(&poses.first), &sets)?;
        Some(Self { pairs, found: Vec::new(), round: 0 })
    }

    fn manifolds(&mut self, question: Question) {
        let set = match stand(question, self.round) {
            Stand::Set(n) => n,
            Stand::Moved(n) => 2 + n,
        };
        self.pairs.patches(set);
        self.round += 1;
    }
}

impl Contender for Coal {
    fn name(&self) -> &'static str {
        "coal f64"
    }

    fn treats(&self, question: Question) -> bool {
        question != Question::Impact
    }

    fn reset(&mut self, question: Question) {
        let margin = if question == Question::Proximity { 0.0 } else { PREDICTION };
        let is_warm = question.is_manifold() && question != Question::ManifoldCold;
        self.pairs.reset(f64::from(margin), is_warm);
        self.round = 0;
    }

    fn ask(&mut self, question: Question) {
        match question {
            Question::Distance => self.pairs.distances(0, &mut self.found),
            Question::Contact | Question::Proximity => self.pairs.contacts(0, &mut self.found),
            _ => self.manifolds(question),
        }
    }

    fn answers(&self, question: Question) -> Vec<Answer> {
        let mut found = self.found.clone();
        if question.is_manifold() {
            self.pairs.deepest(&mut found);
        }
        let answer = |found: f32| match question {
            _ if found.is_nan() => Answer::UNSUPPORTED,
            Question::Distance => Answer(found),
            Question::Proximity => Answer::touching(found.is_finite()),
            _ => Answer::deepest(std::iter::once(found)),
        };
        found.into_iter().map(answer).collect()
    }
}
