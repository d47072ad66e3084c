//! `impinge inspect`: what is in a file, and what is wrong with its meshes.

use core::fmt::Write as _;

use impinge_files::MeshReport;
use impinge_record::{Registry, Replay};
use serde::Serialize;

use crate::args::InspectArgs;
use crate::error::CliError;
use crate::input::Input;
use crate::number::{Number, significant, tuple};
use crate::output::{FAINT, NAME, Outcome, Report, TOUCHES, finish};
use crate::recording::{Label, Log, in_file};
use crate::scene::Loaded;
use crate::space::{KindFields, Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &InspectArgs) -> Result<Outcome, CliError> {
    match Input::open(&args.scene)? {
        Input::Recording(log) => finish(&run_in(log.kind, InspectLog(&log))?, args.format),
        Input::Scene(loaded) => finish(&run_in(loaded.kind, InspectScene(&loaded))?, args.format),
    }
}

/// Looks at a scene.
struct InspectScene<'a>(&'a Loaded);

/// Looks at a recording.
struct InspectLog<'a>(&'a Log);

/// What is in a scene.
#[derive(Debug, Serialize)]
struct SceneReport {
    file: String,
    kind: &'static str,
    #[serde(flatten)]
    space: KindFields,
    objects: Vec<ObjectFields>,
    meshes: Vec<MeshFields>,
    /// Joints of robots at values outside their limits.
    joints_beyond_limits: Vec<String>,
}

/// An object and the box around it; null where it has no bound.
#[derive(Debug, Serialize)]
struct ObjectFields {
    name: String,
    shape: String,
    low: Vec<Number>,
    high: Vec<Number>,
}

/// A part of a mesh file.
#[derive(Debug, Serialize)]
struct MeshFields {
    file: String,
    name: String,
    vertices: usize,
    triangles: usize,
    pieces: usize,
    closed: bool,
    solid: bool,
    volume: Option<f64>,
    boundary_edges: usize,
    problems: Vec<String>,
}

/// What is in a recording.
#[derive(Debug, Serialize)]
struct LogReport {
    file: String,
    kind: &'static str,
    #[serde(flatten)]
    space: KindFields,
    version: u32,
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
        let (file, space) = (loaded.name(), loaded.kind.fields());
        Ok(SceneReport { file, kind: "scene", space, objects, meshes, joints_beyond_limits })
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
        problems: report.problems(),
    }
}

impl Task for InspectLog<'_> {
    type Answer = LogReport;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<LogReport, CliError> {
        let log = self.0;
        let registry = Registry::<N, D, Label>::new();
        let replay = Replay::<N, D, Label>::open(log.bytes.as_slice(), &registry)
            .map_err(in_file(&log.path))?;
        Ok(LogReport {
            file: log.name(),
            kind: "recording",
            space: log.kind.fields(),
            version: log.header.version,
            writer: log.header.writer.clone(),
            steps: replay.len(),
        })
    }
}

impl Report for SceneReport {
    fn text(&self) -> String {
        let mut text = String::new();
        let Self { file, space, objects, .. } = self;
        let count = objects.len();
        let _ = writeln!(text, "{NAME}{file}{NAME:#} {FAINT}({space}){FAINT:#}: {count} objects");
        for ObjectFields { name, shape, low, high } in objects {
            let (low, high) = (tuple(low), tuple(high));
            let _ = writeln!(
                text,
                "  {NAME}{name}{NAME:#} {shape} {FAINT}from{FAINT:#} {low} {FAINT}to{FAINT:#} {high}"
            );
        }
        self.meshes.iter().for_each(|mesh| mesh.write(&mut text));
        for joint in &self.joints_beyond_limits {
            let _ = writeln!(text, "{joint}");
        }
        text
    }

    fn outcome(&self) -> Outcome {
        self.meshes.iter().any(|mesh| !mesh.problems.is_empty()).into()
    }
}

impl MeshFields {
    fn write(&self, text: &mut String) {
        let Self { file, name, vertices, triangles, pieces, boundary_edges, .. } = self;
        let _ = write!(
            text,
            "{NAME}{file}{NAME:#} part {NAME}{name}{NAME:#}: {vertices} vertices, {triangles} triangles, \
             {pieces} pieces, "
        );
        let _ = match (self.volume, self.closed) {
            (Some(volume), _) => writeln!(text, "closed, volume {}", significant(volume)),
            (None, true) => writeln!(text, "closed, without a volume"),
            (None, false) => writeln!(text, "open, {boundary_edges} boundary edges"),
        };
        for problem in &self.problems {
            let _ = writeln!(text, "  {TOUCHES}{problem}{TOUCHES:#}");
        }
    }
}

impl Report for LogReport {
    fn text(&self) -> String {
        let Self { file, space, version, writer, steps, .. } = self;
        format!(
            "{NAME}{file}{NAME:#} {FAINT}({space}){FAINT:#}: a recording of version {version} by {writer}, \
             {steps} steps\n"
        )
    }

    fn outcome(&self) -> Outcome {
        Outcome::Clear
    }
}
