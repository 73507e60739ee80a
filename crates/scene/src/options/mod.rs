//! How a scene is drawn, over what its file says: the options of the command and of Python, under the same names.

pub mod parse;
mod views;

use bevy_color::LinearRgba;
use bevy_math::Vec3;
use halfway_lighting::{
    Edges, Faces, Framing, HiddenEdges, Intensity, LightRig, Material, Reflectance, Shading, Show, Term, Tolerance,
    VertexColors, View, WhichEdges, Width,
};
use halfway_mesh::Normals;

use crate::file::SceneFile;
use crate::lines::LineStyleEntry;
use crate::material::MaterialEntry;
use crate::mesh::{LoadedModel, MeshEntry};
use crate::object::ObjectEntry;
use crate::scalars::ColorMap;
use crate::scalars_entry::ScalarsEntry;
use crate::view::CameraEntry;
use parse::Background;
pub use views::{Views, views};

macro_rules! options {
    ($($(#[doc = $doc:literal])+ $name:ident: $kind:ty = $parse:path,)+) => {
        /// How a scene is drawn. `None` leaves what the scene says.
        ///
        /// ```
        /// use halfway_scene::SceneFile;
        /// use halfway_scene::options::SceneOptions;
        ///
        /// let mut options = SceneOptions::default();
        /// options.set("view", "iso").unwrap();
        /// options.set("background", "white").unwrap();
        /// let error = options.set("normals", "round").unwrap_err();
        /// assert!(error.starts_with("normals: \"round\": expected auto, keep"));
        ///
        /// let mut scene = SceneFile::for_model("part.stl");
        /// options.apply(&mut scene);
        /// assert_eq!(scene.background, [1.0; 3]);
        /// ```
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct SceneOptions {
            $($(#[doc = $doc])+ pub $name: Option<$kind>,)+
        }

        impl SceneOptions {
            /// The names of the options: those of the fields.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($name)),+];

            /// Sets the option of this name, as the command does with `--name text`.
            ///
            /// # Errors
            /// A sentence that names the option and says what was expected.
            pub fn set(&mut self, name: &str, text: &str) -> Result<(), String> {
                match name {
                    $(stringify!($name) => {
                        self.$name = Some($parse(text).map_err(|error| format!("{name}: {text:?}: {error}"))?);
                    })+
                    _ => return Err(format!("unknown option {name:?}; expected {}", Self::NAMES.join(", "))),
                }
                Ok(())
            }
        }
    };
}

options! {
    /// The side from which everything is seen.
    view: View = parse::view,
    /// The direction that is upright in the model, of unit length.
    up: Vec3 = parse::up,
    /// Without perspective.
    ortho: bool = parse::switch,
    /// The share of the picture that the objects fill, above 0 and at most 1.
    fit: f32 = parse::fit,
    /// How many times the middle of the picture is magnified.
    zoom: f32 = parse::zoom,
    /// The material of all objects.
    color: Material = parse::color,
    /// The sides of surfaces that are shown.
    faces: Faces = parse::faces,
    /// The normals of all objects.
    normals: Normals = parse::normals,
    /// Whether a checker is shown where an image of a model is missing or broken.
    mark_missing_images: bool = parse::switch,
    /// The background.
    background: Background = parse::background,
    /// The lights, which follow the camera.
    lights: LightRig = parse::lights,
    /// The shading of all objects.
    shading: Shading = parse::shading,
    /// How surfaces reflect.
    reflectance: Reflectance = parse::reflectance,
    /// Samples a pixel: 1, 4, 16 or 64.
    samples: u32 = parse::samples,
    /// The only term that is drawn.
    only: Term = parse::only,
    /// The only light that is drawn, by its name or its number, counted from 0.
    light: String = parse::words,
    /// The treatment of intensities above 1.
    intensity: Intensity = parse::intensity,
    /// The allowed difference from the exact picture.
    tolerance: Tolerance = parse::tolerance,
    /// Lines along these edges.
    edges: WhichEdges = parse::edges,
    /// The width of the lines along edges.
    edge_width: Width = parse::width,
    /// Whether edges behind surfaces are dashed.
    hidden_edges: bool = parse::switch,
    /// Whether lines along all edges are drawn, and no surfaces.
    wireframe: bool = parse::switch,
    /// The property of the models that is shown by colours.
    scalars: String = parse::words,
    /// The colours of the property.
    map: ColorMap = parse::map,
    /// The numbers that the colours begin and end with.
    range: [f32; 2] = parse::range,
    /// How many lines of equal numbers are drawn, 1 to 100.
    isolines: u32 = parse::isolines,
    /// The title of a legend of the colours.
    legend: String = parse::words,
    /// The width of the models' lines.
    line_width: Width = parse::width,
    /// The diameter of the models' points.
    point_size: Width = parse::width,
    /// Whether parts of the models' lines behind surfaces are dashed.
    hidden_lines: bool = parse::switch,
    /// Lines that explain the scene.
    show: Show = parse::show,
    /// The animation of the models that is played, by its name or its number, counted from 0.
    animation: String = parse::words,
}

impl SceneOptions {
    /// Changes the scene. Without [`samples`](Self::samples), models alone get four.
    pub fn apply(&self, scene: &mut SceneFile) {
        if let Some(shading) = self.shading {
            scene.shading = shading;
            scene.all_cameras_mut().for_each(|camera| camera.shading = None);
            // Over that of a model's own materials, too.
            scene.objects.iter_mut().for_each(|object| object.shading = Some(shading));
        }
        if let Some(reflectance) = self.reflectance {
            scene.reflectance = reflectance;
            scene.all_cameras_mut().for_each(|camera| camera.reflectance = None);
            scene.objects.iter_mut().for_each(|object| object.reflectance = None);
        }
        if let Some(tolerance) = self.tolerance {
            scene.tolerance = Some(tolerance);
            scene.all_cameras_mut().for_each(|camera| camera.tolerance = None);
            scene.objects.iter_mut().for_each(|object| object.tolerance = None);
        }
        if let Some(intensity) = self.intensity {
            scene.intensity = intensity;
        }
        scene.only = self.only.or(scene.only);
        if let Some(light) = &self.light {
            scene.light = Some(light.as_str().into());
        }
        if let Some(animation) = &self.animation {
            scene.animation = Some(animation.as_str().into());
        }
        self.apply_samples(scene);
        self.apply_looks(scene);
        self.apply_lines(scene);
        self.apply_framing(scene);
        self.apply_scalars(scene);
    }

    fn apply_samples(&self, scene: &mut SceneFile) {
        let is_of_models = scene.objects.iter().all(|object| matches!(object.mesh, MeshEntry::Model(_)));
        if let Some(samples) = self.samples {
            scene.samples = samples;
            scene.all_cameras_mut().for_each(|camera| camera.samples = None);
        } else if is_of_models && !scene.objects.is_empty() {
            scene.samples = 4;
        }
    }

    fn apply_looks(&self, scene: &mut SceneFile) {
        for object in &mut scene.objects {
            if let Some(material) = self.color {
                object.material = Some(MaterialEntry::Values(material));
                (object.back_material, object.maps, object.solid) = (None, None, None);
                object.vertex_colors = VertexColors::Ignore;
            }
            object.faces = self.faces.or(object.faces);
            object.normals = self.normals.unwrap_or(object.normals);
            object.mark_missing_images |= self.mark_missing_images == Some(true);
        }
        if let Some(Background { above, below, opacity }) = self.background {
            (scene.background, scene.background_below, scene.background_opacity) = (above, below, opacity);
        }
        if let Some(rig) = self.lights {
            scene.lights = Some(rig.into());
        }
    }

    fn apply_lines(&self, scene: &mut SceneFile) {
        if let Some(edges) = self.given_edges() {
            scene.edges = Some(edges.into());
            scene.objects.iter_mut().for_each(|object| object.edges = None);
        }
        let Self { line_width, point_size, hidden_lines, .. } = *self;
        let hidden = hidden_lines.map(|dashed| if dashed { HiddenEdges::Dash } else { HiddenEdges::Omit });
        if line_width.is_some() || point_size.is_some() || hidden.is_some() {
            let all = std::iter::once(&mut scene.line_style).chain(scene.objects.iter_mut().map(|o| &mut o.line_style));
            for (i, entry) in all.enumerate() {
                // Objects that name no style follow the scene's.
                if i == 0 || entry.is_some() {
                    let style = entry.unwrap_or_default();
                    *entry = Some(LineStyleEntry {
                        line_width: line_width.unwrap_or(style.line_width),
                        point_size: point_size.unwrap_or(style.point_size),
                        hidden: hidden.unwrap_or(style.hidden),
                        ..style
                    });
                }
            }
        }
        if let Some(show) = self.show.filter(Show::any) {
            scene.show = show;
        }
    }

    /// The lines along edges that are asked for.
    fn given_edges(&self) -> Option<Edges> {
        let hidden = if self.hidden_edges == Some(true) { HiddenEdges::Dash } else { HiddenEdges::Omit };
        if self.wireframe == Some(true) {
            // Lines on black are to be seen.
            let color = LinearRgba::rgb(0.6, 0.6, 0.6);
            return Some(Edges { width: 1.0.into(), surface: false, color, ..Edges::new(WhichEdges::All) });
        }
        let edges = Edges::new(self.edges?);
        Some(Edges { width: self.edge_width.unwrap_or(edges.width), hidden, ..edges })
    }

    /// Whether the options move the camera: then one camera has the picture for itself.
    pub fn is_framing(&self) -> bool {
        let Self { view, up, ortho, fit, zoom, .. } = self;
        view.is_some() || up.is_some() || *ortho == Some(true) || fit.is_some() || zoom.is_some()
    }

    fn apply_framing(&self, scene: &mut SceneFile) {
        let Self { view, up, ortho, fit, zoom, .. } = *self;
        if !self.is_framing() {
            return;
        }
        let framed = CameraEntry { view: Some(View::default()), ..CameraEntry::default() };
        let camera = scene.camera.get_or_insert(framed);
        camera.view = view.or(camera.view);
        camera.up = up.map_or(camera.up, |up| up.to_array());
        camera.ortho |= ortho == Some(true);
        camera.fit = fit.or(camera.fit);
        camera.zoom *= zoom.unwrap_or(1.0);
        scene.all_cameras_mut().for_each(|camera| camera.viewport = None);
    }

    /// The upright axis of the model: that of `up`, or of a camera of the scene that frames all objects.
    pub fn upright(&self, scene: &SceneFile) -> Vec3 {
        let of_camera = || scene.camera.as_ref().filter(|camera| camera.view.is_some()).map(|camera| camera.up.into());
        self.up.or_else(of_camera).and_then(Vec3::try_normalize).unwrap_or(Vec3::Y)
    }

    /// The framing from another view.
    pub fn seen_from(&self, view: View) -> Framing {
        let framing = Framing::new(view, self.up.unwrap_or(Vec3::Y));
        Framing { fit: self.fit.unwrap_or(framing.fit), zoom: self.zoom.unwrap_or(framing.zoom), ..framing }
    }

    fn apply_scalars(&self, scene: &mut SceneFile) {
        if let Some(property) = &self.scalars {
            let scalars = ScalarsEntry {
                map: self.map.unwrap_or_default(),
                range: self.range,
                isolines: self.isolines.unwrap_or_default(),
                ..ScalarsEntry::of_property(property)
            };
            let is_model = |object: &&mut ObjectEntry| matches!(object.mesh, MeshEntry::Path(_) | MeshEntry::Model(_));
            for object in scene.objects.iter_mut().filter(is_model) {
                object.scalars = Some(scalars.clone());
                (object.maps, object.displacement) = (None, None);
            }
        }
        if self.legend.is_some() {
            if scene.camera.is_none() && scene.cameras.is_empty() {
                scene.camera = Some(CameraEntry { view: Some(View::default()), ..CameraEntry::default() });
            }
            scene.all_cameras_mut().for_each(|camera| camera.legend.clone_from(&self.legend));
        }
    }
}

/// The material of a surface of which no more than its colour is known: a little highlight.
pub fn finish(color: LinearRgba) -> Material {
    Material { specular: LinearRgba::rgb(0.12, 0.12, 0.12), shininess: 40.0, ..Material::matte(color) }
}

/// The material of models that have none: light grey, in the finish of [`finish`].
pub fn unknown_material() -> Material {
    finish(LinearRgba::rgb(0.75, 0.75, 0.75))
}

/// Charcoal, before which light and dark models stand out.
const BACKGROUND: [f32; 3] = [0.024, 0.027, 0.032];

/// A scene of models that nothing is known of, shown to please: framed from the front, a little from the right and from
/// above, lit by their own lights or by the studio's, before charcoal, with [`Normals::Auto`].
pub fn scene_of_models(models: Vec<LoadedModel>) -> SceneFile {
    let has_lights = models.iter().any(|loaded| !loaded.model.lights.is_empty());
    let object = |loaded| ObjectEntry { normals: Normals::Auto, ..ObjectEntry::new(MeshEntry::Model(loaded)) };
    SceneFile {
        camera: Some(CameraEntry { view: Some(View::default()), fov_y_deg: 30.0, ..CameraEntry::default() }),
        background: BACKGROUND,
        lights: (!has_lights).then(|| LightRig::Studio.into()),
        objects: models.into_iter().map(object).collect(),
        ..SceneFile::default()
    }
}

/// Removes what is drawn over and behind a finished picture by the same code for all renderers, so that a judge of
/// renderers has nothing to say about it: lines, but for those of models, legends, and backgrounds of more than one
/// opaque colour. Returns whether there was any.
pub fn remove_what_is_laid_over(scene: &mut SceneFile) -> bool {
    let edges = scene.objects.iter_mut().filter_map(|object| object.edges.take()).count();
    let is_plain = scene.background_below.is_none() && scene.background_opacity >= 1.0;
    (scene.background_below, scene.background_opacity) = (None, 1.0);
    let legends = scene.all_cameras_mut().filter_map(|camera| camera.legend.take()).count();
    let shows = std::mem::take(&mut scene.show).any();
    scene.edges.take().is_some() || edges + legends > 0 || shows || !is_plain
}
