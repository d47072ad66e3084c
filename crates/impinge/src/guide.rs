//! The user guide: the features of the library and how to use them, chapter by chapter.
//!
//! The chapters are in reading order. Their code blocks are compiled and run as tests.
//!
//! 1. [`introduction`]: two objects in a world, and the contact between them.
//! 2. [`pipeline`]: how a world works, step by step, and its two phases alone.
//! 3. [`shapes`]: the shapes, their parameters, and how objects share them.
//! 4. [`composites`]: compounds, meshes, terrain, deforming shapes.
//! 5. [`own_shapes`]: shapes that you implement.
//! 6. [`contacts`]: contact points and manifolds, from step to step.
//! 7. [`groups`]: which pairs a world considers.
//! 8. [`events`]: contacts and proximities that began or ended.
//! 9. [`queries`]: rays, casts, points and distances, with or without a world.
//! 10. [`batches`]: one query for many placed shapes.
//! 11. `drawing`: debug drawing of shapes, contacts and queries, with the feature `debug_render`.
//! 12. [`performance`]: the cost of a step, and how to reduce it.
//! 13. [`guarantees`]: the guarantees and their precision.
//!
//! [`coming_from`] translates programs that use ncollide, parry, rapier or Box2D.
//!
//! This module exists only in the documentation: a program has no `impinge::guide`.

/// The data URI of an SVG image with one line of text, which refers the reader to the book.
macro_rules! in_the_book {
    () => {
        "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' width='440' height='28'%3E%3Crect width='440' \
         height='28' rx='4' fill='%23e8e6e0'/%3E%3Ctext x='12' y='19' font-family='sans-serif' font-size='14' \
         fill='%2330363f'%3EThis picture is in the book of the guide, in the repository.%3C/text%3E%3C/svg%3E"
    };
}

/// Declares a chapter. Links in the chapter's Markdown refer to files of the guide. The first
/// definition of a link name takes precedence, so the definitions here redirect them to modules.
/// SVG pictures are embedded as data URIs. PNG pictures are not in the package, and `in_the_book!`
/// replaces them.
macro_rules! chapter {
    ($name:ident, $file:literal $(, $picture:literal)*) => {
        #[doc = "[batches]: self::batches"]
        #[doc = "[composites]: self::composites"]
        #[doc = "[composites#shapes-that-touch-themselves]: self::composites#shapes-that-touch-themselves"]
        #[doc = "[composites#solid-meshes-and-lines]: self::composites#solid-meshes-and-lines"]
        #[doc = "[composites#surfaces-have-no-inner-edges]: self::composites#surfaces-have-no-inner-edges"]
        #[doc = "[composites#two-sides-or-one]: self::composites#two-sides-or-one"]
        #[doc = "[composites#what-closed-surfaces-enclose]: self::composites#what-closed-surfaces-enclose"]
        #[doc = "[contacts]: self::contacts"]
        #[doc = "[contacts#substeps]: self::contacts#substeps"]
        #[doc = "[events]: self::events"]
        #[doc = "[guarantees]: self::guarantees"]
        #[doc = "[own-shapes]: self::own_shapes"]
        #[doc = "[performance]: self::performance"]
        #[doc = "[pipeline#fast-bodies]: self::pipeline#fast-bodies"]
        #[doc = "[queries]: self::queries"]
        #[doc = "[queries#about-two-shapes-that-move]: self::queries#about-two-shapes-that-move"]
        $(#[doc = concat!(
            "[", $picture, ".svg]: <", include_str!(concat!("../guide/pictures/", $picture, ".uri")), ">"
        )])*
        #[doc = concat!("[manifold3.png]: <", in_the_book!(), ">")]
        #[doc = concat!("[pile.png]: <", in_the_book!(), ">")]
        #[doc = concat!("[shapes3.png]: <", in_the_book!(), ">")]
        #[doc = concat!("[terrain.png]: <", in_the_book!(), ">")]
        #[doc = ""]
        #[doc = include_str!(concat!("../guide/", $file))]
        pub mod $name {}
    };
}

chapter!(introduction, "introduction.md");
chapter!(pipeline, "pipeline.md", "broad-phase");
chapter!(shapes, "shapes.md", "shapes2");
chapter!(composites, "composites.md", "internal-edges", "sides");
chapter!(own_shapes, "own-shapes.md", "lens");
chapter!(contacts, "contacts.md", "contacts2");
chapter!(groups, "groups.md", "groups");
chapter!(events, "events.md", "events");
chapter!(queries, "queries.md", "rays", "shape-cast", "starts", "nearest");
chapter!(batches, "batches.md");
#[cfg(feature = "debug_render")]
chapter!(drawing, "drawing.md");
chapter!(performance, "performance.md", "tree");
chapter!(guarantees, "guarantees.md");
chapter!(coming_from, "coming-from.md");

/// The README of the crate, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
