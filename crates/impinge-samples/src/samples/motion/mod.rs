//! Samples of motion by contacts, impacts and events.

pub(crate) mod arm;
pub(crate) mod bullets;
pub(crate) mod character;
pub(crate) mod conveyor;
pub(crate) mod crowd;
pub(crate) mod gripper;
pub(crate) mod pile;
pub(crate) mod stack;
