//! Helpers of the tests: samples by name, and a renderer that counts lines.

use impinge::debug_render::{Color, DebugDrawing, DebugRender};
use impinge::math::na::{self, Rotation};
use impinge::math::{Point, Space};
use impinge::world::CollisionObject;
use impinge_record::Recordable;
use impinge_samples::{ControlValue, Entry, Make, Running, Sample, World, entries};

pub(crate) type Object<const D: usize> = CollisionObject<f32, D, String>;

/// A constructor of samples in `D` dimensions, which returns `None` for a sample of the other
/// dimension.
pub(crate) trait Stage<const D: usize>: Recordable<D> {
    fn make(entry: &Entry) -> Option<Box<dyn Sample<D>>>;
}

impl Stage<2> for f32 {
    fn make(entry: &Entry) -> Option<Box<dyn Sample<2>>> {
        if let Make::Plane(make) = entry.make { Some(make()) } else { None }
    }
}

impl Stage<3> for f32 {
    fn make(entry: &Entry) -> Option<Box<dyn Sample<3>>> {
        if let Make::Space(make) = entry.make { Some(make()) } else { None }
    }
}

/// Returns the sample called `name` followed by the digit of its dimension.
pub(crate) fn running<const D: usize>(name: &str) -> Running<D>
where
    f32: Stage<D>,
{
    let name = format!("{name}{D}");
    let entry = entries().iter().find(|entry| entry.name == name).expect("a sample of this name");
    let sample = f32::make(entry).expect("a sample of this dimension");
    Running::new(sample).expect("it starts")
}

pub(crate) fn set_number<const D: usize>(running: &mut Running<D>, name: &str, value: f64)
where
    f32: Recordable<D>,
{
    running.set_control(name, &ControlValue::Number(value)).expect("a usable number");
}

pub(crate) fn choose<const D: usize>(running: &mut Running<D>, name: &str, word: &str)
where
    f32: Recordable<D>,
{
    running.set_control(name, &ControlValue::Choice(word.to_owned())).expect("a known word");
}

/// Returns the value of the readout with this label.
pub(crate) fn readout<const D: usize>(running: &Running<D>, label: &str) -> String
where
    f32: Recordable<D>,
{
    let readouts = running.readouts();
    let found = readouts.into_iter().find(|readout| readout.label == label);
    found.unwrap_or_else(|| panic!("a readout {label:?}")).value
}

/// Returns the object with this label.
pub(crate) fn labelled<'a, const D: usize>(world: &'a World<D>, label: &str) -> &'a Object<D>
where
    f32: Recordable<D>,
{
    let mut objects = world.collision_objects();
    objects.find(|object| object.data() == label).expect("an object of this label")
}

/// Returns the position of an object as the isometry type that queries of two shapes accept in
/// either dimension.
pub(crate) fn position<const D: usize>(object: &Object<D>) -> na::Isometry<f32, Rotation<f32, D>, D>
where
    f32: Space<D>,
{
    let pose = f32::pose(object.position());
    let rotation = Rotation::from_matrix_unchecked(pose.rotation);
    na::Isometry::from_parts(pose.translation.into(), rotation)
}

/// A renderer that counts lines, and the lines whose ends are not finite.
#[derive(Debug, Default)]
pub(crate) struct Count {
    pub(crate) lines: usize,
    pub(crate) broken: usize,
}

impl<const D: usize> DebugRender<f32, D> for Count
where
    f32: Space<D>,
{
    fn line(&mut self, ends: [Point<f32, D>; 2], _: Color, _: impinge::debug_render::Drawn) {
        let is_finite = ends.iter().flat_map(|end| end.iter()).all(|x| x.is_finite());
        self.lines += 1;
        self.broken += usize::from(!is_finite);
    }
}

/// Draws the elements that a sample adds to its objects, and returns the numbers of lines.
pub(crate) fn drawn<const D: usize>(running: &Running<D>) -> Count
where
    f32: Recordable<D>,
{
    let mut count = Count::default();
    running.draw(&mut DebugDrawing::default(), &mut count);
    count
}
