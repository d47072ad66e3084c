//! Queries in the form of records: shapes are indices.

use impinge::bounding_volume::{Aabb, Ray};
use impinge::math::{Point, Space, Vector};
use impinge::query::ImpactOptions;
use impinge::world::CollisionGroups;

use crate::bytes::{Sink, Source};
use crate::error::{Problem, ReadError};
use crate::space::Recordable;

/// A query whose shapes and objects are indices in the recording.
#[derive(Clone, Debug)]
pub(crate) struct QueryData<N: Space<D>, const D: usize> {
    /// The kind of the query with its arguments.
    pub(crate) question: QuestionData<N, D>,
    pub(crate) groups: Option<CollisionGroups>,
    /// The indices of the excluded objects; stale handles are omitted.
    pub(crate) excluded: Vec<u32>,
    /// The hash of the result.
    pub(crate) answer: u64,
}

/// A [`Question`](crate::Question) whose shape is an index in the recording.
#[derive(Clone, Debug)]
pub(crate) enum QuestionData<N: Space<D>, const D: usize> {
    /// A ray cast for the first hit, or for all hits.
    Ray {
        all: bool,
        ray: Ray<N, D>,
        max_time: N,
        solid: bool,
    },
    Containing(Point<N, D>),
    Project {
        point: Point<N, D>,
        max_distance: N,
        solid: bool,
    },
    InAabb(Aabb<N, D>),
    Overlapping {
        position: N::Isometry,
        shape: u32,
    },
    Nearest {
        position: N::Isometry,
        shape: u32,
        count: u32,
        max_distance: N,
    },
    Cast(CastData<N, D>),
}

/// A shape cast.
#[derive(Clone, Debug)]
pub(crate) struct CastData<N: Space<D>, const D: usize> {
    pub(crate) all: bool,
    pub(crate) position: N::Isometry,
    pub(crate) shape: u32,
    pub(crate) velocity: Vector<N, D>,
    pub(crate) options: ImpactOptions<N>,
}

/// Writes the fields of queries.
impl Sink {
    pub(crate) fn query<N: Recordable<D>, const D: usize>(&mut self, query: &QueryData<N, D>) {
        self.question(&query.question);
        self.flag(query.groups.is_some());
        query.groups.iter().for_each(|groups| self.groups(groups));
        self.count(query.excluded.len());
        self.words(&query.excluded);
        self.long(query.answer);
    }

    /// Writes the kind of a query, then its arguments.
    fn question<N: Recordable<D>, const D: usize>(&mut self, question: &QuestionData<N, D>) {
        match question {
            QuestionData::Ray { all, ray, max_time, solid } => {
                self.byte(u8::from(*all));
                self.points(&[ray.origin]);
                self.numbers(ray.dir.as_slice());
                self.number(*max_time);
                self.flag(*solid);
            }
            QuestionData::Containing(point) => {
                self.byte(2);
                self.points(&[*point]);
            }
            QuestionData::Project { point, max_distance, solid } => {
                self.byte(3);
                self.points(&[*point]);
                self.number(*max_distance);
                self.flag(*solid);
            }
            QuestionData::InAabb(aabb) => {
                self.byte(4);
                self.points(&[*aabb.mins(), *aabb.maxs()]);
            }
            QuestionData::Overlapping { position, shape } => {
                self.byte(5);
                self.isometry::<N, D>(position);
                self.word(*shape);
            }
            QuestionData::Nearest { position, shape, count, max_distance } => {
                self.byte(6);
                self.isometry::<N, D>(position);
                self.words(&[*shape, *count]);
                self.number(*max_distance);
            }
            QuestionData::Cast(cast) => self.cast(cast),
        }
    }

    /// Writes a shape cast. Without a tolerance a zero is written, so that the record has a fixed
    /// length.
    fn cast<N: Recordable<D>, const D: usize>(&mut self, cast: &CastData<N, D>) {
        self.byte(if cast.all { 8 } else { 7 });
        self.isometry::<N, D>(&cast.position);
        self.word(cast.shape);
        self.numbers(cast.velocity.as_slice());
        self.numbers(&[cast.options.max_time, cast.options.target_distance]);
        self.flag(cast.options.tolerance.is_some());
        self.number(cast.options.tolerance.unwrap_or(N::ZERO));
        self.flag(cast.options.contact_at_start);
    }
}

/// Reads the fields of queries that [`Sink`] has written.
impl Source<'_> {
    pub(crate) fn query<N: Recordable<D>, const D: usize>(
        &mut self,
    ) -> Result<QueryData<N, D>, ReadError> {
        Ok(QueryData {
            question: self.question()?,
            groups: if self.flag()? { Some(self.groups()?) } else { None },
            excluded: self.list(4, Self::word)?,
            answer: self.long()?,
        })
    }

    fn question<N: Recordable<D>, const D: usize>(
        &mut self,
    ) -> Result<QuestionData<N, D>, ReadError> {
        let kind = self.choice(9, "the kind of a query")?;
        Ok(match kind {
            0 | 1 => QuestionData::Ray {
                all: kind == 1,
                ray: Ray::new(self.point()?, self.vector()?),
                max_time: self.number()?,
                solid: self.flag()?,
            },
            2 => QuestionData::Containing(self.point()?),
            3 => QuestionData::Project {
                point: self.point()?,
                max_distance: self.number()?,
                solid: self.flag()?,
            },
            4 => QuestionData::InAabb(self.aabb()?),
            5 => QuestionData::Overlapping {
                position: self.isometry::<N, D>()?,
                shape: self.word()?,
            },
            6 => QuestionData::Nearest {
                position: self.isometry::<N, D>()?,
                shape: self.word()?,
                count: self.word()?,
                max_distance: self.number()?,
            },
            _ => QuestionData::Cast(self.cast(kind == 8)?),
        })
    }

    /// Reads a box with ordered corners, or the unbounded box. The constructor with corners rejects
    /// the unbounded box, so this box is handled separately.
    fn aabb<N: Recordable<D>, const D: usize>(&mut self) -> Result<Aabb<N, D>, ReadError> {
        let error = self.error(Problem::BadValue { what: "a box" });
        let (mins, maxs) = (self.point()?, self.point()?);
        let is_everything =
            mins == *Aabb::<N, D>::unbounded().mins() && maxs == *Aabb::<N, D>::unbounded().maxs();
        if is_everything {
            return Ok(Aabb::unbounded());
        }
        Aabb::try_new(mins, maxs).map_err(|_| error)
    }

    fn cast<N: Recordable<D>, const D: usize>(
        &mut self,
        all: bool,
    ) -> Result<CastData<N, D>, ReadError> {
        let (position, shape) = (self.isometry::<N, D>()?, self.word()?);
        let (velocity, options) = (self.vector()?, ImpactOptions::new());
        let options = options.with_max_time(self.number()?).with_target_distance(self.number()?);
        let (has_tolerance, tolerance) = (self.flag()?, self.number()?);
        let options = if has_tolerance { options.with_tolerance(tolerance) } else { options };
        let options = options.with_contact_at_start(self.flag()?);
        Ok(CastData { all, position, shape, velocity, options })
    }
}
