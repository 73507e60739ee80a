//! The visible objects, as their components and the view say.

use crate::batch::key::MapLooks;
use crate::batch::object::{Reflecting, wrong_paint};
use crate::batch::table::MapsUse;
use crate::geometry::meshes::{Form, Geometries, Geometry, Paint, PaintComponents};
use crate::lights::surroundings::Surroundings;
use crate::lights::terms::shown_shading;
use crate::view::camera::View;
use crate::view::looks::Surface;
use crate::view::select::Visible;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use halfway_asset::{AssetId, Assets};
use halfway_lighting::{BackMaterial, Faces, InvalidValue, Material, Reflectance, Shading, Terms, Tolerance};
use halfway_mesh::{Mesh, Mesh3d};

type ObjectComponents = (
    &'static Mesh3d,
    Option<&'static Material>,
    Option<&'static BackMaterial>,
    Option<&'static Reflectance>,
    Option<&'static Faces>,
    PaintComponents,
    Option<&'static Tolerance>,
    Option<&'static Shading>,
    Option<&'static Name>,
);

/// The objects that are shown, with their components.
#[derive(SystemParam)]
pub struct ShownObjects<'w, 's> {
    objects: Query<'w, 's, ObjectComponents>,
    meshes: Res<'w, Assets<Mesh>>,
    pub(super) geometries: Res<'w, Geometries>,
    visible: Res<'w, Visible>,
    pub(super) view: Res<'w, View>,
    pub(super) surroundings: Res<'w, Surroundings>,
}

/// One of them.
pub(super) struct ShownObject<'a> {
    pub(super) entity: Entity,
    pub(super) name: Option<&'a Name>,
    pub(super) mesh: AssetId<Mesh>,
    pub(super) reflecting: Reflecting<'a>,
    pub(super) paint: Paint<'a>,
    /// A number of its images, mask or solid that cannot be used.
    pub(super) wrong_paint: Option<InvalidValue>,
    /// An environment would light it, had it no images.
    pub(super) lacks_environment: bool,
    pub(super) terms: Terms,
    pub(super) tolerance: Tolerance,
    /// The components that make its look, unless it has images or a solid.
    pub(super) surface: Option<Surface<'a>>,
}

impl ShownObjects<'_, '_> {
    /// The visible ones in spawn order.
    pub(super) fn visible(&self) -> &[Entity] {
        &self.visible.0
    }

    /// One of them; one with images or a solid is lit by an environment only if `lights_images`.
    pub(super) fn get(&self, entity: Entity, lights_images: bool) -> Option<ShownObject<'_>> {
        let (mesh, material, back, reflectance, faces, components, tolerance, shading, name) =
            self.objects.get(entity).ok()?;
        let (colors, maps, alpha, solid) = components;
        let surface = Surface { mesh, material, back, shading, reflectance, faces, colors, alpha, tolerance };
        let surface = (maps.is_none() && solid.is_none()).then_some(surface);
        let shading = shown_shading(shading, &self.view);
        let of_mesh = |mesh| Paint::new(mesh, components, shading, self.surroundings.are_there());
        let mut paint = self.meshes.get(&mesh.0).map_or(Paint::default(), of_mesh);
        let has_images = paint.has_images() || paint.solid.is_some();
        let lacks_environment = paint.surrounded && has_images && !lights_images;
        paint.surrounded &= !lacks_environment;
        let material = material.unwrap_or(&Material::DEFAULT);
        let reflecting = Reflecting {
            front: material,
            back: back.map_or(material, |back| &back.0),
            shading,
            reflectance: reflectance.copied().unwrap_or(self.view.reflectance),
            faces: faces.copied().unwrap_or_default(),
            colored: paint.colored,
            maps: MapLooks::new(&paint.maps),
            masked: paint.mask.is_some(),
            solid: paint.solid.map(|solid| solid.kind),
            surrounded: paint.surrounded,
        };
        Some(ShownObject {
            entity,
            name,
            mesh: mesh.0.id(),
            reflecting,
            paint,
            wrong_paint: wrong_paint(components),
            lacks_environment,
            terms: shading.into(),
            tolerance: tolerance.copied().unwrap_or(self.view.tolerance),
            surface,
        })
    }
}

impl ShownObject<'_> {
    pub(super) fn form(&self) -> Form {
        Form::new(self.terms, &self.paint)
    }

    pub(super) fn geometry<'b>(&self, geometries: &'b Geometries) -> Option<&'b Geometry> {
        geometries.get(self.mesh, self.form())
    }

    /// Its images, mask and solid, if there are any.
    pub(super) fn maps(&self) -> Option<MapsUse> {
        let Paint { maps, mask, solid, .. } = &self.paint;
        self.paint.is_mapped().then(|| MapsUse::new(maps, mask.unwrap_or(0.0), solid.copied()))
    }
}
