//! Wavefront MTL: the statements that describe a material's reflectance.
//!
//! `tobj` reads the materials, but panics on colours of fewer than three numbers and cannot say the line of an error.
//! So the text is checked here first, and handed on in a plainer form.

use std::fmt::Write as _;
use std::path::Path;

use super::LoadError;
use super::text::{Skipped, Statement, statements};
use crate::{MtlMaterial, SourceMaterial};

/// Appends the checked statements of an MTL file to `plain`, in the form that [`materials`] takes.
///
/// - `Ka Kd Ks Ke`: three finite numbers, or one for all three; spectra (`spectral`, `xyz`) are skipped with a warning.
/// - `Ns d Tr`: one finite number; `d -halo` is skipped with a warning.
/// - `illum`: a number from 0 to 255.
/// - Textures are skipped with a warning, everything else in silence.
pub(super) fn check(path: &Path, text: &[u8], plain: &mut String) -> Result<Vec<String>, LoadError> {
    let mut skipped = Skipped::default();
    let mut inside = false;
    for statement in statements(path, text) {
        let statement = statement?;
        let known = matches!(statement.keyword, "Ka" | "Kd" | "Ks" | "Ke" | "Ns" | "d" | "Tr" | "illum");
        if known && !inside {
            return Err(statement.unexpected("`newmtl` and a name before it is"));
        }
        match statement.keyword {
            "newmtl" if statement.rest.is_empty() => {
                return Err(statement.unexpected("`newmtl` and a name is"));
            }
            "newmtl" => {
                inside = true;
                line(plain, "newmtl", statement.rest);
            }
            "Ka" | "Kd" | "Ks" | "Ke" => color(&statement, plain, &mut skipped)?,
            "Ns" | "d" | "Tr" => scalar(&statement, plain, &mut skipped)?,
            "illum" => {
                let number = single(&statement, "`illum` and a number from 0 to 255 is")?;
                number.parse::<u8>().map_err(|_| statement.unexpected("`illum` and a number from 0 to 255 is"))?;
                line(plain, "illum", number);
            }
            texture if is_texture(texture) => {
                skipped.add(statement.line, format!("the texture `{texture}` is skipped"));
            }
            _ => {}
        }
    }
    Ok(skipped.warnings(path))
}

fn is_texture(keyword: &str) -> bool {
    keyword.starts_with("map_") || matches!(keyword, "bump" | "disp" | "decal" | "refl" | "norm")
}

fn line(plain: &mut String, keyword: &str, rest: &str) {
    // Writing to a string does not fail.
    let _ = writeln!(plain, "{keyword} {rest}");
}

fn single<'a>(statement: &Statement<'a>, expected: &str) -> Result<&'a str, LoadError> {
    let mut words = statement.words();
    match (words.next(), words.next()) {
        (Some(word), None) => Ok(word),
        _ => Err(statement.unexpected(expected)),
    }
}

fn color(statement: &Statement, plain: &mut String, skipped: &mut Skipped) -> Result<(), LoadError> {
    let words: Vec<&str> = statement.words().take(4).collect();
    let [r, g, b] = match words[..] {
        ["spectral" | "xyz", ..] => {
            let kind = format!("`{} {}` is skipped", statement.keyword, words[0]);
            skipped.add(statement.line, kind);
            return Ok(());
        }
        [grey] => [grey; 3],
        [r, g, b] => [r, g, b],
        _ => return Err(statement.unexpected("a colour of three numbers is")),
    };
    for word in [r, g, b] {
        statement.number(word)?;
    }
    line(plain, statement.keyword, &format!("{r} {g} {b}"));
    Ok(())
}

fn scalar(statement: &Statement, plain: &mut String, skipped: &mut Skipped) -> Result<(), LoadError> {
    if statement.words().next() == Some("-halo") {
        skipped.add(statement.line, "`d -halo` is skipped");
        return Ok(());
    }
    let word = single(statement, "one number is")?;
    statement.number(word)?;
    line(plain, statement.keyword, word);
    Ok(())
}

/// A material as `tobj` found it, in this crate's terms. `tobj` keeps `Tr` among the statements it does not know.
pub(super) fn material(found: tobj::Material) -> SourceMaterial {
    SourceMaterial::Mtl(MtlMaterial {
        name: found.name,
        ka: found.ambient,
        kd: found.diffuse,
        ks: found.specular,
        ke: found.emissive,
        ns: found.shininess,
        d: found.dissolve,
        tr: found.unknown_param.get("Tr").and_then(|tr| tr.parse().ok()),
        illum: found.illumination_model,
    })
}
