//! The shapes of a recording. Each shape is stored once and has an index.

use std::collections::BTreeMap;

use impinge::math::Space;
use impinge::shape::ShapeHandle;

use crate::error::{Problem, RecordError};
use crate::registry::Registry;
use crate::shape_data::{ShapeData, data_of, joins_alike};
use crate::space::Recordable;

/// The maximum nesting depth of a shape. The depth of a rounded shape or compound is one more than
/// that of the deepest shape in it.
pub const MAX_DEPTH: u32 = impinge::shape::MAX_NESTING;

/// The maximum number of parts of a shape. The parts of a shared shape count for each use.
pub const MAX_PARTS: usize = 1 << 20;

/// A shape with its nesting depth and its number of parts.
#[derive(Clone, Debug)]
struct SizedShape<N: Space<D>, const D: usize> {
    handle: ShapeHandle<N, D>,
    depth: u32,
    parts: usize,
}

/// The shapes of a recording, by index.
#[derive(Clone, Debug)]
pub(crate) struct ShapeTable<N: Space<D>, const D: usize> {
    shapes: Vec<SizedShape<N, D>>,
}

impl<N: Recordable<D>, const D: usize> ShapeTable<N, D> {
    /// Creates an empty table.
    pub(crate) const fn new() -> Self {
        Self { shapes: Vec::new() }
    }

    /// Returns the shape with an index; an error if it is not defined yet.
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

    /// Creates the shape with this data; an error if it would be too complex, if the library
    /// rejects the data, or if the data has an undefined index or an unknown name.
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

    /// Returns the nesting depth that a shape with this data would have, and the number of parts of
    /// its children; an error if one of them exceeds its maximum.
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

    /// Assigns the next index to a shape with this data.
    fn push(&mut self, data: &ShapeData<N, D>, handle: ShapeHandle<N, D>) -> Result<(), Problem> {
        let [depth, inner] = self.check(data)?;
        let own = handle.geometry().as_composite().map_or(1, |parts| parts.num_parts() as usize);
        let depth = u32::try_from(depth).map_err(|_| Problem::TooComplex)?;
        self.shapes.push(SizedShape { handle, depth, parts: inner.max(own) });
        Ok(())
    }
}

/// The shapes that a recorder has written, or will write before its next record. They are kept
/// alive, since an address identifies each of them.
#[derive(Clone, Debug)]
pub(crate) struct KnownShapes<N: Space<D>, const D: usize> {
    table: ShapeTable<N, D>,
    /// The index of each shape by its address. Addresses are used for look-ups only: no result
    /// depends on their order.
    numbers: BTreeMap<usize, u32>,
    /// The shapes that are not written yet.
    pub(crate) unwritten: Vec<ShapeData<N, D>>,
}

impl<N: Recordable<D>, const D: usize> KnownShapes<N, D> {
    /// Creates an empty set.
    pub(crate) fn new() -> Self {
        Self { table: ShapeTable::new(), numbers: BTreeMap::new(), unwritten: Vec::new() }
    }

    /// Returns the index of a shape. A shape that occurs for the first time gets the next index.
    pub(crate) fn number<T>(
        &mut self,
        shape: &ShapeHandle<N, D>,
        registry: &Registry<N, D, T>,
    ) -> Result<u32, RecordError> {
        // The table keeps the shape alive, so no other shape can get its address.
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

    /// Checks that the data reproduces the shape: with the same data and the same adjacency of
    /// parts. A mesh whose vertices were moved keeps its original adjacency, which may not follow
    /// from the new positions. Named shapes and shapes with shapes in them are not compared.
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

/// Returns data with the name under which the registry has a shape; `None` if it has none.
fn named<N: Recordable<D>, const D: usize, T>(
    shape: &ShapeHandle<N, D>,
    registry: &Registry<N, D, T>,
) -> Option<ShapeData<N, D>> {
    registry.name_of(shape).map(|name| ShapeData::Named(name.to_owned()))
}
