//! Shapes in saved worlds. Each shape is saved once and referred to by its number; a shape that
//! another shape holds is saved before that shape.
//!
//! The record of a shape is the input of its constructor, if the constructor restores the shape
//! exactly. A hull is saved with its faces instead, and a mesh whose vertices were moved also with
//! its joints. Derived data are not saved: they are computed again, with the same bits.

mod mesh;
mod plane;
mod space;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub(crate) use self::mesh::MeshRecord;
pub(crate) use self::plane::{front2, make2, record2};
pub(crate) use self::space::{front3, make3, record3};
use crate::math::numbers::{Damage, NumberSource, Numbers, ensure};
use crate::math::{Real, Space, Unit};
use crate::shape::{
    Ball, Capsule, CompositeShape, Compound, Cuboid, Ellipsoid, MeshByDimension, Plane, Polyline,
    Rounded, Segment, Shape, ShapeHandle, TaperedCapsule, TriMesh, Triangle,
};

/// The name and the data of a shape of your own, in a saved world; see [`Shape::saved`].
///
/// ```
/// use impinge::dim2::bounding_volume::Aabb;
/// use impinge::dim2::math::{Isometry, Point, Vector};
/// use impinge::dim2::shape::{Ball, Geometry, SavedShape, Shape, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, ContactQuery, Registry};
///
/// /// A ball that has a colour.
/// #[derive(Debug)]
/// struct Marble(Ball<f32>, u8);
///
/// impl Shape<f32, 2> for Marble {
///     fn geometry(&self) -> Geometry<'_, f32> {
///         self.0.geometry()
///     }
///     fn local_aabb(&self) -> Aabb<f32> {
///         self.0.local_aabb()
///     }
///     fn saved(&self) -> Option<SavedShape> {
///         let radius = self.0.radius().to_le_bytes();
///         Some(SavedShape { name: "marble".to_owned(), data: [&radius[..], &[self.1]].concat() })
///     }
/// }
///
/// fn marble(data: &[u8]) -> Option<ShapeHandle<f32>> {
///     let (radius, colour) = data.split_first_chunk::<4>()?;
///     let ball = Ball::try_new(f32::from_le_bytes(*radius)).ok()?;
///     Some(ShapeHandle::new(Marble(ball, *colour.first()?)))
/// }
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let shape = ShapeHandle::new(Marble(Ball::new(0.5), 7));
/// let at = Isometry::translation(1.0, 2.0);
/// let handle = world.add(at, shape, CollisionGroups::new(), ContactQuery::default(), ());
///
/// let text = serde_json::to_string(&world).expect("all of it can be saved");
/// let registry = Registry::<f32, ()>::new().with_shape("marble", marble);
/// let restored = registry.restore(&mut serde_json::Deserializer::from_str(&text)).expect("saved just now");
/// let again = restored.counterpart(handle).and_then(|handle| restored.collision_object(handle));
/// let marble = again.and_then(|object| object.shape().as_shape::<Marble>()).expect("a marble");
/// assert_eq!((marble.0.radius(), marble.1), (0.5, 7));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SavedShape {
    /// The name of the type, for [`Registry::with_shape`](crate::world::Registry::with_shape).
    pub name: String,
    /// The data of the shape, in a format of yours.
    pub data: Vec<u8>,
}

/// The reason why a shape cannot be saved.
#[derive(Clone, Debug)]
pub(crate) enum UnsavedShape {
    /// The shape has a user's type, and [`Shape::saved`] returns `None`. The text is its `Debug`
    /// output.
    Own(String),
    /// Compounds have more parts than [`PartLimit`] admits, or there are too many shapes for 32-bit
    /// numbers.
    TooManyParts,
}

/// The record of a shape in a saved world.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) enum ShapeRecord<N: Real> {
    /// The radius.
    Ball(Numbers<N>),
    /// The coordinates of both ends.
    Segment(Numbers<N>),
    /// The coordinates of both ends, then the radius.
    Capsule(Numbers<N>),
    /// The coordinates of the corners.
    Triangle(Numbers<N>),
    /// The half extents.
    Cuboid(Numbers<N>),
    /// The half axes.
    Ellipsoid(Numbers<N>),
    /// The coordinates of both ends, then both radii.
    TaperedCapsule(Numbers<N>),
    /// The outward normal; it is not normalised again.
    HalfSpace(Numbers<N>),
    /// The number of the inner shape, and the radius.
    Rounded(u32, Numbers<N>),
    /// The number and the position of each child.
    Compound(Vec<(u32, Numbers<N>)>),
    Polyline(MeshRecord<N>),
    TriMesh(MeshRecord<N>),
    HeightField(FieldRecord<N>),
    /// The coordinates of the vertices.
    ConvexPolygon(Numbers<N>),
    ConvexHull {
        vertices: Numbers<N>,
        /// The normal of each face.
        normals: Numbers<N>,
        faces: Vec<Vec<u32>>,
    },
    /// Half of the height, then the radius.
    Cylinder(Numbers<N>),
    /// Half of the height, then the radius.
    Cone(Numbers<N>),
    /// The coordinates of the corners.
    Tetrahedron(Numbers<N>),
    /// A shape of a user's type.
    Own(SavedShape),
}

/// The record of a height field.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct FieldRecord<N: Real> {
    pub(in crate::shape) columns: u32,
    pub(in crate::shape) heights: Numbers<N>,
    pub(in crate::shape) scale: Numbers<N>,
    /// The rule of the diagonals: 0 for forward, 1 for backward, 2 for zigzag.
    pub(in crate::shape) diagonals: u8,
    /// The marks of each cell; empty if no cell was ever marked. Bits 0 and 1 mark holes, bit 2 a
    /// diagonal that differs from the rule, bit 3 a ghost.
    pub(in crate::shape) marks: Vec<u8>,
    pub(in crate::shape) is_one_sided: bool,
    pub(in crate::shape) keeps_internal_edges: bool,
}

/// The records of the shapes saved so far.
#[derive(Debug)]
pub(crate) struct ShapeRecords<N: Real> {
    /// The number of each saved shape, by its address. All shapes stay alive while they are saved,
    /// so the address identifies a shape.
    numbers: BTreeMap<usize, u32>,
    limit: PartLimit,
    pub(crate) records: Vec<ShapeRecord<N>>,
}

impl<N: Real> ShapeRecords<N> {
    pub(crate) fn new() -> Self {
        Self { numbers: BTreeMap::new(), limit: PartLimit::default(), records: Vec::new() }
    }

    /// Returns the number of a shape. If the shape has no number yet, first saves the shapes that
    /// it holds, then the shape. Returns an error if the shape, or a shape that it holds, is a
    /// user's shape that cannot be saved, or if there are too many parts or shapes.
    pub(crate) fn number<const D: usize>(
        &mut self,
        shape: &ShapeHandle<N, D>,
    ) -> Result<u32, UnsavedShape>
    where
        N: Space<D>,
    {
        let address = core::ptr::from_ref(&**shape).cast::<()>().addr();
        if let Some(&number) = self.numbers.get(&address) {
            return Ok(number);
        }
        let record = self.record(shape)?;
        if !self.limit.admits(&record, &**shape) {
            return Err(UnsavedShape::TooManyParts);
        }
        let number = u32::try_from(self.records.len()).map_err(|_| UnsavedShape::TooManyParts)?;
        self.numbers.insert(address, number);
        self.records.push(record);
        Ok(number)
    }

    fn record<const D: usize>(
        &mut self,
        shape: &ShapeHandle<N, D>,
    ) -> Result<ShapeRecord<N>, UnsavedShape>
    where
        N: Space<D>,
    {
        if let Some(rounded) = shape.as_shape::<Rounded<N, D>>() {
            let inner = self.number(rounded.shape())?;
            return Ok(ShapeRecord::Rounded(inner, Numbers::of([rounded.radius()])));
        }
        if let Some(compound) = shape.as_shape::<Compound<N, D>>() {
            let children = compound.children().iter();
            let children = children
                .map(|(at, child)| Ok((self.number(child)?, Numbers::of_isometry::<D>(at))));
            return Ok(ShapeRecord::Compound(children.collect::<Result<_, _>>()?));
        }
        let record = solid::<N, D>(&**shape)
            .or_else(|| mesh::record::<N, D>(&**shape))
            .or_else(|| <N::Algorithms>::shape_record(&**shape))
            .or_else(|| shape.saved().map(ShapeRecord::Own));
        record.ok_or_else(|| UnsavedShape::Own(format!("{:?}", &**shape)))
    }
}

/// Returns the record of a half-space, or of a convex solid that exists in both dimensions. `None`
/// for any other shape.
fn solid<N: Real, const D: usize>(shape: &dyn Shape<N, D>) -> Option<ShapeRecord<N>> {
    let ends = |segment: &Segment<N, D>| Numbers::of_points(&[*segment.a(), *segment.b()]);
    let and = |mut numbers: Numbers<N>, more: &[N]| {
        numbers.extend(more);
        numbers
    };
    let of = |vector: &[N]| Numbers::of(vector.iter().copied());
    Some(if let Some(ball) = shape.as_shape::<Ball<N>>() {
        ShapeRecord::Ball(Numbers::of([ball.radius()]))
    } else if let Some(segment) = shape.as_shape::<Segment<N, D>>() {
        ShapeRecord::Segment(ends(segment))
    } else if let Some(capsule) = shape.as_shape::<Capsule<N, D>>() {
        ShapeRecord::Capsule(and(ends(capsule.segment()), &[capsule.radius()]))
    } else if let Some(triangle) = shape.as_shape::<Triangle<N, D>>() {
        ShapeRecord::Triangle(Numbers::of_points(triangle.corners()))
    } else if let Some(cuboid) = shape.as_shape::<Cuboid<N, D>>() {
        ShapeRecord::Cuboid(of(cuboid.half_extents().as_slice()))
    } else if let Some(ellipsoid) = shape.as_shape::<Ellipsoid<N, D>>() {
        ShapeRecord::Ellipsoid(of(ellipsoid.half_axes().as_slice()))
    } else if let Some(capsule) = shape.as_shape::<TaperedCapsule<N, D>>() {
        ShapeRecord::TaperedCapsule(and(ends(capsule.segment()), &capsule.radii()))
    } else {
        ShapeRecord::HalfSpace(of(shape.as_shape::<Plane<N, D>>()?.normal().as_slice()))
    })
}

/// Restores all shapes from their records, in order; `own` restores shapes of a user's types. Ends
/// with the first error: a damaged record, an error of `own`, or too many parts.
pub(crate) fn make_all<N: Space<D>, E: From<Damage>, const D: usize>(
    records: Vec<ShapeRecord<N>>,
    own: &mut dyn FnMut(&SavedShape) -> Result<ShapeHandle<N, D>, E>,
) -> Result<Vec<ShapeHandle<N, D>>, E> {
    let (mut shapes, mut limit) = (Vec::new(), PartLimit::default());
    for record in records {
        let shape = match &record {
            ShapeRecord::Own(saved) => own(saved)?,
            record => make(record, &shapes)?,
        };
        ensure(limit.admits(&record, &*shape), "compounds have too many parts")?;
        shapes.push(shape);
    }
    Ok(shapes)
}

/// Restores a shape of the library; `known` are the shapes restored before it. An error if the
/// record is damaged.
fn make<N: Space<D>, const D: usize>(
    record: &ShapeRecord<N>,
    known: &[ShapeHandle<N, D>],
) -> Result<ShapeHandle<N, D>, Damage> {
    let held = |number: u32| shape_of(known, number).cloned();
    Ok(match record {
        ShapeRecord::Rounded(inner, radius) => {
            let [radius] = radius.array()?;
            let made = Rounded::try_from_handle(held(*inner)?, radius);
            ShapeHandle::new(made.map_err(|error| Damage::found(&error))?)
        }
        ShapeRecord::Compound(children) => {
            let children = children.iter().map(|(number, at)| Ok((at.isometry()?, held(*number)?)));
            let made = Compound::try_new(children.collect::<Result<_, Damage>>()?);
            ShapeHandle::new(made.map_err(|error| Damage::found(&error))?)
        }
        ShapeRecord::Polyline(mesh) => ShapeHandle::new(Polyline::of_record(mesh)?),
        ShapeRecord::TriMesh(mesh) => ShapeHandle::new(TriMesh::of_record(mesh)?),
        record => match make_solid(record)? {
            Some(shape) => shape,
            None => <N::Algorithms>::make_shape(record)?,
        },
    })
}

/// Returns the shape with the number `number`; an error if there is none.
pub(crate) fn shape_of<N: Real, const D: usize>(
    shapes: &[ShapeHandle<N, D>],
    number: u32,
) -> Result<&ShapeHandle<N, D>, Damage> {
    shapes.get(number as usize).ok_or(Damage("there is no shape of a number".into()))
}

/// Restores a shape from a record that [`solid`] returned; `None` for any other kind of record, and
/// an error for a damaged one.
fn make_solid<N: Real, const D: usize>(
    record: &ShapeRecord<N>,
) -> Result<Option<ShapeHandle<N, D>>, Damage> {
    Ok(Some(match record {
        ShapeRecord::Ball(radius) => {
            let [radius] = radius.array()?;
            made(Ball::try_new(radius))?
        }
        ShapeRecord::Segment(ends) => {
            let [a, b] = ends.all(NumberSource::points)?;
            made(Segment::<N, D>::try_new(a, b))?
        }
        ShapeRecord::Capsule(sizes) => {
            let ([a, b], radius) = sizes.all(|sizes| Ok((sizes.points()?, sizes.number()?)))?;
            made(Capsule::<N, D>::try_from_ends(a, b, radius))?
        }
        ShapeRecord::Triangle(corners) => {
            let [a, b, c] = corners.all(NumberSource::points)?;
            made(Triangle::<N, D>::try_new(a, b, c))?
        }
        ShapeRecord::Cuboid(sizes) => {
            made(Cuboid::<N, D>::try_new(sizes.all(NumberSource::vector)?))?
        }
        ShapeRecord::Ellipsoid(sizes) => {
            made(Ellipsoid::<N, D>::try_new(sizes.all(NumberSource::vector)?))?
        }
        ShapeRecord::TaperedCapsule(sizes) => {
            let ([a, b], radii) = sizes.all(|sizes| Ok((sizes.points()?, sizes.array()?)))?;
            made(TaperedCapsule::<N, D>::try_from_ends(a, b, radii))?
        }
        ShapeRecord::HalfSpace(normal) => {
            let normal = Unit::new_unchecked(normal.all(NumberSource::vector)?);
            made(Plane::<N, D>::try_new(normal))?
        }
        _ => return Ok(None),
    }))
}

/// Moves the shape into a handle, or converts the constructor's error.
fn made<N: Real, S: Shape<N, D>, E: core::fmt::Display, const D: usize>(
    result: Result<S, E>,
) -> Result<ShapeHandle<N, D>, Damage> {
    result.map(ShapeHandle::new).map_err(|error| Damage::found(&error))
}

/// The number of parts that a compound may have in addition to the parts listed in the data.
const FREE_PARTS: u64 = 1 << 20;

/// Limits the number of parts of a compound to the number of parts that the data list plus
/// [`FREE_PARTS`]. A short chain of compounds that each hold the previous one twice could otherwise
/// have more parts than there is memory for their contacts.
#[derive(Debug, Default)]
struct PartLimit {
    listed: u64,
}

impl PartLimit {
    /// Counts the parts that the record lists, and returns whether the shape is within the limit.
    fn admits<N: Real, const D: usize>(
        &mut self,
        record: &ShapeRecord<N>,
        shape: &dyn Shape<N, D>,
    ) -> bool {
        let parts = shape.geometry().as_composite().map_or(1, CompositeShape::num_parts);
        let (listed, may_repeat) = match record {
            ShapeRecord::Compound(children) => (children.len() as u64, true),
            _ => (parts.into(), false),
        };
        self.listed = self.listed.saturating_add(listed);
        !may_repeat || u64::from(parts) <= FREE_PARTS.saturating_add(self.listed)
    }
}
