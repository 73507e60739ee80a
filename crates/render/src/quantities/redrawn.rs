//! A copy of the visible scene, drawn with other materials: so that what is not a colour can be read from a picture.

use crate::adapter::Adapter;
use crate::drawers::add_drawers;
use crate::headless::Headless;
use crate::jitter;
use crate::pending::{DrawnIn, draw_frame};
use crate::picture::{Picture, Pixels};
use bevy_app::{App, PostUpdate};
use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::ScheduleLabel;
use bevy_math::{Vec2, Vec4};
use bevy_platform::collections::HashMap;
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_asset::{AssetId, Assets, Handle};
use halfway_frame::error::RenderError;
use halfway_frame::view::camera::{PictureSize, View};
use halfway_frame::view::select::Visible;
use halfway_lighting::{
    AlphaMode, BackMaterial, Camera, Encoding, Faces, Frequency, GlobalAmbient, Intensity, Material, Samples, Shading,
    Terms, VertexColors,
};
use halfway_mesh::{Mesh, Mesh3d};
use halfway_texture::{Channel, MapKind, Maps, SolidTexture, SurfaceMap, Texture};
use image::Rgba32FImage;

/// The values that the copy of a scene shows in place of its colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Shows {
    /// The number of the nearest object and of its triangle, at the middle of each pixel; see [`numbers`]. Blended
    /// objects count as opaque ones.
    Numbers,
    /// The diffuse reflectance, by material, vertex colours, images and solids.
    Albedo,
    /// How much of the background is seen: 1 where there is nothing.
    Background,
}

/// The samples of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Taken {
    /// Those of the newest frame.
    InOneFrame,
    /// All that the camera asks for.
    All,
}

/// The world of the copy, kept from one picture to the next, with the meshes that it was made for.
#[derive(Resource)]
pub(super) struct Redrawn {
    world: World,
    /// The camera and the objects.
    entities: Vec<Entity>,
    meshes: HashMap<(AssetId<Mesh>, MeshCopy), (Mesh, Handle<Mesh>)>,
    images: HashMap<AssetId<Texture>, (Texture, Handle<Texture>)>,
}

/// How a mesh is copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum MeshCopy {
    AsItIs,
    /// With the numbers of triangles as colours; `masked` with texture coordinates, and `faded` with the opacities of its
    /// vertices.
    Numbered {
        masked: bool,
        faded: bool,
    },
}

type Objects = (
    &'static Mesh3d,
    &'static GlobalTransform,
    Option<&'static Material>,
    Option<&'static BackMaterial>,
    Option<&'static Shading>,
    Option<&'static Faces>,
    Option<&'static AlphaMode>,
    Option<&'static VertexColors>,
    Option<&'static Maps>,
    Option<&'static SolidTexture>,
);

/// The look of a copied object.
type Look = (Mesh3d, Material, BackMaterial, Shading, Faces, AlphaMode, VertexColors, Maps);

/// Each of two channels holds this many values of a triangle's number: so few that rounding cannot take one for another.
const VALUES: u32 = 4096;

/// The most triangles whose numbers fit.
const MOST_TRIANGLES: u64 = (VALUES as u64).pow(2);

/// The most objects whose numbers fit into f32.
const MOST_OBJECTS: u64 = 1 << 24;

/// Draws the objects that the newest frame of the world has seen, so that they show other values.
///
/// # Errors
/// [`RenderError::NoPicture`] before the first frame, [`RenderError::TooLarge`] where numbers do not fit, and those of
/// [`take_picture`](crate::take_picture).
pub(super) fn draw(world: &mut World, shows: Shows, samples: Taken) -> Result<Rgba32FImage, RenderError> {
    let mut redrawn = match world.remove_resource::<Redrawn>() {
        Some(redrawn) => redrawn,
        None => Redrawn::new(),
    };
    let picture = redrawn.draw(world, shows, samples);
    world.insert_resource(redrawn);
    picture
}

/// The number of the object, from 0, and that of its triangle, as a pixel of [`Shows::Numbers`] has them; `None` for the
/// background.
pub(super) fn numbers([high, low, object, _]: [f32; 4]) -> Option<[u32; 2]> {
    let [high, low] = [high, low].map(|value| (value * VALUES as f32).round() as u32);
    Some([(object.round() as u32).checked_sub(1)?, high * VALUES + low])
}

/// The colour of a triangle's number.
fn number_color(triangle: u32, opacity: f32) -> Vec4 {
    let share = |number: u32| number as f32 / VALUES as f32;
    Vec4::new(share(triangle / VALUES), share(triangle % VALUES), 1.0, opacity)
}

impl Redrawn {
    fn new() -> Self {
        let mut app = App::new();
        add_drawers(&mut app, PostUpdate.intern());
        app.insert_resource(DrawnIn(PostUpdate.intern())).insert_resource(GlobalAmbient(LinearRgba::WHITE));
        app.finish();
        app.cleanup();
        let world = std::mem::take(app.world_mut());
        Self { world, entities: Vec::new(), meshes: HashMap::default(), images: HashMap::default() }
    }

    fn draw(&mut self, world: &mut World, shows: Shows, samples: Taken) -> Result<Rgba32FImage, RenderError> {
        let adapter = Adapter::from_world(world).ok_or(RenderError::NoPicture)?;
        adapter.insert_into(&mut self.world);
        let size = world.get_resource::<PictureSize>().ok_or(RenderError::NoPicture)?.0;
        self.world.insert_resource(Headless { size, pixels: Pixels::Float });
        self.forget(world);
        let camera = self.place_camera(world, shows, samples)?;
        self.place_objects(world, shows, world.get::<Shading>(camera).copied().unwrap_or_default())?;
        let drawn = match jitter::side(&mut self.world) {
            Some(side) => jitter::averaged(&mut self.world, side, draw_frame),
            None => draw_frame(&mut self.world),
        };
        for entity in self.entities.drain(..) {
            self.world.despawn(entity);
        }
        match drawn? {
            Picture::Float(picture) => Ok(picture),
            Picture::Byte(_) => Err(RenderError::NoPicture),
        }
    }

    /// Forgets the copies of meshes and images that are gone or have changed.
    fn forget(&mut self, world: &World) {
        let meshes = world.get_resource::<Assets<Mesh>>();
        self.meshes.retain(|&(id, _), (source, _)| {
            meshes.and_then(|all| all.get(id)).is_some_and(|mesh| mesh.is_clone_of(source))
        });
        let images = world.get_resource::<Assets<Texture>>();
        self.images.retain(|&id, (source, _)| {
            images.and_then(|all| all.get(id)).is_some_and(|image| image.0.is_same(&source.0))
        });
    }

    /// Copies the camera whose turn it is, and returns it.
    fn place_camera(&mut self, world: &mut World, shows: Shows, samples: Taken) -> Result<Entity, RenderError> {
        let view = world.get_resource::<View>().ok_or(RenderError::NoPicture)?;
        let (camera, entity) = view.camera.zip(view.entity).ok_or(RenderError::NoPicture)?;
        let transform = *world.get::<GlobalTransform>(entity).ok_or(RenderError::NoCamera)?;
        let asked = world.get::<Camera>(entity).map_or(camera.samples, |camera| camera.samples);
        let camera = Camera {
            background: if shows == Shows::Background { LinearRgba::WHITE } else { LinearRgba::BLACK },
            background_below: None,
            background_opacity: 1.0,
            samples: match (shows, samples) {
                (Shows::Numbers, _) => Samples::One,
                (_, Taken::InOneFrame) => camera.samples,
                (_, Taken::All) => asked,
            },
            encoding: Encoding::Raw,
            intensity: Intensity::Clamp,
            ..camera
        };
        self.spawn(camera, transform);
        Ok(entity)
    }

    fn place_objects(&mut self, world: &mut World, shows: Shows, of_view: Shading) -> Result<(), RenderError> {
        let visible = world.get_resource::<Visible>().cloned().unwrap_or_default().0;
        if visible.len() as u64 > MOST_OBJECTS {
            return Err(too_large("the number of objects", visible.len() as u64, MOST_OBJECTS));
        }
        let mut objects = world.query::<Objects>();
        for (number, &entity) in (1_u32..).zip(&visible) {
            // An object that is gone since the newest frame keeps its number, and is not seen.
            let Ok((mesh, transform, material, back, shading, faces, alpha, colors, maps, solid)) =
                objects.get(world, entity)
            else {
                continue;
            };
            // A triangle that is shaded once has the mean of its corners' colours and opacities.
            let is_flat = Terms::from(shading.copied().unwrap_or(of_view)).has(Frequency::Triangle);
            let shading = if is_flat { Shading::Flat } else { Shading::Phong };
            let front = *material.unwrap_or(&Material::DEFAULT);
            let back = back.map_or(front, |back| back.0);
            let alpha = alpha.copied().unwrap_or_default();
            let colors = colors.copied().unwrap_or_default();
            let dressed = |material: Material| dressed(material, shows, number);
            let (copy, alpha) = match shows {
                Shows::Numbers => {
                    let cutoff = alpha.cutoff();
                    let copy = MeshCopy::Numbered {
                        masked: cutoff.is_some(),
                        faded: cutoff.is_some() && colors != VertexColors::Ignore,
                    };
                    (copy, AlphaMode::new(cutoff, false))
                }
                Shows::Albedo | Shows::Background => (MeshCopy::AsItIs, alpha),
            };
            let colors = if shows == Shows::Numbers { VertexColors::Multiply } else { colors };
            let Some(handle) = self.mesh(world, mesh.0.id(), copy)? else { continue };
            let maps = maps.map(|maps| self.maps(world, maps, shows)).unwrap_or_default();
            let faces = faces.copied().unwrap_or_default();
            let sides = (dressed(front), BackMaterial(dressed(back)));
            let look: Look = (Mesh3d(handle), sides.0, sides.1, shading, faces, alpha, colors, maps);
            let solid = solid.filter(|_| shows == Shows::Albedo).copied();
            let copied = self.spawn(look, *transform);
            if let Some(solid) = solid {
                self.world.entity_mut(copied).insert(solid);
            }
        }
        Ok(())
    }

    /// An entity that is placed by its `GlobalTransform` alone, since nothing propagates here.
    fn spawn(&mut self, bundle: impl Bundle, transform: GlobalTransform) -> Entity {
        let mut entity = self.world.spawn(bundle);
        entity.remove::<Transform>();
        let entity = entity.insert(transform).id();
        self.entities.push(entity);
        entity
    }

    /// The copy of a mesh; `None` where it is not there.
    fn mesh(&mut self, world: &World, id: AssetId<Mesh>, copy: MeshCopy) -> Result<Option<Handle<Mesh>>, RenderError> {
        if let Some((_, handle)) = self.meshes.get(&(id, copy)) {
            return Ok(Some(handle.clone()));
        }
        let Some(mesh) = world.get_resource::<Assets<Mesh>>().and_then(|meshes| meshes.get(id)) else {
            return Ok(None);
        };
        let copied = match copy {
            MeshCopy::AsItIs => mesh.clone(),
            MeshCopy::Numbered { masked, faded } => numbered(mesh, masked, faded)?,
        };
        let handle = self.world.resource_mut::<Assets<Mesh>>().add(copied);
        self.meshes.insert((id, copy), (mesh.clone(), handle.clone()));
        Ok(Some(handle))
    }

    /// The images that count: those that set the opacity, and for the albedo the colour.
    fn maps(&mut self, world: &World, maps: &Maps, shows: Shows) -> Maps {
        let mut kept = Maps::default();
        let color = maps.get(MapKind::Color);
        if shows == Shows::Albedo {
            kept.set(MapKind::Color, color.map(|map| self.map(world, map)));
        }
        let opacity = maps.get(MapKind::Opacity).cloned();
        // Without the colours of its image, the opacity still comes from their alpha.
        let alpha = || {
            color.filter(|_| shows != Shows::Albedo).map(|map| SurfaceMap { channel: Channel::Alpha, ..map.clone() })
        };
        let opacity = opacity.or_else(alpha);
        kept.set(MapKind::Opacity, opacity.map(|map| self.map(world, &map)));
        kept
    }

    fn map(&mut self, world: &World, map: &SurfaceMap) -> SurfaceMap {
        let id = map.texture.id();
        let image = world.get_resource::<Assets<Texture>>().and_then(|images| images.get(id));
        let texture = match (self.images.get(&id), image) {
            (Some((_, handle)), _) => handle.clone(),
            (None, Some(image)) => {
                let handle = self.world.resource_mut::<Assets<Texture>>().add(image.clone());
                self.images.insert(id, (image.clone(), handle.clone()));
                handle
            }
            (None, None) => Handle::default(),
        };
        SurfaceMap { texture, ..map.clone() }
    }
}

/// A material that shows a value, under white ambient light and no other.
fn dressed(material: Material, shows: Shows, number: u32) -> Material {
    let ambient = match shows {
        Shows::Numbers => LinearRgba::rgb(1.0, 1.0, number as f32),
        Shows::Albedo => material.diffuse,
        Shows::Background => LinearRgba::BLACK,
    };
    let black = LinearRgba::BLACK;
    Material { ambient, diffuse: black, specular: black, emission: black, ..material }
}

/// The triangles of a mesh, each with vertices of its own, whose colour is the triangle's number.
fn numbered(mesh: &Mesh, masked: bool, faded: bool) -> Result<Mesh, RenderError> {
    let triangles = mesh.triangle_count() as u64;
    if triangles > MOST_TRIANGLES {
        return Err(too_large("the number of a mesh's triangles", triangles, MOST_TRIANGLES));
    }
    let corners = || mesh.triangles().flatten().map(|vertex| vertex as usize);
    let at_corners = |uvs: &[Vec2]| corners().map(|vertex| uvs[vertex]).collect::<Vec<_>>();
    let opacities = mesh.drawn_colors().filter(|_| faded);
    let opacity = |vertex: usize| opacities.as_ref().map_or(1.0, |colors| colors[vertex].w);
    let colors = corners().enumerate().map(|(corner, vertex)| number_color(corner as u32 / 3, opacity(vertex)));
    let positions: Vec<_> = corners().map(|vertex| mesh.positions()[vertex]).collect();
    let normals: Vec<_> = corners().map(|vertex| mesh.normals()[vertex]).collect();
    let uvs = mesh.uvs().filter(|_| masked).map(at_corners);
    let count = positions.len() as u32;
    let copied = Mesh::from_parts(positions, Some(normals), uvs, (0..count).collect())
        .and_then(|copied| copied.with_colors(colors.collect()))
        .and_then(|copied| match mesh.uv_set(1).filter(|_| masked) {
            Some(uvs) => copied.with_second_uvs(at_corners(uvs)),
            None => Ok(copied),
        });
    copied.map_err(|_| too_large("the number of a mesh's corners", 3 * triangles, u64::from(u32::MAX)))
}

fn too_large(what: &str, needed: u64, limit: u64) -> RenderError {
    RenderError::TooLarge { what: format!("{what} in a picture of numbers"), needed, limit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_survive_rounding() {
        for triangle in [0, 1, VALUES - 1, VALUES, 7 * VALUES + 11, MOST_TRIANGLES as u32 - 1] {
            for object in [0, 1, 1000, MOST_OBJECTS as u32 - 1] {
                for error in [-1e-6, 0.0, 1e-6] {
                    let [high, low, one, _] = number_color(triangle, 1.0).to_array();
                    let pixel = [high * (1.0 + error), low * (1.0 + error), one * (object + 1) as f32, 1.0];
                    assert_eq!(numbers(pixel), Some([object, triangle]));
                }
            }
        }
        assert_eq!(numbers([0.0, 0.0, 0.0, 1.0]), None);
    }
}
