//! Converts the user data of objects to bytes.

/// User data of objects that can be recorded. The data is recorded because filters may read it.
///
/// ```
/// use impinge_record::RecordData;
///
/// #[derive(Debug, Default, PartialEq)]
/// struct Team(u8);
///
/// impl RecordData for Team {
///     fn to_bytes(&self) -> Vec<u8> {
///         vec![self.0]
///     }
///
///     fn from_bytes(bytes: &[u8]) -> Option<Self> {
///         if let [team] = bytes { Some(Self(*team)) } else { None }
///     }
/// }
///
/// assert_eq!(Team::from_bytes(&Team(3).to_bytes()), Some(Team(3)));
/// ```
///
/// While a key frame is read, temporary objects occupy free indices. Their data is the [`Default`],
/// which is never read.
pub trait RecordData: Default {
    /// Returns the data as bytes.
    fn to_bytes(&self) -> Vec<u8>;

    /// Returns the data with these bytes; `None` if they are invalid. The bytes may come from an
    /// untrusted recording.
    fn from_bytes(bytes: &[u8]) -> Option<Self>;
}

impl RecordData for () {
    fn to_bytes(&self) -> Vec<u8> {
        Vec::new()
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        bytes.is_empty().then_some(())
    }
}

impl RecordData for u32 {
    fn to_bytes(&self) -> Vec<u8> {
        self.to_le_bytes().to_vec()
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        bytes.try_into().ok().map(Self::from_le_bytes)
    }
}

impl RecordData for u64 {
    fn to_bytes(&self) -> Vec<u8> {
        self.to_le_bytes().to_vec()
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        bytes.try_into().ok().map(Self::from_le_bytes)
    }
}

impl RecordData for String {
    fn to_bytes(&self) -> Vec<u8> {
        self.as_bytes().to_vec()
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        Self::from_utf8(bytes.to_vec()).ok()
    }
}

impl RecordData for Vec<u8> {
    fn to_bytes(&self) -> Vec<u8> {
        self.clone()
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        Some(bytes.to_vec())
    }
}
