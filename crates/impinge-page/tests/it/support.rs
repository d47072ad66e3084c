//! Helpers that make recordings, and that send requests in JSON to an engine.

use impinge::math::{Pose, Vector};
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::shape::{Shape, ShapeHandle};
use impinge::world::CollisionGroups;
use impinge_page::{Engine, message, parts};
use impinge_record::{Recordable, Recorder, Registry};
use serde_json::Value;

/// An engine that takes requests as JSON.
#[derive(Default)]
pub(crate) struct Asker(pub(crate) Engine);

impl Asker {
    /// Creates an engine and opens a recording in it.
    pub(crate) fn of(recording: &[u8]) -> Self {
        let mut asker = Self::default();
        let (info, _) = asker.ask_with(r#"{"do": "open", "kind": "recording"}"#, recording);
        assert_eq!(info["error"], Value::Null, "it opens");
        asker
    }

    pub(crate) fn ask_with(&mut self, text: &str, payload: &[u8]) -> (Value, Vec<u8>) {
        let answer = self.0.call(&message(text, payload));
        let (text, payload) = parts(&answer).expect("an answer has the layout of a message");
        let value = serde_json::from_slice(text).expect("its text is JSON");
        (value, payload.to_vec())
    }

    /// Sends a request, and returns the response without its payload.
    pub(crate) fn ask(&mut self, text: &str) -> Value {
        self.ask_with(text, &[]).0
    }
}

/// The recorder of a world whose objects are added without rotation.
pub(crate) struct Scene<N: Recordable<D>, const D: usize>(pub(crate) Recorder<N, D, Vec<u8>>);

impl<N: Recordable<D>, const D: usize> Scene<N, D> {
    pub(crate) fn new(registry: Registry<N, D, Vec<u8>>) -> Self {
        Self(Recorder::new(N::lit(0.0625), registry).expect("a usable margin"))
    }

    /// Adds an object without rotation, with these groups and a contact query without prediction.
    pub(crate) fn add_in(
        &mut self,
        groups: CollisionGroups,
        at: [f64; 3],
        shape: impl Shape<N, D>,
    ) -> CollisionObjectHandle {
        let contacts = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
        let added = self.0.add(
            place::<N, D>(at),
            ShapeHandle::new(shape),
            groups,
            contacts,
            b"thing".to_vec(),
        );
        added.expect("the world takes it")
    }

    pub(crate) fn add(&mut self, at: [f64; 3], shape: impl Shape<N, D>) -> CollisionObjectHandle {
        self.add_in(CollisionGroups::new(), at, shape)
    }

    /// Returns the recording after one more update.
    pub(crate) fn finish(mut self) -> Vec<u8> {
        self.0.update();
        self.0.finish().bytes
    }
}

/// Returns a position without rotation; in 2D the third coordinate is ignored.
pub(crate) fn place<N: Recordable<D>, const D: usize>(at: [f64; 3]) -> N::Isometry {
    N::isometry(&Pose::from_translation(Vector::<N, D>::from_fn(|axis, _| N::lit(at[axis]))))
}

/// Returns a vector with equal components.
pub(crate) fn all<N: Recordable<D>, const D: usize>(component: f64) -> Vector<N, D> {
    Vector::<N, D>::repeat(N::lit(component))
}

/// Returns the 32-bit floats in a section of a payload.
pub(crate) fn floats(section: &Value, payload: &[u8]) -> Vec<f32> {
    words(section, payload).into_iter().map(f32::from_bits).collect()
}

/// Returns the 32-bit unsigned integers of a section of a payload.
pub(crate) fn words(section: &Value, payload: &[u8]) -> Vec<u32> {
    let [start, count] = [0, 1].map(|part| {
        usize::try_from(section[part].as_u64().expect("a section has numbers"))
            .expect("it is small")
    });
    let bytes = payload[start..start + 4 * count].chunks_exact(4);
    bytes.map(|four| u32::from_le_bytes([four[0], four[1], four[2], four[3]])).collect()
}

/// Returns the first three numbers of a JSON array.
pub(crate) fn three(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|axis| value[axis].as_f64().expect("a coordinate"))
}
