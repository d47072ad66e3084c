//! Errors of a broad phase.

use core::fmt;

use super::ProxyHandle;

/// The reason why a broad phase refused a call. The refused call has changed nothing.
///
/// ```
/// use impinge::dim2::bounding_volume::Aabb;
/// use impinge::dim2::broad_phase::{BroadPhaseError, DBVTBroadPhase};
///
/// let refused = DBVTBroadPhase::<f32, Aabb<f32>, ()>::try_new(-1.0).err();
/// assert_eq!(refused, Some(BroadPhaseError::BadMargin(-1.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BroadPhaseError {
    /// The handle belongs to a removed object or to another broad phase.
    StaleHandle(ProxyHandle),
    /// The handle occurs twice in one list of removals.
    RemovedTwice(ProxyHandle),
    /// The volume is inverted or has a NaN face. The value is the handle of the object, or `None`
    /// for a new object.
    BadVolume(Option<ProxyHandle>),
    /// The margin, converted to `f64`, is negative, infinite or NaN.
    BadMargin(f64),
}

impl fmt::Display for BroadPhaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StaleHandle(handle) => write!(f, "there is no proxy {handle:?}"),
            Self::RemovedTwice(handle) => write!(f, "{handle:?} is to be removed twice at once"),
            Self::BadVolume(Some(handle)) => {
                write!(f, "the volume given to {handle:?} is inverted or not a number")
            }
            Self::BadVolume(None) => {
                f.write_str("the volume of the new proxy is inverted or not a number")
            }
            Self::BadMargin(margin) => {
                write!(f, "the margin is {margin}: it must be finite and not negative")
            }
        }
    }
}

impl std::error::Error for BroadPhaseError {}

/// Returns the value, or panics with the text of the error. Used by the panicking variants of
/// methods.
#[track_caller]
pub(super) fn or_panic<S>(result: Result<S, BroadPhaseError>) -> S {
    match result {
        Ok(value) => value,
        Err(error) => panic!("{error}"),
    }
}
