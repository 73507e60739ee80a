//! Rendering methods.

use halfway::lighting::Choices;
use halfway::prelude::*;

/// Methods with one style in a chart.
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
    /// The diffuse and the specular term at different frequencies.
    Mixed,
}

/// A rendering method, which overrides the scene's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// The frequencies of the lights' terms.
    pub terms: Terms,
    /// The reflectance of highlights; `None` keeps the scene's.
    pub reflectance: Option<Reflectance>,
    /// Whether the viewer is infinitely far away for the highlights, whatever the scene says.
    pub infinite_viewer: bool,
    /// Whether point lights become directional, as seen from the origin. Only used where the distance of a light
    /// varies.
    pub far_lights: bool,
    /// Samples a pixel.
    pub samples: Samples,
    /// The movement of mesh points that is tolerated, in pixels ([`Tolerance::pixels`]): 0 draws every triangle, or 1.
    pub pixels: f32,
}

impl Family {
    /// Every family.
    pub const ALL: [Self; 5] = [Self::Constant, Self::Flat, Self::Gouraud, Self::Phong, Self::Mixed];

    /// Its name for readers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant colour",
            Self::Flat => Shading::Flat.name(),
            Self::Gouraud => Shading::Gouraud.name(),
            Self::Phong => Shading::Phong.name(),
            Self::Mixed => "mixed terms",
        }
    }
}

impl Method {
    /// Without lights: the reference of all times.
    pub const CONSTANT: Self = Self::new(Terms::NONE);
    /// Both terms once a triangle.
    pub const FLAT: Self = Self::new(Terms::both(Frequency::Triangle));
    /// Both terms once a vertex.
    pub const GOURAUD: Self = Self::new(Terms::both(Frequency::Vertex));
    /// Both terms once a pixel.
    pub const PHONG: Self = Self::new(Terms::both(Frequency::Fragment));
    /// The diffuse term once a vertex, the specular one once a pixel.
    pub const HIGHLIGHTS: Self = Self::new(Terms { diffuse: Frequency::Vertex, specular: Frequency::Fragment });

    /// Every triangle with one sample a pixel, and with the scene's reflectance and viewer.
    pub const fn new(terms: Terms) -> Self {
        let samples = Samples::One;
        Self { terms, reflectance: None, infinite_viewer: false, far_lights: false, samples, pixels: 0.0 }
    }

    /// Every method worth trying on a scene: flat, Gouraud and Phong shading, each also with an infinite viewer and
    /// with four samples; every mixture of terms, the constant colour among them; Phong shading with detail within a
    /// pixel; and, where the scene reflects by Phong's formula, Blinn's in its place.
    pub fn all(scene: Option<Reflectance>) -> Vec<Self> {
        let mut methods = vec![Self::CONSTANT];
        for plain in [Self::FLAT, Self::GOURAUD, Self::PHONG] {
            methods.extend([plain, Self { infinite_viewer: true, ..plain }, Self { samples: Samples::Four, ..plain }]);
            if scene == Some(Reflectance::Phong) {
                let others = [Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched];
                methods.extend(others.map(|reflectance| Self { reflectance: Some(reflectance), ..plain }));
            }
        }
        // A term that is shaded once a triangle cannot be combined with another.
        let frequencies = [Frequency::Never, Frequency::Vertex, Frequency::Fragment];
        for diffuse in frequencies {
            let others = frequencies.into_iter().filter(|specular| *specular != diffuse);
            methods.extend(others.map(|specular| Self::new(Terms { diffuse, specular })));
        }
        methods.push(Self { pixels: 1.0, ..Self::PHONG });
        methods
    }

    /// The most informative few.
    pub fn few(scene: Option<Reflectance>) -> Vec<Self> {
        let phong = Self::PHONG;
        let mut methods = vec![Self::FLAT, Self::GOURAUD, Self::HIGHLIGHTS, phong];
        methods.extend([
            Self { infinite_viewer: true, ..phong },
            Self { samples: Samples::Four, ..phong },
            Self { pixels: 1.0, ..phong },
        ]);
        if scene == Some(Reflectance::Phong) {
            methods.push(Self { reflectance: Some(Reflectance::BlinnPhongMatched), ..phong });
        }
        methods
    }

    /// Its family in charts.
    pub fn family(self) -> Family {
        let Terms { diffuse, specular } = self.terms;
        match diffuse {
            _ if diffuse != specular => Family::Mixed,
            Frequency::Never => Family::Constant,
            Frequency::Triangle => Family::Flat,
            Frequency::Vertex => Family::Gouraud,
            Frequency::Fragment => Family::Phong,
        }
    }

    /// Its name on the command line: its parts with hyphens between.
    pub fn id(self) -> String {
        let Terms { diffuse, specular } = self.terms;
        let start = match self.family() {
            Family::Constant => "constant".to_owned(),
            Family::Mixed => format!("diffuse-{}-specular-{}", place(diffuse).0, place(specular).0),
            family => family.name().to_lowercase(),
        };
        self.additions().into_iter().fold(start, |all, (id, _)| format!("{all}-{id}"))
    }

    /// In words.
    pub fn words(self) -> String {
        let Terms { diffuse, specular } = self.terms;
        let start = match self.family() {
            Family::Mixed => format!("diffuse {}, specular {}", place(diffuse).1, place(specular).1),
            family => family.name().to_owned(),
        };
        self.additions().into_iter().fold(start, |all, (_, words)| format!("{all}, {words}"))
    }

    /// Its differences from others of its terms, as the command line takes them and in words.
    fn additions(self) -> Vec<(String, String)> {
        let reflectance = self.reflectance.map(|reflectance| {
            let key = reflectance.choice().map_or("", |choice| choice.key);
            let words = match reflectance {
                Reflectance::Phong => "Phong reflectance".to_owned(),
                other => format!("{} for Phong", other.name()),
            };
            (format!("by-{}", key.replace('_', "-")), words)
        });
        let others = [
            (self.infinite_viewer, ("infinite-viewer", "infinite viewer")),
            (self.far_lights, ("far-lights", "far lights")),
            (self.samples == Samples::Four, ("4-samples", "4 samples")),
            (self.pixels > 0.0, ("1-pixel", "detail within 1 pixel")),
        ];
        let others = others.into_iter().filter(|(applies, _)| *applies);
        let others = others.map(|(_, (id, words))| (id.to_owned(), words.to_owned()));
        reflectance.into_iter().chain(others).collect()
    }

    /// Applies the method to everything in `world`.
    pub fn apply(self, world: &mut World) {
        world.insert_resource(ViewTolerance(Tolerance { steps: 0.0, pixels: self.pixels }));
        let objects: Vec<Entity> = world.query_filtered::<Entity, With<Mesh3d>>().iter(world).collect();
        for object in objects {
            let mut object = world.entity_mut(object);
            object.insert(Shading::Terms(self.terms)).remove::<Tolerance>();
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

/// The frequency of a term, in a word and in words.
fn place(frequency: Frequency) -> (&'static str, &'static str) {
    match frequency {
        Frequency::Never => ("never", "left out"),
        Frequency::Triangle => ("triangle", "once a triangle"),
        Frequency::Vertex => ("vertex", "at vertices"),
        Frequency::Fragment => ("pixel", "at pixels"),
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
            }
            assert!(Method::few(scene).iter().all(|method| Method::all(scene).contains(method)));
        }
        // 3 × 3 shadings with viewers and samples, 6 mixtures, a constant colour, detail; 3 × 2 of reflectances.
        assert_eq!((Method::all(None).len(), Method::all(Some(Reflectance::Phong)).len()), (17, 23));
        let words = [Method::FLAT, Method::HIGHLIGHTS, Method { pixels: 1.0, ..Method::PHONG }].map(Method::words);
        assert_eq!(words, ["flat", "diffuse at vertices, specular at pixels", "Phong, detail within 1 pixel"]);
    }

    #[test]
    fn every_method_can_be_drawn() {
        for method in Method::all(None) {
            assert_eq!(method.terms.validate(), Ok(()), "{}", method.id());
        }
    }
}
