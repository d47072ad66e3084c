//! A picture of events along a time line.

use super::{CLAY, GOLD, GRAY, INK, RED, SLATE, VIOLET, WIDTH, check_svg, note, options};
use impinge::debug_render::{Color, DebugDrawing, DebugRender, Drawn, Style};
use impinge::dim2::prelude::*;
use impinge_view::SvgPicture;

/// The world of the program in the guide: a ball moves through a sensor into a wall.
struct Course {
    world: CollisionWorld<f64, Color>,
    ball: CollisionObjectHandle,
}

impl Course {
    fn new() -> Self {
        let mut world = CollisionWorld::new(0.02);
        let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
        let ball = ShapeHandle::new(Ball::new(0.5));
        let ball = world.add(Isometry::translation(-5.0, 0.0), ball, everybody, contacts, SLATE);
        let zone = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0)));
        world.add(Isometry::identity(), zone, everybody, ProximityQuery::default(), GOLD);
        let wall = ShapeHandle::new(Cuboid::new(Vector::new(0.5, 1.2)));
        world.add(Isometry::translation(5.0, 0.0), wall, everybody, contacts, CLAY);
        Self { world, ball }
    }

    /// Moves the ball to `x` and updates the world. Returns a text and a colour for each event.
    fn step(&mut self, x: f64) -> Vec<(String, Color)> {
        self.world.set_position(self.ball, Isometry::translation(x, 0.0));
        self.world.update();
        let status = |event: &ProximityEvent| (format!("{:?}", event.new_status), VIOLET);
        let contact = |event: &ContactEvent| match event {
            ContactEvent::Started(..) => ("Started".to_owned(), RED),
            ContactEvent::Stopped(..) => ("Stopped".to_owned(), RED),
        };
        let proximities = self.world.proximity_events().iter().map(status);
        proximities.chain(self.world.contact_events().iter().map(contact)).collect()
    }
}

#[test]
fn time_line() {
    let mut course = Course::new();
    let mut options = options::<f64>();
    options.contact_normal = None;
    let colors: Vec<_> =
        course.world.collision_objects().map(|o| (o.handle(), *o.data())).collect();
    let color_of = move |handle| colors.iter().find(|(own, _)| *own == handle).map(|(_, c)| *c);
    let mut drawing = DebugDrawing::new(options).with_object_color(color_of);
    let mut picture = SvgPicture::plane(WIDTH).without_legend().with_title(
        "Events along a time line",
        "A ball moves to the right by one unit a step, through a sensor and into a wall. The events of each update are below its position.",
    );
    let base = -2.1;
    picture.line([Point::new(-5.5, base), Point::new(7.0, base)], GRAY, Drawn::Query);
    note(&mut picture, [-6.2, base - 0.65], "step");
    let trail = Style { color: GRAY.with_alpha(90), size: 0.1 };
    options.object = Some(trail);
    let ball = course.world.collision_object(course.ball).expect("not removed").shape().clone();
    let mut log = Vec::new();
    for step in 0..=11_u8 {
        // The ball moves into the wall, and at the last step out of it.
        let x = if step == 11 { 3.0 } else { f64::from(step) - 5.0 };
        let mark = f64::from(step) - 5.0;
        let events = course.step(x);
        if step < 11 {
            DebugDrawing::new(options).shape(&ball, &Isometry::translation(x, 0.0), &mut picture);
        }
        picture.line(
            [Point::new(mark, base - 0.1), Point::new(mark, base + 0.1)],
            GRAY,
            Drawn::Query,
        );
        note(&mut picture, [mark - 0.2, base - 0.65], &step.to_string());
        for (name, color) in events {
            let at = Point::new(mark, base);
            picture.point(&at, 0.2, color, Drawn::QueryHit);
            picture.text(&at, &name, color, Drawn::QueryHit);
            log.push((step, name));
        }
    }
    drawing.world(&course.world, &mut picture);
    note(&mut picture, [2.5, 0.5], "at step 11");
    note(&mut picture, [-0.9, 1.0], "a sensor");
    note(&mut picture, [4.6, 1.2], "a wall");
    let expected = [(4, "Intersecting"), (7, "Disjoint"), (9, "Started"), (11, "Stopped")];
    assert_eq!(log, expected.map(|(step, name)| (step, name.to_owned())));
    picture.text(&Point::new(-5.4, 0.5), "a ball", INK, Drawn::Object);
    check_svg("events", &picture);
}
