//! Contacts of a single pair of convex solids, or of a single pair with a composite.

use crate::collide::{ManifoldRequest, Placed, Solid};
use crate::math::{Point, Pose, Real, Space, Vector};
use crate::narrow_phase::state::{CompositeState, ContactState, KeptContacts, KeptPoints};
use crate::query::{ContactManifold, ManifoldView};
use crate::shape::Geometry;

/// The contacts of a single pair, stored from one update to the next.
#[derive(Clone)]
pub(in crate::narrow_phase) enum PairContacts<N: Real, const D: usize> {
    Convex(ContactState<N, D>),
    /// Contacts of a pair with a composite.
    Composite(Box<CompositeState<N, D>>),
}

impl<N: Real, const D: usize> PairContacts<N, D> {
    /// Creates an empty state.
    pub(in crate::narrow_phase) fn new(has_composite: bool) -> Self {
        if has_composite {
            Self::Composite(Box::default())
        } else {
            Self::Convex(ContactState::default())
        }
    }
}

impl<N: Real, const D: usize> KeptPoints<N, D> for PairContacts<N, D> {
    fn len(&self) -> usize {
        match self {
            Self::Convex(state) => state.len(),
            Self::Composite(state) => state.len(),
        }
    }

    fn is_swapped(&self) -> bool {
        match self {
            Self::Convex(state) => state.is_swapped(),
            Self::Composite(state) => state.is_swapped(),
        }
    }

    fn each_point(&mut self, each: impl FnMut(&Vector<N, D>, &mut N, &Point<N, D>)) {
        match self {
            Self::Convex(state) => state.each_point(each),
            Self::Composite(state) => state.each_point(each),
        }
    }
}

/// Reorders two values, one for each solid of a pair: the value of the solid in whose frame
/// contacts are stored comes first. `is_swapped` is `true` if this is the second solid.
pub(super) fn in_kept_order<T>([one, other]: [T; 2], is_swapped: bool) -> [T; 2] {
    if is_swapped { [other, one] } else { [one, other] }
}

/// Returns the pose of the solid in whose frame contacts are stored, relative to the other solid.
pub(super) fn pose21<N: Real, const D: usize>(
    [one, other]: &[Pose<N, D>; 2],
    is_swapped: bool,
) -> Pose<N, D> {
    let [first, second] = in_kept_order([one, other], is_swapped);
    Pose::relative(second, first)
}

/// Returns each shape with its pose.
pub(super) fn placed<'a, N: Real, const D: usize>(
    [pose1, pose2]: &[Pose<N, D>; 2],
    [shape1, shape2]: [Geometry<'a, N, D>; 2],
) -> [Placed<'a, N, D>; 2] {
    [Placed { pose: *pose1, shape: shape1 }, Placed { pose: *pose2, shape: shape2 }]
}

impl<N: Space<D>, const D: usize> PairContacts<N, D> {
    /// Updates the contacts. `copies` has a copy of each solid that is a ball, segment, capsule or
    /// box.
    pub(in crate::narrow_phase) fn update(
        &mut self,
        (poses, shapes): (&[Pose<N, D>; 2], [Geometry<'_, N, D>; 2]),
        copies: [Option<&Solid<N, D>>; 2],
        request: &ManifoldRequest<N>,
    ) {
        match self {
            Self::Convex(state) => state.update_alone((poses, shapes), copies, request),
            Self::Composite(state) => {
                state.update_between(&placed(poses, shapes), false, request);
            }
        }
    }

    /// Calls `each` with a view of each manifold; `number` is the pair identifier in contact ids.
    pub(in crate::narrow_phase) fn each_view(
        &self,
        placed: &[Placed<'_, N, D>; 2],
        number: u64,
        each: &mut dyn FnMut(ManifoldView<'_, N, D>),
    ) {
        match self {
            Self::Convex(state) if state.len() == 0 => {}
            Self::Convex(state) => each(state.view(placed, [0, 1], number)),
            Self::Composite(state) => {
                let views = (0..).map_while(|patch| state.view(placed, [0, 1], number, patch));
                views.for_each(each);
            }
        }
    }

    /// Returns the manifolds, in the memory of `old`. For two convex solids the list always has one
    /// manifold, which is empty if there is no contact.
    pub(in crate::narrow_phase) fn manifolds(
        &self,
        placed: &[Placed<'_, N, D>; 2],
        number: u64,
        mut old: Vec<ContactManifold<N, D>>,
    ) -> Vec<ContactManifold<N, D>> {
        match self {
            Self::Convex(state) => {
                let manifold = old.pop().unwrap_or_default();
                old.clear();
                old.push(state.manifolds(placed, number, manifold));
                old
            }
            Self::Composite(state) => state.manifolds(placed, number, old),
        }
    }
}
