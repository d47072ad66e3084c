//! Tests which pixels texts and legends cover.

use crate::scenes::{INK, RED, box_mesh, plane};
use impinge::debug_render::{Color, DebugRender, Drawn};
use impinge::dim2;
use impinge::dim3::math::{Isometry, Point};
use impinge_view::{Camera, Image, PngPicture, SvgPicture};

const BLACK: Color = Color::rgb(0, 0, 0);

/// Returns an empty picture of the square from -1 to 1.
fn framed(size: [u32; 2]) -> PngPicture {
    let corners = [Point::new(-1.0, -1.0, 0.0), Point::new(1.0, 1.0, 0.0)];
    PngPicture::new(Camera::plane().fit(corners), size).with_margin(0.0)
}

/// Returns the smallest and the largest column and row of the pixels that differ from the pixel at
/// the upper left; `None` if all are equal.
fn extent(image: &Image) -> Option<[[u32; 2]; 2]> {
    let [width, height] = image.size();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let mut drawn = pixels.filter(|[x, y]| image.pixel(*x, *y) != image.pixel(0, 0));
    let first = drawn.next()?;
    Some(drawn.fold([first, first], |[low, high], at| {
        [[0, 1].map(|axis| low[axis].min(at[axis])), [0, 1].map(|axis| high[axis].max(at[axis]))]
    }))
}

fn text_at(x: f64, y: f64, text: &str) -> Image {
    let mut picture = framed([100, 100]);
    picture.text(&Point::new(x, y, 0.0), text, BLACK, Drawn::Query);
    picture.to_image()
}

#[test]
fn a_text_is_to_the_upper_right_of_its_point() {
    // The point is at (50, 50). The frame of the four characters begins 5 pixels to the right of it
    // and ends 5 pixels above it.
    let [low, high] = extent(&text_at(0.0, 0.0, "Mlgp")).expect("black on near white");
    assert!(low[0] >= 55 && high[0] < 55 + 28, "four characters, 7 wide each: {low:?} {high:?}");
    assert!(low[1] >= 50 - 5 - 16 && high[1] < 45, "16 high: {low:?} {high:?}");
    assert!(high[0] - low[0] >= 24 && high[1] - low[1] >= 10, "all of them: {low:?} {high:?}");
}

#[test]
fn a_text_at_the_side_is_inside_the_picture() {
    let middle = extent(&text_at(0.0, 0.0, "Mlgp")).expect("drawn");
    let size = [0, 1].map(|axis| middle[1][axis] - middle[0][axis]);
    for [x, y] in [[0.98, 0.0], [0.98, 0.98], [-0.98, 0.98], [0.98, -0.98]] {
        let [low, high] = extent(&text_at(x, y, "Mlgp")).expect("drawn");
        let own = [0, 1].map(|axis| high[axis] - low[axis]);
        assert_eq!(own, size, "all of it, beside {x}, {y}");
    }
}

#[test]
fn texts_of_one_point_do_not_cover_each_other() {
    let count = |image: &Image| image.pixels().iter().filter(|pixel| pixel[0] < 128).count();
    let mut picture = framed([200, 100]);
    let mut alone = 0;
    for text in ["one", "two", "three", "four"] {
        picture.text(&Point::<f32>::origin(), text, BLACK, Drawn::Query);
        let mut single = framed([200, 100]);
        single.text(&Point::<f32>::origin(), text, BLACK, Drawn::Query);
        alone += count(&single.to_image());
    }
    assert_eq!(count(&picture.to_image()), alone, "as many dark pixels as each on its own");
    assert!(alone > 150, "which are some: {alone}");
    assert_eq!(count(&picture.clone().without_texts().to_image()), 0, "unless there are none");
}

#[test]
fn texts_without_a_place_are_left_out() {
    let mut picture = framed([60, 60]);
    let blank = picture.to_image();
    for x in [f32::NAN, f32::INFINITY, 1e30] {
        picture.text(&Point::new(x, 0.0, 0.0), "nowhere", BLACK, Drawn::Query);
    }
    assert_eq!(picture.left_out(), 3, "counted");
    picture.text(&Point::new(5.0_f32, 0.0, 0.0), "outside", BLACK, Drawn::Query);
    assert_eq!((picture.left_out(), picture.to_image()), (3, blank), "not drawn");
}

#[test]
fn a_legend_has_the_colours_of_the_layers() {
    let mut picture = framed([300, 120]);
    let mesh = box_mesh::<f64>(1, [0.5; 3]);
    picture.mesh(&mesh, &Isometry::identity(), INK, Drawn::Object);
    picture.line([Point::new(-1.0, 0.0, 1.0), Point::new(1.0, 0.0, 1.0)], RED, Drawn::Query);
    let without = picture.to_image();
    let image = picture.clone().with_legend().to_image();
    assert_eq!(image.size(), [300, 120], "within the picture");
    // The line of a legend row is 20 pixels above the lower side. The second entry begins after a
    // line, 7 letters and the gaps.
    let is = |color: Color, x| image.pixel(x, 100)[..3] == color.rgb;
    assert!(is(INK, 16) && is(INK, 31) && !is(INK, 32), "16 pixels of the colour of objects");
    assert!(is(RED, 16 + 85) && !is(RED, 16 + 84), "and of queries");
    let names =
        |image: &Image| (38..87).filter(|x| (92..108).any(|y| image.pixel(*x, y)[0] < 100)).count();
    assert!(names(&image) > 25 && names(&without) == 0, "the name of the first");
    let [low, high] = extent(&without).expect("drawn");
    assert!(high[1] - low[1] > 60, "the drawing is higher without it");
}

#[test]
fn a_picture_too_low_has_no_legend() {
    let mut picture = framed([300, 40]);
    picture.line([Point::new(-1.0, 0.0, 1.0), Point::new(1.0, 0.0, 1.0)], RED, Drawn::Query);
    assert_eq!(picture.to_image(), picture.clone().with_legend().to_image());
}

#[test]
fn texts_of_svg_are_inside_their_page() {
    let mut picture = SvgPicture::plane(300);
    plane::<f64>(&mut picture);
    for x in [-4.0, 0.0, 4.0] {
        for y in [-0.5, 2.6] {
            let at = dim2::math::Point::new(x, y);
            picture.text(&at, "a text of some length", INK, Drawn::Query);
        }
    }
    let svg = picture.to_svg();
    let document = roxmltree::Document::parse(&svg).expect("well-formed");
    let number = |node: &roxmltree::Node<'_, '_>, name: &str| {
        node.attribute(name).and_then(|value| value.parse::<f64>().ok()).expect("a number")
    };
    let scene = document.descendants().find(|node| node.attribute("class") == Some("scene"));
    let scene = scene.expect("a drawing");
    let texts: Vec<_> = scene.descendants().filter(|node| node.has_tag_name("text")).collect();
    assert_eq!(texts.len(), 7, "with that of the scene");
    for text in texts {
        let (x, y) = (number(&text, "x"), number(&text, "y"));
        let length = text.text().map_or(0, str::len) as f64;
        assert!(x >= 0.0 && x + 6.0 * length <= 300.0, "{x} of {text:?}");
        assert!(y >= 10.0 && y <= number(&scene, "height"), "{y} of {text:?}");
    }
}
