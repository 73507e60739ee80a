//! `halfway info`.

use std::path::PathBuf;

use clap::Args;
use halfway::mesh::{AlphaMode, Model, SourceLightKind, SourceMaterial};

use super::Failure;

#[derive(Args, Debug)]
pub(super) struct InfoArgs {
    /// A model (.smf, .obj, .gltf, .glb)
    model: PathBuf,
}

pub(super) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let model = halfway::mesh::load(&args.model)?;
    println!("{}", args.model.display());
    print_shape(&model);
    for part in &model.parts {
        let material = part.material.and_then(|i| model.materials.get(i)).map_or("none", SourceMaterial::name);
        let (triangles, vertices) = (part.mesh.triangle_count(), part.mesh.positions().len());
        let uvs = if part.mesh.uvs().is_some() { ", uv" } else { "" };
        println!("part       \"{}\": {triangles} triangles, {vertices} vertices{uvs}; material {material}", part.name);
        println!("  problems {}", part.mesh.problems());
    }
    model.materials.iter().for_each(print_material);
    for light in &model.lights {
        let kind = match light.kind {
            SourceLightKind::Directional => "directional, lux",
            SourceLightKind::Point => "point, candela",
            SourceLightKind::Spot { .. } => "spot, candela",
        };
        println!("light      \"{}\": {kind} {}, colour {:?}", light.name, light.intensity, light.color);
    }
    for warning in &model.warnings {
        println!("warning    {warning}");
    }
    Ok(())
}

fn print_shape(model: &Model) {
    let vertices: usize = model.parts.iter().map(|part| part.mesh.positions().len()).sum();
    println!("triangles  {}", model.triangle_count());
    println!("vertices   {vertices}");
    if let Some(bounds) = model.bounds() {
        let size = bounds.max - bounds.min;
        println!("bounds     {} to {}, size {size}", bounds.min, bounds.max);
    }
}

fn print_material(material: &SourceMaterial) {
    match material {
        SourceMaterial::Mtl(mtl) => {
            let colours = [("Ka", mtl.ka), ("Kd", mtl.kd), ("Ks", mtl.ks), ("Ke", mtl.ke)];
            let numbers = [("Ns", mtl.ns), ("d", mtl.d), ("Tr", mtl.tr), ("illum", mtl.illum.map(f32::from))];
            let said = colours
                .iter()
                .filter_map(|(key, value)| value.map(|value| format!("{key} {value:?}")))
                .chain(numbers.iter().filter_map(|(key, value)| value.map(|value| format!("{key} {value}"))));
            println!("material   \"{}\" (MTL): {}", mtl.name, said.collect::<Vec<_>>().join(", "));
        }
        SourceMaterial::MetallicRoughness(pbr) => {
            let alpha = match pbr.alpha {
                AlphaMode::Opaque => "opaque",
                AlphaMode::Mask { .. } => "masked",
                AlphaMode::Blend => "blended",
            };
            println!(
                "material   \"{}\" (metallic-roughness): base colour {:?}, metallic {}, roughness {}, {alpha}",
                pbr.name, pbr.base_color, pbr.metallic, pbr.roughness
            );
        }
    }
}
