//! Recorded calls that physics engines need.

use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionObject;

use crate::RecordData;
use crate::call::Call;
use crate::error::RecordError;
use crate::recorder::{Recorder, index_of};
use crate::space::Recordable;

impl<N: Recordable<D>, const D: usize, T: RecordData> Recorder<N, D, T> {
    /// Sets whether an object is fixed.
    ///
    /// # Errors
    /// If the handle is stale.
    pub fn set_fixed(
        &mut self,
        handle: CollisionObjectHandle,
        is_fixed: bool,
    ) -> Result<(), RecordError> {
        self.world.try_set_fixed(handle, is_fixed)?;
        self.record(&Call::SetFixed { index: index_of(handle), is_fixed });
        Ok(())
    }

    /// Sets the skin of an object: the distance outside its surface at which contacts are measured.
    ///
    /// # Errors
    /// If the handle is stale, or the skin is negative or not finite.
    pub fn set_skin(&mut self, handle: CollisionObjectHandle, skin: N) -> Result<(), RecordError> {
        self.world.try_set_skin(handle, skin)?;
        self.record(&Call::SetSkin { index: index_of(handle), skin });
        Ok(())
    }

    /// Moves an object with a prediction of its next position.
    ///
    /// # Errors
    /// If the handle is stale or a number of a position is not finite.
    pub fn set_position_with_prediction(
        &mut self,
        handle: CollisionObjectHandle,
        position: N::Isometry,
        predicted: N::Isometry,
    ) -> Result<(), RecordError> {
        self.world.try_set_position_with_prediction(handle, position, predicted)?;
        self.record(&Call::Predict { index: index_of(handle), position, predicted });
        Ok(())
    }

    /// Makes the next update call the filters of all pairs again.
    pub fn refilter_pairs(&mut self) {
        self.world.refilter_pairs();
        self.record(&Call::Refilter(None));
    }

    /// Makes the next update call the filters of the pairs of one object again.
    ///
    /// # Errors
    /// If the handle is stale.
    pub fn refilter_pairs_of(&mut self, handle: CollisionObjectHandle) -> Result<(), RecordError> {
        self.world.try_refilter_pairs_of(handle)?;
        self.record(&Call::Refilter(Some(index_of(handle))));
        Ok(())
    }

    /// Updates the world with a filter for this update. Records the pairs that the filter rejects
    /// and the hashes of the result, so that a replay needs no filter.
    ///
    /// The update of a key frame ([`Self::with_key_frames`]) filters all pairs again.
    ///
    /// ```
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, ContactQuery};
    /// use impinge_record::{Recorder, Registry, validate};
    ///
    /// let registry = Registry::<f32, 2, u32>::new();
    /// let mut recorder = Recorder::new(0.02, registry.clone())?;
    /// let ball = ShapeHandle::new(Ball::new(1.0));
    /// for id in [1, 2, 3] {
    ///     let (at, groups) = (Isometry::identity(), CollisionGroups::new());
    ///     recorder.add(at, ball.clone(), groups, ContactQuery::default(), id)?;
    /// }
    /// recorder.update_with(&mut |a, b| *a.data() != 1 || *b.data() != 3);
    /// assert_eq!(recorder.contact_events().len(), 2);
    /// assert_eq!(validate(&recorder.finish().bytes, &registry), Ok(None));
    /// # Ok::<(), impinge_record::RecordError>(())
    /// ```
    #[expect(clippy::type_complexity, reason = "as of the world's own")]
    pub fn update_with(
        &mut self,
        filter: &mut dyn FnMut(&CollisionObject<N, D, T>, &CollisionObject<N, D, T>) -> bool,
    ) {
        self.begin_step();
        let mut refused = Vec::new();
        self.world.update_with(&mut |one, two| {
            let is_valid = filter(one, two);
            if !is_valid {
                refused.push([one, two].map(|object| index_of(object.handle())));
            }
            is_valid
        });
        if !refused.is_empty() {
            self.record(&Call::Refuse(refused));
        }
        self.end_step();
    }

    /// Makes the next update keep the events of the previous one.
    pub fn keep_events(&mut self) {
        self.world.keep_events();
        self.record(&Call::KeepEvents);
    }

    /// Recomputes the pair of two objects at their current positions. Returns `false` if they have
    /// no pair.
    ///
    /// # Errors
    /// If a handle is stale.
    pub fn update_pair(
        &mut self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Result<bool, RecordError> {
        let is_kept = self.world.try_update_pair(handle1, handle2)?;
        if is_kept {
            self.record(&Call::UpdatePair([handle1, handle2].map(index_of)));
        }
        Ok(is_kept)
    }

    /// Removes and returns the data of a removed object; `None` if there is none. The call is not
    /// recorded, since no later step depends on it.
    pub fn take_removed(&mut self, handle: CollisionObjectHandle) -> Option<T> {
        self.world.take_removed(handle)
    }

    /// Records, after a key frame, the properties that few objects have: fixed flags, skins and
    /// predicted positions. The running world is not changed.
    pub(crate) fn record_rare_facts(&mut self) {
        let mut calls = Vec::new();
        for object in self.world.collision_objects() {
            let (handle, index) = (object.handle(), index_of(object.handle()));
            if object.is_fixed() {
                calls.push(Call::SetFixed { index, is_fixed: true });
            }
            let skin = self.world.skin(handle).filter(|skin| *skin > N::ZERO);
            calls.extend(skin.map(|skin| Call::SetSkin { index, skin }));
            let predicted = self.world.predicted_position(handle).copied();
            let position = *object.position();
            let predict = |predicted| Call::Predict { index, position, predicted };
            calls.extend(predicted.map(predict));
        }
        calls.iter().for_each(|call| self.record(call));
    }
}
