//! `impinge ray`: what a ray hits.

use impinge::math::Point;
use impinge::query::Ray;
use impinge::world::QueryFilter;

use crate::args::RayArgs;
use crate::convert::vector;
use crate::error::CliError;
use crate::hits::{Hits, RayHit};
use crate::number::Number;
use crate::output::{Outcome, finish};
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &RayArgs) -> Result<Outcome, CliError> {
    let loaded = Loaded::read(&args.scene)?;
    finish(&run_in(loaded.kind, Cast { loaded: &loaded, args })?, args.format)
}

/// Casts a ray into a scene.
struct Cast<'a> {
    loaded: &'a Loaded,
    args: &'a RayArgs,
}

impl Task for Cast<'_> {
    type Answer = Hits<RayHit>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Hits<RayHit>, CliError> {
        let Cast { loaded, args } = self;
        let origin = Point::from(vector::<N, D>("--from", &args.from)?);
        let ray = match (&args.to, &args.direction) {
            (Some(to), _) => Ray::new(origin, vector::<N, D>("--to", to)? - origin.coords),
            (None, Some(direction)) => Ray::new(origin, vector::<N, D>("--direction", direction)?),
            (None, None) => Ray::new(origin, impinge::math::Vector::<N, D>::zeros()),
        };
        let max_time = if args.to.is_some() { N::ONE } else { N::INFINITY };
        let mut world = loaded.world::<N, D>()?;
        world.update();
        let mut found = world.ray_hits(&ray, max_time, !args.hollow, &QueryFilter::new());
        found.truncate(if args.all { usize::MAX } else { 1 });
        let speed = ray.dir.norm();
        let hits = found.into_iter().map(|(object, hit)| RayHit {
            object: object.data().clone(),
            time: Number::new(hit.toi),
            length: Number::new(hit.toi * speed),
            point: Number::of_point(&ray.point_at(hit.toi)),
            normal: Number::of_vector(&hit.normal),
            part: hit.part,
        });
        Ok(Hits { file: loaded.name(), kind: loaded.kind.fields(), hits: hits.collect() })
    }
}
