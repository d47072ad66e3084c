//! Errors of the frames, bodies, pairs and obstacles from which a checker is built.

use core::fmt;

/// The reason why frames, bodies, pairs or obstacles were rejected.
///
/// ```
/// use impinge::dim2::checker::{CheckerError, Frame, FrameTree, Joint};
/// use impinge::dim2::math::Pose;
///
/// let lost: Frame<f64> = Frame { parent: Some(4), origin: Pose::identity(), joint: Joint::fixed() };
/// let refused = FrameTree::try_new(&[lost], 0).expect_err("there is no frame 4");
/// assert_eq!(refused, CheckerError::Parent { frame: 0, parent: 4, frames: 1 });
/// assert_eq!(refused.to_string(), "frame 0 has the parent 4 of 1 frames");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CheckerError {
    /// The parent of a frame does not exist.
    Parent {
        /// The index of the frame.
        frame: usize,
        /// The index of the parent.
        parent: usize,
        /// The number of frames.
        frames: usize,
    },
    /// A frame is its own ancestor.
    Loop {
        /// The index of the frame.
        frame: usize,
    },
    /// The column that drives a joint does not exist.
    Column {
        /// The index of the joint's frame.
        frame: usize,
        /// The index of the column.
        column: usize,
        /// The number of columns.
        columns: usize,
    },
    /// The axis of a prismatic joint is not a unit vector, or the generator of a revolute joint
    /// does not generate a rotation about a unit axis.
    Axis {
        /// The index of the joint's frame.
        frame: usize,
    },
    /// A pose or a joint contains a number that is infinite or NaN.
    NotFinite {
        /// The name of the list: `frames`, `bodies` or `obstacles`.
        argument: &'static str,
        /// The index in the list.
        index: usize,
    },
    /// The frame of a body does not exist.
    BodyFrame {
        /// The index of the body.
        body: usize,
        /// The index of the frame.
        frame: usize,
        /// The number of frames.
        frames: usize,
    },
    /// A pair refers to a body or obstacle that does not exist, or to one body twice.
    Pair {
        /// The name of the list of pairs: `pairs` or `ignored`.
        argument: &'static str,
        /// The index of the pair in the list.
        index: usize,
        /// The pair itself.
        pair: [u32; 2],
    },
    /// The number of bodies and obstacles does not fit in 32 bits.
    TooMany {
        /// The number of bodies and obstacles given.
        given: usize,
    },
}

impl fmt::Display for CheckerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parent { frame, parent, frames } => {
                write!(f, "frame {frame} has the parent {parent} of {frames} frames")
            }
            Self::Loop { frame } => write!(f, "the parents of frame {frame} have a loop"),
            Self::Column { frame, column, columns } => {
                write!(f, "the joint of frame {frame} is driven by column {column} of {columns}")
            }
            Self::Axis { frame } => {
                write!(f, "the joint of frame {frame} has an axis that is no unit vector")
            }
            Self::NotFinite { argument, index } => {
                write!(f, "`{argument}[{index}]` has a number that is not finite")
            }
            Self::BodyFrame { body, frame, frames } => {
                write!(f, "body {body} is on frame {frame} of {frames}")
            }
            Self::Pair { argument, index, pair: [one, other] } => {
                write!(f, "`{argument}[{index}]` is {one} and {other}, which are no pair")
            }
            Self::TooMany { given } => {
                write!(f, "{given} bodies and obstacles are more than 32 bits can number")
            }
        }
    }
}

impl core::error::Error for CheckerError {}
