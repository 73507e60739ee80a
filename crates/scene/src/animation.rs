//! Key frames in scene files: how keys of cameras, lights and objects change in time.
//!
//! A [`TrackEntry`] says how one key changes, and [`TrackEntry::at`] what it is at a time. [`AnimationPlugin`] plays the
//! tracks of a scene that was [spawned](fn@crate::spawn): before each frame every animated entity is given the values of
//! its keys at the frame's [`SceneTime`].

use std::sync::Arc;

use bevy_app::{App, Plugin, Update};
use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{DQuat, DVec4};
use bevy_time::Time;
use bevy_transform::components::Transform;
use halfway_lighting::{Camera, Range};
use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::Serializer;
use serde_json::{Map, Value, json};

use crate::check::{Check, KeyProblem, Limits, Within, in_range};
use crate::entry::{Entry, Written, number};
use crate::keys::{Object, keys, words};
use crate::light::{LightEntry, LightKind};
use crate::light_place::place;
use crate::transform::{TransformEntry, TransformParts};
use crate::view::CameraEntry;

keys! {
    /// How one key of a camera, a light or an object changes in time.
    #[derive(Clone, Debug, PartialEq)]
    pub struct TrackEntry {
        [required]
        /// The key that changes.
        of: AnimatedKey,
        /// A list of pairs `[time, value]`: the time in seconds, 0 or more, each later than the one before; the value as
        /// the key has it. Before the first pair and after the last one the key has their values.
        keys: Vec<KeyFrame>,
        [optional]
        /// How the value gets from a pair to the next.
        interpolation: Interpolation = Interpolation::default(),
        /// Whether it begins again, from time 0, after the last pair.
        repeat: bool = false,
    }
}

/// A value at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeyFrame {
    /// In seconds, 0 or more.
    pub time: f32,
    /// The numbers of the key's value.
    pub value: Vec<f32>,
}

/// The keys that change: `translation`, `rotation` and `scale` of an object's transform, and keys of the same names of
/// cameras and lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AnimatedKey {
    /// Of an object's transform.
    #[default]
    Translation,
    /// Of an object's transform: quaternions, between which it turns by the shorter way, at an even speed.
    Rotation,
    /// Of an object's transform.
    Scale,
    /// Of a camera or a light.
    Position,
    /// Of a camera.
    Target,
    /// Of a camera.
    Up,
    /// Of a perspective camera.
    FovYDeg,
    /// Of an orthographic camera.
    Height,
    /// Of a light.
    Direction,
    /// Of a light.
    Ambient,
    /// Of a light.
    Diffuse,
    /// Of a light.
    Specular,
    /// Of a hemisphere.
    Sky,
    /// Of a hemisphere.
    Ground,
}

/// How a value gets from a key frame to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// In proportion to the time.
    #[default]
    Linear,
    /// Not at all: it stays until the next one.
    Step,
}

words! {
    /// The key that changes.
    AnimatedKey {
        /// Of an object's transform.
        translation = Self::Translation,
        /// Of an object's transform: quaternions, between which it turns by the shorter way, at an even speed.
        rotation = Self::Rotation,
        /// Of an object's transform.
        scale = Self::Scale,
        /// Of a camera or a light.
        position = Self::Position,
        /// Of a camera.
        target = Self::Target,
        /// Of a camera.
        up = Self::Up,
        /// Of a perspective camera: one number.
        fov_y_deg = Self::FovYDeg,
        /// Of an orthographic camera: one number.
        height = Self::Height,
        /// Of a light.
        direction = Self::Direction,
        /// Of a light.
        ambient = Self::Ambient,
        /// Of a light.
        diffuse = Self::Diffuse,
        /// Of a light.
        specular = Self::Specular,
        /// Of a hemisphere.
        sky = Self::Sky,
        /// Of a hemisphere.
        ground = Self::Ground,
    }

    /// How a value gets from a pair to the next.
    Interpolation {
        /// In proportion to the time.
        linear = Self::Linear,
        /// Not at all: it stays until the next pair.
        step = Self::Step,
    }
}

impl AnimatedKey {
    fn name(self) -> &'static str {
        <Self as crate::keys::Keys>::WORDS[self as usize].0
    }

    /// How many numbers its value has; of a position in a homogeneous light, which has a fourth, one less.
    fn count(self) -> usize {
        match self {
            Self::Rotation => 4,
            Self::FovYDeg | Self::Height => 1,
            _ => 3,
        }
    }

    /// The range of each of its numbers.
    fn range(self) -> Range {
        match self {
            Self::FovYDeg => CameraEntry::FIELD_OF_VIEW,
            Self::Height => Range::POSITIVE,
            Self::Ambient | Self::Diffuse | Self::Specular | Self::Sky | Self::Ground => Range::CHANNEL,
            _ => Range::FINITE,
        }
    }

    /// Whether its value is a direction, or a quaternion.
    fn is_no_zero(self) -> bool {
        matches!(self, Self::Up | Self::Direction)
    }
}

impl Entry for KeyFrame {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(deserializer)?;
        let numbers = |value: &Value| match value {
            Value::Array(list) => list.iter().map(single).collect::<Option<Vec<f32>>>(),
            one => single(one).map(|one| vec![one]),
        };
        let pair = value.as_array().and_then(|pair| match pair.as_slice() {
            [time, value] => Some(Self { time: single(time)?, value: numbers(value)? }),
            _ => None,
        });
        pair.ok_or_else(|| {
            D::Error::custom(format_args!("is {value}; expected [time, value], such as [0.5, [1, 0, 0]]"))
        })
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeSeq;
        let mut pair = serializer.serialize_seq(Some(2))?;
        pair.serialize_element(&self.time)?;
        match self.value.as_slice() {
            [one] => pair.serialize_element(one)?,
            _ => pair.serialize_element(&Written(&self.value))?,
        }
        pair.end()
    }

    fn schema(_: &mut Map<String, Value>, _: &Limits) -> Value {
        let any = number(&Range::FINITE);
        let value = json!({ "anyOf": [any, { "type": "array", "items": any, "minItems": 3, "maxItems": 4 }] });
        let pair = [number(&Range::NON_NEGATIVE), value];
        json!({ "type": "array", "prefixItems": pair, "items": false, "minItems": 2, "maxItems": 2 })
    }

    fn check(&self, _: &Limits) -> Check {
        in_range("[0]", self.time, Range::NON_NEGATIVE)
    }
}

/// A number of JSON; one that is too large for an `f32` is infinite, which its check refuses.
fn single(value: &Value) -> Option<f32> {
    value.as_f64().map(|number| number as f32)
}

impl Object for TrackEntry {
    const EXPECTED: &'static str =
        "an object such as {\"of\": \"translation\", \"keys\": [[0, [0, 0, 0]], [2, [1, 0, 0]]]}";

    fn check_whole(&self) -> Check {
        if self.keys.is_empty() {
            return Err(KeyProblem::new("keys", "is empty; expected at least one pair [time, value]"));
        }
        let mut before = -1.0;
        for (i, KeyFrame { time, .. }) in self.keys.iter().enumerate() {
            if *time <= before {
                let message = format!("is {time}; expected a time after {before}, that of the pair before");
                return Err(KeyProblem::new("[0]", message)).within_item(i).within("keys");
            }
            before = *time;
        }
        Ok(())
    }
}

impl TrackEntry {
    /// Checks the values of its key, which has so many numbers.
    fn check_values(&self, count: usize) -> Check {
        for (i, KeyFrame { value, .. }) in self.keys.iter().enumerate() {
            let name = self.of.name();
            let wrong = |message: String| Err(KeyProblem::new("[1]", message)).within_item(i).within("keys");
            if value.len() != count {
                let numbers = if count == 1 { "one number".to_owned() } else { format!("{count} numbers") };
                return wrong(format!("has {} numbers; expected {numbers}, as `{name}` has", value.len()));
            }
            let range = self.of.range();
            if let Some(number) = value.iter().find(|number| !range.contains(**number)) {
                return wrong(format!("has {number}; expected of `{name}` {}", range.expected));
            }
            if self.of.is_no_zero() && value.iter().all(|number| *number == 0.0) {
                return wrong("is [0, 0, 0]; expected a direction, of any length above 0".to_owned());
            }
            if let (AnimatedKey::Rotation, &[x, y, z, w]) = (self.of, value.as_slice()) {
                TransformParts { rotation: [x, y, z, w], ..TransformParts::default() }
                    .check_whole()
                    .or_else(|KeyProblem { message, .. }| wrong(message))?;
            }
        }
        Ok(())
    }

    /// The value at a time in seconds: as many numbers as the key has, and zeros after them. Rotations are of unit length.
    ///
    /// ```
    /// use halfway_scene::SceneFile;
    ///
    /// let scene = SceneFile::from_json(
    ///     r#"{"objects": [{"mesh": {"box": {}}, "animation": [
    ///         {"of": "translation", "keys": [[0, [0, 0, 0]], [2, [4, 0, 0]]], "repeat": true}]}]}"#,
    ///     "moving.json",
    /// )?;
    /// let track = &scene.objects[0].animation[0];
    /// assert_eq!(track.at(0.5), [1.0, 0.0, 0.0, 0.0]);
    /// assert_eq!(track.at(2.5), track.at(0.5));
    /// # Ok::<(), halfway_scene::SceneError>(())
    /// ```
    pub fn at(&self, time: f64) -> [f32; 4] {
        let (Some(first), Some(last)) = (self.keys.first(), self.keys.last()) else { return [0.0; 4] };
        let period = f64::from(last.time);
        let time = if self.repeat && period > 0.0 { time.rem_euclid(period) } else { time };
        // The first key frame that is later.
        let next = self.keys.partition_point(|key| f64::from(key.time) <= time);
        let before = if next == 0 { first } else { &self.keys[next - 1] };
        let after = self.keys.get(next).unwrap_or(last);
        let span = f64::from(after.time) - f64::from(before.time);
        let share = match self.interpolation {
            Interpolation::Linear if span > 0.0 => ((time - f64::from(before.time)) / span).clamp(0.0, 1.0),
            Interpolation::Linear | Interpolation::Step => 0.0,
        };
        let [a, b] = [before, after].map(|key| {
            let mut four = [0.0; 4];
            four.iter_mut().zip(&key.value).for_each(|(to, from)| *to = f64::from(*from));
            DVec4::from(four)
        });
        let value = if self.of == AnimatedKey::Rotation {
            let [a, b] = [a, b].map(|v| DQuat::from_vec4(v.normalize_or(DVec4::W)));
            DVec4::from(a.slerp(b, share).normalize())
        } else {
            a + (b - a) * share
        };
        value.to_array().map(|number| number as f32)
    }
}

/// An entry with keys that tracks can change.
pub(crate) trait Animate: Clone {
    /// How many numbers a key has; else what the entry is, and why it has no such key.
    fn count(&self, key: AnimatedKey) -> Result<usize, String>;
    /// Sets a key.
    fn set(&mut self, key: AnimatedKey, value: [f32; 4]);

    /// The entry at a time in seconds.
    fn at(&self, tracks: &[TrackEntry], time: f64) -> Self {
        let mut entry = self.clone();
        for track in tracks {
            entry.set(track.of, track.at(time));
        }
        entry
    }

    /// Checks its tracks.
    fn check_tracks(&self, tracks: &[TrackEntry]) -> Check {
        for (i, track) in tracks.iter().enumerate() {
            let count =
                self.count(track.of).map_err(|why| KeyProblem::new("of", format!("is \"{}\"; {why}", track.of.name())));
            let check = count.and_then(|count| track.check_values(count));
            check.within_item(i).within("animation")?;
            if tracks[..i].iter().any(|other| other.of == track.of) {
                let message = format!("is \"{}\", as of a track before; expected each key once", track.of.name());
                return Err(KeyProblem::new("of", message)).within_item(i).within("animation");
            }
        }
        Ok(())
    }
}

fn three([x, y, z, _]: [f32; 4]) -> [f32; 3] {
    [x, y, z]
}

impl Animate for TransformEntry {
    fn count(&self, key: AnimatedKey) -> Result<usize, String> {
        match (key, self) {
            (AnimatedKey::Translation | AnimatedKey::Rotation | AnimatedKey::Scale, Self::Parts(_)) => Ok(key.count()),
            (AnimatedKey::Translation | AnimatedKey::Rotation | AnimatedKey::Scale, Self::Matrix(_)) => {
                Err("the transform is a matrix; expected one with translation, rotation and scale".to_owned())
            }
            _ => Err("expected a key of an object: translation, rotation or scale".to_owned()),
        }
    }

    fn set(&mut self, key: AnimatedKey, value: [f32; 4]) {
        let Self::Parts(parts) = self else { return };
        match key {
            AnimatedKey::Translation => parts.translation = three(value),
            AnimatedKey::Rotation => parts.rotation = value,
            AnimatedKey::Scale => parts.scale = three(value),
            _ => {}
        }
    }
}

impl Animate for LightEntry {
    fn count(&self, key: AnimatedKey) -> Result<usize, String> {
        let of_lights = [
            AnimatedKey::Position,
            AnimatedKey::Direction,
            AnimatedKey::Ambient,
            AnimatedKey::Diffuse,
            AnimatedKey::Specular,
            AnimatedKey::Sky,
            AnimatedKey::Ground,
        ];
        if of_lights.contains(&key) && self.kind.has(key.name()) {
            let has_w = key == AnimatedKey::Position && self.kind == LightKind::Homogeneous;
            return Ok(key.count() + usize::from(has_w));
        }
        let own: Vec<&str> = of_lights.map(AnimatedKey::name).into_iter().filter(|name| self.kind.has(name)).collect();
        Err(format!("expected a key of this light: {}", own.join(", ")))
    }

    fn set(&mut self, key: AnimatedKey, value: [f32; 4]) {
        let [red, green, blue, _] = value;
        let color = LinearRgba::rgb(red, green, blue);
        match key {
            AnimatedKey::Position if self.kind == LightKind::Homogeneous => self.position = value,
            AnimatedKey::Position => self.position[..3].copy_from_slice(&three(value)),
            AnimatedKey::Direction => self.cone.direction = three(value),
            AnimatedKey::Ambient => self.light.ambient = color,
            AnimatedKey::Diffuse => self.light.diffuse = color,
            AnimatedKey::Specular => self.light.specular = color,
            AnimatedKey::Sky => self.hemisphere.sky = color,
            AnimatedKey::Ground => self.hemisphere.ground = color,
            _ => {}
        }
    }
}

impl Animate for CameraEntry {
    fn count(&self, key: AnimatedKey) -> Result<usize, String> {
        let zoom = if self.height.is_some() { AnimatedKey::Height } else { AnimatedKey::FovYDeg };
        match key {
            AnimatedKey::Position | AnimatedKey::Target | AnimatedKey::Up => Ok(key.count()),
            _ if key == zoom && self.intrinsics.is_none() => Ok(key.count()),
            _ => Err(format!("expected a key of this camera: position, target, up or {}", zoom.name())),
        }
    }

    fn set(&mut self, key: AnimatedKey, value: [f32; 4]) {
        match key {
            AnimatedKey::Position => self.position = three(value),
            AnimatedKey::Target => self.target = three(value),
            AnimatedKey::Up => self.up = three(value),
            AnimatedKey::FovYDeg => self.fov_y_deg = value[0],
            AnimatedKey::Height => self.height = Some(value[0]),
            _ => {}
        }
    }
}

/// The time of the animations of scenes.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub enum SceneTime {
    /// The time since the App's start, by bevy's `Time`.
    #[default]
    Clock,
    /// This many seconds.
    At(f64),
}

/// The set in `Update` in which animated entities are given their values.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct AnimationSystems;

/// Plays the animations of spawned scenes at the App's [`SceneTime`]. Part of `HalfwayPlugins`.
#[derive(Clone, Copy, Debug, Default)]
pub struct AnimationPlugin;

impl Plugin for AnimationPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<SceneTime>().add_systems(Update, play.in_set(AnimationSystems));
    }
}

/// The animated keys of an entity, with those of its entry that stay.
#[derive(Component, Clone, Debug, PartialEq)]
pub(crate) enum Animated {
    Object(Arc<(TransformEntry, Vec<TrackEntry>)>),
    Light(Arc<(LightEntry, Vec<TrackEntry>)>),
    Camera(Arc<(CameraEntry, Vec<TrackEntry>)>),
}

impl Animated {
    /// `None` where nothing changes.
    pub(crate) fn object(transform: &TransformEntry, tracks: &[TrackEntry]) -> Option<Self> {
        (!tracks.is_empty()).then(|| Self::Object(Arc::new((*transform, tracks.to_vec()))))
    }

    /// `None` where nothing changes.
    pub(crate) fn light(light: &LightEntry) -> Option<Self> {
        let still = LightEntry { animation: Vec::new(), ..light.clone() };
        (!light.animation.is_empty()).then(|| Self::Light(Arc::new((still, light.animation.clone()))))
    }

    /// `None` where nothing changes.
    pub(crate) fn camera(camera: &CameraEntry) -> Option<Self> {
        let still = CameraEntry { animation: Vec::new(), ..camera.clone() };
        (!camera.animation.is_empty()).then(|| Self::Camera(Arc::new((still, camera.animation.clone()))))
    }
}

/// Gives every animated entity its values at the scene's time.
fn play(world: &mut World) {
    let mut query = world.query::<(Entity, &Animated)>();
    let animated: Vec<(Entity, Animated)> = query.iter(world).map(|(entity, it)| (entity, it.clone())).collect();
    let time = match world.get_resource::<SceneTime>() {
        Some(SceneTime::At(time)) => *time,
        Some(SceneTime::Clock) | None => world.get_resource::<Time>().map_or(0.0, Time::elapsed_secs_f64),
    };
    for (entity, animated) in animated {
        pose(&mut world.entity_mut(entity), &animated, time);
    }
}

fn pose(entity: &mut EntityWorldMut, animated: &Animated, time: f64) {
    let transform = match animated {
        Animated::Object(object) => object.0.at(&object.1, time).parts(),
        Animated::Light(light) => {
            let (component, transform) = place(&light.0.at(&light.1, time));
            component.insert_into(entity);
            Some(transform)
        }
        Animated::Camera(camera) => {
            let camera = camera.0.at(&camera.1, time);
            if let Some(mut there) = entity.get_mut::<Camera>() {
                let projection = camera.projection();
                if there.projection != projection {
                    there.projection = projection;
                }
            }
            // At a moment without a direction it stays as it was.
            camera.axes().map(|_| camera.transform())
        }
    };
    // Transforms that stay are not touched, so that nothing after them has to be done again.
    if let (Some(transform), Some(mut there)) = (transform, entity.get_mut::<Transform>())
        && *there != transform
    {
        *there = transform;
    }
}
