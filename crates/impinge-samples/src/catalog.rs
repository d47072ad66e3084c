//! The list of all samples.

use impinge_scenes::{asteroids, mixed_shapes, rain, sensors, sparse_drift, terrain_mesh};

use crate::gallery::{Entry, Make, Shows};
use crate::samples::motion::{
    arm::Arm, bullets::Bullets, character::Character, conveyor::Conveyor, crowd::Crowd,
    gripper::Gripper, pile::Pile, stack::Stack,
};
use crate::samples::pairs::{
    grid::Grid, own::OwnShapes, playground::Playground, spinning::Spinning, through::Through,
};
use crate::samples::queries::{casts::Casts, clearance::Clearance, nearest::Nearest, rays::Rays};
use crate::samples::worlds::{
    broad_phase::BroadPhase, groups::Groups, one_sided::OneSided, scaling::Scaling,
    scenery::Scenery, slide::Slide, waves::Waves,
};

/// Expands each row to one [`Entry`] for each of the row's dimensions. The digit of the dimension
/// is appended to the name and to the heading.
///
/// A row contains the name, the heading, the dimensions, the property that a test checks, the
/// sample, and a description of two sentences.
macro_rules! entries {
    ($(
        $name:literal, $title:literal, [$($make:ident $digit:literal),+], $shows:ident, $sample:expr,
        $about:literal;
    )+) => {
        &[$($(
            Entry {
                name: concat!($name, $digit),
                title: concat!($title, " in ", $digit, "D"),
                about: $about,
                shows: Shows::$shows,
                make: Make::$make(|| Box::new($sample)),
            },
        )+)+]
    };
}

/// All samples in the order of the gallery.
pub(crate) const ENTRIES: &[Entry] = entries! {
    "playground", "Two shapes", [Plane 2, Space 3], Drawing, Playground::default(),
    "Drag one shape against the other: distance, closest points, contact and manifold follow. \
        The arrow is a cast of the second shape, with its impact.";

    "pairs", "Every two kinds", [Plane 2, Space 3], Contacts, Grid::default(),
    "Each cell has two solids, one of which turns and is brought to touch the other by a cast. \
        Every pair of kinds has its manifold: points for round solids, lines and areas for flat ones.";

    "stack", "A stack", [Plane 2, Space 3], Contacts, Stack::default(),
    "Boxes lie on each other, with two contact points between any two in 2D and four in 3D. \
        A small solver in the samples pushes them apart by these points alone.";

    "pile", "A pile that comes to rest", [Plane 2, Space 3], Contacts, Pile::default(),
    "Solids of four kinds drop between walls and come to rest. \
        The solver is one file of the samples; all that it knows are contact points and their ids.";

    "floor", "A floor without bumps", [Plane 2, Space 3], Contacts, Slide::default(),
    "A box slides over a floor of triangles, and all normals stay vertical. \
        With contacts of each triangle by itself the inner edges push back, which the red lines mark.";

    "character", "A character along walls", [Plane 2, Space 3], Drawing, Character::default(),
    "A capsule walks on, and slides along what its casts hit. \
        It never gets nearer to anything than its skin is thick.";

    "arm", "A robot arm", [Plane 2, Space 3], Contacts, Arm::default(),
    "Links that hit an obstacle or another link are marked red; a pair filter leaves out those that share a joint. \
        It can turn back before it hits, since overlaps are asked for beforehand.";

    "gripper", "A gripper", [Plane 2, Space 3], Contacts, Gripper::default(),
    "Two fingers close on an object, and stop where a cast says that they touch it. \
        They never go into it, whatever its shape is.";

    "bullets", "Bullets and thin walls", [Plane 2, Space 3], Drawing, Bullets::default(),
    "The walls are much thinner than the path of a bullet in a step is long. \
        Casts reflect it as often as it hits, so that none ever gets through.";

    "spinning", "When spinning bars touch", [Plane 2, Space 3], Drawing, Spinning::default(),
    "Two thin bars fly towards each other and turn; the moment and the point of their first touch are known from the start. \
        They stop there, at a distance of zero.";

    "depth", "Through a solid", [Plane 2, Space 3], Drawing, Through::default(),
    "A solid moves through another: the red line is its depth, above zero where they overlap. \
        The normal turns to where the way out is the shortest.";

    "rays", "A fan of rays", [Plane 2, Space 3], Drawing, Rays::default(),
    "Rays from one point hit the nearest asteroids, as those of a scanner do. \
        The recording has each ray with its answer.";

    "casts", "A solid that is cast", [Plane 2, Space 3], Drawing, Casts::default(),
    "A solid flies from the middle in a direction that turns, and stops at its first impact. \
        It may stop a distance before, or list all that it would hit.";

    "nearest", "The nearest objects", [Plane 2, Space 3], Drawing, Nearest::default(),
    "Lines lead to the objects that are nearest to a ball, in order of their distance. \
        Drag the ball: the search visits few objects only.";

    "clearance", "Space along a path", [Plane 2, Space 3], Drawing, Clearance::default(),
    "The path is red where a body on it would be near an obstacle, and green where there is space enough. \
        Drag obstacles, and make the body larger.";

    "crowd", "A crowd", [Plane 2], Drawing, Crowd::default(),
    "People walk to the opposite side of a circle, and give way to those who are nearest. \
        The green lines are the velocities that follow from the nearest four.";

    "conveyor", "Sensors over a conveyor", [Plane 2, Space 3], ProximityEvents, Conveyor::default(),
    "Each light barrier counts the goods of one kind that enter it, by events of proximity. \
        Groups decide which kind it is interested in.";

    "sensors", "Sensors among boxes", [Plane 2, Space 3], ProximityEvents, Scenery::new(sensors, [120, 1000]),
    "Every tenth object is a ball that reports which boxes are within it, without contact points. \
        The numbers count the events since the start.";

    "groups", "Groups and filters", [Plane 2, Space 3], Contacts, Groups::default(),
    "Boxes of three teams drift, and a rule says which teams touch each other. \
        A pair filter may refuse more pairs, by the labels of the objects.";

    "boxes", "Ten thousand boxes", [Space 3], Contacts, Scenery::new(sparse_drift, [10_000, 10_000]),
    "Ten thousand boxes drift and turn, and each step updates all their pairs. \
        Touching boxes have manifolds all the time.";

    "kinds", "All kinds of shapes", [Plane 2, Space 3], Contacts, Scenery::new(mixed_shapes, [120, 1000]),
    "Solids of all kinds fly about above a half-space. \
        Some ask for contacts, some for proximity alone.";

    "rain", "Rain on hills", [Plane 2, Space 3], Contacts, Scenery::new(rain, [120, 1000]),
    "Solids fall on hilly terrain of triangles and rise again. \
        At any time a few of them touch it.";

    "terrain", "Solids on hills", [Plane 2, Space 3], Contacts, Scenery::new(terrain_mesh, [60, 400]),
    "Balls, boxes, capsules and stones slide and hop over hilly terrain. \
        Contacts follow the surface, not the edges within it.";

    "asteroids", "Asteroids", [Plane 2, Space 3], Contacts, Scenery::new(asteroids, [150, 1000]),
    "Convex rocks drift and turn in all directions. \
        Their hulls touch at corners, edges and faces.";

    "broad-phase", "What the broad phase sees", [Plane 2, Space 3], Drawing, BroadPhase::default(),
    "Each object has a loosened box, which stays while the object moves within it, and a tree holds them all. \
        Of all pairs few have boxes that overlap, and only these are tested.";

    "scaling", "From a thousandth to a million", [Plane 2, Space 3], Contacts, Scaling::default(),
    "The same scene at any size has the same contacts, since no tolerance is an absolute length. \
        The last number is the same at every power of two, and changes only far from the origin.";

    "waves", "A surface in motion", [Plane 2, Space 3], Contacts, Waves::default(),
    "The surface gets another shape at each step, and balls ride on it. \
        Their contacts are those of the new shape, with its normals.";

    "one-sided", "A surface with one side", [Plane 2, Space 3], Contacts, OneSided::default(),
    "A ball rises through a hill that is solid from above alone, and is pushed up as soon as its middle is through. \
        With two sides it is pushed down before.";

    "own-shapes", "Shapes of one's own", [Plane 2, Space 3], Contacts, OwnShapes::default(),
    "The lens is a convex shape by its support map, the beads are a composite by its parts and their boxes. \
        Both are code of the sample, and have every query that the built-in shapes have.";
};
