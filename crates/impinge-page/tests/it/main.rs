//! The engine as the page sees it: messages in, answers out.

mod frames;
mod gallery;
mod hostile;
mod numbers;
mod replays;
mod support;
mod why;
