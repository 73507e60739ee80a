//! `halfway info`.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use clap::Args;
use halfway::mesh::{
    AlphaMode, LodGroup, Mesh, Model, Normals, ScalarValues, SourceLightKind, SourceMaterial, SourceProjection,
};
use halfway::prelude::{DVec3, Vec3};

use crate::failure::Failure;
use crate::reading::ReadingArgs;

#[derive(Args, Debug)]
pub(crate) struct InfoArgs {
    /// Models (.smf, .obj, .gltf, .glb, .ply, .stl, .off, .3mf); - reads one from standard input, of --format
    #[arg(value_name = "MODEL", required = true)]
    models: Vec<PathBuf>,
    #[command(flatten)]
    reading: ReadingArgs,
    /// Make levels of detail, too, and print how many triangles they have within some errors
    #[arg(long, conflicts_with = "table")]
    levels: bool,
    /// Print a table with a line for each model
    #[arg(long)]
    table: bool,
}

pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    args.reading.without_picture()?;
    if args.table {
        println!("{}", TITLES.join("\t"));
    }
    let mut refused = Vec::new();
    for (i, file) in args.models.iter().enumerate() {
        match args.reading.load(file) {
            Ok(model) if args.table => println!("{}", row(file, &model).join("\t")),
            Ok(model) => {
                if i > 0 {
                    println!();
                }
                print_model(file, &model, args.levels);
            }
            Err(failure) => refused.push(failure),
        }
    }
    // The last one is printed by whoever gets it.
    let last = refused.pop();
    for error in refused.into_iter().filter_map(|failure| failure.error) {
        eprintln!("error: {error}");
    }
    last.map_or(Ok(()), Err)
}

const TITLES: [&str; 11] = [
    "file",
    "triangles",
    "vertices",
    "parts",
    "size x",
    "size y",
    "size z",
    "open parts",
    "normals",
    "lines",
    "points",
];

/// The vertices of meshes, lines and points.
fn vertices(model: &Model) -> usize {
    let of_meshes = model.parts.iter().map(|part| part.mesh.positions().len());
    of_meshes.chain(model.lines.iter().map(|part| part.lines.positions().len())).sum()
}

/// The columns of a model.
fn row(file: &Path, model: &Model) -> [String; 11] {
    let size = model.bounds().map_or(Vec3::ZERO, |bounds| bounds.max - bounds.min);
    let open = model.parts.iter().filter(|part| part.mesh.is_open()).count();
    let mut kinds: Vec<String> = model.parts.iter().map(|part| normals(&part.mesh)).collect();
    kinds.sort();
    kinds.dedup();
    [
        file.display().to_string(),
        model.triangle_count().to_string(),
        vertices(model).to_string(),
        model.parts.len().to_string(),
        size.x.to_string(),
        size.y.to_string(),
        size.z.to_string(),
        open.to_string(),
        kinds.join("; "),
        model.line_count().to_string(),
        model.point_count().to_string(),
    ]
}

/// The normals that `--normals auto` gives a mesh.
fn normals(mesh: &Mesh) -> String {
    match mesh.suited_normals() {
        _ if mesh.has_given_normals() => "the file's".to_owned(),
        Normals::Creased { angle, .. } => format!("a made part's, creased at {:.1}°", angle.to_degrees()),
        _ => "smooth".to_owned(),
    }
}

fn print_model(file: &Path, model: &Model, levels: bool) {
    println!("{}", file.display());
    print_shape(model);
    for part in &model.parts {
        let material = part.material.and_then(|i| model.materials.get(i)).map_or("none", SourceMaterial::name);
        println!("part       \"{}\": {}; material {material}", part.name, attributes(&part.mesh));
        part.mesh.report().to_string().lines().for_each(|line| println!("  {line}"));
        println!("  normals    {}", normals(&part.mesh));
        if levels {
            print_levels(&part.mesh);
        }
    }
    for property in model.properties.iter() {
        let range = match property.values.range() {
            Some([low, high]) => format!("from {low} to {high}"),
            None => "no finite number".to_owned(),
        };
        let on = if matches!(property.values, ScalarValues::Vertices(_)) { "vertices" } else { "faces" };
        println!("property   \"{}\" of {on}: {range}", property.name);
    }
    for part in &model.lines {
        let lines = &part.lines;
        let material = part.material.and_then(|i| model.materials.get(i)).map_or("none", SourceMaterial::name);
        let has = [(lines.normals().is_some(), ", normals"), (lines.colors().is_some(), ", colours")];
        let has: String = has.iter().filter(|(has, _)| *has).map(|(_, what)| *what).collect();
        let (segments, points) = (lines.segments().len(), lines.points().len());
        println!(
            "lines      \"{}\": {segments} lines, {points} points; positions{has}; material {material}",
            part.name
        );
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
    for (number, clip) in model.animations.iter().flat_map(|animations| animations.clips().iter().enumerate()) {
        println!("animation  {number} \"{}\": {} s", clip.name, clip.duration);
    }
    for warning in &model.warnings {
        println!("warning    {warning}");
    }
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
    println!("triangles  {}", model.triangle_count());
    for (title, count) in [("lines", model.line_count()), ("points", model.point_count())] {
        if count > 0 {
            println!("{title:<10} {count}");
        }
    }
    println!("vertices   {}", vertices(model));
    if let Some(bounds) = model.bounds() {
        let size = bounds.max - bounds.min;
        let [min, max] = [bounds.min, bounds.max].map(|corner| in_the_file(model.origin, corner, size));
        println!("bounds     {min} to {max}, size {size}");
    }
}

/// A point as the file has it. Far from the origin, with the digits that `f32` keeps of the model's size.
fn in_the_file(origin: DVec3, point: Vec3, size: Vec3) -> String {
    if origin == DVec3::ZERO {
        return point.to_string();
    }
    let [x, y, z] = (origin + point.as_dvec3()).to_array();
    let decimals = (6.0 - size.max_element().log10().floor()).clamp(0.0, 17.0) as usize;
    format!("[{x:.decimals$}, {y:.decimals$}, {z:.decimals$}]")
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
