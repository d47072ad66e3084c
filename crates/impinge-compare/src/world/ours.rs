//! The contender impinge, in 2D and 3D.
//!
//! The library is imported as `super::impinge`, so that another package can compile this file once
//! for each of two versions of the library.

use std::hint::black_box;

use super::impinge::math::na::{Quaternion, Translation, Unit, UnitComplex, UnitQuaternion};
use super::impinge::math::{Isometry2, Isometry3, Point, Space, Vector};
use super::impinge::narrow_phase::{CollisionObjectHandle, DefaultNarrowPhase, GeometricQueryType};
use super::impinge::query::{ManifoldView, Proximity};
use super::impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, HeightField, Plane, Polyline,
    Segment, ShapeHandle, TriMesh, Triangle,
};
use super::impinge::world::{CollisionGroups, CollisionObject, CollisionWorld};
use impinge_scenes::{Placement, Scene, SceneQuery, SceneShape};

use super::PREDICTION;
use super::contender::{Change, Contender, Reading};

type Isometry<const D: usize> = <f32 as Space<D>>::Isometry;

/// A world of impinge.
pub struct Impinge<const D: usize>
where
    f32: Space<D>,
{
    world: CollisionWorld<f32, D, usize>,
    isometry: fn(&Placement<D>) -> Isometry<D>,
    parts: Vec<Part<D>>,
    /// The handle of each object by its index in the scene; `None` for an object that is not alive.
    handles: Vec<Option<CollisionObjectHandle>>,
    gone: Vec<CollisionObjectHandle>,
    born: Vec<(usize, Isometry<D>)>,
    moved: Vec<(CollisionObjectHandle, Isometry<D>)>,
}

/// The constant properties of an object: its shape and its kind of query.
struct Part<const D: usize> {
    shape: ShapeHandle<f32, D>,
    query: GeometricQueryType<f32>,
}

/// Creates a 2D world with the objects of a scene at step 0.
pub fn plane(scene: &Scene<2>) -> Impinge<2> {
    let particular = |shape: &SceneShape<2>| match shape {
        SceneShape::Convex { points } => {
            ShapeHandle::new(ConvexPolygon::from_points(&points_of(points)))
        }
        SceneShape::Polyline { vertices } => ShapeHandle::new(Polyline::open(points_of(vertices))),
        SceneShape::HeightField { heights, extents, .. } => {
            ShapeHandle::new(HeightField::<f32, 2>::new(scalars(heights), vector(extents)))
        }
        other => unreachable!("{other:?} is not of the plane"),
    };
    Impinge::new(scene, particular, |placement| {
        let [cosine, sine] = placement.complex().map(|x| x as f32);
        let rotation = UnitComplex::from_cos_sin_unchecked(cosine, sine);
        let translation = placement.translation.map(|x| x as f32);
        Isometry2::from_parts(Translation::from(translation), rotation)
    })
}

/// Creates a 3D world with the objects of a scene at step 0.
pub fn space(scene: &Scene<3>) -> Impinge<3> {
    let particular = |shape: &SceneShape<3>| match shape {
        SceneShape::Convex { points } => {
            ShapeHandle::new(ConvexHull::from_points(&points_of(points)))
        }
        SceneShape::Cylinder { half_height, radius } => {
            ShapeHandle::new(Cylinder::new(*half_height as f32, *radius as f32))
        }
        SceneShape::Cone { half_height, radius } => {
            ShapeHandle::new(Cone::new(*half_height as f32, *radius as f32))
        }
        SceneShape::TriMesh { vertices, triangles } => {
            ShapeHandle::new(TriMesh::new(points_of(vertices), triangles.clone()))
        }
        SceneShape::HeightField { counts: [rows, columns], heights, extents } => {
            let heights = scalars(heights);
            ShapeHandle::new(HeightField::<f32, 3>::new(*rows, *columns, heights, vector(extents)))
        }
        other => unreachable!("{other:?} is of every dimension"),
    };
    Impinge::new(scene, particular, |placement| {
        let [i, j, k, w] = placement.quaternion().map(|x| x as f32);
        let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        let translation = placement.translation.map(|x| x as f32);
        Isometry3::from_parts(Translation::from(translation), rotation)
    })
}

impl<const D: usize> Impinge<D>
where
    f32: Space<D>,
{
    /// Creates a world. `particular` converts the shapes whose type in impinge differs between 2D
    /// and 3D, or exists in one dimension only.
    fn new(
        scene: &Scene<D>,
        particular: fn(&SceneShape<D>) -> ShapeHandle<f32, D>,
        isometry: fn(&Placement<D>) -> Isometry<D>,
    ) -> Self {
        let parts = scene.objects.iter().map(|object| {
            let query = match object.query {
                SceneQuery::Contacts { linear, angular } => {
                    GeometricQueryType::Contacts(linear as f32, angular as f32)
                }
                SceneQuery::Proximity { margin } => GeometricQueryType::Proximity(margin as f32),
            };
            let shape = common(&object.shape).unwrap_or_else(|| particular(&object.shape));
            Part { shape, query }
        });
        let mut made = Self {
            world: CollisionWorld::new(scene.margin as f32),
            isometry,
            parts: parts.collect(),
            handles: vec![None; scene.objects.len()],
            gone: Vec::new(),
            born: Vec::new(),
            moved: Vec::new(),
        };
        for n in (0..scene.objects.len()).filter(|n| scene.is_alive(*n, 0)) {
            made.add(n, isometry(&scene.placement(n, 0)));
        }
        made
    }

    fn add(&mut self, number: usize, position: Isometry<D>) {
        let Part { shape, query } = &self.parts[number];
        let groups = CollisionGroups::new();
        let handle = self.world.add(position, shape.clone(), groups, *query, number);
        self.handles[number] = Some(handle);
    }

    /// Returns the world.
    pub fn world(&self) -> &CollisionWorld<f32, D, usize> {
        &self.world
    }

    /// Lets each pair keep its contacts until it has moved by half of the prediction.
    pub fn reusing(mut self) -> Self {
        let narrow_phase = DefaultNarrowPhase::new().reusing(PREDICTION / 2.0);
        self.world.set_narrow_phase(Box::new(narrow_phase));
        self
    }
}

fn point<const D: usize>(point: &[f64; D]) -> Point<f32, D> {
    Point::from(point.map(|x| x as f32))
}

fn vector<const D: usize>(v: &[f64; D]) -> Vector<f32, D> {
    Vector::<f32, D>::from(v.map(|x| x as f32))
}

fn scalars(numbers: &[f64]) -> Vec<f32> {
    numbers.iter().map(|x| *x as f32).collect()
}

fn points_of<const D: usize>(points: &[[f64; D]]) -> Vec<Point<f32, D>> {
    points.iter().map(point).collect()
}

/// Converts the shapes whose type in impinge is the same in 2D and 3D; returns `None` for all other
/// shapes.
fn common<const D: usize>(shape: &SceneShape<D>) -> Option<ShapeHandle<f32, D>> {
    Some(match shape {
        SceneShape::Ball { radius } => ShapeHandle::new(Ball::new(*radius as f32)),
        SceneShape::Cuboid { half_extents } => ShapeHandle::new(Cuboid::new(vector(half_extents))),
        SceneShape::Plane { normal } => {
            ShapeHandle::new(Plane::new(Unit::new_normalize(vector(normal))))
        }
        SceneShape::Capsule { half_height, radius } => {
            ShapeHandle::new(Capsule::new(*half_height as f32, *radius as f32))
        }
        SceneShape::Segment { ends: [a, b] } => ShapeHandle::new(Segment::new(point(a), point(b))),
        SceneShape::Triangle { corners: [a, b, c] } => {
            ShapeHandle::new(Triangle::new(point(a), point(b), point(c)))
        }
        _ => return None,
    })
}

/// Reads every contact point of a world, on all threads of the current pool.
pub fn read<const D: usize, T: Sync>(world: &CollisionWorld<f32, D, T>) -> Reading
where
    f32: Space<D>,
{
    #[cfg(feature = "parallel")]
    if rayon::current_num_threads() > 1 {
        use rayon::prelude::*;
        let pieces = world.contact_view_pieces(4 * rayon::current_num_threads());
        let readings = pieces.into_par_iter().map(read_all);
        return readings.reduce(Reading::default, Reading::plus);
    }
    read_all(world.contact_views())
}

/// The two objects of a pair, and one of its manifolds.
type View<'a, const D: usize, T> =
    (&'a CollisionObject<f32, D, T>, &'a CollisionObject<f32, D, T>, ManifoldView<'a, f32, D>);

fn read_all<'a, const D: usize, T: 'a>(views: impl Iterator<Item = View<'a, D, T>>) -> Reading
where
    f32: Space<D>,
{
    let mut reading = Reading::default();
    for (_, _, manifold) in views {
        for point in manifold.contacts() {
            reading.points += 1;
            reading.depth += f64::from(black_box(point).contact.depth);
        }
    }
    reading
}

impl<const D: usize> Contender<D> for Impinge<D>
where
    f32: Space<D>,
{
    fn prepare(&mut self, change: &Change<D>) {
        let Self { isometry, handles, gone, born, moved, .. } = self;
        gone.clear();
        born.clear();
        moved.clear();
        gone.extend(change.gone.iter().filter_map(|n| handles[*n].take()));
        born.extend(change.born.iter().map(|(n, at)| (*n, isometry(at))));
        let poses = change.moved.iter().filter_map(|(n, at)| Some((handles[*n]?, isometry(at))));
        moved.extend(poses);
    }

    fn step(&mut self) {
        if !self.gone.is_empty() {
            self.world.remove(&self.gone);
        }
        for at in 0..self.born.len() {
            let (number, isometry) = self.born[at];
            self.add(number, isometry);
        }
        for (handle, isometry) in &self.moved {
            self.world.set_position(*handle, *isometry);
        }
        self.world.update();
    }

    fn read(&mut self) -> Reading {
        read(&self.world)
    }

    fn touching(&self) -> Vec<(usize, usize)> {
        let touching = self.world.contact_views();
        let mut pairs: Vec<_> = touching.map(|(a, b, _)| (*a.data(), *b.data())).collect();
        let near = self.world.proximity_pairs();
        let met = near.filter(|(_, _, pair)| pair.proximity() == Proximity::Intersecting);
        pairs.extend(met.map(|(a, b, _)| (*a.data(), *b.data())));
        for pair in &mut pairs {
            *pair = (pair.0.min(pair.1), pair.0.max(pair.1));
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }
}
