//! Highlights between vertices.

use halfway::prelude::*;
use halfway::reference::Image;

use super::plots::{names, series, shown};
use super::stage::{camera, four, show, sun};
use super::{FailurePage, only};
use crate::figure::{Axis, AxisScale, Figure, Panel};
use crate::measure::MeasureError;

/// What is charted over.
const SHININESS: [f32; 7] = [1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];
/// Bands of the spheres.
const LEVELS: [u32; 3] = [8, 16, 32];

/// The highlight of a sphere of N bands, under flat, Gouraud and Phong shading, and of the true sphere; it lies in the
/// middle of a cell.
fn pictures(level: u32, shininess: f32) -> Result<[Image; 4], MeasureError> {
    four(|world, shading| {
        camera(world, Vec3::new(0.0, 0.0, 2.9), Vec3::Y);
        // Halfway between two meridians and two parallels, whatever the level: towards the viewer, and by half a cell
        // off.
        let cell = std::f32::consts::PI / level as f32;
        let normal = Quat::from_rotation_y(0.5 * cell) * Quat::from_rotation_x(-0.5 * cell) * Vec3::Z;
        sun(world, 2.0 * normal.dot(Vec3::Z) * normal - Vec3::Z);
        let shine = Material { specular: LinearRgba::WHITE, shininess, ..Material::matte(LinearRgba::BLACK) };
        show(world, UvSphere::new(1.0, 2 * level, level), shine, shading);
    })
}

/// The light of each in all, as a part of the true sphere's.
fn energies(level: u32, shininess: f32) -> Result<[f64; 3], MeasureError> {
    let [flat, gouraud, phong, truth] =
        pictures(level, shininess)?.map(|image| image.pixels().iter().flatten().sum::<f64>());
    Ok([flat, gouraud, phong].map(|energy| energy / truth))
}

pub(super) fn page() -> Result<FailurePage, MeasureError> {
    let mut panels = Vec::new();
    for level in LEVELS {
        let found = SHININESS.map(|shininess| Ok((f64::from(shininess), energies(level, shininess)?)));
        let found = found.into_iter().collect::<Result<Vec<_>, MeasureError>>()?;
        let line = |kind: usize| {
            let points: Vec<_> = found.iter().map(|(shininess, energies)| (*shininess, energies[kind])).collect();
            series(names()[kind], kind, &points, true)
        };
        panels.push(Panel {
            title: format!("{} meridians", 2 * level),
            x_label: None,
            notes: Vec::new(),
            series: [0, 1, 2].map(line).into(),
        });
    }
    let [flat, gouraud, phong, truth] = &pictures(8, 100.0)?;
    Ok(FailurePage {
        id: "highlight",
        title: "Highlights between vertices are lost",
        cause: "Gouraud shading evaluates the highlight at vertices only: one that lies between them, and is smaller \
                than a cell, is not met at all. One that meets a vertex is spread over the cells around it, so that a moving one flickers.",
        remedy: "Shade highlights at pixels (Phong, or diffuse at vertices and specular at pixels), or use cells that are \
                 smaller than the highlight.",
        test: "sharp_highlights_between_vertices_are_lost",
        figures: only(Figure {
            id: "failure-highlight".to_owned(),
            title: "Light of a highlight in the middle of a cell, the true sphere’s being 1".to_owned(),
            x: Axis::new("shininess", AxisScale::Log),
            y: Axis::new("light (true = 1)", AxisScale::Linear),
            columns: 3,
            panels,
        }),
        pictures: shown([
            ("flat, 16 meridians, shininess 100", flat),
            ("Gouraud", gouraud),
            ("Phong", phong),
            ("true sphere", truth),
        ]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sharp_highlights_between_vertices_are_lost() {
        let [_, gouraud, phong] = energies(8, 300.0).unwrap();
        // Half a cell of 22.5° off, n·h is cos 11.25° at most: to the 300th, 0.003.
        assert!(gouraud < 0.1 && (phong - 1.0).abs() < 0.2, "{gouraud}, {phong}");
        let [_, gouraud, _] = energies(32, 3.0).unwrap();
        assert!((gouraud - 1.0).abs() < 0.02, "cells smaller than the highlight: {gouraud}");
    }
}
