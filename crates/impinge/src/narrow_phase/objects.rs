//! The object table: poses, shapes and query types of the objects that have pairs, as a structure
//! of arrays apart from the users' data.
//!
//! ```text
//! handle index   rows: Vec<u32>          row -> handles | solids | bounds | queries | isometries | is_written
//!       0          1 ───────────────┐     0      ...
//!       1          NONE (no pair)   └───> 1      pose and shape in one cache line, the rest apart
//!       2          0                      2      free
//! ```

use core::fmt;

use super::group::PairKey;
use super::substep::PairSolids;
use super::{CollisionObjectHandle, GeometricQueryType};
use crate::collide::far::ReachBounds;
use crate::journal::Journal;
use crate::math::{Mapped, Pose, Real, Space};
use crate::memory::{Look, clone_fields};
use crate::query::PlacedSolids;
use crate::shape::{Geometry, ShapeHandle};

/// Entry in `rows` of an object without a row.
const NONE: u32 = u32::MAX;

/// Poses, shapes and query types of the objects that have pairs, as of the last update. An object
/// is identified by its index, [`CollisionObjectHandle::uid`].
///
/// The world writes an object's row when the object's first pair starts. It writes the row again at
/// the start of an update if the object changed since the previous update. Between updates the rows
/// are constant, so manifolds that are read then are those of the last update. When the last pair
/// of the object stops, its row becomes free for another object.
///
/// The table also records which rows were written in the current update. A pair needs no new query
/// if the rows of both objects are unchanged.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::shape::{Cuboid, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f64, ()>::new(0.02);
/// let square = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0)));
/// let (groups, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
/// let [a, b] = [0.0, 1.75].map(|y| {
///     world.add(Isometry::translation(0.0, y), square.clone(), groups, contacts, ())
/// });
/// world.update();
///
/// world.set_position(b, Isometry::translation(9.0, 9.0));
/// let object = world.collision_object(b).expect("it is there");
/// assert_eq!(object.position().translation.x, 9.0, "the world knows at once");
/// // The table of the narrow phase is written at the next update.
/// world.update();
/// # assert!(world.contains(a));
/// ```
pub struct ObjectTable<N: Space<D>, const D: usize> {
    /// By handle index: the row of the object, or [`NONE`].
    rows: Vec<u32>,
    /// The handle of each row's object. This array and the following arrays, up to `is_written`,
    /// are indexed by row.
    handles: Vec<CollisionObjectHandle>,
    solids: Vec<ObjectSolid<N, D>>,
    /// Bounding balls and boxes of the shapes, which reject most distant pairs without loading the
    /// shapes.
    bounds: Vec<ReachBounds<N, D>>,
    queries: Vec<GeometricQueryType<N>>,
    /// The poses as the user set them, for custom algorithms.
    isometries: Vec<N::Isometry>,
    /// Whether the row was written in the current update.
    is_written: Vec<bool>,
    /// Rows without an object; the last one in the list is used next.
    free: Vec<u32>,
    /// Handle indices of the objects whose rows were written in the current update, in order of
    /// writing. An object stays in the list when its row is released, and is listed again if it
    /// gets another row.
    changed: Vec<u32>,
    /// Number of rows acquired since the last [`Self::compact`].
    acquired: usize,
    /// Pairs that were computed one by one since the last update, sorted by key, with the poses at
    /// which they were computed.
    pub(super) substeps: Vec<PairSolids<N, D>>,
    /// By handle index, up to the largest index of an object with a skin: the skin, as of the last
    /// update.
    pub(super) skins: Vec<N>,
    journal: Journal<RowNote<N, D>, Vec<PairSolids<N, D>>, Option<ObjectRow<N, D>>>,
}

clone_fields!([N: Space<D>, const D: usize] ObjectTable<N, D> {
    rows, handles, solids, bounds, queries, isometries, is_written, free, changed, acquired, substeps, skins, journal,
});

/// The state of an object before a change.
#[derive(Clone, Copy, Debug)]
enum RowNote<N: Space<D>, const D: usize> {
    /// The handle index of an object, and its isometry before a move.
    Moved(u32, N::Isometry),
    /// The handle index of an object, and its skin before a change of row or skin. The journal also
    /// has the old row; `None` if the object had no row.
    Whole(u32, N),
}

impl<N: Space<D>, const D: usize> fmt::Debug for ObjectTable<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let num_objects = self.handles.len() - self.free.len();
        f.debug_struct("ObjectTable").field("num_objects", &num_objects).finish_non_exhaustive()
    }
}

/// Data of an object that every query of a pair reads: one cache line for `f32` in 3D.
#[derive(Debug)]
#[repr(align(64))]
pub(super) struct ObjectSolid<N: Real, const D: usize> {
    pub(super) pose: Pose<N, D>,
    pub(super) shape: ShapeHandle<N, D>,
}

clone_fields!([N: Real, const D: usize] ObjectSolid<N, D> { pose, shape });

/// One row of the table.
#[derive(Clone, Debug)]
pub(crate) struct ObjectRow<N: Space<D>, const D: usize> {
    pub(crate) handle: CollisionObjectHandle,
    pub(crate) isometry: N::Isometry,
    pub(crate) shape: ShapeHandle<N, D>,
    pub(crate) query: GeometricQueryType<N>,
}

impl<N: Space<D>, const D: usize> PlacedSolids<N, D> for ObjectTable<N, D> {
    fn placed(&self, object: u32) -> (&Pose<N, D>, Geometry<'_, N, D>) {
        (self.pose(object), self.shape(object).geometry())
    }

    #[inline]
    fn pose(&self, object: u32) -> &Pose<N, D> {
        Self::pose(self, object)
    }
}

impl<N: Space<D>, const D: usize> ObjectTable<N, D> {
    /// Creates a table without rows.
    pub(crate) fn new() -> Self {
        Self {
            rows: Vec::new(),
            handles: Vec::new(),
            solids: Vec::new(),
            bounds: Vec::new(),
            queries: Vec::new(),
            isometries: Vec::new(),
            is_written: Vec::new(),
            free: Vec::new(),
            changed: Vec::new(),
            acquired: 0,
            substeps: Vec::new(),
            skins: Vec::new(),
            journal: Journal::default(),
        }
    }

    /// Begins an update: clears the list of written rows, and the pairs that were computed since
    /// the last update.
    pub(crate) fn begin_update(&mut self) {
        self.substeps.clear();
        for index in self.changed.drain(..) {
            if let Some(row) = self.rows.get(index as usize).filter(|&&row| row != NONE) {
                self.is_written[*row as usize] = false;
            }
        }
    }

    /// Returns `true` if the object has a row.
    pub(crate) fn has_row(&self, index: u32) -> bool {
        self.rows.get(index as usize).is_some_and(|&row| row != NONE)
    }

    /// Assigns a row to an object and writes it; does nothing if the object has a row.
    pub(crate) fn acquire(&mut self, index: u32, object: impl FnOnce() -> ObjectRow<N, D>) {
        if self.has_row(index) {
            return;
        }
        if self.rows.len() <= index as usize {
            self.rows.resize(index as usize + 1, NONE);
        }
        self.note(index);
        self.acquired += 1;
        match self.free.pop() {
            Some(row) => {
                self.rows[index as usize] = row;
                self.set(index, object);
            }
            None => self.push(index, object()),
        }
    }

    /// Frees the row of an object, if it has one.
    pub(crate) fn release(&mut self, index: u32) {
        if self.has_row(index) {
            self.note(index);
            let row = core::mem::replace(&mut self.rows[index as usize], NONE);
            self.is_written[row as usize] = false;
            self.free.push(row);
            self.substeps.retain(|pair| !pair.key.contains(&index));
        }
    }

    /// Overwrites the row of an object, if it has one.
    pub(crate) fn set(&mut self, index: u32, object: impl FnOnce() -> ObjectRow<N, D>) {
        if self.has_row(index) {
            self.note(index);
            let (row, object) = (self.row(index), object());
            self.handles[row] = object.handle;
            self.bounds[row] = ReachBounds::of(object.shape.as_ref());
            self.solids[row].shape = object.shape;
            self.queries[row] = object.query;
            self.set_position(index, &object.isometry);
        }
    }

    fn push(&mut self, index: u32, object: ObjectRow<N, D>) {
        let row = self.handles.len();
        self.rows[index as usize] = u32::try_from(row).expect("no more rows than objects");
        self.changed.push(index);
        self.is_written.push(true);
        self.handles.push(object.handle);
        self.bounds.push(ReachBounds::of(object.shape.as_ref()));
        let pose = object.shape.geometry().pose_at(&object.isometry);
        self.solids.push(ObjectSolid { pose, shape: object.shape });
        self.isometries.push(object.isometry);
        self.queries.push(object.query);
    }

    /// Writes the position of an object, if it has a row; does not change the rest of the row.
    pub(crate) fn set_position(&mut self, index: u32, isometry: &N::Isometry) {
        if !self.has_row(index) {
            return;
        }
        if self.journal.is_first(index as usize) {
            self.journal.note(RowNote::Moved(index, *self.isometry(index)));
        }
        let row = self.row(index);
        let turns = self.bounds[row].turns();
        self.solids[row].pose = if turns { N::pose(isometry) } else { N::unturned(isometry) };
        self.isometries[row] = *isometry;
        if !self.is_written[row] {
            self.is_written[row] = true;
            self.changed.push(index);
        }
    }

    /// Replaces the pose in an object's row without marking it as written, and returns the old
    /// pose.
    pub(super) fn replace_pose(
        &mut self,
        index: u32,
        (pose, isometry): (Pose<N, D>, N::Isometry),
    ) -> (Pose<N, D>, N::Isometry) {
        let row = self.row(index);
        let pose = core::mem::replace(&mut self.solids[row].pose, pose);
        (pose, core::mem::replace(&mut self.isometries[row], isometry))
    }

    /// Sets the skin of an object.
    pub(crate) fn set_skin(&mut self, index: u32, skin: N) {
        self.note(index);
        let (index, len) = (index as usize, self.skins.len());
        if skin > N::ZERO {
            self.skins.resize(len.max(index + 1), N::ZERO);
        }
        if let Some(known) = self.skins.get_mut(index) {
            *known = skin;
        }
    }

    /// Returns the skin of an object as of the last update; 0 if it has none.
    pub(crate) fn skin(&self, index: u32) -> N {
        self.skins.get(index as usize).copied().unwrap_or(N::ZERO)
    }

    /// Returns the skins of a pair.
    pub(super) fn skins_of(&self, key: PairKey) -> [N; 2] {
        key.mapped(|object| self.skin(object))
    }

    /// Returns the prediction that a pair needs for its shapes without skins: `linear` plus both
    /// skins.
    pub(super) fn beyond_skins(&self, key: PairKey, linear: N) -> N {
        let [first, second] = self.skins_of(key);
        linear + (first + second)
    }

    /// Returns the handle indices of the objects whose rows were written in the current update.
    pub(crate) fn changed(&self) -> &[u32] {
        &self.changed
    }

    /// Returns `true` if the object's row was written in the current update; `false` for an object
    /// without a row.
    #[inline]
    pub(crate) fn has_changed(&self, index: u32) -> bool {
        self.is_written.get(self.row(index)).is_some_and(|&is_written| is_written)
    }

    /// Returns the row of an object; an index beyond all rows if the object has none.
    #[inline]
    fn row(&self, index: u32) -> usize {
        self.rows[index as usize] as usize
    }

    /// Sorts the rows by handle index and drops free rows, if the number of rows acquired since the
    /// last sorting exceeds a quarter of all rows. A pass over the objects then accesses memory in
    /// order.
    pub(crate) fn compact(&mut self) {
        if self.acquired * 4 <= self.handles.len() {
            return;
        }
        self.acquired = 0;
        let mut next = 0;
        for index in 0..self.rows.len() {
            if self.rows[index] != NONE {
                self.swap_rows(self.rows[index] as usize, next);
                next += 1;
            }
        }
        self.handles.truncate(next);
        self.solids.truncate(next);
        self.bounds.truncate(next);
        self.queries.truncate(next);
        self.isometries.truncate(next);
        self.is_written.truncate(next);
        self.free.clear();
    }

    /// Swaps a row in use with another row, which may be free.
    fn swap_rows(&mut self, row: usize, other: usize) {
        let (owner, other_owner) = (self.handles[row].uid(), self.handles[other].uid());
        if self.rows[other_owner] as usize == other {
            self.rows[other_owner] = self.rows[owner];
        }
        self.rows[owner] = u32::try_from(other).expect("no more rows than objects");
        self.handles.swap(row, other);
        self.solids.swap(row, other);
        self.bounds.swap(row, other);
        self.queries.swap(row, other);
        self.isometries.swap(row, other);
        self.is_written.swap(row, other);
    }

    /// Releases memory that has not been needed for some time.
    pub(crate) fn give_back(&mut self, look: Look) {
        self.acquired += self.free.len();
        self.compact();
        look.fit(&mut self.rows);
        look.fit(&mut self.handles);
        look.fit(&mut self.solids);
        look.fit(&mut self.bounds);
        look.fit(&mut self.queries);
        look.fit(&mut self.isometries);
        look.fit(&mut self.is_written);
        look.trim(&mut self.changed);
        look.fit(&mut self.skins);
    }

    /// Sets a mark; see [`Journal`].
    pub(crate) fn mark(&mut self, number: u64) {
        self.journal.mark(number, self.substeps.clone());
    }

    /// Drops the marks whose numbers are less than `number`.
    pub(crate) fn forget_before(&mut self, number: u64) {
        self.journal.forget_before(number);
    }

    /// Undoes all changes since a mark.
    pub(crate) fn rewind(&mut self, number: u64) {
        let mut journal = core::mem::take(&mut self.journal);
        while let Some(note) = journal.undo(number) {
            match note {
                RowNote::Moved(index, isometry) => self.set_position(index, &isometry),
                RowNote::Whole(index, skin) => {
                    match journal.take_kept() {
                        None => self.release(index),
                        Some(row) if self.has_row(index) => self.set(index, || row),
                        Some(row) => self.acquire(index, || row),
                    }
                    self.set_skin(index, skin);
                }
            }
        }
        self.substeps.clone_from(journal.head().expect("the mark is kept"));
        self.journal = journal;
    }

    /// Records row and skin of an object before their first change since the latest mark; does
    /// nothing if there are no marks.
    fn note(&mut self, index: u32) {
        if self.journal.is_first_whole(index as usize) {
            let row = self.has_row(index).then(|| ObjectRow {
                handle: self.handle(index),
                isometry: *self.isometry(index),
                shape: self.shape(index).clone(),
                query: self.query(index),
            });
            let skin = self.skin(index);
            self.journal.note_kept(RowNote::Whole(index, skin), row);
        }
    }

    /// Checks that each row either belongs to one object or is free; the error describes the
    /// violation.
    pub(crate) fn validate(&self) -> Result<(), String> {
        let mut owners = vec![0_u8; self.handles.len()];
        let used = self.rows.iter().filter(|&&row| row != NONE);
        used.chain(&self.free).for_each(|&row| owners[row as usize] += 1);
        match owners.iter().position(|&count| count != 1) {
            Some(row) => Err(format!("row {row} of the table belongs to {} objects", owners[row])),
            None => Ok(()),
        }
    }

    /// Returns the handle of the object, as of the last update.
    pub(crate) fn handle(&self, index: u32) -> CollisionObjectHandle {
        self.handles[self.row(index)]
    }

    /// Returns the pose at the last update; the rotation of a ball is the identity.
    #[inline]
    pub(crate) fn pose(&self, index: u32) -> &Pose<N, D> {
        &self.solids[self.row(index)].pose
    }

    /// Returns the shape and the pose at the last update.
    pub(super) fn solid(&self, index: u32) -> &ObjectSolid<N, D> {
        &self.solids[self.row(index)]
    }

    /// Returns the pose at the last update, as the user set it.
    pub(crate) fn isometry(&self, index: u32) -> &N::Isometry {
        &self.isometries[self.row(index)]
    }

    /// Returns the shape at the last update.
    #[inline]
    pub(crate) fn shape(&self, index: u32) -> &ShapeHandle<N, D> {
        &self.solids[self.row(index)].shape
    }

    /// Returns the bounding ball and box of the shape.
    #[inline]
    pub(crate) fn bounds(&self, index: u32) -> &ReachBounds<N, D> {
        &self.bounds[self.row(index)]
    }

    /// Returns the query type at the last update.
    pub(crate) fn query(&self, index: u32) -> GeometricQueryType<N> {
        self.queries[self.row(index)]
    }
}
