//! The user guide and the README, so that every block in them is compiled and run as a test.

#[doc = include_str!("../../../README.md")]
pub struct Readme;
#[doc = include_str!("../../../guide/introduction.md")]
pub struct Introduction;
#[doc = include_str!("../../../guide/pipeline.md")]
pub struct Pipeline;
#[doc = include_str!("../../../guide/shapes.md")]
pub struct Shapes;
#[doc = include_str!("../../../guide/composites.md")]
pub struct Composites;
#[doc = include_str!("../../../guide/own-shapes.md")]
pub struct OwnShapes;
#[doc = include_str!("../../../guide/contacts.md")]
pub struct Contacts;
#[doc = include_str!("../../../guide/groups.md")]
pub struct Groups;
#[doc = include_str!("../../../guide/events.md")]
pub struct Events;
#[doc = include_str!("../../../guide/queries.md")]
pub struct Queries;
#[doc = include_str!("../../../guide/performance.md")]
pub struct Performance;
#[doc = include_str!("../../../guide/guarantees.md")]
pub struct Guarantees;
#[doc = include_str!("../../../guide/coming-from.md")]
pub struct ComingFrom;
