//! Questions about one solid or two, answered from nothing but the arguments.

mod contact;
mod kinematic;
mod manifold;
mod pair;
mod proximity;
mod raw_manifold;

pub use crate::bounding_volume::Ray;
pub use contact::Contact;
pub use kinematic::{ContactKinematic, NeighborhoodGeometry};
pub use manifold::{ContactId, ContactManifold, TrackedContact};
pub(crate) use pair::{Pair, canonical};
pub use proximity::Proximity;
pub(crate) use raw_manifold::{ManifoldRequest, RawManifold, RawPoint};

pub(crate) fn materialise<N: crate::math::Real, const D: usize>(
    _: &crate::narrow_phase::Posed<'_, N, D>,
    _: &RawManifold<N, D>,
    _: u64,
) -> ContactManifold<N, D> {
    todo!()
}
impl<N: crate::math::Real, const D: usize> RawManifold<N, D> {
    pub(crate) fn flip_names(&mut self) {}
}
