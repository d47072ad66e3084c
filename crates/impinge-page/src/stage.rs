//! Stages: a recording or a sample, independent of scalar and dimension.

use impinge::debug_render::{DebugDrawing, DebugRender};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::{CollisionObject, CollisionWorld};
use impinge_record::RecordData;
use impinge_samples::{ControlValue, TIME_STEP};

use crate::EngineError;
use crate::answer::{
    Frame, Info, NearestAnswer, ObjectAnswer, PairAnswer, Picked, RayAnswer, Status,
};
use crate::ask;
use crate::describe::{object_answer, object_of};
use crate::explain::Two;
use crate::frame::picture::Picture;
use crate::request::{DragRequest, FrameRequest, NearestRequest, PickRequest, RayRequest};
use crate::space::{Viewed, unit_quaternion, vector};

/// The maximum number of steps that a message may request.
pub(crate) const MAX_STEPS: u64 = 10_000;

/// A stage of an engine. It has a method for each message of the page, independent of scalar and
/// dimension.
///
/// A method that fails has changed nothing, with one exception: if a sequence of steps fails
/// midway, the steps before the failure remain.
#[expect(clippy::missing_errors_doc, reason = "the variants of the error say when they are")]
pub trait Stage {
    /// Returns the description of the stage.
    fn info(&self) -> Info;

    /// Returns the state at the current step. It lists the controls of a sample only if one of them
    /// has a value that the page neither received nor set, and the notes of a recording only if the
    /// page has not received all of them.
    fn status(&mut self) -> Status;

    /// Appends bytes to a growing recording; an error for other stages.
    fn push(&mut self, bytes: &[u8]) -> Result<(), EngineError>;

    /// Goes to a step of a recording, or to its last step if it has fewer; an error for samples.
    fn seek(&mut self, step: usize) -> Result<(), EngineError>;

    /// Advances by `steps` steps. A recording advances at most to its last step.
    fn advance(&mut self, steps: u64) -> Result<(), EngineError>;

    /// Goes back to the start: the first update of a recording, step 0 of a sample.
    fn reset(&mut self) -> Result<(), EngineError>;

    /// Sets a control of a sample; an error for recordings.
    fn control(&mut self, name: &str, value: &ControlValue) -> Result<(), EngineError>;

    /// Draws a frame.
    fn frame(&mut self, asked: &FrameRequest) -> Result<Frame, EngineError>;

    /// Describes an object.
    fn object(&self, object: u32) -> Result<ObjectAnswer, EngineError>;

    /// Describes a pair of objects, and explains why they touch or do not.
    fn pair(&self, a: u32, b: u32) -> Result<PairAnswer, EngineError>;

    /// Returns the object at a point on the screen; see [`Picked`].
    fn pick(&self, at: &PickRequest) -> Picked;

    /// Returns the objects that a ray hits.
    fn ray(&self, asked: &RayRequest) -> RayAnswer;

    /// Returns the objects nearest to a point.
    fn nearest(&self, asked: &NearestRequest) -> NearestAnswer;

    /// Moves an object to a position that the user of the page has chosen, and updates the world.
    fn drag(&mut self, asked: &DragRequest) -> Result<(), EngineError>;
}

/// The part of a stage that differs between recordings and samples: the source of its world.
#[expect(clippy::missing_errors_doc, reason = "the variants of the error say when they are")]
pub trait Source<N: Viewed<D>, const D: usize> {
    /// The data of the objects.
    type Data: RecordData;

    /// Returns the world.
    fn world(&self) -> &CollisionWorld<N, D, Self::Data>;

    /// Returns the description of the stage. `Shown` adds the members that all stages have: the
    /// dimension, the scalar, the time step, the bounds and the upward axis.
    fn info(&self) -> Info;

    /// Returns the state at the current step; see [`Stage::status`].
    fn status(&mut self) -> Status;

    /// Appends bytes to a growing recording; an error for other stages.
    fn push(&mut self, bytes: &[u8]) -> Result<(), EngineError>;

    /// Goes to a step of a recording; see [`Stage::seek`].
    fn seek(&mut self, step: usize) -> Result<(), EngineError>;

    /// Advances by `steps` steps; see [`Stage::advance`].
    fn advance(&mut self, steps: u64) -> Result<(), EngineError>;

    /// Goes back to the start; see [`Stage::reset`].
    fn reset(&mut self) -> Result<(), EngineError>;

    /// Sets a control of a sample; see [`Stage::control`].
    fn control(&mut self, name: &str, value: &ControlValue) -> Result<(), EngineError>;

    /// Moves an object and updates the world.
    fn drag(&mut self, object: CollisionObjectHandle, to: &N::Isometry) -> Result<(), EngineError>;

    /// Draws elements other than objects, such as queries.
    fn draw(&self, drawing: &mut DebugDrawing<N, D>, renderer: &mut dyn DebugRender<N, D>);

    /// Returns the names of the pair filters that have stand-ins.
    fn stand_ins(&self) -> &[String];
}

/// A stage that consists of a source and the state of its drawing.
///
/// ```
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::world::{CollisionGroups, GeometricQueryType};
/// use impinge_page::{Recorded, Shown, Stage};
/// use impinge_record::{Recorder, Registry};
///
/// let mut recorder = Recorder::new(0.02, Registry::<f64, 2, Vec<u8>>::new())?;
/// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
/// for x in [0.0, 5.0] {
///     let position = Isometry::translation(x, 0.0);
///     recorder.add(position, ball.clone(), CollisionGroups::new(), query, Vec::new())?;
/// }
/// recorder.update();
/// let recorded = Recorded::<f64, 2>::open(&recorder.finish().bytes, Registry::new())?;
/// assert_eq!(Shown::new(recorded).pair(0, 1)?.distance, 3.0);
/// # Ok::<(), impinge_page::EngineError>(())
/// ```
#[derive(Debug)]
pub struct Shown<S, N: Viewed<D>, const D: usize> {
    source: S,
    picture: Picture<N, D>,
}

impl<S: Source<N, D>, N: Viewed<D>, const D: usize> Shown<S, N, D> {
    /// Creates a stage from a source; no frame has been drawn yet.
    #[must_use]
    pub fn new(source: S) -> Self {
        Self { source, picture: Picture::new() }
    }

    fn object_of(&self, object: u32) -> Result<&CollisionObject<N, D, S::Data>, EngineError> {
        object_of(self.source.world(), object).ok_or(EngineError::NoObject(object))
    }
}

impl<S: Source<N, D>, N: Viewed<D>, const D: usize> Stage for Shown<S, N, D> {
    fn info(&self) -> Info {
        Info {
            dimension: D,
            scalar: format!("f{}", 8 * N::BYTES),
            time_step: TIME_STEP.into(),
            bounds: self.picture.bounds(self.source.world()),
            up: [0.0, 1.0, 0.0],
            ..self.source.info()
        }
    }

    fn status(&mut self) -> Status {
        self.source.status()
    }

    fn push(&mut self, bytes: &[u8]) -> Result<(), EngineError> {
        self.picture.note_change();
        self.source.push(bytes)
    }

    fn seek(&mut self, step: usize) -> Result<(), EngineError> {
        self.picture.note_change();
        self.source.seek(step)
    }

    fn advance(&mut self, steps: u64) -> Result<(), EngineError> {
        if steps > MAX_STEPS {
            return Err(EngineError::TooManySteps(steps));
        }
        self.picture.note_change();
        self.source.advance(steps)
    }

    fn reset(&mut self) -> Result<(), EngineError> {
        self.picture.note_change();
        self.source.reset()
    }

    fn control(&mut self, name: &str, value: &ControlValue) -> Result<(), EngineError> {
        self.picture.note_change();
        self.source.control(name, value)
    }

    fn frame(&mut self, asked: &FrameRequest) -> Result<Frame, EngineError> {
        let Self { source, picture } = self;
        picture.frame(source.world(), asked, |drawing, renderer| source.draw(drawing, renderer))
    }

    fn object(&self, object: u32) -> Result<ObjectAnswer, EngineError> {
        Ok(object_answer(self.source.world(), self.object_of(object)?))
    }

    fn pair(&self, a: u32, b: u32) -> Result<PairAnswer, EngineError> {
        if a == b {
            return Err(EngineError::OneObject(a));
        }
        let (one, two) = (self.object_of(a)?, self.object_of(b)?);
        let (world, stand_ins) = (self.source.world(), self.source.stand_ins());
        Ok(Two { world, one, two, stand_ins }.answer())
    }

    fn pick(&self, at: &PickRequest) -> Picked {
        N::pick(self.source.world(), at)
    }

    fn ray(&self, asked: &RayRequest) -> RayAnswer {
        ask::ray(self.source.world(), asked)
    }

    fn nearest(&self, asked: &NearestRequest) -> NearestAnswer {
        ask::nearest(self.source.world(), asked)
    }

    fn drag(&mut self, asked: &DragRequest) -> Result<(), EngineError> {
        let object = self.object_of(asked.object)?;
        let rotation = match asked.rotation {
            Some(rotation) => unit_quaternion(rotation).ok_or(EngineError::Rotation(rotation))?,
            None => N::quaternion(object.position()),
        };
        let to = N::placed(&vector(asked.translation), rotation);
        let handle = object.handle();
        self.picture.note_change();
        self.source.drag(handle, &to)
    }
}
