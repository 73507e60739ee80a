//! How a scene is drawn.

use halfway::prelude::*;

/// Where the lights' terms are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shade {
    /// All of them at one place.
    At(Shading),
    /// Each of them at a place of its own.
    Mixed(Terms),
    /// Each light's where that is cheapest, within N halves of a step of 255.
    Auto(u8),
}

/// Methods that are drawn alike in a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Without lights.
    Constant,
    /// Once a triangle.
    Flat,
    /// Once a vertex.
    Gouraud,
    /// Once a pixel.
    Phong,
    /// A mixture.
    Mixed,
    /// Automatically, within a tolerance.
    Auto,
}

/// How a scene is drawn, whatever it says itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Method {
    /// Where the lights' terms are evaluated.
    pub shade: Shade,
    /// How highlights are made; `None` leaves that to the scene.
    pub reflectance: Option<Reflectance>,
    /// Whether the viewer is infinitely far away for the highlights, whatever the scene says.
    pub infinite_viewer: bool,
    /// Whether point lights shine as if they were infinitely far away, from where they are as seen from the origin.
    /// Only tried where the distance of a light is what is changed.
    pub far_lights: bool,
    /// Samples a pixel.
    pub samples: Samples,
}

impl Family {
    /// Every family.
    pub const ALL: [Self; 6] = [Self::Constant, Self::Flat, Self::Gouraud, Self::Phong, Self::Mixed, Self::Auto];

    /// As a reader knows it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant colour",
            Self::Flat => "flat",
            Self::Gouraud => "Gouraud",
            Self::Phong => "Phong",
            Self::Mixed => "mixed terms",
            Self::Auto => "automatic",
        }
    }

    /// The family of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|family| family.name() == name)
    }
}

/// The tolerances that are tried, in halves of a step: ½ to 16 steps.
const HALF_STEPS: [u8; 6] = [1, 2, 4, 8, 16, 32];

impl Shade {
    /// Every way; a term that is shaded once a triangle goes with no other.
    fn all() -> Vec<Self> {
        let frequencies = [Frequency::Never, Frequency::Vertex, Frequency::Fragment];
        let mixed = frequencies.iter().flat_map(|&diffuse| frequencies.map(|specular| Terms { diffuse, specular }));
        let mixed = mixed.filter(|terms| terms.diffuse != terms.specular || *terms == Terms::NONE);
        [Shading::Flat, Shading::Gouraud, Shading::Phong]
            .map(Self::At)
            .into_iter()
            .chain(mixed.map(Self::Mixed))
            .chain(HALF_STEPS.map(Self::Auto))
            .collect()
    }

    fn family(self) -> Family {
        match self {
            Self::At(Shading::Flat) => Family::Flat,
            Self::At(Shading::Gouraud) => Family::Gouraud,
            Self::At(_) => Family::Phong,
            Self::Mixed(Terms::NONE) => Family::Constant,
            Self::Mixed(_) => Family::Mixed,
            Self::Auto(_) => Family::Auto,
        }
    }

    fn id(self) -> String {
        match self {
            Self::At(Shading::Flat) => "flat".to_owned(),
            Self::At(Shading::Gouraud) => "gouraud".to_owned(),
            Self::At(_) => "phong".to_owned(),
            Self::Mixed(Terms::NONE) => "constant".to_owned(),
            Self::Auto(half_steps) => format!("auto-{}", f64::from(half_steps) / 2.0),
            Self::Mixed(Terms { diffuse, specular }) => format!("diffuse-{}-specular-{}", at(diffuse), at(specular)),
        }
    }

    fn words(self) -> String {
        let place = |frequency| match frequency {
            Frequency::Never => "left out",
            Frequency::Triangle => "once a triangle",
            Frequency::Vertex => "at vertices",
            Frequency::Fragment => "at pixels",
        };
        match self {
            Self::Mixed(Terms { diffuse, specular }) if diffuse != specular => {
                format!("diffuse {}, specular {}", place(diffuse), place(specular))
            }
            Self::Auto(2) => "automatic, within 1 step".to_owned(),
            Self::Auto(half_steps) => format!("automatic, within {} steps", f64::from(half_steps) / 2.0),
            other => other.family().name().to_owned(),
        }
    }
}

/// Where a term is evaluated, in a word.
fn at(frequency: Frequency) -> &'static str {
    match frequency {
        Frequency::Never => "never",
        Frequency::Triangle => "triangle",
        Frequency::Vertex => "vertex",
        Frequency::Fragment => "pixel",
    }
}

impl Method {
    /// Without lights: what every frame is timed against.
    pub const CONSTANT: Self = Self::new(Shade::Mixed(Terms::NONE));

    /// With one sample, and with the scene's reflectance and viewer.
    pub const fn new(shade: Shade) -> Self {
        Self { shade, reflectance: None, infinite_viewer: false, far_lights: false, samples: Samples::One }
    }

    /// Every method worth trying on a scene: flat, Gouraud and Phong with either viewer and either number of samples,
    /// every mixture of terms, and, where the scene reflects by Phong's formula, Blinn's in its place.
    pub fn all(scene: Option<Reflectance>) -> Vec<Self> {
        let mut methods: Vec<Self> = Shade::all().into_iter().map(Self::new).collect();
        for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
            let plain = Self::new(Shade::At(shading));
            let smooth = Self { samples: Samples::Four, ..plain };
            methods.extend([Self { infinite_viewer: true, ..plain }, smooth, Self { infinite_viewer: true, ..smooth }]);
            if scene == Some(Reflectance::Phong) {
                let others = [Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched];
                methods.extend(others.map(|reflectance| Self { reflectance: Some(reflectance), ..plain }));
            }
        }
        methods
    }

    /// The few that tell most.
    pub fn few(scene: Option<Reflectance>) -> Vec<Self> {
        let highlights = Shade::Mixed(Terms { diffuse: Frequency::Vertex, specular: Frequency::Fragment });
        let phong = Self::new(Shade::At(Shading::Phong));
        let mut methods = [Shade::At(Shading::Flat), Shade::At(Shading::Gouraud), highlights].map(Self::new).to_vec();
        methods.push(Self::new(Shade::Auto(2)));
        methods.extend([phong, Self { infinite_viewer: true, ..phong }, Self { samples: Samples::Four, ..phong }]);
        if scene == Some(Reflectance::Phong) {
            methods.push(Self { reflectance: Some(Reflectance::BlinnPhongMatched), ..phong });
        }
        methods
    }

    /// What it is drawn like.
    pub fn family(self) -> Family {
        self.shade.family()
    }

    /// As the command line takes it: its parts with hyphens between.
    pub fn id(self) -> String {
        let mut id = self.shade.id();
        id += match self.reflectance {
            None => "",
            Some(Reflectance::Phong) => "-by-phong",
            Some(Reflectance::BlinnPhong) => "-by-blinn-phong",
            Some(Reflectance::BlinnPhongMatched) => "-by-blinn-phong-matched",
        };
        id += if self.infinite_viewer { "-infinite-viewer" } else { "" };
        id += if self.far_lights { "-far-lights" } else { "" };
        id + if self.samples == Samples::Four { "-4-samples" } else { "" }
    }

    /// In words.
    pub fn words(self) -> String {
        let mut words = self.shade.words();
        words += match self.reflectance {
            None => "",
            Some(Reflectance::Phong) => ", Phong reflectance",
            Some(Reflectance::BlinnPhong) => ", Blinn–Phong for Phong",
            Some(Reflectance::BlinnPhongMatched) => ", matched Blinn–Phong for Phong",
        };
        words += if self.infinite_viewer { ", infinite viewer" } else { "" };
        words += if self.far_lights { ", far lights" } else { "" };
        words + if self.samples == Samples::Four { ", 4 samples" } else { "" }
    }

    /// The error that it is told to keep to, in steps of 255; `None` of methods that keep to none.
    pub fn tolerance(self) -> Option<f64> {
        match self.shade {
            Shade::Auto(half_steps) => Some(f64::from(half_steps) / 2.0),
            Shade::At(_) | Shade::Mixed(_) => None,
        }
    }

    /// Has everything in `world` drawn so.
    pub fn apply(self, world: &mut World) {
        let objects: Vec<Entity> = world.query_filtered::<Entity, With<Mesh3d>>().iter(world).collect();
        for object in objects {
            let mut object = world.entity_mut(object);
            match self.shade {
                Shade::At(shading) => object.insert(shading).remove::<Terms>(),
                Shade::Mixed(terms) => object.insert(terms),
                Shade::Auto(_) => object.insert(Shading::Phong).remove::<Terms>().remove::<Tolerance>(),
            };
            if let Some(reflectance) = self.reflectance {
                object.insert(reflectance);
            }
        }
        if self.far_lights {
            put_lights_far_away(world);
        }
        for mut camera in world.query::<&mut Camera>().iter_mut(world) {
            camera.samples = self.samples;
            if self.infinite_viewer {
                camera.viewer = Viewer::Infinite;
            }
        }
    }
}

fn put_lights_far_away(world: &mut World) {
    let mut near = world.query::<(Entity, &PointLight, &Transform)>();
    let near: Vec<_> = near.iter(world).map(|(entity, light, place)| (entity, *light, *place)).collect();
    for (entity, light, place) in near {
        let PointLight { ambient, diffuse, specular, .. } = light;
        let far = DirectionalLight { ambient, diffuse, specular };
        let toward = place.looking_at(Vec3::ZERO, Vec3::Y);
        world.entity_mut(entity).remove::<PointLight>().insert((far, toward));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_has_a_name_of_its_own() {
        for scene in [None, Some(Reflectance::BlinnPhong), Some(Reflectance::Phong)] {
            for methods in [Method::all(scene), Method::few(scene)] {
                for name in [Method::id, Method::words] {
                    let mut names: Vec<String> = methods.iter().map(|method| name(*method)).collect();
                    names.sort();
                    names.dedup();
                    assert_eq!(names.len(), methods.len(), "{names:?}");
                }
                assert!(methods.iter().all(|method| Family::named(method.family().name()) == Some(method.family())));
            }
            assert!(Method::few(scene).iter().all(|method| Method::all(scene).contains(method)));
        }
        // 3 shadings, 6 mixtures and none, 6 tolerances; 3 × 3 of viewers and samples; 3 × 2 of reflectances.
        assert_eq!((Method::all(None).len(), Method::all(Some(Reflectance::Phong)).len()), (25, 31));
    }

    #[test]
    fn automatic_shading_is_tried_within_these_tolerances() {
        let tolerances = |methods: Vec<Method>| methods.into_iter().filter_map(Method::tolerance).collect::<Vec<_>>();
        assert_eq!(tolerances(Method::all(None)), [0.5, 1.0, 2.0, 4.0, 8.0, 16.0]);
        assert_eq!(tolerances(Method::few(None)), [1.0]);
    }

    #[test]
    fn mixtures_can_be_drawn() {
        for method in Method::all(None) {
            if let Shade::Mixed(terms) = method.shade {
                assert_eq!(terms.validate(), Ok(()), "{}", method.id());
            }
        }
    }
}
