//! Wavefront MTL: the statements that describe a material's reflectance.

use std::collections::HashMap;
use std::sync::Arc;

use crate::files::LoadError;
use crate::files::source::{ModelFolder, Reader};
use crate::files::text::{Skipped, Statement, Statements, abridged};
use crate::{MtlMaterial, SourceMap, SourceMaterial, SourceWrap};

/// Appends the materials of an MTL file; returns what was skipped.
///
/// - `Ka Kd Ks Ke`: three finite numbers, or one for all three; spectra (`spectral`, `xyz`) are skipped with a warning.
/// - `Ns d Tr`: one finite number; `d -halo` is skipped with a warning.
/// - `illum`: a number from 0 to 255.
/// - `map_Kd`: options `-s -o -clamp`, and a file; others are skipped with a warning. What cannot be read is a warning.
/// - Other textures are skipped with a warning, everything else in silence.
pub(super) fn parse(
    reader: Reader,
    around: ModelFolder,
    materials: &mut Vec<SourceMaterial>,
) -> Result<Vec<String>, LoadError> {
    let mut images = HashMap::new();
    let path = reader.path().to_owned();
    let mut lines = Statements::new(reader);
    let mut skipped = Skipped::default();
    let mut material: Option<MtlMaterial> = None;
    while let Some(statement) = lines.next()? {
        if statement.keyword == "newmtl" {
            if statement.rest.is_empty() {
                return Err(statement.unexpected("`newmtl` and a name is"));
            }
            let begun = MtlMaterial { name: statement.rest.to_owned(), ..MtlMaterial::default() };
            materials.extend(material.replace(begun).map(SourceMaterial::Mtl));
        } else if statement.keyword == "map_Kd" {
            let Some(material) = &mut material else {
                return Err(statement.unexpected("`newmtl` and a name before it is"));
            };
            material.color_map = color_map(&statement, around, &mut images, &mut skipped).or(material.color_map.take());
        } else if is_texture(statement.keyword) {
            skipped.add(statement.line, format!("the texture `{}` is skipped", statement.keyword));
        } else if matches!(statement.keyword, "Ka" | "Kd" | "Ks" | "Ke" | "Ns" | "d" | "Tr" | "illum") {
            let Some(material) = &mut material else {
                return Err(statement.unexpected("`newmtl` and a name before it is"));
            };
            set(material, &statement, &mut skipped)?;
        }
    }
    materials.extend(material.map(SourceMaterial::Mtl));
    lines.warn_of_encoding(&mut skipped);
    Ok(skipped.warnings(&path))
}

/// The image of a statement. v runs upward in the file, downward in a mesh.
fn color_map(
    statement: &Statement,
    around: ModelFolder,
    images: &mut HashMap<String, Arc<[u8]>>,
    skipped: &mut Skipped,
) -> Option<SourceMap> {
    let mut words = statement.words().peekable();
    let (mut scale, mut offset, mut clamp) = ([1.0_f32; 2], [0.0_f32; 2], false);
    while let Some(option) = words.next_if(|word| word.starts_with('-') && word.parse::<f32>().is_err()) {
        let mut numbers = Vec::new();
        let most = match option {
            "-s" | "-o" | "-t" => 3,
            "-mm" => 2,
            "-bm" | "-boost" | "-texres" => 1,
            _ => 0,
        };
        while let Some(number) = words.peek().filter(|_| numbers.len() < most).and_then(|word| word.parse().ok()) {
            numbers.push(number);
            words.next();
        }
        let finite = |number: &f32| number.is_finite();
        match (option, &numbers[..]) {
            ("-s" | "-o", [first, rest @ ..]) if numbers.iter().all(finite) => {
                let default = if option == "-s" { 1.0 } else { 0.0 };
                let pair = [*first, rest.first().copied().unwrap_or(default)];
                if option == "-s" { scale = pair } else { offset = pair }
            }
            ("-clamp", _) => clamp = words.next() == Some("on"),
            _ => {
                if most == 0 {
                    words.next();
                }
                skipped.add(statement.line, format!("the option `{}` of `map_Kd` is skipped", abridged(option, "")));
            }
        }
    }
    let name = words.collect::<Vec<_>>().join(" ").replace('\\', "/");
    if name.is_empty() {
        skipped.add(statement.line, "`map_Kd` without a file is skipped");
        return None;
    }
    let bytes = images.entry(name.clone()).or_insert_with(|| {
        let read =
            around.find(&name).map(|path| around.open(&path).and_then(|reader| Ok(reader.whole()?.into_owned())));
        match read {
            Some(Ok(bytes)) => bytes.into(),
            Some(Err(error)) => {
                skipped.add(statement.line, format!("the texture of `map_Kd` cannot be read: {error}"));
                Arc::from([])
            }
            None => {
                let name = abridged(&name, "");
                skipped.add(statement.line, format!("the texture {name} is outside the folder of the model, not read"));
                Arc::from([])
            }
        }
    });
    let wrap = if clamp { SourceWrap::Clamp } else { SourceWrap::Repeat };
    // 1 − (s·(1 − v) + o), for v that runs downward.
    Some(SourceMap {
        wrap: [wrap; 2],
        offset: [offset[0], 1.0 - scale[1] - offset[1]],
        scale,
        ..SourceMap::new(name, Arc::clone(bytes))
    })
}

fn is_texture(keyword: &str) -> bool {
    let is_map = keyword.strip_prefix("map_").is_some_and(|rest| rest.len() < 20);
    is_map || matches!(keyword, "bump" | "disp" | "decal" | "refl" | "norm")
}

fn set(material: &mut MtlMaterial, statement: &Statement, skipped: &mut Skipped) -> Result<(), LoadError> {
    match statement.keyword {
        "Ka" => material.ka = color(statement, skipped)?.or(material.ka),
        "Kd" => material.kd = color(statement, skipped)?.or(material.kd),
        "Ks" => material.ks = color(statement, skipped)?.or(material.ks),
        "Ke" => material.ke = color(statement, skipped)?.or(material.ke),
        "Ns" => material.ns = scalar(statement, skipped)?.or(material.ns),
        "d" => material.d = scalar(statement, skipped)?.or(material.d),
        "Tr" => material.tr = scalar(statement, skipped)?.or(material.tr),
        _ => {
            const EXPECTED: &str = "`illum` and a number from 0 to 255 is";
            let [number] = statement.exactly(EXPECTED)?;
            material.illum = Some(number.parse().map_err(|_| statement.unexpected(EXPECTED))?);
        }
    }
    Ok(())
}

fn color(statement: &Statement, skipped: &mut Skipped) -> Result<Option<[f32; 3]>, LoadError> {
    if let Some(kind @ ("spectral" | "xyz")) = statement.words().next() {
        skipped.add(statement.line, format!("`{} {kind}` is skipped", statement.keyword));
        return Ok(None);
    }
    let ([r, g, b], count) = statement.numbers(&[1, 3], "a colour of three numbers is")?;
    Ok(Some(if count == 1 { [r; 3] } else { [r, g, b] }))
}

fn scalar(statement: &Statement, skipped: &mut Skipped) -> Result<Option<f32>, LoadError> {
    if statement.words().next() == Some("-halo") {
        skipped.add(statement.line, "`d -halo` is skipped");
        return Ok(None);
    }
    let [word] = statement.exactly("one number is")?;
    statement.number(word).map(Some)
}
