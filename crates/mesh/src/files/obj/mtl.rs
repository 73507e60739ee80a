//! Wavefront MTL: the statements that describe a material's reflectance.

use crate::files::LoadError;
use crate::files::source::Reader;
use crate::files::text::{Skipped, Statement, Statements};
use crate::{MtlMaterial, SourceMaterial};

/// Appends the materials of an MTL file; returns what was skipped.
///
/// - `Ka Kd Ks Ke`: three finite numbers, or one for all three; spectra (`spectral`, `xyz`) are skipped with a warning.
/// - `Ns d Tr`: one finite number; `d -halo` is skipped with a warning.
/// - `illum`: a number from 0 to 255.
/// - Textures are skipped with a warning, everything else in silence.
pub(super) fn parse(reader: Reader, materials: &mut Vec<SourceMaterial>) -> Result<Vec<String>, LoadError> {
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
