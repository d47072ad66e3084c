//! The list of all samples.

use impinge_scenes::{asteroids, mixed_shapes, rain, sensors, sparse_drift, terrain_mesh};

use crate::gallery::{Entry, Make, Shows};
use crate::samples::motion::arm::Arm;
use crate::samples::motion::bullets::Bullets;
use crate::samples::motion::character::Character;
use crate::samples::motion::conveyor::Conveyor;
use crate::samples::motion::crowd::Crowd;
use crate::samples::motion::gripper::Gripper;
use crate::samples::motion::pile::Pile;
use crate::samples::motion::stack::Stack;
use crate::samples::pairs::grid::Grid;
use crate::samples::pairs::own::OwnShapes;
use crate::samples::pairs::playground::Playground;
use crate::samples::pairs::spinning::Spinning;
use crate::samples::pairs::through::Through;
use crate::samples::queries::casts::Casts;
use crate::samples::queries::clearance::Clearance;
use crate::samples::queries::nearest::Nearest;
use crate::samples::queries::rays::Rays;
use crate::samples::worlds::broad_phase::BroadPhase;
use crate::samples::worlds::groups::Groups;
use crate::samples::worlds::one_sided::OneSided;
use crate::samples::worlds::scaling::Scaling;
use crate::samples::worlds::scenery::Scenery;
use crate::samples::worlds::slide::Slide;
use crate::samples::worlds::waves::Waves;

/// In the order of the gallery.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "playground2",
        title: "Two shapes in 2D",
        about: PLAYGROUND,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(Playground::default())),
    },
    Entry {
        name: "playground3",
        title: "Two shapes in 3D",
        about: PLAYGROUND,
        shows: Shows::Drawing,
        make: Make::Space(|| Box::new(Playground::default())),
    },
    Entry {
        name: "pairs2",
        title: "Every two kinds in 2D",
        about: PAIRS,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Grid::default())),
    },
    Entry {
        name: "pairs3",
        title: "Every two kinds in 3D",
        about: PAIRS,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Grid::default())),
    },
    Entry {
        name: "stack2",
        title: "A stack in 2D",
        about: "Boxes lie on each other, with two contact points between any two. \
                A small solver in the samples pushes them apart by these points alone.",
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Stack::<2>::default())),
    },
    Entry {
        name: "stack3",
        title: "A stack in 3D",
        about: "Boxes lie on each other, with four contact points between any two. \
                A small solver in the samples pushes them apart by these points alone.",
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Stack::<3>::default())),
    },
    Entry {
        name: "pile2",
        title: "A pile that comes to rest in 2D",
        about: PILE,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Pile::<2>::default())),
    },
    Entry {
        name: "pile3",
        title: "A pile that comes to rest in 3D",
        about: PILE,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Pile::<3>::default())),
    },
    Entry {
        name: "floor2",
        title: "A floor without bumps in 2D",
        about: FLOOR,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Slide::<2>::default())),
    },
    Entry {
        name: "floor3",
        title: "A floor without bumps in 3D",
        about: FLOOR,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Slide::<3>::default())),
    },
    Entry {
        name: "character2",
        title: "A character along walls in 2D",
        about: CHARACTER,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(Character::<2>::default())),
    },
    Entry {
        name: "character3",
        title: "A character along walls in 3D",
        about: CHARACTER,
        shows: Shows::Drawing,
        make: Make::Space(|| Box::new(Character::<3>::default())),
    },
    Entry {
        name: "arm2",
        title: "A robot arm in 2D",
        about: ARM,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Arm::<2>::default())),
    },
    Entry {
        name: "arm3",
        title: "A robot arm in 3D",
        about: ARM,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Arm::<3>::default())),
    },
    Entry {
        name: "gripper2",
        title: "A gripper in 2D",
        about: GRIPPER,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Gripper::<2>::default())),
    },
    Entry {
        name: "gripper3",
        title: "A gripper in 3D",
        about: GRIPPER,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Gripper::<3>::default())),
    },
    Entry {
        name: "bullets2",
        title: "Bullets and thin walls in 2D",
        about: BULLETS,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(Bullets::<2>::default())),
    },
    Entry {
        name: "bullets3",
        title: "Bullets and thin walls in 3D",
        about: BULLETS,
        shows: Shows::Drawing,
        make: Make::Space(|| Box::new(Bullets::<3>::default())),
    },
    Entry {
        name: "spinning2",
        title: "When spinning bars touch in 2D",
        about: SPINNING,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(Spinning::<2>::default())),
    },
    Entry {
        name: "spinning3",
        title: "When spinning bars touch in 3D",
        about: SPINNING,
        shows: Shows::Drawing,
        make: Make::Space(|| Box::new(Spinning::<3>::default())),
    },
    Entry {
        name: "depth2",
        title: "Through a solid in 2D",
        about: DEPTH,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(Through::default())),
    },
    Entry {
        name: "depth3",
        title: "Through a solid in 3D",
        about: DEPTH,
        shows: Shows::Drawing,
        make: Make::Space(|| Box::new(Through::default())),
    },
    Entry {
        name: "rays2",
        title: "A fan of rays in 2D",
        about: RAYS,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(Rays::<2>::default())),
    },
    Entry {
        name: "rays3",
        title: "A fan of rays in 3D",
        about: RAYS,
        shows: Shows::Drawing,
        make: Make::Space(|| Box::new(Rays::<3>::default())),
    },
    Entry {
        name: "casts2",
        title: "A solid that is cast in 2D",
        about: CASTS,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(Casts::<2>::default())),
    },
    Entry {
        name: "casts3",
        title: "A solid that is cast in 3D",
        about: CASTS,
        shows: Shows::Drawing,
        make: Make::Space(|| Box::new(Casts::<3>::default())),
    },
    Entry {
        name: "nearest2",
        title: "The nearest objects in 2D",
        about: NEAREST,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(Nearest::<2>::default())),
    },
    Entry {
        name: "nearest3",
        title: "The nearest objects in 3D",
        about: NEAREST,
        shows: Shows::Drawing,
        make: Make::Space(|| Box::new(Nearest::<3>::default())),
    },
    Entry {
        name: "clearance2",
        title: "Space along a path in 2D",
        about: CLEARANCE,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(Clearance::<2>::default())),
    },
    Entry {
        name: "clearance3",
        title: "Space along a path in 3D",
        about: CLEARANCE,
        shows: Shows::Drawing,
        make: Make::Space(|| Box::new(Clearance::<3>::default())),
    },
    Entry {
        name: "crowd2",
        title: "A crowd",
        about: CROWD,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(Crowd::<2>::default())),
    },
    Entry {
        name: "conveyor2",
        title: "Sensors over a conveyor in 2D",
        about: CONVEYOR,
        shows: Shows::ProximityEvents,
        make: Make::Plane(|| Box::new(Conveyor::default())),
    },
    Entry {
        name: "conveyor3",
        title: "Sensors over a conveyor in 3D",
        about: CONVEYOR,
        shows: Shows::ProximityEvents,
        make: Make::Space(|| Box::new(Conveyor::default())),
    },
    Entry {
        name: "sensors2",
        title: "Sensors among boxes in 2D",
        about: SENSORS,
        shows: Shows::ProximityEvents,
        make: Make::Plane(|| Box::new(Scenery::<2>::new(sensors, [120, 1000]))),
    },
    Entry {
        name: "sensors3",
        title: "Sensors among boxes in 3D",
        about: SENSORS,
        shows: Shows::ProximityEvents,
        make: Make::Space(|| Box::new(Scenery::<3>::new(sensors, [120, 1000]))),
    },
    Entry {
        name: "groups2",
        title: "Groups and filters in 2D",
        about: GROUPS,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Groups::<2>::default())),
    },
    Entry {
        name: "groups3",
        title: "Groups and filters in 3D",
        about: GROUPS,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Groups::<3>::default())),
    },
    Entry {
        name: "boxes3",
        title: "Ten thousand boxes",
        about: BOXES,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Scenery::<3>::new(sparse_drift, [10_000, 10_000]))),
    },
    Entry {
        name: "kinds2",
        title: "All kinds of shapes in 2D",
        about: KINDS,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Scenery::<2>::new(mixed_shapes, [120, 1000]))),
    },
    Entry {
        name: "kinds3",
        title: "All kinds of shapes in 3D",
        about: KINDS,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Scenery::<3>::new(mixed_shapes, [120, 1000]))),
    },
    Entry {
        name: "rain2",
        title: "Rain on hills in 2D",
        about: RAIN,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Scenery::<2>::new(rain, [120, 1000]))),
    },
    Entry {
        name: "rain3",
        title: "Rain on hills in 3D",
        about: RAIN,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Scenery::<3>::new(rain, [120, 1000]))),
    },
    Entry {
        name: "terrain2",
        title: "Solids on hills in 2D",
        about: TERRAIN,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Scenery::<2>::new(terrain_mesh, [60, 400]))),
    },
    Entry {
        name: "terrain3",
        title: "Solids on hills in 3D",
        about: TERRAIN,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Scenery::<3>::new(terrain_mesh, [60, 400]))),
    },
    Entry {
        name: "asteroids2",
        title: "Asteroids in 2D",
        about: ASTEROIDS,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Scenery::<2>::new(asteroids, [150, 1000]))),
    },
    Entry {
        name: "asteroids3",
        title: "Asteroids in 3D",
        about: ASTEROIDS,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Scenery::<3>::new(asteroids, [150, 1000]))),
    },
    Entry {
        name: "broad-phase2",
        title: "What the broad phase sees in 2D",
        about: BROAD_PHASE,
        shows: Shows::Drawing,
        make: Make::Plane(|| Box::new(BroadPhase::<2>::default())),
    },
    Entry {
        name: "broad-phase3",
        title: "What the broad phase sees in 3D",
        about: BROAD_PHASE,
        shows: Shows::Drawing,
        make: Make::Space(|| Box::new(BroadPhase::<3>::default())),
    },
    Entry {
        name: "scaling2",
        title: "From a thousandth to a million in 2D",
        about: SCALING,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Scaling::default())),
    },
    Entry {
        name: "scaling3",
        title: "From a thousandth to a million in 3D",
        about: SCALING,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Scaling::default())),
    },
    Entry {
        name: "waves2",
        title: "A surface in motion in 2D",
        about: WAVES,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(Waves::<2>::default())),
    },
    Entry {
        name: "waves3",
        title: "A surface in motion in 3D",
        about: WAVES,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(Waves::<3>::default())),
    },
    Entry {
        name: "one-sided2",
        title: "A surface with one side in 2D",
        about: ONE_SIDED,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(OneSided::default())),
    },
    Entry {
        name: "one-sided3",
        title: "A surface with one side in 3D",
        about: ONE_SIDED,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(OneSided::default())),
    },
    Entry {
        name: "own-shapes2",
        title: "Shapes of one's own in 2D",
        about: OWN_SHAPES,
        shows: Shows::Contacts,
        make: Make::Plane(|| Box::new(OwnShapes::<2>::default())),
    },
    Entry {
        name: "own-shapes3",
        title: "Shapes of one's own in 3D",
        about: OWN_SHAPES,
        shows: Shows::Contacts,
        make: Make::Space(|| Box::new(OwnShapes::<3>::default())),
    },
];

// What to see, for both dimensions.

const PLAYGROUND: &str = "Drag one shape against the other: distance, closest points, contact and manifold follow. \
    The arrow is a cast of the second shape, with its impact.";
const PAIRS: &str = "Each cell has two solids, one of which turns and is brought to touch the other by a cast. \
    Every pair of kinds has its manifold: points for round solids, lines and areas for flat ones.";
const PILE: &str = "Solids of four kinds drop between walls and come to rest. \
    The solver is one file of the samples; all that it knows are contact points and their ids.";
const FLOOR: &str = "A box slides over a floor of triangles, and all normals stay vertical. \
    With contacts of each triangle by itself the inner edges push back, which the red lines mark.";
const CHARACTER: &str = "A capsule walks on, and slides along what its casts hit. \
    It never gets nearer to anything than its skin is thick.";
const ARM: &str = "Links that hit an obstacle or another link are marked red; a pair filter leaves out those that share a joint. \
    It can turn back before it hits, since overlaps are asked for beforehand.";
const GRIPPER: &str = "Two fingers close on an object, and stop where a cast says that they touch it. \
    They never go into it, whatever its shape is.";
const BULLETS: &str = "The walls are much thinner than the way that a bullet makes in a step. \
    Casts reflect it as often as it hits, so that none ever gets through.";
const SPINNING: &str = "Two thin bars fly towards each other and turn; the moment and the point of their first touch are known from the start. \
    They stop there, at a distance of zero.";
const DEPTH: &str = "A solid moves through another: the red line is its depth, above zero where they overlap. \
    The normal turns to where the way out is the shortest.";
const RAYS: &str = "Rays from one point hit the nearest asteroids, as those of a scanner do. \
    The recording has each ray with its answer.";
const CASTS: &str = "A solid flies from the middle in a direction that turns, and stops at its first impact. \
    It may stop a distance before, or list all that it would hit.";
const NEAREST: &str = "Lines lead to the objects that are nearest to a ball, in order of their distance. \
    Drag the ball: the answer needs a look at few objects only.";
const CLEARANCE: &str = "The path is red where a body on it would be near an obstacle, and green where there is space enough. \
    Drag obstacles, and make the body larger.";
const CROWD: &str = "People walk to the opposite side of a circle, and give way to those who are nearest. \
    The green lines are the velocities that follow from the nearest four.";
const CONVEYOR: &str = "Each light barrier counts the goods of one kind that enter it, by events of proximity. \
    Groups decide which kind it is interested in.";
const SENSORS: &str = "Every tenth object is a ball that reports which boxes are within it, without contact points. \
    The numbers count the events since the start.";
const GROUPS: &str = "Boxes of three teams drift, and a rule says which teams touch each other. \
    A pair filter may refuse more pairs, by the labels of the objects.";
const BOXES: &str = "Ten thousand boxes drift and turn, and each step updates all their pairs. \
    Touching boxes have manifolds all the time.";
const KINDS: &str = "Solids of all kinds fly about above a half-space. \
    Some ask for contacts, some for proximity alone.";
const RAIN: &str = "Solids fall on hilly ground of triangles and rise again. \
    At any time a few of them touch it.";
const TERRAIN: &str = "Balls, boxes, capsules and stones slide and hop over hilly ground. \
    Contacts follow the surface, not the edges within it.";
const ASTEROIDS: &str = "Convex rocks drift and turn in all directions. \
    Their hulls touch at corners, edges and faces.";
const BROAD_PHASE: &str = "Each object has a loosened box, which stays while the object moves within it, and a tree holds them all. \
    Of all pairs few have boxes that overlap, and only these are looked at.";
const SCALING: &str = "The same scene at any size has the same contacts, since no tolerance is an absolute length. \
    The last number is the same at every power of two, and changes only far from the origin.";
const WAVES: &str = "The surface gets another shape at each step, and balls ride on it. \
    Their contacts are those of the new shape, with its normals.";
const ONE_SIDED: &str = "A ball rises through a hill that is solid from above alone, and is pushed up as soon as its middle is through. \
    With two sides it is pushed down before.";
const OWN_SHAPES: &str = "The lens is a convex shape by its support map, the beads are a composite by its parts and their boxes. \
    Both are code of the sample, and have every query that the built-in shapes have.";
