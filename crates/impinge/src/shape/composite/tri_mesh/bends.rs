//! The cache of edge angles at the sides of a mesh's triangles, computed on first use.
//!
//! ```text
//! bit   15 14 | 13             | 12           | 11 .. 8 | 7 .. 4 | 3 .. 0
//!       unused| UNCERTAIN_AREA | CERTAIN_AREA | side 2  | side 1 | side 0
//! ```
//!
//! The code of a side is `UNKNOWN`, 1 to 3, or `UNCLEAR`.

use core::sync::atomic::{AtomicU16, Ordering};

use crate::shape::surface::bend::BendShape;

/// The number of bits per side.
const BITS: usize = 4;
/// Codes of an edge angle: not computed yet, and uncertain. Codes 1 to 3 are flat, ridge and
/// hollow.
const UNKNOWN: u16 = 0;
const UNCLEAR: u16 = 4;
/// Flags above the bits of the sides: the triangle certainly has an area, or it may have none.
/// Neither is set before the first use.
const CERTAIN_AREA: u16 = 1 << 12;
const UNCERTAIN_AREA: u16 = 1 << 13;

/// The [`BendShape`] of each triangle's sides, and whether the triangle certainly has an area.
///
/// The values depend only on the mesh. So it does not matter which thread computes a value first,
/// or that one of two concurrent writes is lost.
#[derive(Debug)]
pub(super) struct Bends {
    sides: Vec<AtomicU16>,
}

impl Bends {
    /// Returns an empty cache for `triangles` triangles.
    pub(super) fn new(triangles: usize) -> Self {
        let mut sides = Vec::new();
        sides.resize_with(triangles, AtomicU16::default);
        Self { sides }
    }

    /// Marks all values as not computed, after the vertices of the mesh moved.
    pub(super) fn clear(&mut self) {
        for side in &mut self.sides {
            *side.get_mut() = UNKNOWN;
        }
    }

    /// Returns the cached shape of the edge at a side, or computes the shape with `find` and stores
    /// it. `None` if the shape is uncertain.
    pub(super) fn at(
        &self,
        triangle: u32,
        side: usize,
        find: impl FnOnce() -> Option<BendShape>,
    ) -> Option<BendShape> {
        let kept = &self.sides[triangle as usize];
        let (all, shift) = (kept.load(Ordering::Relaxed), side * BITS);
        match all >> shift & 7 {
            UNKNOWN => {
                let found = find();
                kept.store(all | code(found) << shift, Ordering::Relaxed);
                found
            }
            1 => Some(BendShape::Flat),
            2 => Some(BendShape::Ridge),
            3 => Some(BendShape::Hollow),
            _ => None,
        }
    }

    /// Returns whether the triangle certainly has an area, from the cache or computed by `find`.
    pub(super) fn has_certain_area(&self, triangle: u32, find: impl FnOnce() -> bool) -> bool {
        let kept = &self.sides[triangle as usize];
        let all = kept.load(Ordering::Relaxed);
        if all & (CERTAIN_AREA | UNCERTAIN_AREA) == 0 {
            let has_certain_area = find();
            kept.store(
                all | if has_certain_area { CERTAIN_AREA } else { UNCERTAIN_AREA },
                Ordering::Relaxed,
            );
            return has_certain_area;
        }
        all & CERTAIN_AREA != 0
    }
}

impl Clone for Bends {
    fn clone(&self) -> Self {
        let copied = |side: &AtomicU16| AtomicU16::new(side.load(Ordering::Relaxed));
        Self { sides: self.sides.iter().map(copied).collect() }
    }
}

const fn code(found: Option<BendShape>) -> u16 {
    match found {
        Some(BendShape::Flat) => 1,
        Some(BendShape::Ridge) => 2,
        Some(BendShape::Hollow) => 3,
        None => UNCLEAR,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_side_is_found_once() {
        let mut bends = Bends::new(2);
        let all = [Some(BendShape::Flat), Some(BendShape::Ridge), Some(BendShape::Hollow), None];
        for (at, shape) in all.into_iter().cycle().take(6).enumerate() {
            let (triangle, side) = (u32::from(at > 2), at % 3);
            assert_eq!(bends.at(triangle, side, || shape), shape, "as found");
        }
        let copy = bends.clone();
        for (at, shape) in all.into_iter().cycle().take(6).enumerate() {
            let (triangle, side) = (u32::from(at > 2), at % 3);
            for kept in [&bends, &copy] {
                let again = kept.at(triangle, side, || panic!("computed twice"));
                assert_eq!(again, shape, "as kept");
            }
        }
        assert!(
            bends.has_certain_area(1, || true)
                && bends.has_certain_area(1, || panic!("computed twice")),
            "kept"
        );
        assert!(
            !bends.has_certain_area(0, || false) && !bends.has_certain_area(0, || true),
            "kept"
        );
        bends.clear();
        assert_eq!(bends.at(0, 0, || None), None, "found anew");
    }
}
