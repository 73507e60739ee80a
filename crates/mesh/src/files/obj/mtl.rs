//! Wavefront MTL: the statements that describe a material's reflectance.

use std::collections::HashMap;
use std::iter::Peekable;
use std::sync::Arc;

use crate::files::LoadError;
use crate::files::source::{ModelFolder, Reader};
use crate::files::text::{Skipped, Statement, Statements, abridged};
use crate::{MtlMaps, MtlMaterial, SourceChannel, SourceMap, SourceMaterial, SourceWrap};

/// Appends the materials of an MTL file; skipped statements are warnings.
///
/// - `Ka Kd Ks Ke`: three finite numbers, or one for all three; spectra (`spectral`, `xyz`) are skipped with a warning.
/// - `Ns d Tr`: one finite number; `d -halo` is skipped with a warning.
/// - `illum`: a number from 0 to 255.
/// - `map_Kd map_Ks map_Ke map_d map_Ns norm map_Bump` (also `map_bump`, `bump`): options `-s -o -clamp -imfchan`, of
///   bumps `-bm`, and a file; other options are skipped with a warning. An unreadable image is a warning.
/// - Other textures are skipped with a warning, all other statements in silence.
pub(super) fn parse(
    reader: Reader,
    around: ModelFolder,
    materials: &mut Vec<SourceMaterial>,
) -> Result<Vec<String>, LoadError> {
    let mut images = HashMap::new();
    let path = reader.path().to_owned();
    let mut lines = Statements::new(reader, false);
    let mut skipped = Skipped::default();
    let mut material: Option<MtlMaterial> = None;
    while let Some(statement) = lines.next()? {
        if statement.keyword == "newmtl" {
            if statement.rest.is_empty() {
                return Err(statement.unexpected("`newmtl` and a name is"));
            }
            let begun = MtlMaterial { name: statement.rest.to_owned(), ..MtlMaterial::default() };
            materials.extend(material.replace(begun).map(SourceMaterial::Mtl));
        } else if let Some(place) = map_place(statement.keyword) {
            let Some(material) = &mut material else {
                return Err(statement.unexpected("`newmtl` and a name before it is"));
            };
            if let Some(map) = map(&statement, around, &mut images, &mut skipped) {
                *place(&mut material.maps) = Some(map);
            }
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

/// The field for the image of a statement, if it is read.
fn map_place(keyword: &str) -> Option<fn(&mut MtlMaps) -> &mut Option<SourceMap>> {
    let place: fn(&mut MtlMaps) -> &mut Option<SourceMap> = match keyword {
        "map_Kd" => |maps| &mut maps.kd,
        "map_Ks" => |maps| &mut maps.ks,
        "map_Ke" => |maps| &mut maps.ke,
        "map_d" => |maps| &mut maps.d,
        "map_Ns" => |maps| &mut maps.ns,
        "norm" => |maps| &mut maps.norm,
        keyword if is_bump(keyword) => |maps| &mut maps.bump,
        _ => return None,
    };
    Some(place)
}

fn is_bump(keyword: &str) -> bool {
    matches!(keyword, "map_Bump" | "map_bump" | "bump")
}

/// The options of an image.
struct MapOptions {
    scale: [f32; 2],
    offset: [f32; 2],
    clamp: bool,
    amount: f32,
    channel: Option<SourceChannel>,
}

impl MapOptions {
    /// Reads the options at the beginning of a statement's words.
    fn read<'a>(
        words: &mut Peekable<impl Iterator<Item = &'a str>>,
        statement: &Statement,
        skipped: &mut Skipped,
    ) -> Self {
        let mut options = Self { scale: [1.0; 2], offset: [0.0; 2], clamp: false, amount: 1.0, channel: None };
        while let Some(option) = words.next_if(|word| word.starts_with('-') && word.parse::<f32>().is_err()) {
            let mut numbers: Vec<f32> = Vec::new();
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
            let is_finite = numbers.iter().all(|number| number.is_finite());
            let channel = |word: Option<&str>| match word {
                Some("r") => Some(SourceChannel::Red),
                Some("g") => Some(SourceChannel::Green),
                Some("b") => Some(SourceChannel::Blue),
                Some("m") => Some(SourceChannel::Alpha),
                _ => None,
            };
            let is_known = match (option, &numbers[..]) {
                ("-s" | "-o", [first, rest @ ..]) if is_finite => {
                    let default = if option == "-s" { 1.0 } else { 0.0 };
                    let pair = [*first, rest.first().copied().unwrap_or(default)];
                    if option == "-s" {
                        options.scale = pair;
                    } else {
                        options.offset = pair;
                    }
                    true
                }
                ("-bm", [amount]) if is_finite && is_bump(statement.keyword) => {
                    options.amount = *amount;
                    true
                }
                ("-clamp", _) => {
                    options.clamp = words.next() == Some("on");
                    true
                }
                ("-imfchan", _) => {
                    options.channel = channel(words.next());
                    options.channel.is_some()
                }
                _ => {
                    if most == 0 {
                        words.next();
                    }
                    false
                }
            };
            if !is_known {
                let what = format!("the option `{}` of `{}` is skipped", abridged(option, ""), statement.keyword);
                skipped.add(statement.line, what);
            }
        }
        options
    }
}

/// The image of a statement. v runs upward in the file, downward in a mesh.
fn map(
    statement: &Statement,
    around: ModelFolder,
    images: &mut HashMap<String, Arc<[u8]>>,
    skipped: &mut Skipped,
) -> Option<SourceMap> {
    let mut words = statement.words().peekable();
    let MapOptions { scale, offset, clamp, amount, channel } = MapOptions::read(&mut words, statement, skipped);
    let (line, keyword) = (statement.line, statement.keyword);
    let name = words.collect::<Vec<_>>().join(" ").replace('\\', "/");
    if name.is_empty() {
        skipped.add(line, format!("`{keyword}` without a file is skipped"));
        return None;
    }
    let bytes = images.entry(name.clone()).or_insert_with(|| {
        let read = around.find(&name).map(|path| around.open(&path).and_then(Reader::whole));
        match read {
            Some(Ok(bytes)) => bytes.into(),
            Some(Err(error)) => {
                skipped.add(line, format!("the texture of `{keyword}` cannot be read: {error}"));
                Arc::from([])
            }
            None => {
                let name = abridged(&name, "");
                skipped.add(line, format!("the texture {name} is outside the folder of the model, not read"));
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
        amount,
        channel,
        ..SourceMap::new(name, Arc::clone(bytes))
    })
}

fn is_texture(keyword: &str) -> bool {
    let is_map = keyword.strip_prefix("map_").is_some_and(|rest| rest.len() < 20);
    is_map || matches!(keyword, "disp" | "decal" | "refl")
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
