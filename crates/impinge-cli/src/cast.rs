//! `impinge cast`: what a moving shape or object hits first.

use impinge::math::{Pose, Vector};
use impinge::query::ImpactOptions;
use impinge::shape::{Ball, Capsule, Cuboid, ShapeHandle};
use impinge::world::{CollisionWorld, QueryFilter};

use crate::args::{CastArgs, ShapeKind, ShapeSpec};
use crate::convert::{scalar, vector};
use crate::error::CliError;
use crate::hits::{CastHit, Hits};
use crate::number::{Number, significant};
use crate::output::{Outcome, finish};
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &CastArgs) -> Result<Outcome, CliError> {
    let loaded = Loaded::read(&args.scene)?;
    finish(&run_in(loaded.kind, Cast { loaded: &loaded, args })?, args.format)
}

/// Casts a shape into a scene.
struct Cast<'a> {
    loaded: &'a Loaded,
    args: &'a CastArgs,
}

/// A shape at the start of its way, and what it may hit.
struct Sweep<N: Stage<D>, const D: usize> {
    shape: ShapeHandle<N, D>,
    start: N::Isometry,
    way: Vector<N, D>,
    filter: QueryFilter<'static, N, D, String>,
}

impl Task for Cast<'_> {
    type Answer = Hits<CastHit>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Hits<CastHit>, CliError> {
        let Cast { loaded, args } = self;
        let mut world = loaded.world::<N, D>()?;
        world.update();
        let sweep = self.sweep(&world)?;
        let Sweep { shape, start, way, filter } = &sweep;
        let options = ImpactOptions::new()
            .with_max_time(N::ONE)
            .with_target_distance(scalar("--distance", args.distance.0)?);
        let mut found = world.cast_shape_all(start, way, &**shape, &options, filter);
        found.truncate(if args.all { usize::MAX } else { 1 });
        let (origin, length) = (N::translation(start), way.norm());
        let hits = found.into_iter().map(|(object, impact)| CastHit {
            object: object.data().clone(),
            time: Number::new(impact.toi),
            moved: Number::new(impact.toi * length),
            position: Number::of_vector(&(origin + way * impact.toi)),
            point: Number::of_point(&impact.world1),
            normal: Number::of_vector(&impact.normal),
            part: impact.part2,
        });
        Ok(Hits { file: loaded.name(), kind: loaded.kind.fields(), hits: hits.collect() })
    }
}

impl Cast<'_> {
    /// The shape of the arguments, or the object that they name, which hits what it interacts with.
    fn sweep<N: Stage<D>, const D: usize>(
        &self,
        world: &CollisionWorld<N, D, String>,
    ) -> Result<Sweep<N, D>, CliError> {
        let args = self.args;
        if let (Some(name), Some(by)) = (&args.object, &args.by) {
            let object = self.loaded.object(world, name)?;
            let filter = QueryFilter::new().exclude(object.handle());
            return Ok(Sweep {
                shape: object.shape().clone(),
                start: *object.position(),
                way: vector("--by", by)?,
                filter: filter.groups(*object.collision_groups()),
            });
        }
        let (Some(spec), Some(from), Some(to)) = (&args.shape, &args.from, &args.to) else {
            return Err(CliError::argument("--shape", "", "needs --from and --to"));
        };
        let start = vector::<N, D>("--from", from)?;
        Ok(Sweep {
            shape: self.shape(spec)?,
            start: N::isometry(&Pose::from_translation(start)),
            way: vector::<N, D>("--to", to)? - start,
            filter: QueryFilter::new(),
        })
    }
    /// The shape of a few characters, of the scene, or in JSON.
    fn shape<N: Stage<D>, const D: usize>(
        &self,
        spec: &ShapeSpec,
    ) -> Result<ShapeHandle<N, D>, CliError> {
        match spec {
            ShapeSpec::Sizes { kind, sizes } => sized(*kind, sizes),
            ShapeSpec::Scene(text) => Ok(self.loaded.scene().shape(text)?),
        }
    }
}

/// The shape of a kind with its sizes.
fn sized<N: Stage<D>, const D: usize>(
    kind: ShapeKind,
    sizes: &[f64],
) -> Result<ShapeHandle<N, D>, CliError> {
    let converted = sizes.iter().map(|size| scalar::<N>("--shape", *size));
    let converted = converted.collect::<Result<Vec<_>, _>>()?;
    let refused = |reason: String| {
        let text = sizes.iter().copied().map(significant).collect::<Vec<_>>().join(",");
        CliError::argument("--shape", format!("{}:{text}", kind.name()), reason)
    };
    let made = match (kind, converted.as_slice()) {
        (ShapeKind::Ball, &[radius]) => Ball::try_new(radius).map(ShapeHandle::new),
        (ShapeKind::Cuboid, extents) if extents.len() == D => {
            Cuboid::try_new(Vector::<N, D>::from_column_slice(extents)).map(ShapeHandle::new)
        }
        (ShapeKind::Capsule, &[half_height, radius]) => {
            Capsule::try_new(half_height, radius).map(ShapeHandle::new)
        }
        (ShapeKind::Ball, _) => return Err(refused("a ball has a radius".into())),
        (ShapeKind::Cuboid, _) => return Err(refused(format!("a box has {D} half extents"))),
        (ShapeKind::Capsule, _) => {
            return Err(refused("a capsule has half a height and a radius".into()));
        }
    };
    made.map_err(|error| refused(error.to_string()))
}
