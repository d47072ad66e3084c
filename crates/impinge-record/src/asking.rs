//! Runs queries on a recorded world, and records them.

use impinge::world::CollisionObject;

use crate::RecordData;
use crate::call::Call;
use crate::error::RecordError;
use crate::query::{CastQuestion, Found, PlacedShape, Query, Question, answer_hash};
use crate::question_data::{CastData, QueryData, QuestionData};
use crate::recorder::{Recorder, index_of};
use crate::space::Recordable;

/// Methods that run a query by [`Query::ask`] and record it with a hash of its result.
impl<N: Recordable<D>, const D: usize, T: RecordData> Recorder<N, D, T> {
    /// Runs a query and records the hash of its result.
    ///
    /// # Errors
    /// If a shape of the query cannot be written.
    pub fn ask(&mut self, query: &Query<N, D>) -> Result<Vec<Found<N, D>>, RecordError> {
        let question = self.question(&query.question)?;
        let living = query.excluded.iter().filter(|handle| self.contains(**handle));
        let excluded = living.copied().map(index_of).collect();
        let answer = query.ask(&**self);
        let (groups, hash) = (query.groups, answer_hash(&answer));
        let data = QueryData { question, groups, excluded, answer: hash };
        self.record(&Call::Query(Box::new(data)));
        Ok(answer)
    }

    /// Runs a query about the objects that satisfy a predicate. Predicates are code and cannot be
    /// recorded. Instead the recording lists the objects that do not satisfy the predicate as
    /// excluded.
    ///
    /// Calls the predicate once for each object of the world. The recording gets four bytes for
    /// each excluded object.
    ///
    /// # Errors
    /// If a shape of the query cannot be written.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point};
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, GeometricQueryType};
    /// use impinge_record::{Query, Question, Recorder, Registry};
    ///
    /// let mut recorder = Recorder::new(0.02_f32, Registry::<f32, 2, u32>::new())?;
    /// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
    /// for id in 0..4 {
    ///     recorder.add(Isometry::identity(), ball.clone(), CollisionGroups::new(), query, id)?;
    /// }
    /// let query = Query::new(Question::Containing(Point::new(0.5, 0.0)));
    /// assert_eq!(recorder.ask_where(&query, |object| *object.data() >= 3)?.len(), 1);
    /// # Ok::<(), impinge_record::RecordError>(())
    /// ```
    pub fn ask_where(
        &mut self,
        query: &Query<N, D>,
        mut accepts: impl FnMut(&CollisionObject<N, D, T>) -> bool,
    ) -> Result<Vec<Found<N, D>>, RecordError> {
        let mut query = query.clone();
        let others = self.collision_objects().filter(|object| !accepts(object));
        query.excluded.extend(others.map(CollisionObject::handle));
        self.ask(&query)
    }

    fn question(&mut self, question: &Question<N, D>) -> Result<QuestionData<N, D>, RecordError> {
        let is_about_all = matches!(question, Question::RayHits(_) | Question::CastShapeAll(_));
        Ok(match question {
            Question::FirstRayHit(asked) | Question::RayHits(asked) => QuestionData::Ray {
                all: is_about_all,
                ray: asked.ray,
                max_time: asked.max_time,
                solid: asked.solid,
            },
            Question::Containing(point) => QuestionData::Containing(*point),
            Question::ProjectPoint { point, max_distance, solid } => {
                QuestionData::Project { point: *point, max_distance: *max_distance, solid: *solid }
            }
            Question::InAabb(aabb) => QuestionData::InAabb(*aabb),
            Question::Overlapping(PlacedShape { position, shape }) => {
                QuestionData::Overlapping { position: *position, shape: self.number(shape)? }
            }
            Question::Nearest { from, count, max_distance } => QuestionData::Nearest {
                position: from.position,
                shape: self.number(&from.shape)?,
                count: *count,
                max_distance: *max_distance,
            },
            Question::CastShape(cast) | Question::CastShapeAll(cast) => {
                QuestionData::Cast(self.cast(cast, is_about_all)?)
            }
        })
    }

    fn cast(
        &mut self,
        cast: &CastQuestion<N, D>,
        all: bool,
    ) -> Result<CastData<N, D>, RecordError> {
        Ok(CastData {
            all,
            position: cast.start.position,
            shape: self.number(&cast.start.shape)?,
            velocity: cast.velocity,
            options: cast.options,
        })
    }
}
