//! A small renderer in single precision, as a student writes it: rays through the pixels, every triangle tried, lighting
//! in eye space. It shares no code of the oracle, and makes mistakes of its own accord.

use bevy_math::{Mat3, Mat4, Vec3};
use halfway_lighting::{Encoding, Faces, Reflectance, Shading, Viewer};
use halfway_reference::mistakes::{Mistake, Mistakes};
use image::{Rgb, RgbImage};

use crate::task::{Lamp, LampKind, Look, SIZE, Task, Thing};

/// The mistakes that this renderer can make.
pub(crate) fn can_make(mistake: Mistake) -> bool {
    use Mistake as M;
    !matches!(
        mistake,
        M::VertexColorsIgnored | M::TexturesIgnored | M::OpacityIgnored | M::ToneMappingMissing | M::ExponentNotMatched
    )
}

/// Draws the task with these mistakes, one ray a pixel.
pub(crate) fn draw(task: &Task, mistakes: Mistakes) -> RgbImage {
    draw_smoothed(task, mistakes, &[[0.5, 0.5]])
}

/// The points of `n` rows of `n` in a pixel.
pub(crate) fn grid(n: u16) -> Vec<[f32; 2]> {
    let place = |i: u16| (f32::from(i) + 0.5) / f32::from(n);
    (0..n * n).map(|i| [place(i % n), place(i / n)]).collect()
}

/// Draws the task with these mistakes, each pixel the mean of rays through these points of it.
pub(crate) fn draw_smoothed(task: &Task, mistakes: Mistakes, points: &[[f32; 2]]) -> RgbImage {
    let renderer = Renderer::new(task, mistakes);
    let (width, height) = SIZE;
    let mut picture = RgbImage::new(width, height);
    for row in 0..height {
        for column in 0..width {
            let mut color = Vec3::ZERO;
            for [right, down] in points {
                color += renderer.ray(column as f32 + right, row as f32 + down) / points.len() as f32;
            }
            let x = if renderer.is(Mistake::Mirrored) { width - 1 - column } else { column };
            let y = if renderer.is(Mistake::UpsideDown) { height - 1 - row } else { row };
            picture.put_pixel(x, y, Rgb(renderer.bytes(color)));
        }
    }
    picture
}

struct Corner {
    world: Vec3,
    eye: Vec3,
    n: Vec3,
}

struct Triangle {
    corners: [Corner; 3],
    thing: usize,
    /// Of the front, in eye space.
    face: Vec3,
}

struct Met {
    triangle: usize,
    t: f32,
    weights: [f32; 3],
    front: bool,
}

struct Renderer<'a> {
    task: &'a Task,
    mistakes: Mistakes,
    view: Mat4,
    triangles: Vec<Triangle>,
    lamps: Vec<Lamp>,
}

impl<'a> Renderer<'a> {
    fn new(task: &'a Task, mistakes: Mistakes) -> Self {
        let view = task.world_from_camera().inverse();
        let mut it = Self { task, mistakes, view, triangles: Vec::new(), lamps: task.lamps.clone() };
        for (number, thing) in task.things.iter().enumerate() {
            it.add(number, thing);
        }
        if it.is(Mistake::FirstLightOnly) {
            it.lamps.truncate(1);
        }
        if it.is(Mistake::LastLightOnly) {
            it.lamps = it.lamps.split_off(it.lamps.len() - 1);
        }
        it
    }

    fn is(&self, mistake: Mistake) -> bool {
        self.mistakes.has(mistake)
    }

    fn add(&mut self, number: usize, thing: &Thing) {
        let model_view = self.view * thing.place;
        let corner = |index: u32| {
            let (p, n) = (thing.mesh.positions()[index as usize], thing.mesh.normals()[index as usize]);
            let world = thing.place.transform_point3(p);
            Corner { world, eye: self.view.transform_point3(world), n: self.normal(n, &model_view, &thing.place) }
        };
        let triangles: Vec<Triangle> = thing
            .mesh
            .triangles()
            .map(|indices| {
                let [a, b, c] = indices.map(|index| thing.mesh.positions()[index as usize]);
                let face = self.normal((b - a).cross(c - a), &model_view, &thing.place);
                Triangle { corners: indices.map(corner), thing: number, face }
            })
            .collect();
        self.triangles.extend(triangles);
    }

    /// A normal of the model in eye space.
    fn normal(&self, n: Vec3, model_view: &Mat4, place: &Mat4) -> Vec3 {
        let m = Mat3::from_mat4(*model_view);
        if self.is(Mistake::NormalsInModelSpace) {
            n.normalize()
        } else if self.is(Mistake::NormalsByModelMatrix) {
            (m * n).normalize()
        } else if self.is(Mistake::NormalsInWorldSpace) {
            (Mat3::from_mat4(*place).inverse().transpose() * n).normalize()
        } else if self.is(Mistake::NormalsReversed) {
            -(m.inverse().transpose() * n).normalize()
        } else {
            (m.inverse().transpose() * n).normalize()
        }
    }

    /// The colour at a point of the picture, in pixels from its top left corner.
    fn ray(&self, column: f32, row: f32) -> Vec3 {
        let (width, height) = (SIZE.0 as f32, SIZE.1 as f32);
        let up = (0.5 * self.task.fov).tan();
        let x = (2.0 * column / width - 1.0) * up * width / height;
        let y = (1.0 - 2.0 * row / height) * up;
        let ray = self.view.inverse().transform_vector3(Vec3::new(x, y, -1.0));
        let mut best: Option<Met> = None;
        for (number, triangle) in self.triangles.iter().enumerate() {
            let Some(met) = meet(self.task.eye, ray, number, triangle) else { continue };
            let met = Met { front: met.front != self.is(Mistake::WindingReversed), ..met };
            if !self.is_drawn(&self.task.things[triangle.thing], met.front) {
                continue;
            }
            let wins = best.as_ref().is_none_or(|best| {
                if self.is(Mistake::DepthTestMissing) {
                    true
                } else if self.is(Mistake::DepthTestReversed) {
                    met.t > best.t
                } else {
                    met.t < best.t
                }
            });
            if wins {
                best = Some(met);
            }
        }
        best.map_or(Vec3::from(self.task.background), |met| self.color(&met))
    }

    fn is_drawn(&self, thing: &Thing, front: bool) -> bool {
        match thing.faces {
            Faces::Front => front || self.is(Mistake::BackFacesNotCulled),
            Faces::Back => !front || self.is(Mistake::BackFacesNotCulled),
            Faces::Both => front || !self.is(Mistake::BackFacesCulled),
        }
    }

    fn shading(&self, thing: &Thing) -> Shading {
        match thing.shading {
            Shading::Phong if self.is(Mistake::GouraudForPhong) => Shading::Gouraud,
            Shading::Gouraud if self.is(Mistake::PhongForGouraud) => Shading::Phong,
            Shading::Phong | Shading::Gouraud if self.is(Mistake::FlatForSmooth) => Shading::Flat,
            Shading::Flat if self.is(Mistake::GouraudForFlat) => Shading::Gouraud,
            Shading::Flat if self.is(Mistake::PhongForFlat) => Shading::Phong,
            shading => shading,
        }
    }

    fn color(&self, met: &Met) -> Vec3 {
        let triangle = &self.triangles[met.triangle];
        let thing = &self.task.things[triangle.thing];
        let look = match &thing.back {
            Some(back) if !met.front && !self.is(Mistake::BackMaterialIgnored) => back,
            _ => &thing.front,
        };
        let sign = if met.front || self.is(Mistake::NormalsNotFlipped) { 1.0 } else { -1.0 };
        let face = if self.is(Mistake::WindingReversed) { -triangle.face } else { triangle.face };
        let [a, b, c] = &triangle.corners;
        let mut weights = met.weights;
        if self.is(Mistake::AffineInterpolation) {
            // Weights on the picture: areas of the projected triangle.
            let on_picture = |p: Vec3| Vec3::new(p.x / -p.z, p.y / -p.z, 0.0);
            let [pa, pb, pc] = [a, b, c].map(|corner| on_picture(corner.eye));
            let p = on_picture(mix([a.eye, b.eye, c.eye], weights));
            let area = |u: Vec3, v: Vec3, w: Vec3| (v - u).cross(w - u).z;
            weights = [area(p, pb, pc), area(p, pc, pa), area(p, pa, pb)].map(|part| part / area(pa, pb, pc));
        }
        let lit = match self.shading(thing) {
            Shading::Flat => {
                if self.is(Mistake::FlatFromFirstVertex) {
                    self.light(look, thing.reflectance, a.eye, sign * a.n)
                } else if self.is(Mistake::FlatFromLastVertex) {
                    self.light(look, thing.reflectance, c.eye, sign * c.n)
                } else {
                    self.light(look, thing.reflectance, (a.eye + b.eye + c.eye) / 3.0, sign * face)
                }
            }
            Shading::Gouraud => {
                let colors = [a, b, c].map(|corner| self.light(look, thing.reflectance, corner.eye, sign * corner.n));
                mix(colors, weights)
            }
            _ => {
                let mut n = mix([a.n, b.n, c.n], weights);
                if !self.is(Mistake::NormalsNotRenormalised) {
                    n = n.normalize();
                }
                if self.is(Mistake::FaceNormals) {
                    n = face;
                }
                self.light(look, thing.reflectance, mix([a.eye, b.eye, c.eye], weights), sign * n)
            }
        };
        lit + if self.is(Mistake::EmissionMissing) { Vec3::ZERO } else { Vec3::from(look.ke) }
    }

    /// All light that a point gives back, without emission.
    fn light(&self, look: &Look, reflectance: Reflectance, p: Vec3, n: Vec3) -> Vec3 {
        let [mut ka, mut kd, mut ks] = [look.ka, look.kd, look.ks].map(Vec3::from);
        if self.is(Mistake::AmbientByKd) {
            ka = kd;
        }
        if self.is(Mistake::SpecularSwapped) {
            std::mem::swap(&mut kd, &mut ks);
        }
        if self.is(Mistake::HighlightInSurfaceColor) {
            ks = kd;
        }
        let mut sum = ka * Vec3::from(self.task.ambient);
        if self.is(Mistake::AmbientNotTimesKa) {
            sum = Vec3::from(self.task.ambient);
        }
        if self.is(Mistake::AmbientForEachLight) {
            sum *= self.lamps.len() as f32;
        }
        if self.is(Mistake::AmbientMissing) {
            sum = Vec3::ZERO;
        }
        for lamp in &self.lamps {
            let (l, strength, fade) = self.arriving(lamp, p);
            let n_l = n.dot(l);
            let diffuse = if self.is(Mistake::CosineAbsolute) {
                n_l.abs()
            } else if self.is(Mistake::CosineNotClamped) {
                n_l
            } else {
                n_l.max(0.0)
            };
            let mut highlight = 0.0;
            if n_l > 0.0 || self.is(Mistake::HighlightBehind) {
                highlight = self.highlight(look, reflectance, [p, n, l]);
            }
            if self.is(Mistake::HighlightTimesCosine) {
                highlight *= n_l.max(0.0);
            }
            let is_positional = !matches!(lamp.kind, LampKind::Sun(_));
            let mut ambient = Vec3::from(lamp.la) * ka;
            let weakens = lamp.attenuates_ambient || self.is(Mistake::AmbientAttenuated);
            if is_positional && weakens && !self.is(Mistake::AmbientNotAttenuated) {
                ambient *= strength * fade;
            }
            if self.is(Mistake::AmbientMissing) || self.is(Mistake::LightAmbientMissing) {
                ambient = Vec3::ZERO;
            }
            sum += ambient;
            if !self.is(Mistake::DiffuseMissing) {
                sum += kd * Vec3::from(lamp.ld) * diffuse * strength * fade;
            }
            let ls = Vec3::from(if self.is(Mistake::HighlightInDiffuseLight) { lamp.ld } else { lamp.ls });
            let of_highlight = if self.is(Mistake::AttenuationOfDiffuseOnly) { fade } else { strength * fade };
            if !self.is(Mistake::HighlightMissing) {
                sum += ks * ls * highlight * of_highlight;
            }
        }
        sum
    }

    /// Toward the light, its attenuation, and the factor of its range and cone.
    fn arriving(&self, lamp: &Lamp, p: Vec3) -> (Vec3, f32, f32) {
        let rotated = |direction: Vec3| self.view.transform_vector3(direction);
        let falloff = |[mut a, mut b, mut c]: [f32; 3], d: f32| {
            if self.is(Mistake::AttenuationSwapped) {
                (b, c) = (c, b);
            }
            if self.is(Mistake::AttenuationInverseSquare) {
                (a, b, c) = (0.0, 0.0, 1.0);
            }
            if self.is(Mistake::AttenuationMissing) { 1.0 } else { 1.0 / (a + b * d + c * d * d) }
        };
        let at = match lamp.kind {
            LampKind::Sun(toward) => {
                let mut l = -rotated(toward);
                if self.is(Mistake::LightDirectionInWorldSpace) {
                    l = -toward;
                }
                if self.is(Mistake::LightDirectionReversed) {
                    l = -l;
                }
                let as_position = self.view.transform_point3(-toward);
                if self.is(Mistake::DirectionAsPosition) {
                    l = (as_position - p).normalize();
                }
                let mut strength = 1.0;
                if self.is(Mistake::AttenuationOfDirectional) {
                    let like = self.task.lamps.iter().find(|lamp| !matches!(lamp.kind, LampKind::Sun(_)));
                    let like = like.map_or([1.0, 0.09, 0.032], |lamp| lamp.attenuation);
                    strength = falloff(like, (as_position - p).length());
                }
                return (l, strength, 1.0);
            }
            LampKind::Bulb(at) | LampKind::Spot { at, .. } => at,
        };
        let at = if self.is(Mistake::LightPositionInWorldSpace) { at } else { self.view.transform_point3(at) };
        let d = (at - p).length();
        let l = if self.is(Mistake::LightNotUnit) { at - p } else { (at - p) / d };
        let strength =
            falloff(lamp.attenuation, if self.is(Mistake::AttenuationByEyeDistance) { p.length() } else { d });
        let mut fade = 1.0;
        if let Some(range) = lamp.range.filter(|_| !self.is(Mistake::RangeIgnored)) {
            fade *= (1.0 - (d / range).powi(4)).clamp(0.0, 1.0).powi(2);
        }
        if let LampKind::Spot { toward, cutoff, inner, exponent, .. } = lamp.kind {
            let mut axis = if self.is(Mistake::SpotDirectionInWorldSpace) { toward } else { rotated(toward) };
            if self.is(Mistake::SpotReversed) {
                axis = -axis;
            }
            fade *= self.cone(axis.dot(-l), cutoff, inner, exponent);
        }
        (l, strength, fade)
    }

    fn cone(&self, cos_phi: f32, cutoff: f32, inner: Option<f32>, exponent: f32) -> f32 {
        let angle = |angle: f32| {
            if self.is(Mistake::CutoffAsFullAngle) {
                angle / 2.0
            } else if self.is(Mistake::CutoffDoubled) {
                angle * 2.0
            } else if self.is(Mistake::CutoffInDegrees) {
                angle.to_degrees()
            } else {
                angle
            }
        };
        let cos_cutoff = angle(cutoff).cos();
        if cos_phi < cos_cutoff && !self.is(Mistake::CutoffIgnored) {
            return 0.0;
        }
        let mut factor = if self.is(Mistake::SpotExponentIgnored) || exponent == 0.0 {
            1.0
        } else {
            cos_phi.clamp(0.0, 1.0).powf(exponent)
        };
        let inner = inner.filter(|_| !self.is(Mistake::SpotInnerIgnored) && !self.is(Mistake::CutoffIgnored));
        if let Some(inner) = inner {
            let cos_inner = angle(inner).cos();
            if cos_phi < cos_inner {
                factor *= ((cos_phi - cos_cutoff) / (cos_inner - cos_cutoff)).powi(2);
            }
        }
        factor
    }

    fn highlight(&self, look: &Look, reflectance: Reflectance, [p, n, l]: [Vec3; 3]) -> f32 {
        let mut v = (-p).normalize();
        if self.is(Mistake::ViewNotUnit) {
            v = -p;
        }
        let is_infinite = match self.task.viewer {
            Viewer::Local => self.is(Mistake::ViewerAtInfinity),
            Viewer::Infinite => !self.is(Mistake::ViewerLocal),
        };
        if is_infinite {
            v = Vec3::Z;
        }
        if self.is(Mistake::ViewerAtWorldOrigin) {
            v = (self.view.transform_point3(Vec3::ZERO) - p).normalize();
        }
        if self.is(Mistake::ViewReversed) {
            v = -v;
        }
        let mut exponent = look.shininess;
        if reflectance == Reflectance::BlinnPhongMatched {
            exponent = halfway_lighting::matched_shininess(exponent);
        }
        let wants_phong = reflectance == Reflectance::Phong;
        let is_phong = if wants_phong { !self.is(Mistake::BlinnForPhong) } else { self.is(Mistake::PhongForBlinn) };
        if is_phong != wants_phong || self.is(Mistake::ShininessIgnored) {
            exponent = look.shininess;
        }
        if self.is(Mistake::ShininessIgnored) {
            exponent = 1.0;
        }
        let cosine = if is_phong {
            let r = 2.0 * n.dot(l) * n - l;
            if self.is(Mistake::ReflectionReversed) { -r.dot(v) } else { r.dot(v) }
        } else {
            let h = if self.is(Mistake::HalfwayNotUnit) { (l + v) / 2.0 } else { (l + v).normalize() };
            n.dot(h)
        };
        cosine.clamp(0.0, 1.0).powf(exponent)
    }

    fn bytes(&self, color: Vec3) -> [u8; 3] {
        let srgb = |i: f32| if i <= 0.003_130_8 { 12.92 * i } else { 1.055 * i.powf(1.0 / 2.4) - 0.055 };
        let byte = |i: f32| {
            let wraps = self.is(Mistake::ClampMissing);
            let i = if wraps { i.max(0.0) } else { i.clamp(0.0, 1.0) };
            let mut encoded = match self.task.encoding {
                Encoding::Srgb => srgb(i),
                Encoding::Raw => i,
            };
            if self.is(Mistake::GammaMissing) {
                encoded = i;
            }
            if self.is(Mistake::GammaAsPower) {
                encoded = i.powf(1.0 / 2.2);
            }
            if self.is(Mistake::GammaTwice) || self.is(Mistake::GammaUnasked) {
                encoded = srgb(encoded);
            }
            let steps = (encoded * 255.0 + 0.5) as u32;
            (if wraps { steps % 256 } else { steps.min(255) }) as u8
        };
        let [r, g, b] = color.to_array().map(byte);
        if self.is(Mistake::RedAndBlueSwapped) { [b, g, r] } else { [r, g, b] }
    }
}

fn mix([a, b, c]: [Vec3; 3], [u, v, w]: [f32; 3]) -> Vec3 {
    a * u + b * v + c * w
}

/// Möller and Trumbore, 1997.
fn meet(origin: Vec3, ray: Vec3, number: usize, triangle: &Triangle) -> Option<Met> {
    let [a, b, c] = triangle.corners.each_ref().map(|corner| corner.world);
    let (ab, ac) = (b - a, c - a);
    let q = ray.cross(ac);
    let determinant = ab.dot(q);
    if determinant == 0.0 {
        return None;
    }
    let from_a = (origin - a) / determinant;
    let u = from_a.dot(q);
    let r = from_a.cross(ab);
    let v = ray.dot(r);
    if u < 0.0 || v < 0.0 || u + v > 1.0 {
        return None;
    }
    let t = ac.dot(r);
    // Nothing nearer than the camera's near plane.
    (t > 0.1).then_some(Met { triangle: number, t, weights: [1.0 - u - v, u, v], front: determinant > 0.0 })
}
