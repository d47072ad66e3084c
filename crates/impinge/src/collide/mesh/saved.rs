//! Serialized form of the contacts of composites, for saved worlds.

use serde::{Deserialize, Serialize};

use super::part_cache::CacheMargin;
use super::{CompositeContacts, Patch, PatchPoint};
use crate::bounding_volume::Aabb;
use crate::collide::PairIds;
use crate::collide::saved::PointRecord;
use crate::math::numbers::{Damage, NumberSource, Numbers, ensure};
use crate::math::{Real, Space};
use crate::shape::{CompositeShape, Geometry};

/// Serialized form of [`CompositeContacts`].
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct CompositeRecord<N: Real> {
    ids: PairIds,
    pose12: Numbers<N>,
    patches: Vec<PatchRecord<N>>,
    reference: Option<Numbers<N>>,
    /// Corners of the box whose parts are cached; `None` if nothing is cached. Whether a
    /// specialised path computes a pair with a compound depends on the cached parts, so these parts
    /// must also be cached after loading.
    around: Option<Numbers<N>>,
    room: CacheMargin,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
struct PatchRecord<N: Real> {
    /// The normal, then the position and distance of each point.
    numbers: Numbers<N>,
    /// The other data of each point, and the indices of its parts.
    points: Vec<(PointRecord, [u32; 2])>,
}

impl<N: Real> PatchRecord<N> {
    fn of<const D: usize>(patch: &Patch<N, D>) -> Self {
        let mut numbers = Numbers::of(patch.normal.iter().copied());
        let record =
            |point: &PatchPoint<N, D>| (PointRecord::of(&point.raw, &mut numbers), point.parts);
        let points = patch.points.iter().map(record).collect();
        Self { numbers, points }
    }

    /// Restores the patch. `parts` are the numbers of parts of both shapes; a part index beyond
    /// them is an error.
    fn restore<const D: usize>(&self, parts: [u32; 2]) -> Result<Patch<N, D>, Damage> {
        self.numbers.all(|numbers| {
            let normal = numbers.vector()?;
            let points = self.points.iter().map(|&(point, own)| {
                ensure(own[0] < parts[0] && own[1] < parts[1], "a contact is on a part of none")?;
                Ok(PatchPoint { raw: point.restore(numbers)?, parts: own })
            });
            Ok(Patch { normal, points: points.collect::<Result<_, Damage>>()? })
        })
    }
}

impl<N: Real, const D: usize> CompositeContacts<N, D> {
    /// Returns the serialized form of the contacts.
    pub(crate) fn record(&self) -> CompositeRecord<N> {
        let mut pose12 = Numbers::default();
        pose12.extend_pose(&self.pose12);
        let (within, room) = self.around.room();
        let corners = |within: &Aabb<N, D>| Numbers::of_points(&[*within.mins(), *within.maxs()]);
        CompositeRecord {
            ids: self.ids,
            pose12,
            patches: self.patches.iter().map(PatchRecord::of).collect(),
            reference: self.reference.map(|middle| Numbers::of_points(&[middle])),
            around: within.map(corners),
            room,
        }
    }
}

impl<N: Space<D>, const D: usize> CompositeContacts<N, D> {
    /// Restores contacts from their serialized form. `shapes` are in the order in which the
    /// contacts were stored.
    pub(crate) fn restored(
        record: &CompositeRecord<N>,
        shapes: [Geometry<'_, N, D>; 2],
    ) -> Result<Self, Damage> {
        let composites = shapes.map(|shape| shape.as_composite());
        let parts = composites.map(|composite| composite.map_or(1, CompositeShape::num_parts));
        let patches = record.patches.iter().map(|patch| patch.restore(parts));
        let reference = record.reference.as_ref();
        let mut contacts = Self {
            patches: patches.collect::<Result<_, _>>()?,
            ids: record.ids,
            reference: reference.map(|middle| middle.all(NumberSource::point)).transpose()?,
            pose12: record.pose12.all(NumberSource::pose)?,
            ..Self::default()
        };
        if let Some(within) = &record.around {
            let [mins, maxs] = within.all(NumberSource::points)?;
            let within = Aabb::try_new(mins, maxs).map_err(|error| Damage::found(&error))?;
            let [None, Some(composite)] = composites else {
                return Err(Damage("parts are kept around a composite".into()));
            };
            ensure(within.is_bounded(), "parts are kept without bound")?;
            contacts.around.fill_again(composite, within);
        }
        contacts.around.set_room(record.room);
        Ok(contacts)
    }
}
