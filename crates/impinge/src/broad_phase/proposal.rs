//! Objects that a search proposes.

use super::dbvt::data_of;
use crate::math::Real;

/// The data of a broad phase's objects, by index of the handle; `None` where there is no object.
pub(super) type Proxies<T> = Vec<Option<T>>;

/// An object that a search proposes. What is kept about it is fetched when it is asked for: memory is
/// slow.
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
    /// An object whose data are at hand; see [`Self::key`].
    #[must_use]
    pub const fn of(data: &'a T, key: N) -> Self {
        Self { source: Source::Data(data), key }
    }

    /// An object that is known to be there.
    pub(super) const fn kept(proxies: &'a [Option<T>], id: u32, key: N) -> Self {
        Self { source: Source::Kept(proxies, id), key }
    }

    /// What the object was created with.
    #[must_use]
    pub fn data(&self) -> &'a T {
        match self.source {
            Source::Data(data) => data,
            Source::Kept(proxies, id) => data_of(proxies, id),
        }
    }

    /// The time at which the volume of the object is met, or its distance, or less.
    #[must_use]
    pub const fn key(&self) -> N {
        self.key
    }

    /// [`ProxyHandle::uid`](super::ProxyHandle::uid) of the object, where that is known without a look
    /// at it.
    #[must_use]
    pub const fn uid(&self) -> Option<usize> {
        match self.source {
            Source::Data(_) => None,
            Source::Kept(_, id) => Some(id as usize),
        }
    }
}
