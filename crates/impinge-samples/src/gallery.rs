//! The samples in the order of the gallery.

use serde::{Serialize, Serializer};

use crate::Sample;
use crate::catalog::ENTRIES;

/// Makes a sample of a dimension.
#[derive(Clone, Copy, Debug)]
pub enum Make {
    /// In 2D.
    Plane(fn() -> Box<dyn Sample<2>>),
    /// In 3D.
    Space(fn() -> Box<dyn Sample<3>>),
}

impl Make {
    /// 2 or 3.
    #[must_use]
    pub const fn dimension(&self) -> usize {
        match self {
            Self::Plane(_) => 2,
            Self::Space(_) => 3,
        }
    }
}

/// Serializes as the number of its dimension.
impl Serialize for Make {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.dimension().serialize(serializer)
    }
}

/// The property of a sample that tests check within its first two seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// A contact.
    Contacts,
    /// A proximity event.
    ProximityEvents,
    /// A drawing beside the objects.
    Drawing,
}

/// A sample of the gallery. It serializes with its name, title, about and dimension.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Entry {
    /// A word, unique in the gallery.
    pub name: &'static str,
    /// The heading.
    pub title: &'static str,
    /// A description in two sentences.
    pub about: &'static str,
    /// The property that is visible soon after the start.
    #[serde(skip)]
    pub shows: Shows,
    /// The constructor.
    #[serde(rename = "dimension")]
    pub make: Make,
}

/// The samples in the order of the gallery.
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
