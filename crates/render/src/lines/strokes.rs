//! The lines and points of entities.

use crate::lines::drawing::Drawing;
use crate::lines::marks::{Ink, Mark};
use crate::quantities::no_camera;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemState;
use bevy_math::{DVec3, Vec3, Vec4};
use bevy_transform::components::GlobalTransform;
use halfway_asset::Assets;
use halfway_frame::error::{RenderError, label};
use halfway_frame::view::matrices::normal_matrix;
use halfway_lighting::equations::{Coefficients, Eye, Light, ShadedPoint, shade};
use halfway_lighting::lights::{LightQueries, LightView};
use halfway_lighting::{
    AlphaMode, Camera, Cameras, GlobalAmbient, Intensity, LineStyle, Material, Reflectance, Shading, Shown,
    VertexColors,
};
use halfway_mesh::{Lines, Lines3d, SpawnOrder};

type Strokes<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static Lines3d,
        &'static GlobalTransform,
        &'static SpawnOrder,
        Option<&'static Material>,
        Option<&'static VertexColors>,
        Option<&'static AlphaMode>,
        (Option<&'static Reflectance>, Option<&'static Shading>),
        Option<&'static LineStyle>,
        Option<&'static Name>,
    ),
>;

type CameraLooks<'w, 's> = Query<
    'w,
    's,
    (&'static Camera, Option<&'static Reflectance>, Option<&'static LineStyle>, Option<&'static Shading>),
>;

/// The marks of all lines and points that are shown, in spawn order.
///
/// # Errors
/// [`RenderError::Invalid`] for an invalid component, [`RenderError::MissingMesh`] where a handle leads to no lines,
/// [`RenderError::BadTransform`].
pub(super) fn marks(world: &mut World, drawing: &Drawing) -> Result<Vec<Mark>, RenderError> {
    type Data<'w, 's> = (
        Strokes<'w, 's>,
        (Cameras<'w, 's>, CameraLooks<'w, 's>),
        LightQueries<'w, 's>,
        Shown<'w, 's>,
        Option<Res<'w, Assets<Lines>>>,
        Option<Res<'w, GlobalAmbient>>,
    );
    let mut state = SystemState::<Data>::new(world);
    let (strokes, (cameras, looks), lights, shown, assets, ambient) =
        state.get(world).map_err(|_| RenderError::NoPicture)?;
    let current = cameras.current().map_err(no_camera)?;
    let (camera, of_camera, style_of_camera, shading_of_camera) =
        looks.get(current).map_err(|_| RenderError::NoCamera)?;
    let is_shown = shown.by_entity();
    let mut all: Vec<_> = strokes.iter().filter(|stroke| is_shown(stroke.0)).collect();
    all.sort_unstable_by_key(|stroke| (*stroke.3, stroke.0));
    let mut lighting = None;
    let mut marks = Vec::new();
    for (entity, handle, transform, _, material, colors, alpha, (reflectance, shading), style, name) in all {
        let Some(lines) = assets.as_ref().and_then(|assets| assets.get(&handle.0)) else {
            return Err(RenderError::MissingMesh { entity: label(entity, name) });
        };
        if !transform.affine().is_finite() {
            let found = format!("{:?}", transform.affine().to_cols_array());
            return Err(RenderError::BadTransform { entity: label(entity, name), found });
        }
        let material = material.copied().unwrap_or_default();
        let style = style.or(style_of_camera).copied().unwrap_or_default();
        let invalid = |source| RenderError::Invalid { entity: label(entity, name), source };
        material.validate().and_then(|()| style.validate()).map_err(invalid)?;
        let is_unlit = shading.or(shading_of_camera) == Some(&Shading::Unlit);
        let lit = lines.normals().filter(|_| style.color.is_none() && !is_unlit);
        if lit.is_some() && lighting.is_none() {
            lighting = Some(Lighting::new(&lights, ambient.as_deref(), camera, drawing)?);
        }
        let look = Look {
            material,
            multiplies: colors.copied().unwrap_or_default() == VertexColors::Multiply,
            blends: alpha.copied().unwrap_or_default().blends(),
            reflectance: reflectance.or(of_camera).copied().unwrap_or_default(),
            style,
            lighting: lighting.as_ref().filter(|_| lit.is_some()),
        };
        look.add(lines, transform, drawing, &mut marks);
    }
    Ok(marks)
}

/// The lights in eye space.
struct Lighting {
    lights: Vec<Light<f64>>,
    ambient: [f64; 3],
    eye: Eye<f64>,
    /// The policy of the picture, whose curve what is lit has, as surfaces have it.
    policy: Intensity,
}

impl Lighting {
    fn new(
        queries: &LightQueries,
        ambient: Option<&GlobalAmbient>,
        camera: &Camera,
        drawing: &Drawing,
    ) -> Result<Self, RenderError> {
        let view = LightView { eye_from_world: drawing.eye_from_world(), unit: 1.0, farthest: f64::INFINITY };
        let (mut lights, mut refused) = (Vec::new(), None);
        queries.visit(|entity, name, light, at| match light.placed(at) {
            Ok(light) => lights.push(light.in_eye_space(&view)),
            Err(source) => {
                refused.get_or_insert_with(|| RenderError::Invalid { entity: label(entity, name), source });
            }
        });
        match refused {
            Some(error) => Err(error),
            None => {
                let ambient = ambient.copied().unwrap_or_default().ga();
                Ok(Self { lights, ambient, eye: camera.eye(), policy: camera.intensity })
            }
        }
    }
}

/// The looks of an entity's lines and points.
struct Look<'a> {
    material: Material,
    /// Whether the colours of vertices count.
    multiplies: bool,
    blends: bool,
    reflectance: Reflectance,
    style: LineStyle,
    /// `None` where they are not lit.
    lighting: Option<&'a Lighting>,
}

impl Look<'_> {
    fn add(&self, lines: &Lines, transform: &GlobalTransform, drawing: &Drawing, marks: &mut Vec<Mark>) {
        let eye_from_model = drawing.eye_from_world() * crate::quantities::world_from_model(transform);
        let eye: Vec<DVec3> = lines.positions().iter().map(|p| eye_from_model.transform_point3(p.as_dvec3())).collect();
        let turn = normal_matrix(&eye_from_model.matrix3).as_dmat3();
        let inks: Vec<Ink> = (0..eye.len())
            .map(|vertex| {
                let normal = lines.normals().map_or(Vec3::ZERO, |normals| normals[vertex]);
                let color = lines.colors().filter(|_| self.multiplies).map_or(Vec4::ONE, |colors| colors[vertex]);
                let normal = (turn * normal.as_dvec3()).normalize_or_zero();
                self.ink(eye[vertex], normal, color.clamp(Vec4::ZERO, Vec4::ONE), drawing)
            })
            .collect();
        // The end of the path so far, and its length in pixels.
        let (mut end, mut length) = (None, 0.0);
        for &[from, to] in lines.segments() {
            length = if end == Some(from) { length } else { 0.0 };
            end = Some(to);
            let ends = [from, to].map(|end| end as usize);
            let Some(placed) = drawing.placed(ends.map(|end| eye[end])) else { continue };
            let widths = placed.nearness.map(|nearness| drawing.in_pixels(self.style.line_width, nearness));
            let line = Mark::line(&placed, widths, ends.map(|end| inks[end]), self.style.hidden.into());
            marks.push(line.after(length));
            length += (placed.ends[1] - placed.ends[0]).length();
        }
        for &point in lines.points() {
            let point = point as usize;
            let Some((middle, nearness)) = drawing.placed_point(eye[point]) else { continue };
            let size = drawing.in_pixels(self.style.point_size, nearness);
            marks.push(Mark::disc(middle, size, -eye[point].z, inks[point]));
        }
    }

    /// The colour of a vertex in eye space, with a unit normal or 0.
    fn ink(&self, p: DVec3, n: DVec3, color: Vec4, drawing: &Drawing) -> Ink {
        let opacity = if self.blends { self.material.opacity * color.w } else { 1.0 };
        if let Some(color) = self.style.color {
            return Vec4::new(color.red, color.green, color.blue, opacity);
        }
        let Some(lighting) = self.lighting else {
            return (unlit(&self.material) * color.truncate()).extend(opacity);
        };
        // Points and lines have no back.
        let sight = DVec3::from(drawing.lens().sight(p.to_array())).normalize_or(DVec3::NEG_Z);
        let n = if n == DVec3::ZERO { -sight } else { n * -sight.dot(n).signum() };
        let surface = ShadedPoint { position: p.to_array(), normal: n.to_array() };
        let material = Coefficients::from(&self.material).tinted(color.truncate().as_dvec3().to_array());
        let Lighting { lights, ambient, eye, policy } = lighting;
        let lit = shade(&surface, &material, lights, *ambient, eye, self.reflectance);
        DVec3::from_array(lit.map(|channel| policy.toned(channel))).as_vec3().extend(opacity)
    }
}

/// The colour of a material without light: its diffuse reflectance or, as that of metals is black, its specular one; and
/// what it emits.
fn unlit(material: &Material) -> Vec3 {
    let [diffuse, specular, emission] = [material.diffuse, material.specular, material.emission]
        .map(|color| Vec3::new(color.red, color.green, color.blue));
    emission + if diffuse == Vec3::ZERO { specular } else { diffuse }
}
