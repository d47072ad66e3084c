//! The shapes of a recording: each once, by number.

use std::collections::BTreeMap;

use impinge::math::Space;
use impinge::shape::ShapeHandle;

use crate::error::{Problem, RecordError};
use crate::registry::Registry;
use crate::shape_data::{ShapeData, data_of, joins_alike};
use crate::space::Recordable;

/// So deep may shapes nest: a rounded shape or compound is one deeper than what it holds.
pub const MAX_DEPTH: u32 = impinge::shape::MAX_NESTING;

/// So many parts may a shape have, those of what it holds counted as often as it holds them.
pub const MAX_PARTS: usize = 1 << 20;

/// A shape, and how large it is.
#[derive(Clone, Debug)]
struct SizedShape<N: Space<D>, const D: usize> {
    handle: ShapeHandle<N, D>,
    depth: u32,
    parts: usize,
}

/// Shapes by number.
#[derive(Clone, Debug)]
pub(crate) struct ShapeTable<N: Space<D>, const D: usize> {
    shapes: Vec<SizedShape<N, D>>,
}

impl<N: Recordable<D>, const D: usize> ShapeTable<N, D> {
    /// Without shapes.
    pub(crate) const fn new() -> Self {
        Self { shapes: Vec::new() }
    }

    /// The shape of a number, if it is defined by now.
    pub(crate) fn get(&self, number: u32) -> Result<&ShapeHandle<N, D>, Problem> {
        let shape = self.shapes.get(number as usize);
        Ok(&shape.ok_or(Problem::NoSuchShape(number))?.handle)
    }

    /// Defines the next shape by its data.
    pub(crate) fn define<T>(
        &mut self,
        data: &ShapeData<N, D>,
        registry: &Registry<N, D, T>,
    ) -> Result<(), Problem> {
        let handle = self.make(data, registry)?;
        self.push(data, handle)
    }

    /// The shape of some data, unless it would be too complex.
    fn make<T>(
        &self,
        data: &ShapeData<N, D>,
        registry: &Registry<N, D, T>,
    ) -> Result<ShapeHandle<N, D>, Problem> {
        self.check(data)?;
        if let ShapeData::Named(name) = data {
            let shape = registry.shape(name).cloned();
            return shape.ok_or_else(|| Problem::UnknownShape(name.clone()));
        }
        data.make(&|number| self.get(number).cloned())
    }

    /// How deep a shape of this data is, and how many parts those within it have.
    fn check(&self, data: &ShapeData<N, D>) -> Result<[usize; 2], Problem> {
        let (mut depth, mut parts) = (0, 0_usize);
        for number in data.inner() {
            let inner = self.shapes.get(number as usize).ok_or(Problem::NoSuchShape(number))?;
            depth = depth.max(inner.depth + 1);
            parts = parts.saturating_add(inner.parts);
        }
        let is_simple = depth <= MAX_DEPTH && parts <= MAX_PARTS;
        if is_simple { Ok([depth as usize, parts]) } else { Err(Problem::TooComplex) }
    }

    /// Gives the next number to a shape made of some data.
    fn push(&mut self, data: &ShapeData<N, D>, handle: ShapeHandle<N, D>) -> Result<(), Problem> {
        let [depth, inner] = self.check(data)?;
        let own = handle.geometry().as_composite().map_or(1, |parts| parts.num_parts() as usize);
        let depth = u32::try_from(depth).map_err(|_| Problem::TooComplex)?;
        self.shapes.push(SizedShape { handle, depth, parts: inner.max(own) });
        Ok(())
    }
}

/// The shapes that a recorder has met. It keeps each of them alive: their addresses are their identities.
#[derive(Clone, Debug)]
pub(crate) struct KnownShapes<N: Space<D>, const D: usize> {
    table: ShapeTable<N, D>,
    /// The number of the shape at an address. It is looked up only: the order of addresses means nothing.
    numbers: BTreeMap<usize, u32>,
    /// Those that are not written yet.
    pub(crate) unwritten: Vec<ShapeData<N, D>>,
}

impl<N: Recordable<D>, const D: usize> KnownShapes<N, D> {
    /// A recorder has met none.
    pub(crate) fn new() -> Self {
        Self { table: ShapeTable::new(), numbers: BTreeMap::new(), unwritten: Vec::new() }
    }

    /// The number of a shape, which is new if it was not met before.
    pub(crate) fn number<T>(
        &mut self,
        shape: &ShapeHandle<N, D>,
        registry: &Registry<N, D, T>,
    ) -> Result<u32, RecordError> {
        // The shape is kept alive below, so that no other one comes to have its address.
        let address = std::ptr::from_ref(&**shape).cast::<()>().addr();
        if let Some(&number) = self.numbers.get(&address) {
            return Ok(number);
        }
        let data = data_of(shape, &mut |inner| self.number(inner, registry))?;
        let data = match data.or_else(|| named(shape, registry)) {
            Some(data) => data,
            None => return Err(RecordError::UnknownShape { shape: format!("{:?}", &**shape) }),
        };
        self.check(&data, shape, registry)?;
        let number = u32::try_from(self.table.shapes.len()).map_err(|_| RecordError::TooComplex)?;
        self.table.push(&data, shape.clone()).map_err(|_| RecordError::TooComplex)?;
        self.numbers.insert(address, number);
        self.unwritten.push(data);
        Ok(number)
    }

    /// The data make the shape again: the same data, and parts that are joined in the same way. A mesh whose vertices
    /// were moved keeps the joints that it was made with, which its vertices alone do not say.
    fn check<T>(
        &self,
        data: &ShapeData<N, D>,
        shape: &ShapeHandle<N, D>,
        registry: &Registry<N, D, T>,
    ) -> Result<(), RecordError> {
        let deformed = || RecordError::Deformed { shape: format!("{:?}", &**shape) };
        let made = match self.table.make(data, registry) {
            Err(Problem::TooComplex) => return Err(RecordError::TooComplex),
            made => made.map_err(|_| deformed())?,
        };
        if !data.inner().is_empty() || matches!(data, ShapeData::Named(_)) {
            return Ok(());
        }
        let again = data_of(&made, &mut |_| Err(RecordError::TooComplex))?;
        let is_same = again.as_ref() == Some(data) && joins_alike(&**shape, &*made);
        if is_same { Ok(()) } else { Err(deformed()) }
    }
}

/// The name that the registry has for a shape of the user's own.
fn named<N: Recordable<D>, const D: usize, T>(
    shape: &ShapeHandle<N, D>,
    registry: &Registry<N, D, T>,
) -> Option<ShapeData<N, D>> {
    registry.name_of(shape).map(|name| ShapeData::Named(name.to_owned()))
}
