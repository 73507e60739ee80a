//! 3MF (3MF Consortium, core specification 1.3, materials extension 1.2, production extension 1.1): meshes in XML within
//! a zip archive.

mod assemble;
mod failure;
mod package;
mod xml;

use std::collections::HashMap;

use glam::{DMat4, DVec3};

use self::assemble::Assembly;
use self::failure::Failure;
use self::package::Package;
use self::xml::{Element, Elements};
use super::LoadError;
use super::source::{Source, stem};
use super::srgb::decoded;
use super::text::abridged;
use crate::Model;

/// Reads the items of the build: objects of triangles, their components and transforms, base materials and colour
/// groups. Lengths are in millimetres, whatever the unit of the file. Resources of other kinds are skipped with a warning.
pub(super) fn parse(source: Source) -> Result<Model, LoadError> {
    let path = source.path;
    let read = source.reader.whole().map_err(Failure::from).and_then(|bytes| read(bytes, &stem(path)));
    read.map_err(|failure| failure.for_file(path))
}

fn read(bytes: Vec<u8>, name: &str) -> Result<Model, Failure> {
    let mut assembly = Assembly::new(bytes.len(), name);
    let mut package = Package::new(bytes)?;
    let root = package.root()?;
    let mut document = Document::default();
    let items = document.read(&root, &mut package, true)?;
    let world_from_build = DMat4::from_scale(DVec3::splat(document.millimetres));
    for item in &items {
        document.place(item, world_from_build, 0, &mut package, &mut assembly)?;
    }
    assembly.into_model(&document)
}

/// How deep components may lie in components.
const DEPTH: usize = 32;

/// The characters of a name that are kept.
const LONGEST_NAME: usize = 100;

/// A part of the package, and a number that it gives.
type Id = (String, u32);

/// The resources of all parts of the package that were read.
#[derive(Default)]
struct Document {
    objects: HashMap<Id, Object>,
    groups: HashMap<Id, Group>,
    /// The parts that were read.
    parts: Vec<String>,
    /// How many millimetres the unit of the root has.
    millimetres: f64,
    warnings: Vec<String>,
}

/// An object: a mesh, or others at their places.
#[derive(Default)]
struct Object {
    name: String,
    /// The property of triangles that name none: a group and a number in it.
    property: Option<(u32, u32)>,
    vertices: Vec<DVec3>,
    triangles: Vec<Triangle>,
    components: Vec<Reference>,
}

struct Triangle {
    corners: [u32; 3],
    /// A group of properties, if not the object's.
    group: Option<u32>,
    /// The number in the group for each corner, if not the object's.
    numbers: Option<[u32; 3]>,
}

/// Properties that triangles refer to.
enum Group {
    /// Names and colours.
    Materials(Vec<(String, [f32; 4])>),
    /// Colours.
    Colors(Vec<[f32; 4]>),
    /// Those of a kind that is skipped.
    Other,
}

/// An object at a place.
#[derive(Clone)]
struct Reference {
    object: Id,
    transform: DMat4,
}

impl Document {
    /// Reads a part of the package, and returns the items of its build.
    fn read(&mut self, part: &str, package: &mut Package, is_root: bool) -> Result<Vec<Reference>, Failure> {
        let mut elements = package.open(part)?;
        let mut items = Vec::new();
        let mut in_build = false;
        self.parts.push(part.to_owned());
        while let Some(element) = elements.next()? {
            match element.name.as_str() {
                "model" => {
                    let millimetres = millimetres(&element)?;
                    if is_root {
                        self.millimetres = millimetres;
                    } else if millimetres.to_bits() != self.millimetres.to_bits() {
                        return Err(element.failure("another unit", "the unit of the first part is"));
                    }
                    self.warn_of_extensions(&element);
                }
                "basematerials" | "colorgroup" => {
                    let id = element.number("id")?;
                    let group = group(&element, &mut elements)?;
                    self.groups.insert((part.to_owned(), id), group);
                }
                "texture2dgroup" | "compositematerials" | "multiproperties" => {
                    self.warn(format!("`{}` is skipped", element.name));
                    self.groups.insert((part.to_owned(), element.number("id")?), Group::Other);
                    elements.skip(&element)?;
                }
                "texture2d" | "slicestack" | "displacement2d" => {
                    self.warn(format!("`{}` is skipped", element.name));
                    elements.skip(&element)?;
                }
                "object" => {
                    let id = element.number("id")?;
                    let object = self.object(&element, part, &mut elements)?;
                    if self.objects.insert((part.to_owned(), id), object).is_some() {
                        return Err(element.failure(&format!("a second object {id}"), "one of each number is"));
                    }
                }
                "build" => in_build = true,
                "item" if in_build => items.push(reference(&element, part)?),
                _ => {}
            }
        }
        Ok(items)
    }

    /// An object of `Elements` up to its end.
    fn object(&mut self, element: &Element, part: &str, elements: &mut Elements) -> Result<Object, Failure> {
        let property = match element.optional("pid")? {
            Some(group) => Some((group, element.optional("pindex")?.unwrap_or(0))),
            None => None,
        };
        // Each part that shows it has the name.
        let name = element.get("name").unwrap_or_default().chars().take(LONGEST_NAME).collect();
        let mut object = Object { name, property, ..Object::default() };
        if let Some(kind @ ("support" | "surface" | "other")) = element.get("type") {
            self.warn(format!("objects of the type `{kind}` are shown as others are"));
        }
        while let Some(inner) = elements.next_within(element)? {
            match inner.name.as_str() {
                "vertex" => {
                    let [x, y, z] = [inner.real("x")?, inner.real("y")?, inner.real("z")?];
                    object.vertices.push(DVec3::new(x, y, z));
                }
                "triangle" => object.triangles.push(triangle(&inner, object.vertices.len())?),
                "component" => object.components.push(reference(&inner, part)?),
                "beamlattice" => {
                    self.warn("`beamlattice` is skipped".to_owned());
                    elements.skip(&inner)?;
                }
                "trianglesets" | "metadatagroup" => elements.skip(&inner)?,
                _ => {}
            }
        }
        Ok(object)
    }

    /// Adds an object and those that it is made of.
    fn place(
        &mut self,
        reference: &Reference,
        world: DMat4,
        depth: usize,
        package: &mut Package,
        assembly: &mut Assembly,
    ) -> Result<(), Failure> {
        let Reference { object: id, transform } = reference;
        let world = world * *transform;
        if depth > DEPTH {
            return Err(Failure::new("components", format!("more than {DEPTH} in one another"), "fewer are"));
        }
        if !world.is_finite() {
            return Err(Failure::new("transform", "numbers beyond f64".to_owned(), "finite numbers are"));
        }
        if !self.parts.contains(&id.0) {
            let items = self.read(&id.0.clone(), package, false)?;
            if !items.is_empty() {
                self.warn(format!("the build of {} is skipped", id.0));
            }
        }
        let Some(object) = self.objects.get(id) else {
            return Err(Failure::new(
                "build",
                format!("the object {} of {}", id.1, id.0),
                "an object that is there is",
            ));
        };
        if !object.triangles.is_empty() {
            assembly.add(id, world)?;
        }
        for component in object.components.clone() {
            assembly.count()?;
            self.place(&component, world, depth + 1, package, assembly)?;
        }
        Ok(())
    }

    /// Warns of extensions that a reader has to know.
    fn warn_of_extensions(&mut self, element: &Element) {
        const KNOWN: [&str; 2] = [
            "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
            "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
        ];
        let required = element.get("requiredextensions").unwrap_or_default();
        for prefix in required.split_ascii_whitespace() {
            let namespace = element.get(&format!("xmlns:{prefix}")).unwrap_or(prefix);
            if !KNOWN.contains(&namespace) {
                self.warn(format!("the required extension {} is not read", abridged(namespace, "")));
            }
        }
    }

    /// Adds a sentence once, as long as there are few.
    fn warn(&mut self, what: String) {
        if self.warnings.len() < 20 && !self.warnings.contains(&what) {
            self.warnings.push(what);
        }
    }
}

fn millimetres(element: &Element) -> Result<f64, Failure> {
    match element.get("unit") {
        None | Some("millimeter") => Ok(1.0),
        Some("micron") => Ok(1e-3),
        Some("centimeter") => Ok(10.0),
        Some("inch") => Ok(25.4),
        Some("foot") => Ok(304.8),
        Some("meter") => Ok(1000.0),
        Some(other) => {
            Err(element
                .failure(&format!("the unit `{other}`"), "micron, millimeter, centimeter, inch, foot or meter is"))
        }
    }
}

fn group(element: &Element, elements: &mut Elements) -> Result<Group, Failure> {
    let (mut materials, mut colors) = (Vec::new(), Vec::new());
    while let Some(inner) = elements.next_within(element)? {
        match inner.name.as_str() {
            "base" => {
                materials.push((inner.get("name").unwrap_or_default().to_owned(), color(&inner, "displaycolor")?));
            }
            "color" => colors.push(color(&inner, "color")?),
            _ => {}
        }
    }
    Ok(if element.name == "basematerials" { Group::Materials(materials) } else { Group::Colors(colors) })
}

/// `#RRGGBB` or `#RRGGBBAA` in sRGB, as linear numbers.
fn color(element: &Element, key: &str) -> Result<[f32; 4], Failure> {
    let text = element.required(key)?;
    let digits = text.strip_prefix('#').filter(|digits| matches!(digits.len(), 6 | 8) && digits.is_ascii());
    let value = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
    let Some(value) = value else {
        return Err(element.failure(&format!("`{key}` {text:?}"), "a colour as #RRGGBB or #RRGGBBAA is"));
    };
    let value = if text.len() == 7 { value << 8 | 0xFF } else { value };
    let [r, g, b, a] = value.to_be_bytes().map(|byte| f32::from(byte) / 255.0);
    Ok([decoded(r), decoded(g), decoded(b), a])
}

fn triangle(element: &Element, vertices: usize) -> Result<Triangle, Failure> {
    let corners = [element.number("v1")?, element.number("v2")?, element.number("v3")?];
    if let Some(wrong) = corners.iter().find(|corner| **corner as usize >= vertices) {
        let expected = format!("one of the {vertices} vertices before it, counted from 0, is");
        return Err(element.failure(&format!("the vertex {wrong}"), &expected));
    }
    let group = element.optional("pid")?;
    let numbers = match element.optional("p1")? {
        None => None,
        Some(first) => {
            Some([first, element.optional("p2")?.unwrap_or(first), element.optional("p3")?.unwrap_or(first)])
        }
    };
    Ok(Triangle { corners, group, numbers })
}

/// An `item` or a `component`.
fn reference(element: &Element, part: &str) -> Result<Reference, Failure> {
    let place = element.get("path").map_or(part, |path| path.trim_start_matches('/')).to_owned();
    let transform = match element.get("transform") {
        None => DMat4::IDENTITY,
        Some(text) => {
            let numbers: Option<Vec<f64>> = text.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
            let Some(&[ax, ay, az, bx, by, bz, cx, cy, cz, x, y, z]) = numbers.as_deref() else {
                return Err(element.failure("`transform`", "twelve numbers are"));
            };
            // Rows of the file are what the axes become.
            DMat4::from_cols_array(&[ax, ay, az, 0.0, bx, by, bz, 0.0, cx, cy, cz, 0.0, x, y, z, 1.0])
        }
    };
    if !transform.is_finite() {
        return Err(element.failure("`transform`", "twelve finite numbers are"));
    }
    Ok(Reference { object: (place, element.number("objectid")?), transform })
}
