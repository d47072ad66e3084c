//! The operations for authors of physics engines, performed on the world and its naive twin.

use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent};
use impinge::world::{CollisionObject, WorldError};
use impinge_reference::world::{Handle, QueryType};

use super::both::Both;
use super::draw::{self, Grid};
use super::twins;

/// Name under which the naive world registers the filter that the tested world gets as an argument
/// of its update.
const LENT: &str = "lent";

impl<N: Grid<D>, const D: usize> Both<N, D> {
    /// Performs a random operation for authors of engines on the world and its twin.
    pub(super) fn operate_as_engine(&mut self) {
        match self.random.below(20) {
            0..3 => self.change_fixed(),
            3..6 => self.predict(),
            6 => self.change_lent_filter(),
            7..9 => self.keep_events(),
            9 => self.take_removed(),
            10..12 => self.change_skin(),
            _ => self.update_pair(),
        }
    }

    fn change_fixed(&mut self) {
        let Some((handle, twin)) = self.someone() else { return };
        let is_fixed = self.random.chance(0.6);
        self.world.set_fixed(handle, is_fixed);
        self.naive.set_fixed(twin, is_fixed).expect("alive");
        let object = self.world.collision_object(handle).expect("alive");
        assert_eq!(object.is_fixed(), is_fixed, "at once");
    }

    /// Moves an object and predicts its next pose. The prediction may change only the pairs of the
    /// broad phase, which the validation after each update checks.
    fn predict(&mut self) {
        let Some((handle, twin)) = self.someone() else { return };
        let from = self.naive.object(twin).expect("alive").pose;
        let (position, pose) = draw::pose_near::<N, D>(&from, &mut self.random);
        let (predicted, _) = draw::pose::<N, D>(&mut self.random);
        self.world.set_position_with_prediction(handle, position, predicted);
        self.naive.set_position(twin, pose).expect("alive");
        assert_eq!(self.world.predicted_position(handle), Some(&predicted), "as it was given");
        if self.random.chance(0.3) {
            self.place(handle, (position, pose));
            assert_eq!(self.world.predicted_position(handle), None, "it was moved since");
        }
    }

    fn change_lent_filter(&mut self) {
        self.lent = self.random.chance(0.5).then(|| 2 + self.random.below(4));
        match self.lent {
            Some(number) => {
                let allows = move |a: usize, b: usize| !(a + b).is_multiple_of(number);
                self.naive.register_filter(LENT, allows);
            }
            None => {
                self.naive.unregister_filter(LENT);
            }
        }
        self.world.refilter_pairs();
    }

    fn keep_events(&mut self) {
        self.world.keep_events();
        self.keeps_events = true;
    }

    fn take_removed(&mut self) {
        if self.stale.is_empty() {
            return;
        }
        let handle = *self.random.pick(&self.stale);
        let is_there = self.world.removed_object(handle).is_some();
        let taken = self.world.take_removed(handle);
        assert_eq!(taken, is_there.then(|| self.data[&handle]), "its data");
        assert!(self.world.removed_object(handle).is_none(), "taken");
        self.taken.extend(taken.map(|_| handle));
    }

    fn change_skin(&mut self) {
        let Some((handle, twin)) = self.someone() else { return };
        let skin = *self.random.pick(&[0.0, 0.125, 0.25, 0.5]);
        self.world.set_skin(handle, N::lit(skin));
        self.naive.set_skin(twin, skin).expect("alive");
        assert_eq!(self.world.skin(handle), Some(N::lit(skin)), "as it was given");
        for wrong in [-0.125, f64::NAN, f64::INFINITY] {
            let refused = self.world.try_set_skin(handle, N::lit(wrong));
            assert!(matches!(refused, Err(WorldError::Skin { .. })), "{wrong}");
        }
    }

    /// Computes a pair of the world between updates, mostly a pair that exists.
    fn update_pair(&mut self) {
        let Some((one, _)) = self.someone() else { return };
        let partners: Vec<_> = self.world.pairs_with(one).map(CollisionObject::handle).collect();
        let other = if partners.is_empty() || self.random.chance(0.2) {
            *self.random.pick(&self.alive)
        } else {
            *self.random.pick(&partners)
        };
        let [first, second] = if one < other { [one, other] } else { [other, one] };
        let is_kept = self.world.update_pair(one, other);
        assert_eq!(is_kept, partners.contains(&other), "pairs are those of the last update");
        let twins = [first, second].map(|handle| self.twins[&handle]);
        let before = self.is_told(twins);
        if is_kept {
            self.naive.update_pair(twins[0], twins[1]).expect("the last update has seen both");
            self.tally.substeps += 1;
        }
        let touching = twins::touching(&self.twins, &self.world);
        assert_eq!(touching, self.naive.touching_pairs(), "pairs with contacts, at once");
        let close = twins::close(&self.twins, &self.world);
        assert_eq!(close, self.naive.close_pairs(), "pairs that are not disjoint, at once");
        self.tally.changed += usize::from(self.is_told(twins) != before);
    }

    /// Returns `true` if two objects touch in the naive world, or if their proximity there is not
    /// disjoint.
    fn is_told(&self, [first, second]: [Handle; 2]) -> bool {
        let is_near = |&(a, b, _): &(Handle, Handle, _)| (a, b) == (first, second);
        self.naive.touching_pairs().contains(&(first, second))
            || self.naive.close_pairs().iter().any(is_near)
    }

    /// Updates the world, with the passed filter if there is one, and validates it.
    pub(super) fn update_world(&mut self) {
        let Some(number) = self.lent else {
            self.world.update();
            self.world.validate().expect("the parts of the world agree");
            return;
        };
        let allows = |a: &CollisionObject<N, D, u64>, b: &CollisionObject<N, D, u64>| {
            assert!(a.handle() < b.handle(), "in order");
            !(a.handle().uid() + b.handle().uid()).is_multiple_of(number)
        };
        let mut asked = Vec::new();
        self.world.update_with(&mut |a, b| {
            asked.push((a.handle(), b.handle()));
            allows(a, b)
        });
        self.tally.asked += asked.len();
        asked.sort_unstable();
        assert!(asked.is_sorted_by(|one, next| one < next), "each pair once");
        self.world.validate_with(&allows).expect("the parts of the world agree");
    }

    /// Asserts that the pairs of each object are all pairs of the world that contain it.
    pub(super) fn check_pairs_of_objects(&mut self) {
        let contacts = self.world.contact_pairs().map(|(a, b, _)| [a.handle(), b.handle()]);
        let proximities = self.world.proximity_pairs().map(|(a, b, _)| [a.handle(), b.handle()]);
        let pairs: Vec<_> = contacts.chain(proximities).collect();
        for &handle in &self.alive {
            let own = pairs.iter().filter(|pair| pair.contains(&handle));
            let mut expected: Vec<_> = own.map(|&[a, b]| if a == handle { b } else { a }).collect();
            expected.sort_unstable();
            let found: Vec<_> =
                self.world.pairs_with(handle).map(CollisionObject::handle).collect();
            assert_eq!(found, expected, "the pairs of {handle:?}");
        }
        let gone = self.stale.iter().all(|&stale| self.world.pairs_with(stale).next().is_none());
        assert!(gone, "no pairs of removed objects");
    }

    /// Asserts that the data of every object in an event are available, whether it lives or was
    /// removed.
    pub(super) fn check_data(&self) {
        for handle in self.named() {
            let living = self.world.collision_object(handle);
            let gone = self.world.removed_object(handle);
            let data = living.or(gone).map(|object| *object.data());
            let is_taken = self.taken.contains(&handle);
            assert_eq!(data, (!is_taken).then(|| self.data[&handle]), "the data of {handle:?}");
        }
    }

    /// Asserts that after an update the world keeps no removed object except those in events.
    pub(super) fn check_removed(&mut self) {
        let named = self.named();
        for &stale in &self.stale {
            let is_kept = self.world.removed_object(stale).is_some();
            assert!(!is_kept || named.contains(&stale), "no event names {stale:?}");
            self.tally.named += usize::from(is_kept);
        }
    }

    /// Returns the objects in the events of the last update.
    fn named(&self) -> Vec<CollisionObjectHandle> {
        let contacts = self.world.contact_events().iter().map(ContactEvent::handles);
        let proximities = self.world.proximity_events().iter();
        let proximities = proximities.map(|event| (event.collider1, event.collider2));
        contacts.chain(proximities).flat_map(|(a, b)| [a, b]).collect()
    }

    /// Counts pairs of fixed objects that overlap, and pairs that have contacts only because of
    /// their skins.
    pub(super) fn count_rare_pairs(&mut self) {
        let fixed: Vec<_> = self.naive.objects().filter(|object| object.is_fixed).collect();
        for (place, object1) in fixed.iter().enumerate() {
            let others = fixed[place + 1..].iter();
            let meets = |object2: &&&_| self.naive.signed_distance(object1, object2) <= 0.0;
            self.tally.fixed += others.filter(meets).count();
        }
        for (one, two) in self.naive.touching_pairs() {
            let objects = [one, two].map(|handle| self.naive.object(handle).expect("alive"));
            let prediction = objects.map(|object| match object.query_type {
                QueryType::Contacts(prediction) => prediction,
                QueryType::Proximity(_) => unreachable!("contacts are asked for"),
            });
            let distance = self.naive.signed_distance(objects[0], objects[1]);
            self.tally.in_skins += usize::from(distance > prediction[0] + prediction[1]);
        }
    }
}
