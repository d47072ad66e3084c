//! The tree of joints of a robot, which computes the frames of links from joint values.

use core::fmt;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use impinge::math::na::{Isometry3, Translation3, Vector3};
use urdf_rs::{Joint, JointType, Mimic};

use super::geometry::isometry;
use super::xml::XmlFile;
use crate::error::{Fault, Within};
use crate::scene::{about, unit};
use crate::{FileError, Printable, Problem};

/// The links of a robot, and the joints between them.
#[derive(Debug)]
pub(super) struct Tree {
    /// The names of the links, in the order of the file.
    pub(super) links: Vec<String>,
    /// The index of each link by its name.
    index: BTreeMap<String, usize>,
    joints: BTreeMap<String, TreeJoint>,
    /// For each link, the name of the joint that connects it to its parent; `None` for the root.
    above: Vec<Option<String>>,
    /// The indices of the links, sorted so that parents come before their children.
    order: Vec<usize>,
    /// For each joint that mimics another, the resolved relation to a joint that mimics none.
    follows: BTreeMap<String, Follows>,
}

/// The value of a joint that mimics another: `factor` times the value of `joint`, which mimics
/// none, plus `offset`.
#[derive(Clone, Debug, PartialEq)]
struct Follows {
    /// The name of the joint that is followed. All joints that follow it share the text.
    joint: Rc<str>,
    factor: f64,
    offset: f64,
}

/// A joint of a robot whose value is outside the limits of its URDF file.
///
/// The link below the joint is placed by this value nevertheless. Limits describe the drives of a
/// robot, whereas a collision checker must accept any pose.
#[derive(Clone, Debug, PartialEq)]
pub struct JointBeyondLimits {
    /// The prefix of the names of the robot's objects.
    pub robot: String,
    /// The name of the joint.
    pub joint: String,
    /// The value in the scene, in radians or as a length. For a joint that mimics another, the
    /// derived value.
    pub value: f64,
    /// The lower and the upper limit of the URDF file.
    pub limits: [f64; 2],
}

/// A joint; `Tree::joints` stores it by its name.
#[derive(Debug)]
struct TreeJoint {
    /// The index of the parent link.
    parent: usize,
    /// The frame of the joint in the frame of the parent link.
    origin: Isometry3<f64>,
    motion: JointMotion,
    /// The lower and the upper limit; `None` if the file gives none, or the kind of joint has none.
    limits: Option<[f64; 2]>,
    mimic: Option<Mimic>,
}

/// The motion of a joint as a function of its value, about or along a unit vector.
#[derive(Clone, Copy, Debug)]
enum JointMotion {
    Turn(Vector3<f64>),
    Slide(Vector3<f64>),
    /// The joint is fixed, or has several degrees of freedom, which scenes do not move.
    None,
}

impl Tree {
    /// Builds the tree of a robot, and checks that its links form a tree. Errors contain the line
    /// in `xml`.
    pub(super) fn new(robot: &urdf_rs::Robot, xml: &XmlFile) -> Result<Self, FileError> {
        let links: Vec<String> = robot.links.iter().map(|link| link.name.clone()).collect();
        let index: BTreeMap<String, usize> = links.iter().cloned().zip(0..).collect();
        let mut above = vec![None; links.len()];
        let mut joints = BTreeMap::new();
        for joint in &robot.joints {
            let wrong = |problem| xml.error("joint", &joint.name, problem);
            let link = |name: &String| {
                let found = index.get(name).copied();
                found.ok_or_else(|| wrong(Problem::UnknownLink(name.clone())))
            };
            let (parent, child) = (link(&joint.parent.link)?, link(&joint.child.link)?);
            // Each link has at most one joint above it. The links then form a tree if `sorted`
            // finds a single root and no separate cycle.
            if above[child].replace(joint.name.clone()).is_some() {
                return Err(wrong(Problem::NotATree { link: joint.child.link.clone() }));
            }
            let read = tree_joint(joint, parent).map_err(wrong)?;
            if joints.insert(joint.name.clone(), read).is_some() {
                return Err(wrong(Problem::DuplicateName(joint.name.clone())));
            }
        }
        let (order, follows) = (Vec::new(), BTreeMap::new());
        let mut tree = Self { links, index, joints, above, order, follows };
        tree.order = tree
            .sorted()
            .map_err(|link| xml.error("link", &link.clone(), Problem::NotATree { link }))?;
        tree.follows =
            tree.mimics().map_err(|(name, problem)| xml.error("joint", &name, problem))?;
        Ok(tree)
    }

    /// Returns the indices of the links, parents first. The error contains the name of a second
    /// root, or of a link that is not connected to the root.
    fn sorted(&self) -> Result<Vec<usize>, String> {
        let mut below = vec![Vec::new(); self.links.len()];
        let mut open = Vec::new();
        // The stack starts with the root.
        for (link, above) in self.above.iter().enumerate() {
            match above {
                Some(joint) => below[self.joints[joint].parent].push(link),
                None => open.push(link),
            }
        }
        if let Some(second) = open.get(1) {
            return Err(self.links[*second].clone());
        }
        let mut order = Vec::new();
        // Terminates: each link has at most one parent, so it is pushed at most once.
        while let Some(link) = open.pop() {
            order.push(link);
            open.append(&mut below[link]);
        }
        let reached: BTreeSet<&usize> = order.iter().collect();
        // The links of a cycle cannot be reached from the root.
        let is_missing = |link: &usize| !reached.contains(link);
        match (0..self.links.len()).find(is_missing) {
            Some(link) => Err(self.links[link].clone()),
            None => Ok(order),
        }
    }

    /// Resolves chains of mimicking joints of any length, and visits each joint once. The error
    /// contains the name of a joint on a cycle, or of a joint that mimics a missing joint.
    fn mimics(&self) -> Result<BTreeMap<String, Follows>, (String, Problem)> {
        let mut follows: BTreeMap<String, Follows> = BTreeMap::new();
        for name in self.joints.keys() {
            let mut chain: Vec<(&String, &Mimic)> = Vec::new();
            let mut passed = BTreeSet::new();
            let mut current = name;
            // Terminates: a joint that is visited twice is an error.
            while let (None, Some(mimic)) = (follows.get(current), &self.joints[current].mimic) {
                if !passed.insert(current) {
                    return Err((current.clone(), Problem::MimicCycle(current.clone())));
                }
                if !self.joints.contains_key(&mimic.joint) {
                    return Err((current.clone(), Problem::UnknownJoint(mimic.joint.clone())));
                }
                chain.push((current, mimic));
                current = &mimic.joint;
            }
            let leader = Follows { joint: current.as_str().into(), factor: 1.0, offset: 0.0 };
            let mut last = follows.get(current).cloned().unwrap_or(leader);
            for (name, mimic) in chain.into_iter().rev() {
                last = last.followed_by(mimic);
                follows.insert(name.clone(), last.clone());
            }
        }
        Ok(follows)
    }

    /// Returns the frames of all links, from joint values and the frame of the root. Joints without
    /// a value are at 0. Only joints that move and mimic no other joint may have a value.
    pub(super) fn frames(
        &self,
        values: &BTreeMap<String, f64>,
        base: &Isometry3<f64>,
    ) -> Result<Vec<Isometry3<f64>>, Fault> {
        for name in values.keys() {
            let joint = self.joints.get(name);
            let moves = joint.is_some_and(|joint| {
                joint.mimic.is_none() && !matches!(joint.motion, JointMotion::None)
            });
            if !moves {
                return Err(Problem::UnknownJoint(name.clone())).within(name).within("joints");
            }
        }
        let mut frames = vec![*base; self.links.len()];
        // Parents come first, so the frame of the parent is known.
        for &link in &self.order {
            if let Some(name) = &self.above[link] {
                let joint = &self.joints[name];
                let motion = joint.motion.at(self.value(name, values));
                frames[link] = frames[joint.parent] * joint.origin * motion;
            }
        }
        Ok(frames)
    }

    /// Returns the value of a joint; for a mimicking joint, the derived value.
    fn value(&self, name: &str, values: &BTreeMap<String, f64>) -> f64 {
        let given = |name: &str| values.get(name).copied().unwrap_or(0.0);
        match self.follows.get(name) {
            Some(Follows { joint, factor, offset }) => factor * given(joint) + offset,
            None => given(name),
        }
    }

    /// Returns the joints whose values are outside their limits, sorted by name. `robot` is the
    /// prefix of the names of the robot's objects.
    pub(super) fn beyond_limits(
        &self,
        robot: &str,
        values: &BTreeMap<String, f64>,
    ) -> Vec<JointBeyondLimits> {
        let joints = self.joints.iter().filter_map(|(name, joint)| {
            let (limits, value) = (joint.limits?, self.value(name, values));
            let is_within = (limits[0]..=limits[1]).contains(&value);
            (!is_within).then(|| {
                let (robot, joint) = (robot.to_owned(), name.clone());
                JointBeyondLimits { robot, joint, value, limits }
            })
        });
        joints.collect()
    }

    /// Returns the number of joints.
    pub(super) fn num_joints(&self) -> usize {
        self.joints.len()
    }

    /// Returns the index of the link with this name; `None` if the robot has no such link.
    pub(super) fn link(&self, name: &str) -> Option<usize> {
        self.index.get(name).copied()
    }

    /// Returns, for each link, its nearest ancestor for which `holds` returns `true`; `None` if
    /// there is none.
    pub(super) fn nearest_above(&self, holds: impl Fn(usize) -> bool) -> Vec<Option<usize>> {
        let mut nearest = vec![None; self.links.len()];
        // Parents come first, so the result of the parent is known.
        for &link in &self.order {
            if let Some(joint) = &self.above[link] {
                let parent = self.joints[joint].parent;
                nearest[link] = if holds(parent) { Some(parent) } else { nearest[parent] };
            }
        }
        nearest
    }
}

impl Follows {
    /// Returns the relation of a joint that mimics the joint of `self` by `mimic`. Both follow the
    /// same joint.
    fn followed_by(&self, mimic: &Mimic) -> Self {
        let multiplier = mimic.multiplier.unwrap_or(1.0);
        Self {
            joint: Rc::clone(&self.joint),
            factor: multiplier * self.factor,
            offset: multiplier * self.offset + mimic.offset.unwrap_or(0.0),
        }
    }
}

/// Converts a joint. The axes of fixed joints are ignored, since many files have zeros there.
fn tree_joint(joint: &Joint, parent: usize) -> Result<TreeJoint, Problem> {
    let axis = || unit(Vector3::from(joint.axis.xyz.0));
    let motion = match joint.joint_type {
        JointType::Revolute | JointType::Continuous => JointMotion::Turn(axis()?),
        JointType::Prismatic => JointMotion::Slide(axis()?),
        JointType::Fixed | JointType::Floating | JointType::Planar | JointType::Spherical => {
            JointMotion::None
        }
    };
    let (origin, mimic) = (isometry(&joint.origin)?, joint.mimic.clone());
    Ok(TreeJoint { parent, origin, motion, limits: limits(joint), mimic })
}

/// Returns the limits of a revolute or prismatic joint; `None` for other kinds. For a joint without
/// a `limit` element, as in many files, the parser returns 0 twice, which means no limits.
fn limits(joint: &Joint) -> Option<[f64; 2]> {
    let is_limited = matches!(joint.joint_type, JointType::Revolute | JointType::Prismatic);
    let limits = [joint.limit.lower, joint.limit.upper];
    (is_limited && limits != [0.0; 2]).then_some(limits)
}

impl fmt::Display for JointBeyondLimits {
    /// Writes a sentence such as `the joint elbow of arm is at 3.5, outside its limits -2.5 to
    /// 2.5`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { robot, joint, value, limits: [lower, upper] } = self;
        let [robot, joint] = [robot, joint].map(|name| Printable(name));
        write!(
            f,
            "the joint {joint} of {robot} is at {value}, outside its limits {lower} to {upper}"
        )
    }
}

impl JointMotion {
    /// Returns the motion of the joint at `value`, in the frame of the joint.
    fn at(self, value: f64) -> Isometry3<f64> {
        match self {
            Self::Turn(axis) => Isometry3::from_parts(Translation3::identity(), about(axis, value)),
            Self::Slide(axis) => Translation3::from(axis * value).into(),
            Self::None => Isometry3::identity(),
        }
    }
}
