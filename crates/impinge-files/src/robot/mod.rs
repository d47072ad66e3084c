//! Robots: the collision elements of URDF files, placed by joint values.

mod geometry;
mod kinematics;
mod packages;
mod xml;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use impinge::math::na::Isometry3;

pub use kinematics::JointBeyondLimits;

use self::kinematics::Tree;
use self::packages::Packages;
use self::xml::XmlFile;
use crate::error::Fault;
use crate::format::{RobotFile, ShapeFile};
use crate::{FileError, Problem};

/// A robot as its files have it.
#[derive(Debug)]
pub(crate) struct Robot {
    pub(crate) name: String,
    tree: Tree,
    /// By link: its collision elements, in the frame of the link.
    solids: Vec<Option<LinkSolid>>,
    /// Pairs of links, by name, that the SRDF file disables.
    disabled: BTreeSet<[String; 2]>,
}

/// The collision elements of a link as one shape.
#[derive(Debug)]
struct LinkSolid {
    shape: ShapeFile,
    /// Where the shape is in the frame of the link.
    frame: Isometry3<f64>,
}

/// A link with collision elements, placed.
#[derive(Debug)]
pub(crate) struct RobotLink {
    pub(crate) name: String,
    pub(crate) shape: ShapeFile,
    pub(crate) frame: Isometry3<f64>,
}

impl Robot {
    /// Reads the files of a robot; paths are relative to a folder.
    pub(crate) fn read(file: &RobotFile, folder: &Path) -> Result<Self, FileError> {
        let path = folder.join(&file.urdf);
        let xml = XmlFile::read(&path)?;
        let robot = urdf_rs::read_from_string(&xml.without_visuals()?)
            .map_err(|error| xml.whole(Problem::Syntax(error.to_string())))?;
        let tree = Tree::new(&robot, &xml)?;
        let packages = Packages::new(file, folder, &path);
        let solids = robot.links.iter().map(|link| {
            let solid = geometry::solid(link, file.kind, &packages);
            solid.map_err(|problem| xml.error("link", &link.name, problem))
        });
        let solids = solids.collect::<Result<_, _>>()?;
        let disabled = match &file.srdf {
            None => BTreeSet::new(),
            Some(srdf) => disabled_pairs(&XmlFile::read(&folder.join(srdf))?, &tree)?,
        };
        Ok(Self { name: robot.name, tree, solids, disabled })
    }

    /// The links with collision elements, in the order of the file, for joint values and a frame of the root link.
    pub(crate) fn links(
        &self,
        file: &RobotFile,
        base: &Isometry3<f64>,
    ) -> Result<Vec<RobotLink>, Fault> {
        // Links without collision elements move those below them, and are no objects themselves.
        let frames = self.tree.frames(&file.joints, base)?;
        let links = self.tree.links.iter().zip(&self.solids).zip(frames);
        let links = links.filter_map(|((name, solid), frame)| {
            let LinkSolid { shape, frame: own } = solid.as_ref()?;
            let (name, shape) = (name.clone(), shape.clone());
            Some(RobotLink { name, shape, frame: frame * own })
        });
        Ok(links.collect())
    }

    /// The joints at values outside their limits; `name` is what the names of the robot's objects begin with.
    pub(crate) fn beyond_limits(&self, file: &RobotFile, name: &str) -> Vec<JointBeyondLimits> {
        self.tree.beyond_limits(name, &file.joints)
    }

    /// The pairs of links, by their index among those with collision elements, that have no contacts: those that a joint
    /// connects, directly or by way of links without collision elements, and those that the SRDF file disables.
    /// A pair may occur several times.
    pub(crate) fn disabled_pairs(&self, links: &[RobotLink]) -> Vec<[usize; 2]> {
        let names = links.iter().map(|link| link.name.as_str()).zip(0..);
        let index: BTreeMap<&str, usize> = names.collect();
        // Above the nearest link with collision elements nothing is joined directly.
        let joined = index.iter().filter_map(|(name, link)| {
            let above = self.tree.ancestors(name).find_map(|above| index.get(above))?;
            Some([*above, *link])
        });
        let disabled = self.disabled.iter().filter_map(|[link1, link2]| {
            Some([*index.get(link1.as_str())?, *index.get(link2.as_str())?])
        });
        joined.chain(disabled).filter(|[link1, link2]| link1 != link2).collect()
    }
}

/// The pairs of an SRDF file; its links are those of the robot.
fn disabled_pairs(xml: &XmlFile, tree: &Tree) -> Result<BTreeSet<[String; 2]>, FileError> {
    let mut pairs = BTreeSet::new();
    for (line, names) in xml.attributes("disable_collisions", ["link1", "link2"])? {
        if let Some(unknown) = names.iter().find(|name| !tree.has_link(name)) {
            let problem = Problem::UnknownLink(unknown.clone());
            return Err(FileError { line: Some(line), ..xml.whole(problem) });
        }
        pairs.insert(names);
    }
    Ok(pairs)
}
