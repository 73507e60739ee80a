//! Validates a pass: references within their lists, numbers finite and in their ranges.

use crate::error::{LARGEST_SIDE, RasterError};
use crate::input::pass::{DrawCall, DrawMaps, Output, Pass};
use halfway_lighting::Frequency;
use halfway_lighting::lights::Kind;
use halfway_lighting::record::{InstanceRecord, LightRange, LightRecord, SurfaceLights, SurfaceRecord};
use halfway_texture::environment::SurroundingsData;
use halfway_texture::{MapKind, SolidTexture};

/// Checks a pass, except for faults that drawing itself detects.
pub(crate) fn check(pass: &Pass, output: &Output) -> Result<(), RasterError> {
    check_size(pass, output)?;
    check_view(pass)?;
    for (index, light) in pass.lights.iter().enumerate() {
        check_light(index, light)?;
    }
    if let Some((index, &light)) =
        pass.lists.iter().enumerate().find(|(_, light)| **light as usize >= pass.lights.len())
    {
        return beyond("list", index, "light", u64::from(light) + 1, pass.lights.len());
    }
    for (index, surface) in pass.surfaces.iter().enumerate() {
        check_surface(index, surface, pass)?;
    }
    for (index, instance) in pass.instances.iter().enumerate() {
        check_instance(index, instance, pass)?;
    }
    for (index, map) in pass.maps.iter().enumerate() {
        finite("map", index, "rows", map.rows.as_flattened())?;
        finite("map", index, "amount", &[map.amount])?;
    }
    if let Some(SurroundingsData { strength, rows, mean, sky, .. }) = pass.surroundings {
        from_zero("surroundings", 0, "strength", &[*strength])?;
        finite("surroundings", 0, "rows", rows.as_flattened())?;
        finite("surroundings", 0, "mean", mean.as_flattened())?;
        from_zero("surroundings", 0, "sky", &[sky.unwrap_or_default()])?;
    }
    for (index, draw) in pass.draws.iter().enumerate() {
        if draw.mesh as usize >= pass.meshes.len() {
            return beyond("draw", index, "mesh", u64::from(draw.mesh) + 1, pass.meshes.len());
        }
        let mesh = pass.meshes[draw.mesh as usize];
        if draw.colored && !mesh.has_colors() {
            return beyond("draw", index, "colors", mesh.triangle_count() as u64, 0);
        }
        if let Some(maps) = &draw.maps {
            check_maps(index, draw, maps, pass)?;
        }
        if draw.instances.end as usize > pass.instances.len() {
            return beyond("draw", index, "instances", u64::from(draw.instances.end), pass.instances.len());
        }
    }
    Ok(())
}

fn check_maps(index: usize, draw: &DrawCall, maps: &DrawMaps, pass: &Pass) -> Result<(), RasterError> {
    let mesh = pass.meshes[draw.mesh as usize];
    let triangles = mesh.triangle_count() as u64;
    if maps.surrounded && pass.surroundings.is_none() {
        return beyond("draw", index, "surroundings", 1, 0);
    }
    for map in maps.calls.iter().flatten() {
        if map.map as usize >= pass.maps.len() {
            return beyond("draw", index, "map", u64::from(map.map) + 1, pass.maps.len());
        }
        if !mesh.has_uvs() {
            return beyond("draw", index, "texture coordinates", triangles, 0);
        }
    }
    if maps.has(MapKind::Normal) && !draw.terms.has(Frequency::Triangle) && !mesh.has_tangents() {
        return beyond("draw", index, "tangents", triangles, 0);
    }
    if let Some(of) = maps.solid.as_ref().and_then(SolidTexture::wrong) {
        return wrong("draw", index, of.field, of.value, of.expected);
    }
    maps.mask.map_or(Ok(()), |cutoff| finite("draw", index, "mask", &[cutoff]))
}

fn check_size(pass: &Pass, output: &Output) -> Result<(), RasterError> {
    let [width, height] = pass.size;
    if !pass.size.iter().all(|side| (1..=LARGEST_SIDE).contains(side)) {
        return Err(RasterError::Size { width, height });
    }
    let expected = 4 * width as usize * height as usize;
    let (found, fits) = match output {
        Output::Bytes(bytes) => (bytes.len(), pass.pixels.is_bytes()),
        Output::Floats(floats) => (floats.len(), !pass.pixels.is_bytes()),
    };
    if found == expected && fits { Ok(()) } else { Err(RasterError::Output { width, height, expected, found }) }
}

fn check_view(pass: &Pass) -> Result<(), RasterError> {
    finite("pass", 0, "clear", &pass.clear)?;
    match pass.lens.fault() {
        None => Ok(()),
        Some((field, value, expected)) => wrong("lens", 0, field, value, expected),
    }
}

fn check_light(index: usize, light: &LightRecord) -> Result<(), RasterError> {
    if Kind::from_number(light.kind).is_none() {
        return wrong("light", index, "kind", light.kind as f32, "the number of a kind of light");
    }
    finite("light", index, "position", &light.position)?;
    finite("light", index, "direction", &light.direction)?;
    finite("light", index, "cos_cutoff", &[light.cos_cutoff])?;
    finite("light", index, "inner_scale", &[light.inner_scale])?;
    finite("light", index, "inner_offset", &[light.inner_offset])?;
    from_zero("light", index, "inverse_range", &[light.inverse_range])?;
    from_zero("light", index, "constant", &[light.constant])?;
    from_zero("light", index, "linear", &[light.linear])?;
    from_zero("light", index, "quadratic", &[light.quadratic])?;
    from_zero("light", index, "exponent", &[light.exponent])?;
    from_zero("light", index, "ambient", &light.ambient)?;
    from_zero("light", index, "diffuse", &light.diffuse)?;
    from_zero("light", index, "specular", &light.specular)
}

fn check_surface(index: usize, surface: &SurfaceRecord, pass: &Pass) -> Result<(), RasterError> {
    for material in [&surface.front, &surface.back] {
        if let Some((field, value)) = material.wrong() {
            return wrong("surface", index, field.name, value, field.range.expected);
        }
    }
    let range = |field, range: &LightRange| {
        let end = u64::from(range.start) + u64::from(range.count);
        let fits = range.is_empty() || end <= pass.lists.len() as u64;
        if fits { Ok(()) } else { beyond("surface", index, field, end, pass.lists.len()) }
    };
    let SurfaceLights { both, diffuse, specular } = &surface.lights;
    range("both", both)?;
    range("diffuse", diffuse)?;
    range("specular", specular)
}

fn check_instance(index: usize, instance: &InstanceRecord, pass: &Pass) -> Result<(), RasterError> {
    finite("instance", index, "eye_from_model", instance.eye_from_model.as_flattened())?;
    finite("instance", index, "normal", instance.normal.as_flattened())?;
    if instance.surface as usize >= pass.surfaces.len() {
        return beyond("instance", index, "surface", u64::from(instance.surface) + 1, pass.surfaces.len());
    }
    Ok(())
}

fn finite(what: &'static str, index: usize, field: &'static str, values: &[f32]) -> Result<(), RasterError> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(&value) => wrong(what, index, field, value, "a finite number"),
        None => Ok(()),
    }
}

fn from_zero(what: &'static str, index: usize, field: &'static str, values: &[f32]) -> Result<(), RasterError> {
    match values.iter().find(|value| !(0.0..=f32::MAX).contains(*value)) {
        Some(&value) => wrong(what, index, field, value, "a finite number from 0"),
        None => Ok(()),
    }
}

fn wrong(
    what: &'static str,
    index: usize,
    field: &'static str,
    value: f32,
    expected: &'static str,
) -> Result<(), RasterError> {
    Err(RasterError::Number { what, index, field, value: f64::from(value), expected })
}

fn beyond(
    what: &'static str,
    index: usize,
    field: &'static str,
    reaches: u64,
    available: usize,
) -> Result<(), RasterError> {
    Err(RasterError::Reference { what, index, field, reaches, available: available as u64 })
}
