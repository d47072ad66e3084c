//! The engine: passes messages to a stage and returns responses.

use core::fmt;
use std::borrow::Cow;

use impinge_record::{Header, Registry, is_packed, unpack};
use impinge_samples::{ControlValue, Make, entries};
use serde::Serialize;
use serde_json::Value;

use crate::answer::Gallery;
use crate::request::{Opening, Request};
use crate::{EngineError, Recorded, Sampled, Shown, Stage, Viewed, message, parts};

/// A stage of any scalar and dimension.
type Opened = Box<dyn Stage>;

/// Processes the messages that `PROTOCOL.md` describes, and holds one stage.
///
/// ```
/// use impinge_page::{Engine, message, parts};
///
/// let mut engine = Engine::new();
/// let mut ask = |text: &str| {
///     let answer = engine.call(&message(text, &[]));
///     let (text, _) = parts(&answer).expect("an answer has the layout of a message");
///     serde_json::from_slice::<serde_json::Value>(text).expect("its text is JSON")
/// };
/// let info = ask(r#"{"do": "open", "kind": "sample", "name": "stack3"}"#);
/// assert_eq!(info["dimension"], 3);
/// assert_eq!(ask(r#"{"do": "advance", "steps": 5}"#)["step"], 5);
/// let refusal = ask(r#"{"do": "object", "object": 12345}"#);
/// assert_eq!((&refusal["error"], &refusal["code"]), (&"there is no object 12345".into(), &"no-object".into()));
/// ```
#[derive(Default)]
pub struct Engine {
    stage: Option<Opened>,
    /// The bytes of a stream whose header is still incomplete; `None` for other stages. Until the
    /// header is complete, scalar and dimension are unknown, and `stage` is an empty recording.
    begun: Option<Vec<u8>>,
}

impl fmt::Debug for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Engine").field("is_open", &self.stage.is_some()).finish_non_exhaustive()
    }
}

/// A response: a JSON text and a payload.
struct Reply {
    text: String,
    payload: Vec<u8>,
}

/// Returns a response without a payload.
fn reply(answer: &impl Serialize) -> Result<Reply, EngineError> {
    Ok(Reply { text: serde_json::to_string(answer)?, payload: Vec::new() })
}

/// The response that describes an error.
#[derive(Serialize)]
struct Failure {
    error: String,
    code: &'static str,
}

impl Engine {
    /// Creates an engine without a stage.
    #[must_use]
    pub const fn new() -> Self {
        Self { stage: None, begun: None }
    }

    /// Opens a stage that the caller has created, for instance a recording whose shapes and pair
    /// filters are code of this program.
    pub fn show(&mut self, stage: Box<dyn Stage>) {
        (self.stage, self.begun) = (Some(stage), None);
    }

    /// Processes a message. Any bytes are accepted: the response to an invalid message has a member
    /// `error`.
    pub fn call(&mut self, bytes: &[u8]) -> Vec<u8> {
        let reply = self.answer(bytes).unwrap_or_else(|error| {
            let failure = Failure { error: error.to_string(), code: error.code() };
            let text = serde_json::to_string(&failure);
            Reply { text: text.unwrap_or_default(), payload: Vec::new() }
        });
        message(&reply.text, &reply.payload)
    }

    fn answer(&mut self, bytes: &[u8]) -> Result<Reply, EngineError> {
        let (text, payload) = parts(bytes)?;
        match serde_json::from_slice(text)? {
            Request::Samples => reply(&Gallery { samples: entries() }),
            Request::Open(opening) => {
                self.open(&opening, payload)?;
                self.info()
            }
            Request::Push => {
                self.push(payload)?;
                self.info()
            }
            request => self.ask(request),
        }
    }

    fn stage(&mut self) -> Result<&mut Opened, EngineError> {
        self.stage.as_mut().ok_or(EngineError::NothingOpen)
    }

    fn info(&mut self) -> Result<Reply, EngineError> {
        reply(&self.stage()?.info())
    }

    /// Processes queries and changes of the stage. The response to a change is the status of the
    /// stage.
    fn ask(&mut self, request: Request) -> Result<Reply, EngineError> {
        let stage = self.stage()?;
        match request {
            Request::Frame(asked) => {
                let frame = stage.frame(&asked)?;
                return Ok(Reply { text: frame.text, payload: frame.payload });
            }
            Request::Object { object } => return reply(&stage.object(object)?),
            Request::Pair { a, b } => return reply(&stage.pair(a, b)?),
            Request::Pick(at) => return reply(&stage.pick(&at)),
            Request::Ray(asked) => return reply(&stage.ray(&asked)),
            Request::Nearest(asked) => return reply(&stage.nearest(&asked)),
            Request::Seek { step } => stage.seek(usize::try_from(step).unwrap_or(usize::MAX))?,
            Request::Advance { steps } => stage.advance(steps)?,
            Request::Reset => stage.reset()?,
            Request::Control { name, value } => stage.control(&name, &control_value(value)?)?,
            Request::Drag(asked) => stage.drag(&asked)?,
            // `answer` processes these requests.
            Request::Samples | Request::Open(_) | Request::Push => {}
        }
        reply(&stage.status())
    }

    /// Opens a stage. If this fails, the current stage stays.
    fn open(&mut self, opening: &Opening, payload: &[u8]) -> Result<(), EngineError> {
        let stage = match opening {
            Opening::Recording => open_recording(payload)?,
            Opening::Stream => return self.open_stream(payload),
            Opening::Sample { name } => open_sample(name)?,
        };
        self.show(stage);
        Ok(())
    }

    /// Opens a stream that begins with `payload`.
    fn open_stream(&mut self, payload: &[u8]) -> Result<(), EngineError> {
        let stage = begun_stage(payload)?;
        self.begun = stage.is_none().then(|| payload.to_vec());
        // Before the header is complete, the stage is an empty recording of arbitrary scalar and
        // dimension.
        let empty = || Box::new(Shown::new(Recorded::<f32, 3>::growing(Registry::new()))) as Opened;
        self.stage = Some(stage.unwrap_or_else(empty));
        Ok(())
    }

    /// Appends bytes to a stream. If this fails, the stream is as before.
    fn push(&mut self, bytes: &[u8]) -> Result<(), EngineError> {
        let Some(begun) = &mut self.begun else { return self.stage()?.push(bytes) };
        let before = begun.len();
        begun.extend(bytes);
        match begun_stage(begun) {
            Ok(Some(stage)) => self.show(stage),
            Ok(None) => {}
            Err(error) => {
                begun.truncate(before);
                return Err(error);
            }
        }
        Ok(())
    }
}

/// Returns the stage of a stream that begins with `bytes`, with the scalar and dimension of its
/// header; `None` as long as the header is incomplete.
fn begun_stage(bytes: &[u8]) -> Result<Option<Opened>, EngineError> {
    match Header::read(bytes) {
        Ok(header) => {
            let mut stage = stage_of(&header, None)?;
            stage.push(bytes)?;
            Ok(Some(stage))
        }
        Err(error) if Header::is_begun(bytes, &error) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

fn open_sample(name: &str) -> Result<Opened, EngineError> {
    let entry = entries().iter().find(|entry| entry.name == name);
    let entry = entry.ok_or_else(|| EngineError::UnknownSample(name.to_owned()))?;
    Ok(match entry.make {
        Make::Plane(make) => Box::new(Shown::new(Sampled::new(entry, make())?)),
        Make::Space(make) => Box::new(Shown::new(Sampled::new(entry, make())?)),
    })
}

fn open_recording(bytes: &[u8]) -> Result<Opened, EngineError> {
    let bytes = if is_packed(bytes) { Cow::Owned(unpack(bytes)?) } else { Cow::Borrowed(bytes) };
    stage_of(&Header::read(&bytes)?, Some(&bytes))
}

/// Creates a stage with the scalar and dimension of `header`: the recording `bytes`, or an empty
/// growing recording if `bytes` is `None`.
fn stage_of(header: &Header, bytes: Option<&[u8]>) -> Result<Opened, EngineError> {
    match (header.scalar_bytes, header.dimension) {
        (4, 2) => recorded::<f32, 2>(bytes),
        (4, 3) => recorded::<f32, 3>(bytes),
        (8, 2) => recorded::<f64, 2>(bytes),
        (8, 3) => recorded::<f64, 3>(bytes),
        (scalar_bytes, dimension) => Err(EngineError::Kind { dimension, scalar_bytes }),
    }
}

/// Creates a stage with this scalar and dimension: the recording `bytes`, or an empty growing
/// recording if `bytes` is `None`.
fn recorded<N: Viewed<D>, const D: usize>(bytes: Option<&[u8]>) -> Result<Opened, EngineError> {
    let recorded = match bytes {
        Some(bytes) => Recorded::<N, D>::open(bytes, Registry::new())?,
        None => Recorded::growing(Registry::new()),
    };
    Ok(Box::new(Shown::new(recorded)))
}

/// Converts the value of a control from JSON; `null` means that a button is pressed.
fn control_value(value: Value) -> Result<ControlValue, EngineError> {
    match (value.as_f64(), value) {
        (Some(number), _) => Ok(ControlValue::Number(number)),
        (_, Value::Null) => Ok(ControlValue::Pressed),
        (_, Value::Bool(flag)) => Ok(ControlValue::Flag(flag)),
        (_, Value::String(word)) => Ok(ControlValue::Choice(word)),
        (_, other) => Err(EngineError::Value(other.to_string())),
    }
}
