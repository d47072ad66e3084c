//! Access to one pair, to all pairs in canonical order, or to all manifolds in memory order.

mod composite;
mod convex;
mod stream;

use crate::tables::entries;
use core::fmt;

use self::composite::CompositeViews;
use self::convex::ConvexViews;
pub use self::stream::{ContactStream, StreamManifold, StreamPoint};
use super::group::PairKey;
use super::pair_groups::{CompositeGroup, ContactGroup, GroupId, PairGroups};
use super::state::KeptPoints;
use super::traits::ContactManifoldGenerator;
use super::{DefaultNarrowPhase, ObjectTable};
use crate::math::Space;
use crate::pairs::PairTable;
use crate::query::{ContactManifold, ManifoldView, Proximity};

/// All manifolds with at least one contact: first of convex solids, then of composites, then of
/// custom algorithms.
pub(crate) struct Views<'a, N: Space<D>, const D: usize> {
    /// Whether the contacts of every pair can be read in place, without built manifolds.
    pub(crate) reads_in_place: bool,
    convex: ConvexViews<'a, N, D>,
    composites: CompositeViews<'a, N, D>,
    custom: Option<&'a DefaultNarrowPhase<N, D>>,
}

impl<'a, N: Space<D>, const D: usize> Views<'a, N, D> {
    /// Iterates over all manifolds, read in place and mapped by `with_handles`. Each source is
    /// mapped before the sources are chained, because a chain copies its items.
    pub(crate) fn in_place<R>(
        self,
        with_handles: impl Fn(View<'a, N, D>) -> R + Copy,
    ) -> impl Iterator<Item = R> {
        let custom = self.custom.into_iter().flat_map(DefaultNarrowPhase::custom_views);
        let second = UnfusedChain {
            first: self.composites.map(with_handles),
            second: custom.map(with_handles),
        };
        UnfusedChain { first: self.convex.map(with_handles), second }
    }

    /// Iterates over all manifolds, mapped by `with_handles`. Builds the manifolds of pairs that
    /// cannot be read in place; see [`ObjectTable::needs_built_manifolds`].
    pub(crate) fn with_built<R>(
        self,
        with_handles: impl Fn(View<'a, N, D>) -> R,
    ) -> impl Iterator<Item = R> {
        let custom = self.custom.into_iter().flat_map(DefaultNarrowPhase::custom_views);
        self.convex.with_built().chain(self.composites.with_built()).chain(custom).map(with_handles)
    }
}

/// The handle indices of two objects, and one of their manifolds.
pub(crate) type View<'a, N, const D: usize> = (u32, u32, ManifoldView<'a, N, D>);

/// Chains two iterators. Unlike `Iterator::chain` it does not record that the first iterator has
/// ended. So each later step calls the first iterator again, which must go on returning `None`.
struct UnfusedChain<A, B> {
    first: A,
    second: B,
}

impl<A: Iterator, B: Iterator<Item = A::Item>> Iterator for UnfusedChain<A, B> {
    type Item = A::Item;

    #[inline]
    fn next(&mut self) -> Option<A::Item> {
        if let Some(item) = self.first.next() {
            return Some(item);
        }
        self.second.next()
    }

    fn fold<C, F: FnMut(C, A::Item) -> C>(self, start: C, mut each: F) -> C {
        let after_first = self.first.fold(start, &mut each);
        self.second.fold(after_first, each)
    }
}

/// Contacts of a pair of objects, as of the last update.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::shape::{Cuboid, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f64, ()>::new(0.02);
/// let square = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0)));
/// let (groups, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
/// let [a, b] = [0.0, 1.75].map(|y| {
///     world.add(Isometry::translation(0.0, y), square.clone(), groups, contacts, ())
/// });
/// world.update();
///
/// let pair = world.contact_pair(a, b).expect("their boxes meet");
/// let depths = pair.views().flat_map(|view| view.contacts()).map(|point| point.contact.depth);
/// assert_eq!(depths.collect::<Vec<_>>(), [0.25, 0.25]);
/// let mut manifolds = Vec::new();
/// pair.contacts(&mut manifolds);
/// assert_eq!((manifolds.len(), pair.num_contacts()), (1, 2));
/// ```
#[derive(Clone, Copy)]
pub struct ContactPair<'a, N: Space<D>, const D: usize>(ViewedContacts<'a, N, D>);

#[derive(Clone, Copy)]
enum ViewedContacts<'a, N: Space<D>, const D: usize> {
    BuiltIn(BuiltIn<'a, N, D>),
    Composite(Composite<'a, N, D>),
    Custom(&'a dyn ContactManifoldGenerator<N, D>),
}

/// The table, group and row of a built-in pair of convex solids.
#[derive(Clone, Copy)]
pub(super) struct BuiltIn<'a, N: Space<D>, const D: usize> {
    pub(super) table: &'a ObjectTable<N, D>,
    pub(super) group: &'a ContactGroup<N, D>,
    pub(super) row: u32,
}

/// The table, group and row of a built-in pair with a composite.
#[derive(Clone, Copy)]
pub(super) struct Composite<'a, N: Space<D>, const D: usize> {
    pub(super) table: &'a ObjectTable<N, D>,
    pub(super) group: &'a CompositeGroup<N, D>,
    pub(super) row: u32,
}

impl<'a, N: Space<D>, const D: usize> BuiltIn<'a, N, D> {
    /// Returns the manifold; `None` if it has no contact.
    fn manifold(&self) -> Option<&'a ContactManifold<N, D>> {
        if !self.group.is_touching(self.row) {
            return None;
        }
        let (group, row) = (self.group, self.row);
        let placed = || self.table.placed_pair(group.key(row));
        let entry = group.state(row);
        let skins = self.table.skins_of(group.key(row));
        let make =
            |old| entries::public_manifold(&entry.state, &placed(), entry.number, old).grown(skins);
        Some(group.view(row).manifolds(make))
    }

    /// Returns a view of the manifold, read in place if possible; `None` if the manifold has no
    /// contact.
    pub(super) fn view(&self) -> Option<ManifoldView<'a, N, D>> {
        let (group, row, key) = (self.group, self.row, self.group.key(self.row));
        if self.table.needs_built_manifolds(key) {
            return self.manifold().and_then(ManifoldView::of_manifold);
        }
        let entry = group.state(row);
        group.is_touching(row).then(|| entry.state.view(self.table, key, entry.number))
    }
}

impl<'a, N: Space<D>, const D: usize> Composite<'a, N, D> {
    /// Returns the manifolds, each of which has at least one contact.
    fn manifolds(&self) -> &'a [ContactManifold<N, D>] {
        let (group, row) = (self.group, self.row);
        let placed = || self.table.placed_pair(group.key(row));
        let entry = group.state(row);
        let skins = self.table.skins_of(group.key(row));
        let make = |old| {
            let manifolds =
                entries::composite_manifolds(&entry.state, &placed(), entry.number, old);
            manifolds.into_iter().map(|manifold| manifold.grown(skins)).collect()
        };
        group.view(row).manifolds(make)
    }

    /// Iterates over views of the manifolds, read in place if possible.
    pub(super) fn views(self) -> impl Iterator<Item = ManifoldView<'a, N, D>> {
        let (key, entry) = (self.group.key(self.row), self.group.state(self.row));
        let needs_built_manifolds = self.table.needs_built_manifolds(key);
        let made = if needs_built_manifolds { self.manifolds() } else { &[] };
        let view = move |patch| entry.state.view(self.table, key, entry.number, patch);
        let kept = (0..).map_while(move |patch| (!needs_built_manifolds).then(|| view(patch))?);
        made.iter().filter_map(ManifoldView::of_manifold).chain(kept)
    }
}

impl<'a, N: Space<D>, const D: usize> ContactPair<'a, N, D> {
    /// Creates the access to the contacts of a custom algorithm, for a custom narrow phase.
    #[must_use]
    pub fn from_algorithm(algorithm: &'a dyn ContactManifoldGenerator<N, D>) -> Self {
        Self(ViewedContacts::Custom(algorithm))
    }

    /// Returns the number of contact points over all manifolds.
    #[must_use]
    pub fn num_contacts(&self) -> usize {
        match self.0 {
            ViewedContacts::BuiltIn(pair) => pair.group.state(pair.row).state.len(),
            ViewedContacts::Composite(pair) => pair.group.state(pair.row).state.len(),
            ViewedContacts::Custom(algorithm) => algorithm.num_contacts(),
        }
    }

    /// Iterates over the manifolds with at least one contact.
    pub(crate) fn manifolds(self) -> impl Iterator<Item = &'a ContactManifold<N, D>> {
        let (mut own, mut parts, mut others) = (None, &[][..], Vec::new());
        match self.0 {
            // The common cases allocate nothing.
            ViewedContacts::BuiltIn(pair) => own = pair.manifold(),
            ViewedContacts::Composite(pair) => parts = pair.manifolds(),
            ViewedContacts::Custom(algorithm) => algorithm.contacts(&mut others),
        }
        own.into_iter().chain(parts).chain(others)
    }

    /// Iterates over views of the manifolds with at least one contact, in the order of
    /// [`Self::contacts`]. They are read in place, except for custom algorithms, objects with a
    /// skin, and pairs computed by
    /// [`CollisionWorld::update_pair`](crate::world::CollisionWorld::update_pair) since the last
    /// update.
    pub fn views(self) -> impl Iterator<Item = ManifoldView<'a, N, D>> {
        let (mut own, mut patches, mut others) = (None, None, Vec::new());
        match self.0 {
            ViewedContacts::BuiltIn(pair) => own = pair.view(),
            ViewedContacts::Composite(pair) => patches = Some(pair.views()),
            ViewedContacts::Custom(algorithm) => algorithm.contacts(&mut others),
        }
        let others = others.into_iter().filter_map(ManifoldView::of_manifold);
        own.into_iter().chain(patches.into_iter().flatten()).chain(others)
    }

    /// Appends the manifolds with at least one contact to `out`.
    pub fn contacts(&self, out: &mut Vec<&'a ContactManifold<N, D>>) {
        match self.0 {
            ViewedContacts::BuiltIn(pair) => out.extend(pair.manifold()),
            ViewedContacts::Composite(pair) => out.extend(pair.manifolds()),
            ViewedContacts::Custom(algorithm) => algorithm.contacts(out),
        }
    }
}

impl<N: Space<D>, const D: usize> fmt::Debug for ContactPair<'_, N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ContactPair").field("num_contacts", &self.num_contacts()).finish()
    }
}

/// Proximity of a pair of objects, as of the last update.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// use impinge::dim2::events::Proximity;
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let ball = ShapeHandle::new(Ball::new(1.0));
/// let [a, b] = [0.0, 2.25].map(|x| {
///     let query = GeometricQueryType::Proximity(0.25);
///     world.add(Isometry::translation(x, 0.0), ball.clone(), CollisionGroups::new(), query, ())
/// });
/// world.update();
/// let pair = world.proximity_pair(a, b).expect("their boxes meet");
/// assert_eq!(pair.proximity(), Proximity::WithinMargin);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProximityPair(Proximity);

impl ProximityPair {
    /// Creates a pair with this proximity, for a custom narrow phase.
    #[must_use]
    pub const fn new(proximity: Proximity) -> Self {
        Self(proximity)
    }

    /// Returns the proximity of the two objects.
    #[must_use]
    pub const fn proximity(&self) -> Proximity {
        self.0
    }
}

/// Returns the indices of the pairs for which `is_wanted` returns `true`, sorted by the smaller
/// object index of the pair, then by the larger.
fn sorted(pairs: &PairTable, is_wanted: impl Fn(usize) -> bool) -> Vec<u32> {
    let objects = pairs.pairs().iter().map(|&(_, second)| second + 1).max().unwrap_or(0);
    let (mut order, mut partners) = (Vec::new(), Vec::new());
    for object in 0..objects {
        for (partner, index) in pairs.partners(object) {
            if partner >= object && is_wanted(index) {
                partners.push((partner, index));
            }
        }
        partners.sort_unstable();
        let indices = partners.drain(..).map(|(_, index)| index);
        order.extend(indices.map(|index| u32::try_from(index).expect("a pair table is smaller")));
    }
    order
}

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Returns the contacts of a pair; `None` if there is no such pair or its query is for
    /// proximity.
    pub(crate) fn contact_pair<'a>(
        &'a self,
        table: &'a ObjectTable<N, D>,
        first: u32,
        second: u32,
    ) -> Option<ContactPair<'a, N, D>> {
        self.contacts_at(table, self.pairs.index_of(first, second)?)
    }

    /// Returns the proximity of a pair; `None` if there is no such pair or its query is for
    /// contacts.
    pub(crate) fn proximity_pair(&self, first: u32, second: u32) -> Option<ProximityPair> {
        self.proximity_at(self.pairs.index_of(first, second)?)
    }

    /// Iterates over all pairs whose query is for contacts, sorted by handle index.
    pub(crate) fn contact_pairs<'a>(
        &'a self,
        table: &'a ObjectTable<N, D>,
    ) -> impl Iterator<Item = (u32, u32, ContactPair<'a, N, D>)> + 'a {
        self.sorted().filter_map(move |index| {
            let (first, second) = self.pairs.pairs()[index];
            Some((first, second, self.contacts_at(table, index)?))
        })
    }

    /// Iterates over all manifolds with at least one contact, sorted by the handle indices of their
    /// pairs.
    pub(crate) fn contact_manifolds<'a>(
        &'a self,
        table: &'a ObjectTable<N, D>,
    ) -> impl Iterator<Item = (u32, u32, &'a ContactManifold<N, D>)> + 'a {
        let is_touching = |index: usize| self.groups.is_touching(self.locations[index]);
        let touching = self.touching.get_or_init(|| sorted(&self.pairs, is_touching));
        touching.iter().flat_map(move |&index| {
            let (first, second) = self.pairs.pairs()[index as usize];
            let pair = self.contacts_at(table, index as usize);
            let manifolds = pair.into_iter().flat_map(ContactPair::manifolds);
            manifolds.map(move |manifold| (first, second, manifold))
        })
    }

    /// Returns all manifolds with at least one contact, in memory order.
    pub(crate) fn contact_views<'a>(&'a self, table: &'a ObjectTable<N, D>) -> Views<'a, N, D> {
        let convex = ConvexViews::new(self.groups.contacts.all(), table);
        let composites = CompositeViews::new(&self.groups.composites, table);
        Views { reads_in_place: table.reads_in_place(), convex, composites, custom: Some(self) }
    }

    /// Splits [`Self::contact_views`] into at least one and at most `pieces` consecutive parts,
    /// with about equally many pairs.
    pub(crate) fn contact_view_pieces<'a>(
        &'a self,
        table: &'a ObjectTable<N, D>,
        pieces: usize,
    ) -> impl Iterator<Item = Views<'a, N, D>> + 'a {
        let PairGroups { contacts, composites, .. } = &self.groups;
        // Cuts are between words of touching flags: first those of convex solids, then those of
        // composites. The last part also has the manifolds of custom algorithms.
        let convex = ConvexViews::num_words(contacts.all());
        let words = convex + composites.touching().len();
        let pieces = pieces.min(words).max(1);
        (0..pieces).map(move |piece| {
            let [from, to] = [piece, piece + 1].map(|cut| words * cut / pieces);
            let of_composites = from.saturating_sub(convex)..to.saturating_sub(convex);
            let of_convex = from.min(convex)..to.min(convex);
            let all = self.contact_views(table);
            Views {
                convex: all.convex.of_words(of_convex),
                composites: all.composites.of_words(of_composites),
                custom: all.custom.filter(|_| to == words),
                ..all
            }
        })
    }

    /// Iterates over the manifolds of custom algorithms with at least one contact.
    fn custom_views<'a>(&'a self) -> impl Iterator<Item = View<'a, N, D>> + Send + 'a {
        self.groups.custom_contacts.iter_touching().flat_map(|(key, entry)| {
            let manifolds = ContactPair::from_algorithm(&*entry.algorithm).manifolds();
            let views = manifolds.filter_map(ManifoldView::of_manifold);
            views.map(move |view| (key[0], key[1], view))
        })
    }

    /// Iterates over all pairs whose query is for proximity, sorted by handle index.
    pub(crate) fn proximity_pairs(&self) -> impl Iterator<Item = (u32, u32, ProximityPair)> + '_ {
        self.sorted().filter_map(move |index| {
            let (first, second) = self.pairs.pairs()[index];
            Some((first, second, self.proximity_at(index)?))
        })
    }

    fn contacts_at<'a>(
        &'a self,
        table: &'a ObjectTable<N, D>,
        index: usize,
    ) -> Option<ContactPair<'a, N, D>> {
        let location = self.locations[index];
        match location.group {
            GroupId::Contacts(kinds) => {
                let group = self.groups.contacts.of(kinds);
                let pair = BuiltIn { table, group, row: location.row };
                Some(ContactPair(ViewedContacts::BuiltIn(pair)))
            }
            GroupId::Composites => {
                let (group, row) = (&self.groups.composites, location.row);
                Some(ContactPair(ViewedContacts::Composite(Composite { table, group, row })))
            }
            GroupId::CustomContacts => {
                let entry = self.groups.custom_contacts.state(location.row);
                Some(ContactPair(ViewedContacts::Custom(&*entry.algorithm)))
            }
            _ => None,
        }
    }

    fn proximity_at(&self, index: usize) -> Option<ProximityPair> {
        let location = self.locations[index];
        let status = match location.group {
            GroupId::Proximity(kinds) => self.groups.proximity.of(kinds).state(location.row).status,
            GroupId::CustomProximity => self.groups.custom_proximity.state(location.row).status,
            _ => return None,
        };
        Some(ProximityPair(status.0))
    }

    /// Iterates over the indices of all pairs, sorted by pair.
    fn sorted(&self) -> impl Iterator<Item = usize> + '_ {
        let order = self.order.get_or_init(|| sorted(&self.pairs, |_| true));
        order.iter().map(|&index| index as usize)
    }

    /// Returns the objects that have a pair with `object`, sorted by handle index.
    pub(crate) fn partners(&self, object: u32) -> Vec<u32> {
        let mut partners: Vec<_> =
            self.pairs.partners(object).map(|(partner, _)| partner).collect();
        partners.sort_unstable();
        partners
    }

    /// Returns the number of pairs.
    #[must_use]
    pub fn num_pairs(&self) -> usize {
        self.pairs.len()
    }

    /// Checks that pairs, locations and groups agree.
    ///
    /// # Errors
    /// Returns a sentence that names the mismatch.
    pub fn validate(&self) -> Result<(), String> {
        self.pairs.validate()?;
        if self.locations.len() != self.pairs.len() {
            return Err("locations out of step with pairs".to_owned());
        }
        for (&pair, location) in self.pairs.pairs().iter().zip(&self.locations) {
            let key = PairKey::from(pair);
            let row = location.row;
            let found = match location.group {
                GroupId::Contacts(kinds) => self.groups.contacts.of(kinds).key(row),
                GroupId::Composites => self.groups.composites.key(row),
                GroupId::Proximity(kinds) => self.groups.proximity.of(kinds).key(row),
                GroupId::CustomContacts => self.groups.custom_contacts.key(row),
                GroupId::CustomProximity => self.groups.custom_proximity.key(row),
                GroupId::Nothing => key,
            };
            if found != key {
                return Err(format!("the state of pair {key:?} is that of {found:?}"));
            }
            let has_contacts = match location.group {
                GroupId::Contacts(kinds) => self.groups.contacts.of(kinds).state(row).is_touching(),
                GroupId::Composites => self.groups.composites.state(row).is_touching(),
                _ => continue,
            };
            if has_contacts != self.groups.is_touching(*location) {
                return Err(format!("readers hold a wrong opinion of pair {key:?}"));
            }
        }
        Ok(())
    }
}
