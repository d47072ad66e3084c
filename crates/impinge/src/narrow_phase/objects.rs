//! What the narrow phase reads of the objects: a structure of arrays by handle index, apart from
//! the users' data.

use super::{CollisionObjectHandle, GeometricQueryType};
use crate::math::{Pose, Space};
use crate::shape::ShapeHandle;

/// The poses, shapes and query types as of the last update, by [`CollisionObjectHandle::uid`].
///
/// The world copies an object's row here when an update begins, if the object changed since the one
/// before; between updates the rows stand still, so that manifolds read then are those of the last
/// update. A row outlives its object until the index is given to another.
///
/// The table also knows which rows were written in the update under way: pairs of rows that
/// stand still need no new query.
#[derive(Clone, Debug)]
pub struct ObjectTable<N: Space<D>, const D: usize> {
    handles: Vec<CollisionObjectHandle>,
    poses: Vec<Pose<N, D>>,
    shapes: Vec<ShapeHandle<N, D>>,
    queries: Vec<GeometricQueryType<N>>,
    /// The poses as the user gave them, for algorithms of the user's own.
    isometries: Vec<N::Isometry>,
    /// The update in which each row was written last.
    written: Vec<u64>,
    /// The rows written in the update under way, each once, in order of writing.
    changed: Vec<u32>,
    update: u64,
}

/// One row of the table.
#[derive(Clone, Debug)]
pub(crate) struct ObjectRow<N: Space<D>, const D: usize> {
    pub(crate) handle: CollisionObjectHandle,
    pub(crate) isometry: N::Isometry,
    pub(crate) shape: ShapeHandle<N, D>,
    pub(crate) query: GeometricQueryType<N>,
}

impl<N: Space<D>, const D: usize> ObjectTable<N, D> {
    /// A table without rows.
    pub(crate) const fn new() -> Self {
        Self {
            handles: Vec::new(),
            poses: Vec::new(),
            shapes: Vec::new(),
            queries: Vec::new(),
            isometries: Vec::new(),
            written: Vec::new(),
            changed: Vec::new(),
            update: 0,
        }
    }

    /// Forgets which rows were written: those written from now on are the changed ones.
    pub(crate) fn begin_update(&mut self) {
        self.update += 1;
        self.changed.clear();
    }

    /// Writes an object's row; the index is that of a row already there or the next one.
    pub(crate) fn set(&mut self, row: ObjectRow<N, D>) {
        let index = row.handle.uid();
        if index == self.handles.len() {
            self.push(row);
            return;
        }
        self.handles[index] = row.handle;
        self.shapes[index] = row.shape;
        self.queries[index] = row.query;
        self.set_position(row.handle.index(), row.isometry);
    }

    fn push(&mut self, row: ObjectRow<N, D>) {
        self.changed.push(row.handle.index());
        self.written.push(self.update);
        self.handles.push(row.handle);
        self.poses.push(N::pose(&row.isometry));
        self.isometries.push(row.isometry);
        self.shapes.push(row.shape);
        self.queries.push(row.query);
    }

    /// Moves an object without touching the rest of its row.
    pub(crate) fn set_position(&mut self, index: u32, isometry: N::Isometry) {
        let row = index as usize;
        self.poses[row] = N::pose(&isometry);
        self.isometries[row] = isometry;
        if self.written[row] != self.update {
            self.written[row] = self.update;
            self.changed.push(index);
        }
    }

    /// The rows written since the last update began.
    pub(crate) fn changed(&self) -> &[u32] {
        &self.changed
    }

    /// The row was written since the last update began.
    #[inline]
    pub(crate) fn has_changed(&self, index: u32) -> bool {
        self.written[index as usize] == self.update
    }

    /// How many rows there are.
    pub(crate) fn len(&self) -> usize {
        self.handles.len()
    }

    /// The handle of the object that the row was written for.
    pub(crate) fn handle(&self, index: u32) -> CollisionObjectHandle {
        self.handles[index as usize]
    }

    /// The pose at the last update.
    #[inline]
    pub(crate) fn pose(&self, index: u32) -> &Pose<N, D> {
        &self.poses[index as usize]
    }

    /// The pose at the last update, as the user gave it.
    pub(crate) fn isometry(&self, index: u32) -> &N::Isometry {
        &self.isometries[index as usize]
    }

    /// The shape at the last update.
    #[inline]
    pub(crate) fn shape(&self, index: u32) -> &ShapeHandle<N, D> {
        &self.shapes[index as usize]
    }

    /// The query type at the last update.
    pub(crate) fn query(&self, index: u32) -> GeometricQueryType<N> {
        self.queries[index as usize]
    }
}
