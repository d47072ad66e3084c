//! The list of touching contacts of a world of Box2D or Box3D, updated by the events of the engine.

/// The id of a contact in an engine.
pub(crate) trait ContactName: Copy {
    /// The index, which is reused for another contact after this contact has ended.
    fn index(self) -> usize;

    /// The generation, which distinguishes successive contacts with the same index.
    fn generation(self) -> u32;
}

/// The contacts that have begun and not ended. The list is kept here because neither engine has a
/// list of all contacts.
#[derive(Debug)]
pub(crate) struct Contacts<Name> {
    names: Vec<Name>,
    /// For each index of a contact its position in `names`; [`NOWHERE`] for an index without a
    /// contact.
    places: Vec<usize>,
}

const NOWHERE: usize = usize::MAX;

impl<Name: ContactName> Contacts<Name> {
    pub(crate) const fn new() -> Self {
        Self { names: Vec::new(), places: Vec::new() }
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = Name> + '_ {
        self.names.iter().copied()
    }

    /// Removes a contact that has ended. The end events of a step must be processed before its
    /// begin events, since both may contain the same index.
    pub(crate) fn end(&mut self, name: Name) {
        let place = self.places.get(name.index()).copied().unwrap_or(NOWHERE);
        let is_it = |kept: &Name| kept.generation() == name.generation();
        if place == NOWHERE || !self.names.get(place).is_some_and(is_it) {
            return;
        }
        self.names.swap_remove(place);
        self.places[name.index()] = NOWHERE;
        if let Some(moved) = self.names.get(place) {
            self.places[moved.index()] = place;
        }
    }

    pub(crate) fn begin(&mut self, name: Name) {
        if self.places.len() <= name.index() {
            self.places.resize(name.index() + 1, NOWHERE);
        }
        let place = self.places[name.index()];
        if place == NOWHERE {
            self.places[name.index()] = self.names.len();
            self.names.push(name);
        } else {
            self.names[place] = name;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    struct Name(usize, u32);

    impl ContactName for Name {
        fn index(self) -> usize {
            self.0
        }

        fn generation(self) -> u32 {
            self.1
        }
    }

    #[test]
    fn names_come_and_go() {
        let mut contacts = Contacts::new();
        [Name(3, 1), Name(0, 1), Name(2, 1)].into_iter().for_each(|name| contacts.begin(name));
        contacts.end(Name(3, 1));
        contacts.end(Name(7, 1));
        assert_eq!(contacts.iter().collect::<Vec<_>>(), [Name(2, 1), Name(0, 1)], "the last fills");
        contacts.begin(Name(3, 2));
        contacts.end(Name(3, 1));
        contacts.end(Name(2, 1));
        assert_eq!(contacts.iter().collect::<Vec<_>>(), [Name(3, 2), Name(0, 1)], "a late end");
    }
}
