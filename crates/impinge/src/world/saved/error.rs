//! Errors of saving and restoring a world.

use core::fmt;

use crate::math::numbers::Damage;
use crate::shape::saved::UnsavedShape;

/// The reason why a world cannot be saved.
///
/// ```
/// use impinge::dim2::narrow_phase::{DefaultContactDispatcher, DefaultNarrowPhase, PairProximityDetector};
/// use impinge::dim2::world::{CollisionWorld, SaveError};
/// use impinge::narrow_phase::{ProximityAlgorithm, ProximityDispatcher};
/// use impinge::shape::Shape;
///
/// struct Own;
///
/// impl ProximityDispatcher<f32, 2> for Own {
///     fn get_proximity_algorithm(
///         &self,
///         _: &dyn Shape<f32, 2>,
///         _: &dyn Shape<f32, 2>,
///     ) -> Option<ProximityAlgorithm<f32, 2>> {
///         None
///     }
/// }
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let contacts = Box::new(DefaultContactDispatcher::new());
/// world.set_narrow_phase(Box::new(DefaultNarrowPhase::with_dispatchers(contacts, Box::new(Own))));
/// assert_eq!(world.saved().err(), Some(SaveError::NarrowPhase));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SaveError {
    /// The present broad phase, or its replacement for the next update, is not the library's own;
    /// or objects were added to the replacement before the world received it.
    BroadPhase,
    /// The present narrow phase, or its replacement for the next update, is not the library's own,
    /// or has a custom dispatcher.
    NarrowPhase,
    /// [`Shape::saved`](crate::shape::Shape::saved) returned `None` for a shape of a user's type.
    OwnShape {
        /// The `Debug` output of the shape.
        shape: String,
    },
    /// A compound has too many parts: more than 2^20 in addition to the parts listed in the data.
    /// Nested compounds that share children can have exponentially many parts.
    TooManyParts,
}

impl From<UnsavedShape> for SaveError {
    fn from(unsaved: UnsavedShape) -> Self {
        match unsaved {
            UnsavedShape::Own(shape) => Self::OwnShape { shape },
            UnsavedShape::TooManyParts => Self::TooManyParts,
        }
    }
}

impl fmt::Display for SaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BroadPhase => write!(f, "the broad phase is not the library's own"),
            Self::NarrowPhase => {
                write!(f, "the narrow phase is not the library's own, with its dispatchers")
            }
            Self::OwnShape { shape } => write!(f, "the shape {shape} cannot be saved"),
            Self::TooManyParts => write!(f, "a compound of compounds has too many parts"),
        }
    }
}

impl std::error::Error for SaveError {}

/// The reason why a world cannot be restored from data.
///
/// ```
/// use impinge::dim2::world::{CollisionWorld, Registry, RestoreError, SavedWorld};
///
/// let text = serde_json::to_string(&CollisionWorld::<f64, ()>::new(0.02)).expect("it is empty");
/// let saved: SavedWorld<f32, ()> = serde_json::from_str(&text).expect("the kind is read");
/// assert_eq!(saved.restore(&Registry::new()).err(), Some(RestoreError::Scalar { found: 64 }));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RestoreError {
    /// The data has another version of the format.
    Version {
        /// The version in the data.
        found: u32,
    },
    /// The data belongs to a world with another scalar type.
    Scalar {
        /// The number of bits of a scalar in the data.
        found: u8,
    },
    /// The data belongs to a world of another dimension.
    Dimension {
        /// The dimension in the data.
        found: u8,
    },
    /// The registry has no shape type of this name.
    UnknownShape(String),
    /// The function that the registry has for this shape type returned `None` for the data.
    RefusedShape(String),
    /// The registry has no pair filter of this name.
    UnknownFilter(String),
    /// The data is invalid: it is incomplete or contradicts itself.
    Damaged {
        /// A description of the defect.
        what: String,
    },
}

impl From<Damage> for RestoreError {
    fn from(damage: Damage) -> Self {
        Self::Damaged { what: damage.0.into_owned() }
    }
}

impl fmt::Display for RestoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Version { found } => write!(f, "the world is saved in version {found}"),
            Self::Scalar { found } => write!(f, "the numbers of the world have {found} bits"),
            Self::Dimension { found } => write!(f, "the world has {found} dimensions"),
            Self::UnknownShape(name) => write!(f, "no shapes {name:?} are registered"),
            Self::RefusedShape(name) => write!(f, "the data makes no shape {name:?}"),
            Self::UnknownFilter(name) => write!(f, "no pair filter {name:?} is registered"),
            Self::Damaged { what } => write!(f, "the saved world is damaged: {what}"),
        }
    }
}

impl std::error::Error for RestoreError {}
