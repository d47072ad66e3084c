//! All samples run, are recorded, and show what they claim to show.

mod claims;
mod entries;
mod motion_claims;
mod support;
