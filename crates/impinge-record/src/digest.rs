//! The hash of a recording: FNV-1a over 64-bit words, each mixed as in `SplitMix64`. The hash is
//! the same on every platform.

use std::hash::{Hash, Hasher};

use impinge::query::ContactId;
use impinge::shape::FeatureId;

use crate::space::Scalar;

/// A hash to which words are added.
#[derive(Clone, Debug)]
pub(crate) struct Digest(u64);

impl Digest {
    /// Creates a hash with the offset basis of FNV-1a.
    pub(crate) const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub(crate) const fn finish(&self) -> u64 {
        self.0
    }

    /// Returns the hash folded to 32 bits.
    #[expect(clippy::cast_possible_truncation, reason = "both halves are folded into one")]
    pub(crate) const fn folded(&self) -> u32 {
        (self.0 ^ (self.0 >> 32)) as u32
    }

    /// Adds a word. The word is mixed first, so that words that differ only in a high bit change
    /// the low bits too.
    pub(crate) const fn word(&mut self, word: u64) {
        let mixed = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        self.0 = (self.0 ^ mixed ^ (mixed >> 31)).wrapping_mul(0x0000_0100_0000_01b3);
    }

    /// Adds an index, converted to 64 bits on every platform.
    pub(crate) const fn index(&mut self, index: usize) {
        self.word(index as u64);
    }

    /// Adds the bits of numbers.
    pub(crate) fn numbers<N: Scalar>(&mut self, numbers: &[N]) {
        numbers.iter().for_each(|number| self.word(number.bits()));
    }

    /// Adds the kind of a feature as 0, 1 or 2, then its index.
    pub(crate) fn feature(&mut self, feature: FeatureId) {
        let (kind, index) = match feature {
            FeatureId::Vertex(index) => (0, index),
            FeatureId::Edge(index) => (1, index),
            FeatureId::Face(index) => (2, index),
        };
        self.word(kind);
        self.word(u64::from(index));
    }
}

/// Returns the two parts of a contact id: the index of the pair, and the index within the pair. The
/// parts are read through the `Hash` of the id.
pub(crate) fn id_parts(id: ContactId) -> [u64; 2] {
    let mut parts = IdParts::default();
    id.hash(&mut parts);
    [parts.pair, parts.number]
}

/// A hasher that stores its input, since an id gives no other access to its parts.
#[derive(Debug, Default)]
struct IdParts {
    pair: u64,
    number: u64,
}

impl Hasher for IdParts {
    fn finish(&self) -> u64 {
        self.pair
    }

    /// Ignored: an id hashes no byte slices.
    fn write(&mut self, _bytes: &[u8]) {}

    fn write_u32(&mut self, number: u32) {
        self.number = u64::from(number);
    }

    fn write_u64(&mut self, pair: u64) {
        self.pair = pair;
    }
}
