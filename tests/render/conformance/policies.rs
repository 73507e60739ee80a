//! The rows of the intensity policies that act on the finished picture, by what is in it.

use super::Row;
use super::features::still_life;
use crate::render::compare::BLENDED;
use crate::render::scene::{Lamp, Scene, Thing, glowing, point_light};
use halfway::prelude::*;

/// Brighter than 1 in places, and each channel by another amount.
fn bright() -> Scene {
    still_life().lit(Lamp::point(PointLight::new(LinearRgba::rgb(9.0, 4.0, 2.0)), Vec3::new(1.2, 1.6, 1.8)))
}

/// Panes before it, one of which is bright itself.
fn bright_and_blended() -> Scene {
    let mut scene = bright();
    scene.things.push(Thing::square(Vec3::new(0.2, 0.2, 1.2), Vec3::Z, 0.9).blended(0.5));
    let pane = Thing::square(Vec3::new(-0.3, 0.1, 1.4), Vec3::Z, 0.6).with_material(glowing(2.0, 3.0, 0.5));
    scene.things.push(pane.blended(0.4));
    scene
}

/// Nothing exceeds 1.
fn dim() -> Scene {
    still_life().lit(Lamp::point(point_light(), Vec3::new(1.2, 1.6, 1.8)))
}

/// Only the background does.
fn bright_background() -> Scene {
    let mut scene = dim();
    scene.camera.background = LinearRgba::rgb(0.5, 3.0, 1.5);
    scene
}

pub(crate) const POLICIES: [(&str, Intensity); 5] = [
    ("renormalised", Intensity::Renormalize { smoothing: 0.0 }),
    ("renormalised smoothly", Intensity::Renormalize { smoothing: 0.75 }),
    ("reinhard", Intensity::Reinhard { white: Intensity::WHITE }),
    ("reinhard with a white point of 1.5", Intensity::Reinhard { white: 1.5 }),
    ("aces", Intensity::Aces),
];

pub(super) fn rows(samples: Samples) -> Vec<Row> {
    let scenes: [(&str, fn() -> Scene); 4] = [
        ("bright", bright),
        ("bright and blended", bright_and_blended),
        ("dim", dim),
        ("a bright background", bright_background),
    ];
    let mut rows = Vec::new();
    for (name, scene) in scenes {
        // Smoothing follows a picture whose divisor is the same as its own.
        for (policy, intensity) in POLICIES {
            let mut scene = scene();
            (scene.camera.intensity, scene.camera.samples) = (intensity, samples);
            if samples == Samples::Four {
                // Adapters differ in where they shade a pixel that is covered in part; a facet has one color.
                scene.view_shading = Some(Shading::Flat);
            }
            let row = Row::new(format!("{policy}, {name}, {samples:?}"), scene);
            // Pictures with four samples are judged by their possible colours.
            rows.push(Row { raw: if samples == Samples::Four { BLENDED } else { row.raw }, ..row });
        }
    }
    rows
}
