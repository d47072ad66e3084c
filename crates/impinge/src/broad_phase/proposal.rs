//! Objects that a search proposes.

use smallvec::SmallVec;

use super::ProxyHandle;
use super::dbvt::data_of;

/// The objects of a broad phase, by index of the handle; `None` where there is none.
pub(super) type Proxies<T> = Vec<Option<(ProxyHandle, T)>>;

/// A few of them, as many as a search hands out at once.
pub(super) type Proposals<'a, T> = SmallVec<[Proposal<'a, T>; 4]>;

/// An object that a search proposes. What is kept about it is fetched when it is asked for: memory is
/// slow.
#[derive(Clone, Copy, Debug)]
pub struct Proposal<'a, T>(Source<'a, T>);

#[derive(Clone, Copy, Debug)]
enum Source<'a, T> {
    Data(&'a T),
    Kept(&'a [Option<(ProxyHandle, T)>], u32),
}

impl<'a, T> Proposal<'a, T> {
    /// An object whose data are at hand.
    #[must_use]
    pub const fn of(data: &'a T) -> Self {
        Self(Source::Data(data))
    }

    /// An object that is known to be there.
    pub(super) const fn kept(proxies: &'a [Option<(ProxyHandle, T)>], id: u32) -> Self {
        Self(Source::Kept(proxies, id))
    }

    /// What the object was created with.
    #[must_use]
    pub fn data(&self) -> &'a T {
        match self.0 {
            Source::Data(data) => data,
            Source::Kept(proxies, id) => data_of(proxies, id),
        }
    }

    /// [`ProxyHandle::uid`] of the object, where that is known without a look at it.
    #[must_use]
    pub const fn uid(&self) -> Option<usize> {
        match self.0 {
            Source::Data(_) => None,
            Source::Kept(_, id) => Some(id as usize),
        }
    }
}
