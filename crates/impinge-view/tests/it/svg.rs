//! Parses SVG documents and checks their content.

use crate::scenes::{INK, ball_mesh, box_mesh, boxes, hills, plane};
use impinge::debug_render::{DebugRender, Drawn, ShapeMesh};
use impinge::dim2::math::Point as Point2;
use impinge::dim3::math::{Isometry, Vector};
use impinge::math::Real;
use impinge_view::{Camera, SvgPicture};
use roxmltree::{Document, Node};

fn oblique() -> Camera {
    Camera::look_along(&Vector::new(-0.6, -0.5, -1.0), &Vector::y())
}

fn classes(document: &Document<'_>) -> Vec<String> {
    let groups = document.descendants().filter(|node| node.has_tag_name("g"));
    groups.filter_map(|group| group.attribute("class").map(str::to_owned)).collect()
}

/// Returns all coordinates of an SVG path element, x and y in turn.
fn numbers(path: &Node<'_, '_>) -> Vec<f64> {
    let data = path.attribute("d").unwrap_or_default();
    let words = data.split(['M', 'L', 'Z', ' ']).filter(|word| !word.is_empty());
    words.map(|word| word.parse().expect("a number")).collect()
}

fn text_of(document: &Document<'_>, tag: &str) -> String {
    let child = document.root_element().children().find(|node| node.has_tag_name(tag));
    child.and_then(|node| node.text()).unwrap_or_default().to_owned()
}

fn plane_document<N: Real>() {
    let mut picture = SvgPicture::plane(400).with_title("2D & more", "");
    plane::<N>(&mut picture);
    let svg = picture.to_svg();
    let document = Document::parse(&svg).expect("well-formed");
    let layers = ["object", "tight-box", "contact-point", "contact-normal", "query", "query-hit"];
    assert_eq!(classes(&document)[..6], layers, "in the order of Drawn");
    assert_eq!(classes(&document)[6..], ["legend"], "and the legend");
    assert_eq!(text_of(&document, "title"), "2D & more", "unescaped again");
    assert!(text_of(&document, "desc").starts_with("It shows objects, tight boxes, "), "{svg}");
    let labels: Vec<_> = document.descendants().filter(|n| n.has_tag_name("text")).collect();
    assert_eq!(labels[0].text(), Some("hit < 1 & free"), "a text of the scene");
    assert_eq!(labels.len(), 1 + layers.len(), "and those of the legend");
    assert!(!svg.contains("hidden\" d"), "nothing is hidden in 2D");
}

#[test]
fn a_2d_scene_has_its_layers() {
    plane_document::<f32>();
    plane_document::<f64>();
}

#[test]
fn a_2d_scene_is_to_scale_with_y_upwards() {
    let mut picture = SvgPicture::plane(232);
    let ends = [Point2::new(-1.0_f32, 0.0), Point2::new(3.0, 2.0)];
    picture.line(ends, INK, Drawn::Object);
    let svg = picture.to_svg();
    let document = Document::parse(&svg).expect("well-formed");
    let path = document.descendants().find(|node| node.has_tag_name("path")).expect("a line");
    assert_eq!(numbers(&path), [16.0, 116.0, 216.0, 16.0], "50 pixels for 1, from the lower left");
}

#[test]
fn hidden_lines_of_a_box_are_the_three_behind() {
    let mut picture = SvgPicture::space(oblique(), 300);
    picture.mesh(&box_mesh::<f32>(1, [0.5; 3]), &Isometry::identity(), INK, Drawn::Object);
    let svg = picture.to_svg();
    let document = Document::parse(&svg).expect("well-formed");
    let object = document.descendants().find(|node| node.attribute("class") == Some("object"));
    let paths = object.expect("a group").children().filter(|node| node.has_tag_name("path"));
    let (mut hidden, mut seen) = (0, 0);
    for path in paths {
        let is_hidden = path.attribute("class").is_some_and(|class| class.ends_with(" hidden"));
        let lines = path.attribute("d").unwrap_or_default().matches('L').count();
        *if is_hidden { &mut hidden } else { &mut seen } += lines;
    }
    assert!(hidden >= 3 && seen >= 9, "of the twelve edges, {hidden} and {seen}");
    assert_eq!(hidden, 3, "those that meet at the farthest corner");
}

/// Draws a ball without lines. The picture is the silhouette of the ball, which has an edge for
/// each step around and is not hidden by the ball.
#[test]
fn the_outline_of_a_ball_is_not_hidden_by_the_ball() {
    for direction in [[0.0, 0.0, -1.0], [-0.6, -0.5, -1.0], [0.3, -1.0, 0.2]] {
        let camera = Camera::look_along(&Vector::from(direction), &Vector::y());
        let mut picture = SvgPicture::space(camera, 300);
        let ball = ShapeMesh { lines: Vec::new(), ..ball_mesh::<f32>(1, 1.0) };
        picture.mesh(&ball, &Isometry::identity(), INK, Drawn::Object);
        let svg = picture.to_svg();
        let document = Document::parse(&svg).expect("well-formed");
        let lines = document.descendants().filter(|node| node.has_tag_name("path"));
        let count = lines.map(|path| path.attribute("d").map_or(0, |d| d.matches('L').count()));
        assert!(count.sum::<usize>() > 48, "an edge for each step around, and the legend");
        assert!(!svg.contains(" hidden\""), "no part is hidden");
    }
}

#[test]
fn every_scene_is_well_formed_and_inside_its_page() {
    let draws: [fn(&mut SvgPicture); 2] = [boxes::<f32>, hills::<f64>];
    for draw in draws {
        for camera in [oblique(), oblique().perspective(0.8)] {
            let mut picture = SvgPicture::space(camera, 300);
            draw(&mut picture);
            let svg = picture.to_svg();
            let document = Document::parse(&svg).expect("well-formed");
            let scene = document.descendants().find(|n| n.attribute("class") == Some("scene"));
            let paths = scene.expect("a drawing").descendants().filter(|n| n.has_tag_name("path"));
            let numbers: Vec<_> = paths.flat_map(|path| numbers(&path)).collect();
            assert!(numbers.len() > 100, "many lines");
            assert!(numbers.iter().all(|x| (8.0..=500.0).contains(x)), "inside the page");
            assert!(svg.contains("prefers-color-scheme:dark"), "for dark pages too");
        }
    }
}
