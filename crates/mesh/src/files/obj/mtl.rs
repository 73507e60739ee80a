//! Wavefront MTL: the statements that describe a material's reflectance.

use std::collections::HashMap;
use std::iter::Peekable;
use std::sync::Arc;

use crate::files::LoadError;
use crate::files::source::{ModelFolder, Reader};
use crate::files::text::{Skipped, Statement, Statements, abridged};
use crate::{MtlMaps, MtlMaterial, SourceChannel, SourceMap, SourceMaterial, SourceWrap};

/// Appends the materials of the library that an OBJ file calls `name`. One that is missing, or may not be read, is a
/// warning.
pub(super) fn read_library(
    name: &str,
    around: ModelFolder,
    materials: &mut Vec<SourceMaterial>,
    warnings: &mut Vec<String>,
) -> Result<(), LoadError> {
    let Some(library) = around.find(name) else {
        warnings.push(format!("{}: outside the folder of the model, not read", abridged(name, "")));
        return Ok(());
    };
    match around.open(&library) {
        Ok(reader) => {
            let beside = name.rfind('/').map_or("", |slash| &name[..=slash]);
            warnings.extend(parse(reader, &Images { around, beside }, materials)?);
        }
        Err(error) => warnings.push(error.to_string()),
    }
    Ok(())
}

/// Appends the materials of an MTL file. A statement that is malformed or skipped is a warning.
///
/// - `Ka Kd Ks Ke`: three numbers from 0 on, or one for all three; spectra (`spectral`, `xyz`) are skipped.
/// - `Ns d Tr`: a number from 0 on; `d -halo` is skipped.
/// - `Pr Pm`: a number from 0 to 1.
/// - `illum`: a number from 0 to 255.
/// - `map_Kd map_Ks map_Ke map_d map_Ns norm map_Bump` (also `map_bump`, `bump`): options `-s -o -clamp -imfchan`, of
///   bumps `-bm`, and a file; other options are skipped. `map_Ka` may repeat `map_Kd`, whose image multiplies `Ka`, too.
/// - Other textures and statements are skipped. `Ni` and `sharpness` say nothing without refraction and reflection, of
///   which `illum` warns, and are skipped in silence, as is a `Tf` of 1.
fn parse(reader: Reader, images: &Images, materials: &mut Vec<SourceMaterial>) -> Result<Vec<String>, LoadError> {
    let mut read = HashMap::new();
    let path = reader.path().to_owned();
    let mut lines = Statements::new(reader, false);
    let mut skipped = Skipped::default();
    let mut current: Option<Draft> = None;
    while let Some(statement) = lines.next()? {
        if statement.keyword == "newmtl" {
            materials.extend(current.take().map(|draft| draft.finish(&mut skipped)));
            if statement.rest.is_empty() {
                leave_out(statement.unexpected("`newmtl` and a name is"), statement.line, &mut skipped)?;
            } else {
                current = Some(Draft::new(statement.rest));
            }
        } else if matches!(statement.keyword, "Ni" | "sharpness") {
        } else if let Some(draft) = &mut current {
            if let Some(place) = map_place(statement.keyword) {
                if let Some(map) = map(&statement, images, &mut read, &mut skipped) {
                    *place(&mut draft.material.maps) = Some(map);
                }
            } else if statement.keyword == "map_Ka" {
                draft.ambient = Some((statement.line, image_name(&statement)));
            } else if let Err(error) = set(&mut draft.material, &statement, &mut skipped) {
                leave_out(error, statement.line, &mut skipped)?;
            }
        } else {
            leave_out(statement.unexpected("`newmtl` and a name before it is"), statement.line, &mut skipped)?;
        }
    }
    materials.extend(current.map(|draft| draft.finish(&mut skipped)));
    lines.warn_of_encoding(&mut skipped);
    Ok(skipped.warnings(&path))
}

/// Turns the error of a statement into a warning.
fn leave_out(error: LoadError, line: usize, skipped: &mut Skipped) -> Result<(), LoadError> {
    let LoadError::Line { found, expected, .. } = error else { return Err(error) };
    skipped.add(line, format!("{found}; {expected} expected, and the statement is skipped"));
    Ok(())
}

/// A material, as far as it was read.
struct Draft {
    material: MtlMaterial,
    /// The line of `map_Ka`, and its file.
    ambient: Option<(usize, String)>,
}

impl Draft {
    fn new(name: &str) -> Self {
        Self { material: MtlMaterial { name: name.to_owned(), ..MtlMaterial::default() }, ambient: None }
    }

    fn finish(self, skipped: &mut Skipped) -> SourceMaterial {
        let Self { material, ambient } = self;
        // The image of `map_Kd` multiplies the ambient reflectance, too.
        if let Some((line, name)) = ambient
            && material.maps.kd.as_ref().is_none_or(|kd| kd.name != name)
        {
            skipped.add(line, "the texture `map_Ka` is skipped");
        }
        SourceMaterial::Mtl(material)
    }
}

/// Where the images of a library are looked for.
struct Images<'a> {
    around: ModelFolder<'a>,
    /// The folder of the library as seen from the model's, with a slash at its end; empty for the same.
    beside: &'a str,
}

impl Images<'_> {
    /// The bytes of an image, beside the library or beside the model; of a name with folders that lead nowhere, those of
    /// the file of that name there. What is to be said of it is added.
    fn read(&self, name: &str, statement: &Statement, skipped: &mut Skipped) -> Arc<[u8]> {
        let (line, keyword) = (statement.line, statement.keyword);
        let last = name.rsplit('/').next().unwrap_or(name);
        let at_hand = |name: &str| {
            let [library, model] = [self.beside, ""].map(|folder| self.around.find(&format!("{folder}{name}")));
            [library, model].into_iter().flatten().find(|path| path.is_file())
        };
        let found = at_hand(name).or_else(|| {
            let found = at_hand(last)?;
            let name = abridged(name, "");
            skipped.add(line, format!("the texture {name} of `{keyword}` is not there; {} is read", found.display()));
            Some(found)
        });
        let Some(path) = found.or_else(|| self.around.find(name)) else {
            let name = abridged(name, "");
            skipped.add(line, format!("the texture {name} is outside the folder of the model, not read"));
            return Arc::from([]);
        };
        self.around.open(&path).and_then(Reader::whole).map_or_else(
            |error| {
                skipped.add(line, format!("the texture of `{keyword}` cannot be read: {error}"));
                Arc::from([])
            },
            Arc::from,
        )
    }
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
    images: &Images,
    read: &mut HashMap<String, Arc<[u8]>>,
    skipped: &mut Skipped,
) -> Option<SourceMap> {
    let mut words = statement.words().peekable();
    let MapOptions { scale, offset, clamp, amount, channel } = MapOptions::read(&mut words, statement, skipped);
    let name = file_name(words);
    if name.is_empty() {
        skipped.add(statement.line, format!("`{}` without a file is skipped", statement.keyword));
        return None;
    }
    let bytes = read.entry(name.clone()).or_insert_with(|| images.read(&name, statement, skipped));
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

/// The words of a file's name, with the slashes that every system knows.
fn file_name<'a>(words: impl Iterator<Item = &'a str>) -> String {
    words.collect::<Vec<_>>().join(" ").replace('\\', "/")
}

/// The file of a statement whose options say nothing here.
fn image_name(statement: &Statement) -> String {
    let mut words = statement.words().peekable();
    MapOptions::read(&mut words, statement, &mut Skipped::default());
    file_name(words)
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
        "Pr" => material.pr = Some(fraction(statement)?),
        "Pm" => material.pm = Some(fraction(statement)?),
        "illum" => {
            const EXPECTED: &str = "`illum` and a number from 0 to 255 is";
            let [number] = statement.exactly(EXPECTED)?;
            material.illum = Some(number.parse().map_err(|_| statement.unexpected(EXPECTED))?);
        }
        "Tf" if statement.words().all(|word| word.parse() == Ok(1.0)) => {}
        texture if is_texture(texture) => skipped.add(statement.line, format!("the texture `{texture}` is skipped")),
        _ => skipped.add_statement(statement),
    }
    Ok(())
}

/// The largest channel of a colour, as materials have it.
const BRIGHTEST: f32 = 1e12;

fn color(statement: &Statement, skipped: &mut Skipped) -> Result<Option<[f32; 3]>, LoadError> {
    if let Some(kind @ ("spectral" | "xyz")) = statement.words().next() {
        skipped.add(statement.line, format!("`{} {kind}` is skipped", statement.keyword));
        return Ok(None);
    }
    let ([r, g, b], count) = statement.numbers(&[1, 3], "a colour of three numbers is")?;
    if [r, g, b].iter().any(|channel| !(0.0..=BRIGHTEST).contains(channel)) {
        return Err(statement.unexpected("a colour of three numbers from 0 to 10¹² is"));
    }
    Ok(Some(if count == 1 { [r; 3] } else { [r, g, b] }))
}

fn scalar(statement: &Statement, skipped: &mut Skipped) -> Result<Option<f32>, LoadError> {
    if statement.words().next() == Some("-halo") {
        skipped.add(statement.line, "`d -halo` is skipped");
        return Ok(None);
    }
    let [word] = statement.exactly("one number is")?;
    let number = statement.number(word)?;
    if number < 0.0 {
        return Err(statement.unexpected("a number from 0 on is"));
    }
    Ok(Some(number))
}

fn fraction(statement: &Statement) -> Result<f32, LoadError> {
    let [word] = statement.exactly("one number is")?;
    let number = statement.number(word)?;
    if !(0.0..=1.0).contains(&number) {
        return Err(statement.unexpected("a number from 0 to 1 is"));
    }
    Ok(number)
}
