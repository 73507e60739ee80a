//! Meshes of the objects that are built.

use std::collections::{BTreeMap, HashMap};

use glam::{DMat4, DVec3, Mat4, Vec3, Vec4};

use super::failure::Failure;
use super::{Document, Group, Id, Object};
use crate::numbering::Numbering;
use crate::{Mesh, Model, MtlMaterial, Part, SourceMaterial, origin_of_box};

/// How many objects are placed at most: so many, and one for so many bytes of the file.
const MOST_PLACED: usize = 256;
const BYTES_EACH: usize = 4;

/// The objects of the build at their places.
pub(super) struct Assembly {
    /// The name of objects without one.
    name: String,
    placed: Vec<(Id, DMat4)>,
    count: usize,
    most: usize,
}

impl Assembly {
    /// Of a file of so many bytes.
    pub(super) fn new(bytes: usize, name: &str) -> Self {
        Self { name: name.to_owned(), placed: Vec::new(), count: 0, most: MOST_PLACED + bytes / BYTES_EACH }
    }

    pub(super) fn add(&mut self, object: &Id, world: DMat4) -> Result<(), Failure> {
        self.placed.push((object.clone(), world));
        self.count()
    }

    /// Counts an object or a component: components of components multiply.
    pub(super) fn count(&mut self) -> Result<(), Failure> {
        self.count += 1;
        if self.count > self.most {
            let expected = format!("at most {} of them for a file of this size are", self.most);
            return Err(Failure::new("build", "components within components".to_owned(), &expected));
        }
        Ok(())
    }

    pub(super) fn into_model(self, document: &Document) -> Result<Model, Failure> {
        let mut materials = Materials { all: Vec::new(), numbers: HashMap::new(), missing: 0 };
        let mut built: HashMap<&Id, Built> = HashMap::new();
        for (id, _) in &self.placed {
            if !built.contains_key(id) {
                built.insert(id, Built::new(id, &document.objects[id], document, &mut materials)?);
            }
        }
        let corners = self.placed.iter().flat_map(|(id, world)| built[id].corners().map(|p| world.transform_point3(p)));
        let all = corners.map(|p| [p, p]).reduce(|[min, max], [p, _]| [min.min(p), max.max(p)]);
        let origin = all.map_or(DVec3::ZERO, |[min, max]| origin_of_box(min, max));
        let mut parts = Vec::new();
        for (id, world) in &self.placed {
            let Built { origin: own, meshes, .. } = &built[id];
            let matrix = DMat4::from_translation(-origin) * *world * DMat4::from_translation(*own);
            let world_from_part: Mat4 = matrix.as_mat4();
            if !world_from_part.is_finite() {
                return Err(Failure::new("build", "an object beyond f32".to_owned(), "finite positions are"));
            }
            let name = &document.objects[id].name;
            let name = if name.is_empty() { &self.name } else { name };
            for (mesh, material) in meshes {
                let (name, mesh, material) = (name.clone(), mesh.clone(), *material);
                parts.push(Part { name, mesh, material, world_from_part });
            }
        }
        let mut warnings = document.warnings.clone();
        if materials.missing > 0 {
            warnings.push(format!("the properties of {} triangles are not there", materials.missing));
        }
        Ok(Model { origin, parts, materials: materials.all, warnings, ..Model::default() })
    }
}

/// An object's meshes, one for each of its materials, with their box and the place that they are counted from.
struct Built {
    origin: DVec3,
    extent: [DVec3; 2],
    meshes: Vec<(Mesh, Option<usize>)>,
}

/// The triangles of one material.
#[derive(Default)]
struct Draft {
    corners: Vec<u32>,
    /// The colour of each corner; empty as long as there are none.
    colors: Vec<[f32; 4]>,
}

impl Built {
    fn new(id: &Id, object: &Object, document: &Document, materials: &mut Materials) -> Result<Self, Failure> {
        let mut drafts: BTreeMap<Option<usize>, Draft> = BTreeMap::new();
        for triangle in &object.triangles {
            let group = triangle.group.or(object.property.map(|(group, _)| group));
            // The number of the object counts in its own group.
            let own = object.property.filter(|(own, _)| Some(*own) == group).map(|(_, number)| [number; 3]);
            let (material, colors) = match group.zip(triangle.numbers.or(own)) {
                Some((group, numbers)) => materials.properties(document, (id.0.clone(), group), numbers),
                None => (None, None),
            };
            let draft = drafts.entry(material).or_default();
            if let Some(colors) = colors {
                draft.colors.resize(draft.corners.len(), [1.0; 4]);
                draft.colors.extend(colors);
            }
            draft.corners.extend(triangle.corners);
        }
        let used = || object.triangles.iter().flat_map(|it| it.corners).map(|corner| object.vertices[corner as usize]);
        let extent = [used().reduce(DVec3::min), used().reduce(DVec3::max)].map(Option::unwrap_or_default);
        let origin = origin_of_box(extent[0], extent[1]);
        let mut meshes = Vec::new();
        for (material, draft) in drafts {
            meshes.push((draft.mesh(object, origin, id)?, material));
        }
        Ok(Self { origin, extent, meshes })
    }

    /// The corners of the box.
    fn corners(&self) -> [DVec3; 8] {
        let ends = self.extent;
        std::array::from_fn(|i| DVec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z))
    }
}

impl Draft {
    fn mesh(mut self, object: &Object, origin: DVec3, id: &Id) -> Result<Mesh, Failure> {
        let has_colors = !self.colors.is_empty();
        if has_colors {
            self.colors.resize(self.corners.len(), [1.0; 4]);
        }
        let Self { corners, colors } = self;
        let color = |corner: usize| colors.get(corner).copied().unwrap_or_default();
        let key = |corner: usize| {
            let [r, g, b, a] = color(corner).map(f32::to_bits);
            [corners[corner], r, g, b, a]
        };
        let Numbering { numbers, firsts } = Numbering::new(corners.len(), key);
        let position = |first: &u32| (object.vertices[corners[*first as usize] as usize] - origin).as_vec3();
        let positions: Vec<Vec3> = firsts.iter().map(position).collect();
        let mesh = Mesh::new(positions, numbers).and_then(|mesh| {
            if !has_colors {
                return Ok(mesh);
            }
            mesh.with_colors(firsts.iter().map(|&first| Vec4::from(color(first as usize))).collect())
        });
        mesh.map_err(|error| Failure::new(&format!("{}: object {}", id.0, id.1), error.to_string(), "a valid mesh is"))
    }
}

/// The materials of the model.
struct Materials {
    all: Vec<SourceMaterial>,
    /// By their group and number.
    numbers: HashMap<(Id, u32), usize>,
    /// How many triangles refer to what is not there.
    missing: usize,
}

impl Materials {
    /// The material of a triangle, or the colours of its corners.
    fn properties(
        &mut self,
        document: &Document,
        group: Id,
        numbers: [u32; 3],
    ) -> (Option<usize>, Option<[[f32; 4]; 3]>) {
        match document.groups.get(&group) {
            Some(Group::Materials(materials)) => {
                let Some((name, color)) = materials.get(numbers[0] as usize) else {
                    self.missing += 1;
                    return (None, None);
                };
                let Self { all, numbers: known, .. } = self;
                let index = *known.entry((group, numbers[0])).or_insert_with(|| {
                    all.push(SourceMaterial::Mtl(material(name, *color)));
                    all.len() - 1
                });
                (Some(index), None)
            }
            Some(Group::Colors(colors)) => {
                let found = numbers.map(|number| colors.get(number as usize).copied());
                if let [Some(a), Some(b), Some(c)] = found {
                    return (None, Some([a, b, c]));
                }
                self.missing += 1;
                (None, None)
            }
            // Of its kind there is a warning.
            Some(Group::Other) => (None, None),
            None => {
                self.missing += 1;
                (None, None)
            }
        }
    }
}

/// A matte material of this colour.
fn material(name: &str, [r, g, b, a]: [f32; 4]) -> MtlMaterial {
    let (ka, kd) = (Some([r, g, b]), Some([r, g, b]));
    MtlMaterial { name: name.to_owned(), ka, kd, d: (a < 1.0).then_some(a), ..MtlMaterial::default() }
}
