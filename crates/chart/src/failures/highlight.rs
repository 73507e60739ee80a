//! Highlights between vertices.

use super::prelude::*;

/// The exponents of the chart.
const SHININESS: [f32; 7] = [1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];
/// Bands of the spheres.
const LEVELS: [u32; 3] = [8, 16, 32];

/// The highlight of a sphere of N bands, under flat, Gouraud and Phong shading, and of the true sphere; it lies in the
/// middle of a cell.
fn pictures(level: u32, shininess: f32) -> Result<[Image; 4], ChartError> {
    four(SIZE, |world, shading| {
        camera(world, Vec3::new(0.0, 0.0, 2.9), Vec3::Y);
        // Halfway between two meridians and two parallels, whatever the level: towards the viewer, and by half a cell
        // off.
        let cell = std::f32::consts::PI / level as f32;
        let normal = Quat::from_rotation_y(0.5 * cell) * Quat::from_rotation_x(-0.5 * cell) * Vec3::Z;
        sun(world, 2.0 * normal.dot(Vec3::Z) * normal - Vec3::Z);
        show(world, UvSphere::new(1.0, 2 * level, level), shine(shininess), shading);
    })
}

/// The total light of each, relative to the true sphere's.
fn energies(level: u32, shininess: f32) -> Result<[f64; 3], ChartError> {
    let [flat, gouraud, phong, truth] = pictures(level, shininess)?.each_ref().map(light);
    Ok([flat, gouraud, phong].map(|energy| energy / truth))
}

/// The total light of each in every frame while the light moves across a sphere of 16 meridians: along a line that
/// crosses meridians and parallels at an angle, so that the highlight, which stays well inside the outline, meets
/// vertices, edges and faces in turn.
fn moving(frames: u32, size: u32) -> Result<[Vec<f64>; 4], ChartError> {
    let mut energies: [Vec<f64>; 4] = Default::default();
    for frame in 0..frames {
        let t = frame as f32 / frames.saturating_sub(1).max(1) as f32;
        let spawn = |world: &mut World, shading| {
            camera(world, Vec3::new(0.0, 0.0, 2.9), Vec3::Y);
            sun(world, Vec3::new(-1.0, 0.2, 1.0).lerp(Vec3::new(1.0, 0.8, 1.0), t));
            show(world, UvSphere::new(1.0, 16, 8), shine(32.0), shading);
        };
        let pictures = four(UVec2::splat(size), spawn)?;
        energies.iter_mut().zip(&pictures).for_each(|(energies, picture)| energies.push(light(picture)));
    }
    Ok(energies)
}

/// How unsteady a highlight is: the root of the mean over all pairs of frames of δ(t)², where
/// δ(t) = (\[E(t + 1) − E(t)\] − \[E*(t + 1) − E*(t)\]) / mean E*, E the energy that is judged and E* the true one.
fn unsteadiness(energy: &[f64], truth: &[f64]) -> f64 {
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    let changes = energy.windows(2).zip(truth.windows(2));
    let squares: Vec<f64> = changes.map(|(e, t)| (((e[1] - e[0]) - (t[1] - t[0])) / mean).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

fn moving_figure() -> Result<Figure, ChartError> {
    let all = moving(60, 128)?;
    let truth = &all[3];
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    let lines = all.iter().zip(NAMES).enumerate().map(|(kind, (energies, name))| {
        let points = energies.iter().enumerate().map(|(frame, energy)| (frame as f64, energy / mean));
        let name = format!("{name}: {:.2} %", 100.0 * unsteadiness(energies, truth));
        series(&name, kind, &points.collect::<Vec<_>>(), false)
    });
    let figure = figure(
        "highlight-moving",
        "Light of a highlight of shininess 32 while its light moves",
        [Axis::linear("frame"), Axis::linear("light (mean of the true sphere = 1)")],
        Panel::new("16 meridians; RMS change from frame to frame, less the true one", lines.collect()),
    );
    Ok(figure.named("moving"))
}

pub(super) fn page() -> Result<FailurePage, ChartError> {
    let mut panels = Vec::new();
    for level in LEVELS {
        let found = SHININESS.map(|shininess| Ok((f64::from(shininess), energies(level, shininess)?)));
        let found = found.into_iter().collect::<Result<Vec<_>, ChartError>>()?;
        let line = |kind: usize| {
            let points: Vec<_> = found.iter().map(|(shininess, energies)| (*shininess, energies[kind])).collect();
            series(NAMES[kind], kind, &points, true)
        };
        panels.push(Panel::new(format!("{} meridians", 2 * level), [0, 1, 2].map(line).into()));
    }
    let title = "Light of a highlight in the middle of a cell, the true sphere’s being 1";
    let axes = [Axis::log("shininess"), Axis::linear("light (true = 1)")];
    let [flat, gouraud, phong, truth] = &pictures(8, 100.0)?;
    Ok(FailurePage {
        id: "highlight",
        title: "Highlights between vertices are lost",
        cause: "Gouraud shading evaluates the highlight at vertices only: one that lies between them, and is smaller \
                than a cell, is not met at all. One that meets a vertex is spread over the cells around it, so that a moving one flickers.",
        remedy: "Shade highlights at pixels (Phong, or diffuse at vertices and specular at pixels), or use cells that are \
                 smaller than the highlight.",
        test: "sharp_highlights_between_vertices_are_lost",
        figures: vec![Figure::new("failure-highlight", title, axes, panels).named("at rest"), moving_figure()?],
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

    /// Gouraud shading makes highlights flicker, Phong shading hardly does: the bar is three times, where several times
    /// are measured at the sizes of the page.
    #[test]
    fn highlights_flicker_under_gouraud() {
        let all = moving(24, 96).unwrap();
        let [flat, gouraud, phong, truth] = all.each_ref().map(|energies| unsteadiness(energies, &all[3]));
        assert!(flat > 3.0 * phong && gouraud > 3.0 * phong && truth <= 0.0, "{flat}, {gouraud}, {phong}");
    }

    #[test]
    fn unsteadiness_is_of_changes() {
        // Brighter by a constant is an error of each frame, but not an unsteady one.
        let truth = [10.0, 11.0, 9.0, 10.0];
        assert!(unsteadiness(&truth.map(|energy| energy + 5.0), &truth) < 1e-15);
        let jumps = unsteadiness(&[10.0, 10.0, 14.0, 14.0, 13.0], &[10.0; 5]);
        // √((0.4² + 0.1²)/4)
        assert!((jumps - (0.17f64 / 4.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn sharp_highlights_between_vertices_are_lost() {
        let [_, gouraud, phong] = energies(8, 300.0).unwrap();
        // Half a cell of 22.5° off, n·h is cos 11.25° at most: to the 300th, 0.003.
        assert!(gouraud < 0.1 && (phong - 1.0).abs() < 0.2, "{gouraud}, {phong}");
        let [_, gouraud, _] = energies(32, 3.0).unwrap();
        assert!((gouraud - 1.0).abs() < 0.02, "cells smaller than the highlight: {gouraud}");
    }
}
