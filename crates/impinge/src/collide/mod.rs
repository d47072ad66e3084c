//! Computes contacts: from two shapes and their poses to the points of a manifold.
//!
//! This layer lies between the algorithms on convex sets, which do not depend on shape types
//! ([`crate::convex`]), and the public queries ([`crate::query`]). From bottom to top:
//!
//! - [`pair`] puts two shapes in canonical order and computes their relative pose; [`far`] rejects
//!   pairs that are certainly too far apart;
//! - [`separation`] computes the signed distance, normal and nearest points of two solids;
//! - [`manifold`] computes contact points of two solids: supporting features, clipping, reduction,
//!   ids;
//! - [`batch`] computes separations and contact points of the most frequent pairs, 8 at a time;
//! - [`parts`] finds pairs of parts that are near each other, one part of each shape, if at least
//!   one of two shapes is a composite; it also finds the separation of the nearest pair;
//! - [`mesh`] builds the manifolds of a composite and another shape. It finds the near parts, culls
//!   them in packets of 8 ([`packet`]), and computes the contact of each remaining part. It then
//!   drops or corrects normals that the surface does not admit, and merges the contact points into
//!   patches.

pub(crate) mod batch;
pub(crate) mod far;
pub(crate) mod manifold;
pub(crate) mod mesh;
pub(crate) mod packet;
pub(crate) mod pair;
pub(crate) mod parts;
mod raw_manifold;
#[cfg(feature = "serde")]
pub(crate) mod saved;
pub(crate) mod separation;
mod size;

pub(crate) use batch::{
    ConvexPair, KeptPairs, PairQuestion, Solid, contacts_in_lanes, distances2, distances3,
    separations2, separations3, update_pair2, update_pair3, update_pairs2, update_pairs3,
};
pub(crate) use manifold::{
    OnFace, between2, build3, contacts_of_separation2, contacts_of_separation3, on_face2, on_face3,
    tangents2, tangents3, witness_feature2, witness_feature3, witness_features2, witness_features3,
};
pub(crate) use mesh::{CompositeContacts, each_contact_within, own_distance};
pub(crate) use pair::{Pair, Placed, Placing, canonical};
pub(crate) use raw_manifold::{ManifoldRequest, PairIds, RawManifold, RawPoint, RawPoints};
pub(crate) use separation::AtIsometry;
