//! Overlaps whose shortest separating translation is along the normal of a face of the flat solid
//! or of a cap of the round one.

use super::{DirectedPoint, FlatCore, NearestHull, RevolvedFound, RevolvedPair, still};
use crate::math::{Real, Vector};

impl<N: Real> RevolvedPair<'_, N> {
    /// Returns the separation by [`Self::by_own_face`] or, if that proves none, by
    /// [`Self::by_cap`]; `None` if neither proves one.
    pub(super) fn by_face(&self) -> Option<RevolvedFound<N>> {
        self.by_own_face().or_else(|| self.by_cap())
    }

    /// Returns the separation along the normal of that face of the flat solid above which the round
    /// solid lies highest. `None` unless the solids overlap along this normal and the flat solid
    /// contains the ball around the deepest point of the round solid with the depth as radius. Also
    /// `None` for segments, capsules and triangles.
    fn by_own_face(&self) -> Option<RevolvedFound<N>> {
        let mut best: Option<(N, DirectedPoint<N>)> = None;
        let mut try_face = |normal: &Vector<N, 3>, offset: N| {
            let outward = -self.pose12.rotation.tr_mul(normal);
            let nearest = self.profile.round.support(&outward);
            let extent = outward.dot(&nearest);
            let height = normal.dot(&self.shift) - offset * self.shrink - extent;
            if best.as_ref().is_none_or(|(most, _)| height > *most) {
                let point = nearest + outward * height;
                best = Some((height, DirectedPoint { point, nearest, outward, extent }));
            }
        };
        match self.flat {
            FlatCore::Cuboid(cuboid) => {
                for axis in 0..3 {
                    let normal = Vector::<N, 3>::ith(axis, N::ONE);
                    try_face(&normal, cuboid.half_extents()[axis]);
                    try_face(&-normal, cuboid.half_extents()[axis]);
                }
            }
            FlatCore::Polytope(hull) => {
                hull.faces().iter().for_each(|face| try_face(&face.normal, face.offset));
            }
            _ => {}
        }
        let (height, directed) = best?;
        let is_proved = height <= N::ZERO && self.holds(&directed.nearest, -height);
        is_proved.then(|| directed.proved(height)).flatten()
    }

    /// Tries the vertex of the flat solid that is lowest along the normal of a cap, for each cap of
    /// the round solid. Returns the separation at the first such vertex that is also lowest along
    /// `outward`, the direction of its distance from the round solid; `None` if there is none or
    /// the separation is not proved.
    fn by_cap(&self) -> Option<RevolvedFound<N>> {
        self.profile.round.caps().iter().find_map(|&up| {
            let vertex = self.lowest(&(Vector::<N, 3>::y() * N::lit(up)));
            let (_, directed): (NearestHull<N>, _) = self.at_point(vertex);
            let low = self.lowest(&directed.outward);
            let is_lowest = directed.outward.dot(&(directed.point - low)) <= still();
            let height = directed.outward.dot(&low) - directed.extent;
            is_lowest.then(|| directed.proved(height)).flatten()
        })
    }
}
