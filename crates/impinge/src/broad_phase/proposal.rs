//! Objects that a search of the broad phase proposes to its caller.

use super::dbvt::data_of;
use crate::math::Real;

/// Users' data by handle index; `None` for an index without an object.
pub(super) type Proxies<T> = Vec<Option<T>>;

/// An object that a search of the broad phase proposes. Its data are loaded only on access.
#[derive(Debug)]
pub struct Proposal<'a, N, T> {
    source: Source<'a, T>,
    key: N,
}

#[derive(Debug)]
enum Source<'a, T> {
    Data(&'a T),
    Kept(&'a [Option<T>], u32),
}

impl<N: Copy, T> Copy for Proposal<'_, N, T> {}

impl<N: Copy, T> Clone for Proposal<'_, N, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Source<'_, T> {}

impl<T> Clone for Source<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<'a, N: Real, T> Proposal<'a, N, T> {
    /// Creates a proposal from a reference to the data; see [`Self::key`] for `key`.
    #[must_use]
    pub const fn of(data: &'a T, key: N) -> Self {
        Self { source: Source::Data(data), key }
    }

    /// Creates a proposal for object `id`, which must exist; does not load its data.
    pub(super) const fn kept(proxies: &'a [Option<T>], id: u32, key: N) -> Self {
        Self { source: Source::Kept(proxies, id), key }
    }

    /// Returns the data that the object was created with.
    #[must_use]
    pub fn data(&self) -> &'a T {
        match self.source {
            Source::Data(data) => data,
            Source::Kept(proxies, id) => data_of(proxies, id),
        }
    }

    /// Returns the key of the object's volume, or a lower bound of the key. For a ray or a moving
    /// volume, the key is the time of the first contact with the object's volume; for a search by
    /// distance, the distance to that volume.
    #[must_use]
    pub const fn key(&self) -> N {
        self.key
    }

    /// Returns the [uid](super::ProxyHandle::uid) of the object; `None` if it cannot be determined
    /// without loading the object's data.
    #[must_use]
    pub const fn uid(&self) -> Option<usize> {
        match self.source {
            Source::Data(_) => None,
            Source::Kept(_, id) => Some(id as usize),
        }
    }
}
