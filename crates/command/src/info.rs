//! `halfway info`.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use clap::Args;
use halfway::mesh::{AlphaMode, LodGroup, Mesh, Model, SourceLightKind, SourceMaterial, SourceProjection};

use crate::failure::Failure;

#[derive(Args, Debug)]
pub(crate) struct InfoArgs {
    /// A model (.smf, .obj, .gltf, .glb, .ply, .stl)
    model: PathBuf,
    /// Make levels of detail, too, and print how many triangles they have within some errors
    #[arg(long)]
    levels: bool,
}

pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let model = halfway::mesh::load(&args.model)?;
    println!("{}", args.model.display());
    print_shape(&model);
    for part in &model.parts {
        let material = part.material.and_then(|i| model.materials.get(i)).map_or("none", SourceMaterial::name);
        println!("part       \"{}\": {}; material {material}", part.name, attributes(&part.mesh));
        part.mesh.report().to_string().lines().for_each(|line| println!("  {line}"));
        if args.levels {
            print_levels(&part.mesh);
        }
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
    for camera in &model.cameras {
        println!("camera     \"{}\": {}", camera.name, projection(camera.projection));
    }
    for warning in &model.warnings {
        println!("warning    {warning}");
    }
    Ok(())
}

fn attributes(mesh: &Mesh) -> String {
    let has =
        [(mesh.uvs().is_some(), "uvs"), (mesh.colors().is_some(), "colours"), (mesh.tangents().is_some(), "tangents")];
    let has = has.iter().filter(|(has, _)| *has).map(|(_, what)| *what);
    ["positions", "normals"].into_iter().chain(has).collect::<Vec<_>>().join(", ")
}

fn print_levels(mesh: &Mesh) {
    let Some(levels) = mesh.lod_hierarchy(&AtomicBool::new(false)) else { return };
    println!("  levels     {} clusters in {} groups", levels.clusters.len(), levels.groups.len());
    let count = |error: &dyn Fn(&LodGroup) -> f32, most: f32| -> usize {
        levels.cut(|group| error(group) <= most).into_iter().map(|cluster| levels.triangles_of(cluster).len()).sum()
    };
    let radius = mesh.bounds().radius();
    for most in (2..13).rev().map(|exponent| radius * 0.5_f32.powi(exponent)) {
        let [surface, shading] = [false, true].map(|lit| count(&|group| group.error(lit, false), most));
        println!("             {surface} triangles within {most:.2e}, {shading} if lit");
    }
}

fn projection(projection: SourceProjection) -> String {
    match projection {
        SourceProjection::Perspective { yfov, aspect, near, far } => {
            let aspect = aspect.map_or("the picture's".into(), |aspect| aspect.to_string());
            let far = far.map_or("infinity".into(), |far| far.to_string());
            format!("perspective, {:.4}° high, aspect {aspect}, from {near} to {far}", yfov.to_degrees())
        }
        SourceProjection::Orthographic { half_width, half_height, near, far } => {
            format!("orthographic, {} × {}, from {near} to {far}", 2.0 * half_width, 2.0 * half_height)
        }
    }
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
            let colors = [("Ka", mtl.ka), ("Kd", mtl.kd), ("Ks", mtl.ks), ("Ke", mtl.ke)];
            let numbers = [("Ns", mtl.ns), ("d", mtl.d), ("Tr", mtl.tr), ("illum", mtl.illum.map(f32::from))];
            let said = colors
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
