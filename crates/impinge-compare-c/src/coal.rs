//! Coal: queries for many pairs in one call.

use std::ffi::c_void;
use std::marker::PhantomData;
use std::ptr::NonNull;

type Handle = *mut c_void;

// `coal.cpp` describes the arguments and the lengths of the arrays.
unsafe extern "C" {
    fn impinge_coal_ball(radius: f64) -> Handle;
    fn impinge_coal_box(half: *const f64, radius: f64) -> Handle;
    fn impinge_coal_capsule(half: f64, radius: f64) -> Handle;
    fn impinge_coal_cylinder(half: f64, radius: f64) -> Handle;
    fn impinge_coal_cone(half: f64, radius: f64) -> Handle;
    fn impinge_coal_hull(points: *const f64, count: usize) -> Handle;
    fn impinge_coal_half_space(normal: *const f64) -> Handle;
    fn impinge_coal_mesh(v: *const f64, vertices: usize, t: *const u32, triangles: usize)
    -> Handle;
    fn impinge_coal_drop_solid(solid: Handle);
    fn impinge_coal_pairs(a: Handle, b: Handle, first: *const f64, count: usize) -> Handle;
    fn impinge_coal_add_set(pairs: Handle, second: *const f64);
    fn impinge_coal_drop_pairs(pairs: Handle);
    fn impinge_coal_reset(pairs: Handle, margin: f64, is_warm: bool);
    fn impinge_coal_distances(pairs: Handle, set: usize, answers: *mut f32);
    fn impinge_coal_contacts(pairs: Handle, set: usize, answers: *mut f32);
    fn impinge_coal_patches(pairs: Handle, set: usize);
    fn impinge_coal_deepest(pairs: Handle, answers: *mut f32);
}

/// A solid around the origin, in `f64`. Axes of symmetry are along the second coordinate.
#[derive(Debug)]
pub struct CoalSolid(NonNull<c_void>);

impl CoalSolid {
    fn owned(handle: Handle) -> Self {
        Self(NonNull::new(handle).expect("it is made by `new`"))
    }

    /// Creates a ball.
    #[must_use]
    pub fn ball(radius: f64) -> Self {
        // SAFETY: the arguments are numbers; `owned` takes the ownership of the result.
        Self::owned(unsafe { impinge_coal_ball(radius) })
    }

    /// Creates a box, rounded outwards by `radius`.
    #[must_use]
    pub fn cuboid(half_extents: &[f64; 3], radius: f64) -> Self {
        // SAFETY: three numbers are read from the array.
        Self::owned(unsafe { impinge_coal_box(half_extents.as_ptr(), radius) })
    }

    /// Creates a capsule.
    #[must_use]
    pub fn capsule(half_height: f64, radius: f64) -> Self {
        // SAFETY: the arguments are numbers.
        Self::owned(unsafe { impinge_coal_capsule(half_height, radius) })
    }

    /// Creates a cylinder.
    #[must_use]
    pub fn cylinder(half_height: f64, radius: f64) -> Self {
        // SAFETY: the arguments are numbers.
        Self::owned(unsafe { impinge_coal_cylinder(half_height, radius) })
    }

    /// Creates a cone with its apex in the positive direction.
    #[must_use]
    pub fn cone(half_height: f64, radius: f64) -> Self {
        // SAFETY: the arguments are numbers.
        Self::owned(unsafe { impinge_coal_cone(half_height, radius) })
    }

    /// Creates the convex hull of points that span a volume.
    #[must_use]
    pub fn hull(points: &[[f64; 3]]) -> Self {
        // SAFETY: three numbers are read for each point.
        Self::owned(unsafe { impinge_coal_hull(points.as_flattened().as_ptr(), points.len()) })
    }

    /// Creates the half-space bounded by the plane through the origin with this outward normal.
    #[must_use]
    pub fn half_space(normal: &[f64; 3]) -> Self {
        // SAFETY: three numbers are read from the array.
        Self::owned(unsafe { impinge_coal_half_space(normal.as_ptr()) })
    }

    /// Creates a triangle mesh, with a tree over the triangles.
    ///
    /// # Panics
    /// If a triangle has the index of a vertex that does not exist.
    #[must_use]
    pub fn mesh(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Self {
        let named = triangles.as_flattened();
        let is_there = |n: &u32| (*n as usize) < vertices.len();
        assert!(named.iter().all(is_there), "a triangle names a vertex that is not there");
        let (points, corners) = (vertices.as_flattened().as_ptr(), named.as_ptr());
        // SAFETY: three numbers are read for each vertex and triangle; all indices were checked.
        Self::owned(unsafe { impinge_coal_mesh(points, vertices.len(), corners, triangles.len()) })
    }
}

impl Drop for CoalSolid {
    fn drop(&mut self) {
        // SAFETY: a constructor of this type returned the handle, and it is released once.
        unsafe { impinge_coal_drop_solid(self.0.as_ptr()) }
    }
}

/// A pose: a translation, then a quaternion `[x, y, z, w]`.
pub type CoalPose = [f64; 7];

/// Two solids in many pairs of placements.
#[derive(Debug)]
pub struct CoalPairs {
    handle: NonNull<c_void>,
    count: usize,
    sets: usize,
    /// Makes the type not `Send`: searches keep state on their thread.
    thread: PhantomData<*const ()>,
}

impl CoalPairs {
    /// Stores the placements of the first solid, and sets of placements of the second solid, each
    /// as long as `first`. `None` if Coal has no algorithm for the two solids.
    ///
    /// # Panics
    /// If the length of a set differs from that of `first`.
    #[must_use]
    pub fn new(
        solids: &[CoalSolid; 2],
        first: &[CoalPose],
        sets: &[Vec<CoalPose>],
    ) -> Option<Self> {
        let [a, b] = solids.each_ref().map(|solid| solid.0.as_ptr());
        let numbers = first.as_flattened().as_ptr();
        // SAFETY: seven numbers are read for each placement. The pairs share ownership of the
        // geometry of the solids.
        let handle = NonNull::new(unsafe { impinge_coal_pairs(a, b, numbers, first.len()) })?;
        let mut pairs = Self { handle, count: first.len(), sets: sets.len(), thread: PhantomData };
        for set in sets {
            assert_eq!(set.len(), first.len(), "every pair has one placement in a set");
            // SAFETY: the length was checked; seven numbers are read for each placement.
            unsafe { impinge_coal_add_set(handle.as_ptr(), set.as_flattened().as_ptr()) };
        }
        pairs.reset(0.0, false);
        Some(pairs)
    }

    /// Drops the state of earlier queries. Contacts are computed up to the distance `margin`. With
    /// `is_warm` a search for contacts begins with the direction at which the last one ended.
    pub fn reset(&mut self, margin: f64, is_warm: bool) {
        // SAFETY: the handle is that of the pairs, which `self` owns.
        unsafe { impinge_coal_reset(self.handle.as_ptr(), margin, is_warm) }
    }

    /// Computes the distance of every pair in a set; 0 for a pair of solids that overlap.
    pub fn distances(&mut self, set: usize, answers: &mut Vec<f32>) {
        let handle = self.begin(set, answers);
        // SAFETY: the index of the set was checked, and there are as many answers as pairs.
        unsafe { impinge_coal_distances(handle, set, answers.as_mut_ptr()) }
    }

    /// Computes the signed distance of the deepest contact of every pair in a set; infinite for a
    /// pair without a contact within the margin.
    pub fn contacts(&mut self, set: usize, answers: &mut Vec<f32>) {
        let handle = self.begin(set, answers);
        // SAFETY: the index of the set was checked, and there are as many answers as pairs.
        unsafe { impinge_coal_contacts(handle, set, answers.as_mut_ptr()) }
    }

    /// Computes and stores the contacts of every pair in a set, and the polygons in which their
    /// surfaces touch.
    pub fn patches(&mut self, set: usize) {
        assert!(set < self.sets, "there are {} sets", self.sets);
        // SAFETY: the index of the set was checked.
        unsafe { impinge_coal_patches(self.handle.as_ptr(), set) }
    }

    /// Returns the signed distance of the deepest stored contact of every pair.
    pub fn deepest(&self, answers: &mut Vec<f32>) {
        answers.resize(self.count, 0.0);
        // SAFETY: there are as many answers as pairs.
        unsafe { impinge_coal_deepest(self.handle.as_ptr(), answers.as_mut_ptr()) }
    }

    fn begin(&mut self, set: usize, answers: &mut Vec<f32>) -> Handle {
        assert!(set < self.sets, "there are {} sets", self.sets);
        answers.resize(self.count, 0.0);
        self.handle.as_ptr()
    }
}

impl Drop for CoalPairs {
    fn drop(&mut self) {
        // SAFETY: `new` made the handle, and it is released once.
        unsafe { impinge_coal_drop_pairs(self.handle.as_ptr()) }
    }
}
