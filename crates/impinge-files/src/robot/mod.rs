//! Robots: the collision elements of URDF files, placed by joint values.

mod geometry;
mod kinematics;
mod packages;
mod xml;

use std::collections::BTreeSet;
use std::path::Path;

use impinge::math::na::Isometry3;

pub use kinematics::JointBeyondLimits;

use self::kinematics::Tree;
use self::packages::Packages;
use self::xml::XmlFile;
use crate::error::Fault;
use crate::files::Files;
use crate::format::{RobotFile, ShapeFile};
use crate::{FileError, Problem};

/// The data of the files of a robot.
#[derive(Debug)]
pub(crate) struct Robot {
    pub(crate) name: String,
    tree: Tree,
    /// For each link, its collision elements as one shape; `None` if it has none.
    solids: Vec<Option<LinkSolid>>,
    /// The pairs of link names whose contacts the SRDF file disables.
    disabled: BTreeSet<[String; 2]>,
}

/// The collision elements of a link as one shape.
#[derive(Debug)]
struct LinkSolid {
    shape: ShapeFile,
    /// The frame of the shape in the frame of the link.
    frame: Isometry3<f64>,
}

/// A link with collision elements, and the frame of its shape in the scene.
#[derive(Debug)]
pub(crate) struct RobotLink {
    pub(crate) name: String,
    pub(crate) shape: ShapeFile,
    pub(crate) frame: Isometry3<f64>,
}

impl Robot {
    /// Reads the files of a robot. Paths are relative to `folder`.
    pub(crate) fn read(
        file: &RobotFile,
        folder: &Path,
        files: &mut Files,
    ) -> Result<Self, FileError> {
        let path = folder.join(&file.urdf);
        let xml = XmlFile::read(&path, files)?;
        let robot = urdf_rs::read_from_string(&xml.without_visuals()?)
            .map_err(|error| xml.whole(Problem::syntax(error)))?;
        let tree = Tree::new(&robot, &xml)?;
        let packages = Packages::new(file, folder, &path, files);
        let solids = robot.links.iter().map(|link| {
            let solid = geometry::solid(link, file.kind, &packages);
            solid.map_err(|problem| xml.error("link", &link.name, problem))
        });
        let solids = solids.collect::<Result<_, _>>()?;
        let disabled = match &file.srdf {
            None => BTreeSet::new(),
            Some(srdf) => disabled_pairs(&XmlFile::read(&folder.join(srdf), files)?, &tree)?,
        };
        Ok(Self { name: robot.name, tree, solids, disabled })
    }

    /// Returns the links with collision elements, in the order of the file. `base` is the frame of
    /// the root link.
    pub(crate) fn links(
        &self,
        file: &RobotFile,
        base: &Isometry3<f64>,
    ) -> Result<Vec<RobotLink>, Fault> {
        // Links without collision elements move their child links, but become no objects.
        let frames = self.tree.frames(&file.joints, base)?;
        let links = self.tree.links.iter().zip(&self.solids).zip(frames);
        let links = links.filter_map(|((name, solid), frame)| {
            let LinkSolid { shape, frame: own } = solid.as_ref()?;
            let (name, shape) = (name.clone(), shape.clone());
            Some(RobotLink { name, shape, frame: frame * own })
        });
        Ok(links.collect())
    }

    /// Returns the number of joints.
    pub(crate) fn num_joints(&self) -> usize {
        self.tree.num_joints()
    }

    /// Returns the joints whose values are outside their limits. `name` is the prefix of the names
    /// of the robot's objects.
    pub(crate) fn beyond_limits(&self, file: &RobotFile, name: &str) -> Vec<JointBeyondLimits> {
        self.tree.beyond_limits(name, &file.joints)
    }

    /// Returns the pairs of links whose contacts are disabled, as indices among the links with
    /// collision elements. These are the pairs connected by a joint, directly or through links
    /// without collision elements, and the pairs of the SRDF file. A pair may occur several times.
    /// O(n log n), where n is the number of links plus the number of pairs of the SRDF file.
    pub(crate) fn disabled_pairs(&self) -> Vec<[usize; 2]> {
        let has_solid = |link: usize| self.solids[link].is_some();
        let numbers = (0..self.solids.len()).scan(0, |next, link| {
            let number = has_solid(link).then_some(*next);
            *next += usize::from(has_solid(link));
            Some(number)
        });
        let numbers: Vec<Option<usize>> = numbers.collect();
        // The search upwards ends at the nearest link with collision elements.
        let above = self.tree.nearest_above(has_solid).into_iter().enumerate();
        let joined = above.filter_map(|(link, above)| Some([above?, link]));
        let disabled = self.disabled.iter().filter_map(|pair| {
            let [link1, link2] = pair.each_ref().map(|name| self.tree.link(name));
            Some([link1?, link2?])
        });
        let pairs = joined.chain(disabled).filter(|[link1, link2]| link1 != link2);
        pairs.filter_map(|[link1, link2]| Some([numbers[link1]?, numbers[link2]?])).collect()
    }
}

/// Reads the disabled pairs of an SRDF file. A link that the robot does not have is an error.
fn disabled_pairs(xml: &XmlFile, tree: &Tree) -> Result<BTreeSet<[String; 2]>, FileError> {
    let mut pairs = BTreeSet::new();
    xml.each("disable_collisions", ["link1", "link2"], |names| {
        match names.into_iter().find(|name| tree.link(name).is_none()) {
            Some(unknown) => Err(Problem::UnknownLink(unknown.to_owned())),
            None => {
                pairs.insert(names.map(str::to_owned));
                Ok(())
            }
        }
    })?;
    Ok(pairs)
}
