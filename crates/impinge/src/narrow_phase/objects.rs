//! What the narrow phase reads of the objects: a structure of arrays by handle index, apart from
//! the users' data.

use super::{CollisionObjectHandle, GeometricQueryType};
use crate::math::{Pose, Real};
use crate::shape::ShapeHandle;

/// The poses, shapes and query types as of the last update, by [`CollisionObjectHandle::uid`].
///
/// The world copies an object's row here when an update begins, if the object changed since the one
/// before; between updates the rows stand still, so that manifolds read then are those of the last
/// update. A row outlives its object until the index is given to another.
#[derive(Clone, Debug, Default)]
pub struct ObjectTable<N: Real, const D: usize> {
    handles: Vec<CollisionObjectHandle>,
    poses: Vec<Pose<N, D>>,
    shapes: Vec<ShapeHandle<N, D>>,
    queries: Vec<GeometricQueryType<N>>,
}

/// One row of the table.
#[derive(Clone, Debug)]
pub(crate) struct ObjectRow<N: Real, const D: usize> {
    pub(crate) handle: CollisionObjectHandle,
    pub(crate) pose: Pose<N, D>,
    pub(crate) shape: ShapeHandle<N, D>,
    pub(crate) query: GeometricQueryType<N>,
}

impl<N: Real, const D: usize> ObjectTable<N, D> {
    /// Writes an object's row; the index is that of a row already there or the next one.
    pub(crate) fn set(&mut self, row: ObjectRow<N, D>) {
        let index = row.handle.uid();
        if index == self.handles.len() {
            self.handles.push(row.handle);
            self.poses.push(row.pose);
            self.shapes.push(row.shape);
            self.queries.push(row.query);
            return;
        }
        self.handles[index] = row.handle;
        self.poses[index] = row.pose;
        self.shapes[index] = row.shape;
        self.queries[index] = row.query;
    }

    /// Moves an object without touching the rest of its row.
    pub(crate) fn set_pose(&mut self, index: usize, pose: Pose<N, D>) {
        self.poses[index] = pose;
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
    pub(crate) fn pose(&self, index: u32) -> &Pose<N, D> {
        &self.poses[index as usize]
    }

    /// The shape at the last update.
    pub(crate) fn shape(&self, index: u32) -> &ShapeHandle<N, D> {
        &self.shapes[index as usize]
    }

    /// The query type at the last update.
    pub(crate) fn query(&self, index: u32) -> GeometricQueryType<N> {
        self.queries[index as usize]
    }
}
