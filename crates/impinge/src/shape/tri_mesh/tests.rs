//! Tests of what only this module can see.
