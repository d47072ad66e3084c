//! Overlaps whose shortest way out is along a face of the flat solid or a cap of the round one.

use super::{FlatCore, NearestHull, RevolvedFound, RevolvedMeeting, RevolvedPlace, still};
use crate::math::{Real, Vector};

impl<N: Real> RevolvedMeeting<'_, N> {
    /// Returns the answer along the face or cap with the least depth, if balls prove it.
    pub(super) fn by_face(&self) -> Option<RevolvedFound<N>> {
        self.by_own_face().or_else(|| self.by_cap())
    }

    /// Tries the faces of the flat solid, which has to contain the ball around the deepest point.
    fn by_own_face(&self) -> Option<RevolvedFound<N>> {
        let mut best: Option<(N, RevolvedPlace<N>)> = None;
        let mut try_face = |normal: &Vector<N, 3>, offset: N| {
            let outward = -self.pose12.rotation.tr_mul(normal);
            let nearest = self.profile.round.support(&outward);
            let level = outward.dot(&nearest);
            let height = normal.dot(&self.shift) - offset * self.shrink - level;
            if best.as_ref().is_none_or(|(most, _)| height > *most) {
                let point = nearest + outward * height;
                best = Some((height, RevolvedPlace { point, nearest, outward, level }));
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
        let (height, place) = best?;
        let is_proved = height <= N::ZERO && self.holds(&place.nearest, -height);
        is_proved.then(|| place.proved(height)).flatten()
    }

    /// Tries the caps of the round solid, which has to contain the ball around the lowest vertex.
    fn by_cap(&self) -> Option<RevolvedFound<N>> {
        self.profile.round.caps().iter().find_map(|&up| {
            let vertex = self.lowest(&(Vector::<N, 3>::y() * N::lit(up)));
            let (_, place): (NearestHull<N>, _) = self.at_point(vertex);
            let low = self.lowest(&place.outward);
            let is_lowest = place.outward.dot(&(place.point - low)) <= still();
            let height = place.outward.dot(&low) - place.level;
            is_lowest.then(|| place.proved(height)).flatten()
        })
    }
}
