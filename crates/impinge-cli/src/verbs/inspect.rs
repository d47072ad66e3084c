//! `impinge inspect`: describes the content of a file, and the defects of its meshes.

use core::fmt;

use impinge_files::{MeshReport, Printable};
use serde::Serialize;

use crate::args::InspectArgs;
use crate::error::CliError;
use crate::input::Input;
use crate::log::Log;
use crate::number::{Number, tuple};
use crate::output::{FAINT, NAME, Outcome, Report, Subject, TOUCHES, finish};
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &InspectArgs) -> Result<Outcome, CliError> {
    match Input::open(&args.scene)? {
        Input::Recording(log) => finish(&run_in(log.kind, InspectLog(&log))?, args.format),
        Input::Scene(loaded) => finish(&run_in(loaded.kind, InspectScene(&loaded))?, args.format),
    }
}

/// The task that describes the objects and meshes of a scene.
struct InspectScene<'a>(&'a Loaded);

/// The task that reads the header and counts the steps of a recording.
struct InspectLog<'a>(&'a Log);

/// The report of a scene.
#[derive(Debug, Serialize)]
struct SceneReport {
    #[serde(flatten)]
    subject: Subject,
    kind: &'static str,
    objects: Vec<ObjectFields>,
    meshes: Vec<MeshFields>,
    /// A sentence for each joint of a robot whose value is outside its limits.
    joints_beyond_limits: Vec<String>,
}

/// An object, and the lower and upper corner of its bounding box. Unbounded coordinates are null.
#[derive(Debug, Serialize)]
struct ObjectFields {
    name: String,
    shape: String,
    low: Vec<Number>,
    high: Vec<Number>,
}

/// The counts and the defects of one mesh of a file.
#[derive(Debug, Serialize)]
struct MeshFields {
    file: String,
    name: String,
    vertices: usize,
    triangles: usize,
    /// The number of connected components.
    pieces: usize,
    /// `true` if each edge has two triangles or more.
    closed: bool,
    /// `true` if each edge has two triangles, whose fronts are on the same side.
    solid: bool,
    /// The volume of a solid, negative if its triangles point inwards; null if `solid` is `false`.
    volume: Option<f64>,
    /// The number of edges with one triangle.
    boundary_edges: usize,
    /// All counts as a line of text.
    #[serde(skip)]
    numbers: String,
    /// A line for each kind of defect, with the indices of its first occurrences.
    problems: Vec<String>,
}

/// The report of a recording.
#[derive(Debug, Serialize)]
struct LogReport {
    #[serde(flatten)]
    subject: Subject,
    kind: &'static str,
    /// The version of the format.
    version: u32,
    /// The program that wrote the recording, with its version.
    writer: String,
    steps: usize,
}

impl Task for InspectScene<'_> {
    type Answer = SceneReport;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<SceneReport, CliError> {
        let loaded = self.0;
        let world = loaded.world::<N, D>()?;
        let objects = world.collision_objects().map(|object| {
            let aabb = object.shape().aabb(&N::pose(object.position()));
            ObjectFields {
                name: object.data().clone(),
                shape: format!("{:?}", object.shape().geometry().kind()),
                low: Number::of_point(aabb.mins()),
                high: Number::of_point(aabb.maxs()),
            }
        });
        let objects = objects.collect();
        let mut meshes = Vec::new();
        for (path, file) in loaded.scene().mesh_files() {
            let path = path.display().to_string();
            meshes.extend(file.parts().iter().map(|part| fields(&path, &part.name, &part.report)));
        }
        let joints = loaded.scene().joints_beyond_limits().iter();
        let joints_beyond_limits = joints.map(ToString::to_string).collect();
        let subject = loaded.subject();
        Ok(SceneReport { subject, kind: "scene", objects, meshes, joints_beyond_limits })
    }
}

fn fields(file: &str, name: &str, report: &MeshReport) -> MeshFields {
    MeshFields {
        file: file.to_owned(),
        name: name.to_owned(),
        vertices: report.vertices,
        triangles: report.triangles,
        pieces: report.components,
        closed: report.is_closed(),
        solid: report.is_solid(),
        volume: report.volume,
        boundary_edges: report.boundary_edges.count,
        // The first line contains the counts; the other lines are the defects.
        numbers: report.to_string().lines().next().unwrap_or_default().to_owned(),
        problems: report.problems(),
    }
}

impl Task for InspectLog<'_> {
    type Answer = LogReport;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<LogReport, CliError> {
        let log = self.0;
        Ok(LogReport {
            subject: log.subject(),
            kind: "recording",
            version: log.header.version,
            writer: log.header.writer.clone(),
            steps: log.replay::<N, D>()?.len(),
        })
    }
}

impl fmt::Display for SceneReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {} objects", self.subject, self.objects.len())?;
        for ObjectFields { name, shape, low, high } in &self.objects {
            let [low, high] = [low, high].map(|numbers| tuple(numbers));
            let name = Printable(name);
            writeln!(
                f,
                "  {NAME}{name}{NAME:#} {shape} {FAINT}from{FAINT:#} {low} {FAINT}to{FAINT:#} {high}"
            )?;
        }
        self.meshes.iter().try_for_each(|mesh| mesh.fmt(f))?;
        self.joints_beyond_limits.iter().try_for_each(|joint| writeln!(f, "{joint}"))
    }
}

impl Report for SceneReport {
    fn outcome(&self) -> Outcome {
        self.meshes.iter().any(|mesh| !mesh.problems.is_empty()).into()
    }
}

impl fmt::Display for MeshFields {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { numbers, problems, .. } = self;
        let [file, name] = [&self.file, &self.name].map(|name| Printable(name));
        writeln!(f, "{NAME}{file}{NAME:#} part {NAME}{name}{NAME:#}: {numbers}")?;
        problems.iter().try_for_each(|text| writeln!(f, "  {TOUCHES}{text}{TOUCHES:#}"))
    }
}

impl fmt::Display for LogReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { subject, version, steps, .. } = self;
        let writer = Printable(&self.writer);
        writeln!(f, "{subject}: a recording of version {version} by {writer}, {steps} steps")
    }
}

impl Report for LogReport {}
