//! Scenes for a solver, as plain numbers.

use impinge_scenes::{Placement, SceneShape};

/// A scene: solids that should come to rest or stay at rest, or slide.
#[derive(Clone, Debug)]
pub struct Stack<const D: usize> {
    /// The name, a few words, for tables, filters and messages.
    pub name: &'static str,
    /// The objects, the fixed ones first.
    pub items: Vec<Item<D>>,
    /// Coulomb's coefficient of friction of all pairs.
    pub friction: f64,
    /// The number of iterations of the solver; tall stacks need more.
    pub iterations: usize,
    /// Whether the solids stand, fall or slide.
    pub kind: Kind,
}

/// The expected behaviour of the solids of a scene, by which its measures are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Solids that stand at their initial positions.
    Rest,
    /// Solids that fall and come to rest.
    Fall,
    /// A solid that slides without friction.
    Slide,
}

/// An object of a scene.
#[derive(Clone, Debug)]
pub struct Item<const D: usize> {
    /// The shape.
    pub solid: Solid<D>,
    /// The initial placement.
    pub placement: Placement<D>,
    /// The density; zero for a fixed object.
    pub density: f64,
    /// The initial velocity.
    pub velocity: [f64; D],
}

/// The shape of an object.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid<const D: usize> {
    /// One shape.
    One(SceneShape<D>),
    /// Several shapes, which do not overlap each other.
    Compound(Vec<(Placement<D>, SceneShape<D>)>),
}

/// Mass, centre of mass and inertia tensor of a solid of density 1, in its local frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass<const D: usize> {
    /// The volume; in 2D the area.
    pub mass: f64,
    /// The centre of mass.
    pub center: [f64; D],
    /// The inertia tensor about the centre of mass; 2D uses only the last entry of the diagonal.
    pub inertia: [[f64; 3]; 3],
}

impl<const D: usize> Solid<D> {
    /// Returns the longest edge of the bounding box; infinite for half-spaces.
    #[must_use]
    pub fn extent(&self) -> f64 {
        let boxes: Vec<_> = match self {
            Self::One(shape) => vec![shape.aabb(&Placement::at([0.0; D]))],
            Self::Compound(parts) => parts.iter().map(|(at, shape)| shape.aabb(at)).collect(),
        };
        let edge = |axis: usize| {
            let low = boxes.iter().map(|b| b.map_or(f64::NEG_INFINITY, |(low, _)| low[axis]));
            let high = boxes.iter().map(|b| b.map_or(f64::INFINITY, |(_, high)| high[axis]));
            high.fold(f64::NEG_INFINITY, f64::max) - low.fold(f64::INFINITY, f64::min)
        };
        (0..D).map(edge).fold(0.0, f64::max)
    }
}

impl<const D: usize> Stack<D> {
    /// Returns the extents of the objects.
    #[must_use]
    pub fn extents(&self) -> Vec<f64> {
        self.items.iter().map(|item| item.solid.extent()).collect()
    }

    /// Creates a scene without objects, with friction 0.5 and 10 iterations.
    pub(crate) fn new(name: &'static str, kind: Kind) -> Self {
        Self { name, items: Vec::new(), friction: 0.5, iterations: 10, kind }
    }

    /// Adds a fixed object.
    pub(crate) fn fixed(self, shape: SceneShape<D>, at: [f64; D]) -> Self {
        self.item(Item {
            solid: Solid::One(shape),
            placement: Placement::at(at),
            density: 0.0,
            velocity: [0.0; D],
        })
    }

    /// Adds a movable solid.
    pub(crate) fn with(self, shape: SceneShape<D>, placement: Placement<D>) -> Self {
        let velocity = [0.0; D];
        self.item(Item { solid: Solid::One(shape), placement, density: 1.0, velocity })
    }

    /// Adds an object.
    pub(crate) fn item(mut self, item: Item<D>) -> Self {
        self.items.push(item);
        self
    }
}
