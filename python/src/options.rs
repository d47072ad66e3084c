//! Options of objects and queries besides arrays: groups, query types and filters.

use impinge::math::Real;
use impinge::math::na::convert;
use impinge::narrow_phase::GeometricQueryType;
use impinge::world::{CollisionGroups, GroupError};
use pyo3::prelude::*;

/// The groups of an object or of a query, as lists of indices. `None` keeps the default list of new
/// objects.
#[derive(FromPyObject)]
pub(crate) struct GroupLists {
    membership: Option<Vec<usize>>,
    whitelist: Option<Vec<usize>>,
    blacklist: Option<Vec<usize>>,
}

impl GroupLists {
    /// Converts to groups of the library.
    pub(crate) fn groups(&self) -> Result<CollisionGroups, GroupError> {
        let mut groups = CollisionGroups::new();
        if let Some(membership) = &self.membership {
            groups.try_set_membership(membership)?;
        }
        if let Some(whitelist) = &self.whitelist {
            groups.try_set_whitelist(whitelist)?;
        }
        if let Some(blacklist) = &self.blacklist {
            groups.try_set_blacklist(blacklist)?;
        }
        Ok(groups)
    }

    /// Whether no list is given.
    pub(crate) const fn is_empty(&self) -> bool {
        self.membership.is_none() && self.whitelist.is_none() && self.blacklist.is_none()
    }
}

/// The query type of the pairs of an object.
#[derive(FromPyObject)]
pub(crate) struct QueryOptions {
    /// The prediction of contacts, which is added to that of the other object; used if there is no
    /// margin.
    prediction: f64,
    /// The margin of proximity. An object with a margin queries proximity instead of contacts.
    margin: Option<f64>,
}

impl QueryOptions {
    /// Converts to a query type of the library.
    pub(crate) fn query_type<N: Real>(&self) -> GeometricQueryType<N> {
        match self.margin {
            Some(margin) => GeometricQueryType::Proximity(convert(margin)),
            None => GeometricQueryType::Contacts(convert(self.prediction), N::ZERO),
        }
    }
}

/// The properties of a new object other than shape and pose.
#[derive(FromPyObject)]
pub(crate) struct ObjectOptions {
    pub(crate) query: QueryOptions,
    pub(crate) groups: GroupLists,
}

/// The objects that a query considers.
#[derive(FromPyObject)]
pub(crate) struct FilterOptions {
    pub(crate) groups: GroupLists,
    /// The handles of excluded objects.
    pub(crate) exclude: Vec<u64>,
}
