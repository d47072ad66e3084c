//! The gallery: the list of all samples.

use serde::{Serialize, Serializer};

use crate::Sample;
use crate::catalog::ENTRIES;

/// The constructor of a sample, by dimension.
#[derive(Clone, Copy, Debug)]
pub enum Make {
    /// Creates a sample in 2D.
    Plane(fn() -> Box<dyn Sample<2>>),
    /// Creates a sample in 3D.
    Space(fn() -> Box<dyn Sample<3>>),
}

impl Make {
    /// Returns the number of dimensions, 2 or 3.
    #[must_use]
    pub const fn dimension(&self) -> usize {
        match self {
            Self::Plane(_) => 2,
            Self::Space(_) => 3,
        }
    }
}

/// Serializes the constructor as the number of dimensions.
impl Serialize for Make {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.dimension().serialize(serializer)
    }
}

/// A property of a sample that tests check. It becomes visible within the first two seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// The world has a contact.
    Contacts,
    /// The world has an event of two objects that begin to intersect.
    ProximityEvents,
    /// The sample draws lines besides the objects.
    Drawing,
}

/// A sample of the gallery. It serializes with its name, title, description and dimension.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Entry {
    /// A name, unique in the gallery.
    pub name: &'static str,
    /// The heading of the sample.
    pub title: &'static str,
    /// A description in two sentences.
    pub about: &'static str,
    /// The property that is visible soon after the start.
    #[serde(skip)]
    pub shows: Shows,
    /// The constructor of the sample.
    #[serde(rename = "dimension")]
    pub make: Make,
}

/// Returns all samples in the order of the gallery.
///
/// ```
/// use impinge_samples::entries;
///
/// let names: Vec<_> = entries().iter().map(|entry| entry.name).collect();
/// assert_eq!(names[..2], ["playground2", "playground3"]);
/// ```
#[must_use]
pub const fn entries() -> &'static [Entry] {
    ENTRIES
}
