//! The steps of `halfway convert` on meshes, each with a line about its result.

use std::collections::HashMap;

use halfway::mesh::{Mesh, MeshError, Model, NormalReport, Normals, Part, RepairReport, Subdivision, Weld, WeldReport};

/// The meshes of a model, each once however many parts show it; counted once for each part.
pub(crate) struct Meshes {
    /// Each mesh with the parts that show it.
    all: Vec<(Mesh, Vec<usize>)>,
    /// How many parts had tangents.
    tangents: usize,
    /// Prints a line.
    say: fn(String),
}

impl Meshes {
    pub(crate) fn from_model(model: &Model, say: fn(String)) -> Self {
        let mut meshes: Vec<(Mesh, Vec<usize>)> = Vec::new();
        let mut numbers = HashMap::new();
        for (i, part) in model.parts.iter().enumerate() {
            // Meshes that share their data have it at one address.
            let number = *numbers.entry(part.mesh.positions().as_ptr()).or_insert(meshes.len());
            match meshes.get_mut(number) {
                Some((_, parts)) => parts.push(i),
                None => meshes.push((part.mesh.clone(), vec![i])),
            }
        }
        Self { tangents: with_tangents(model), all: meshes, say }
    }

    /// Gives the parts their meshes; parts without a mesh are dropped.
    pub(crate) fn put_into(self, model: &mut Model) {
        let mut parts: Vec<_> = std::mem::take(&mut model.parts).into_iter().map(Some).collect();
        let mut changed = Vec::new();
        for (mesh, shown) in self.all {
            changed.extend(shown.into_iter().filter_map(|i| Some((i, mesh.clone(), parts[i].take()?))));
        }
        changed.sort_by_key(|&(i, ..)| i);
        model.parts = changed.into_iter().map(|(_, mesh, part)| Part { mesh, ..part }).collect();
        for part in parts.into_iter().flatten() {
            (self.say)(format!("lost       part \"{}\", of which no triangle is left", part.name));
        }
        let tangents = self.tangents.saturating_sub(with_tangents(model));
        if tangents > 0 {
            (self.say)(format!("lost       the tangents of {tangents} parts, which belonged to other normals"));
        }
    }

    fn triangles(&self) -> usize {
        self.all.iter().map(|(mesh, parts)| mesh.triangle_count() * parts.len()).sum()
    }

    fn vertices(&self) -> usize {
        self.all.iter().map(|(mesh, parts)| mesh.positions().len() * parts.len()).sum()
    }

    /// Changes every mesh; `step` also gets the number of parts that show it. Meshes without triangles are dropped.
    fn change(&mut self, mut step: impl FnMut(&Mesh, usize) -> Option<Mesh>) {
        let meshes = std::mem::take(&mut self.all).into_iter();
        self.all = meshes.filter_map(|(mesh, parts)| Some((step(&mesh, parts.len())?, parts))).collect();
    }

    pub(crate) fn weld(&mut self, weld: Weld) {
        let before = self.vertices();
        let mut all = WeldReport::default();
        self.change(|mesh, times| {
            let (welded, report) = mesh.welded(weld).ok()?;
            all.merged_vertices += times * report.merged_vertices;
            all.collapsed_triangles += times * report.collapsed_triangles;
            Some(welded)
        });
        let WeldReport { merged_vertices, collapsed_triangles } = all;
        (self.say)(format!(
            "weld       {merged_vertices} of {before} vertices merged, {collapsed_triangles} triangles collapsed"
        ));
    }

    pub(crate) fn repair(&mut self) {
        let mut all = RepairReport::default();
        self.change(|mesh, times| {
            let (repaired, report) = mesh.repaired().ok()?;
            all.removed_degenerate += times * report.removed_degenerate;
            all.removed_duplicate += times * report.removed_duplicate;
            all.removed_vertices += times * report.removed_vertices;
            all.turned += times * report.turned;
            all.conflicts += times * report.conflicts;
            all.against_normals += times * report.against_normals;
            Some(repaired)
        });
        (self.say)(format!("repair     {all}"));
    }

    pub(crate) fn subdivide(&mut self, scheme: Subdivision, times: u32) -> Result<(), MeshError> {
        let before = self.triangles();
        for (mesh, _) in &mut self.all {
            *mesh = mesh.subdivided(scheme, times)?;
        }
        (self.say)(format!("subdivide  {before} to {} triangles", self.triangles()));
        Ok(())
    }

    /// To `triangles` in all, or as near as `max_error` allows.
    pub(crate) fn simplify(&mut self, triangles: usize, max_error: f64) {
        let before = self.triangles();
        let share = triangles as f64 / before as f64;
        let mut error = 0.0_f64;
        self.change(|mesh, _| {
            let level = mesh.simplified((share * mesh.triangle_count() as f64).round() as usize, max_error);
            error = error.max(level.error);
            Some(level.mesh)
        });
        let after = self.triangles();
        (self.say)(format!("simplify   {before} to {after} triangles; no point is further off than {error:.3e}"));
    }

    pub(crate) fn make_normals(&mut self, normals: Normals) {
        let before = self.vertices();
        let mut all = NormalReport::default();
        self.change(|mesh, times| {
            let (mesh, report) = mesh.clone().with_normals(normals);
            all.degenerate_triangles += times * report.degenerate_triangles;
            all.cancelled += times * report.cancelled;
            all.without_face += times * report.without_face;
            Some(mesh)
        });
        let vertices = self.vertices();
        let mut line = vec![format!("normals    {before} to {vertices} vertices")];
        for (count, what) in [
            (all.degenerate_triangles, "degenerate triangles without one"),
            (all.cancelled, "vertices whose faces cancel out"),
            (all.without_face, "vertices of no face"),
        ] {
            if count > 0 {
                line.push(format!("{count} {what}"));
            }
        }
        (self.say)(line.join(", "));
    }
}

fn with_tangents(model: &Model) -> usize {
    model.parts.iter().filter(|part| part.mesh.tangents().is_some()).count()
}
