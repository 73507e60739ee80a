//! An App that draws scenes, one after the other.

use crate::render::adapter::choice;
use crate::render::scene::{Around, Kind, Lamp, Map, On, Scene, Thing};
use halfway::prelude::*;
use halfway::reference::Oracle;
use halfway::reference::metrics::Bars;
use halfway::render::{Adapter, AdapterChoice, RenderError};
use halfway::texture::environment::{EnvironmentLight, EnvironmentMap};
use image::{Rgba32FImage, RgbaImage};
use std::sync::OnceLock;
use std::time::Duration;

/// Every mesh as it is, and lights left out within half a step.
pub(crate) const FULL: Tolerance = Tolerance::steps(0.5);

/// `bars` for bytes of hardware, which may round to either byte from 0.4 of a step to 0.6 (Direct3D's conversion
/// rules): a fifth of all values, in each of a pixel's three channels.
pub(crate) fn of_hardware(bars: Bars) -> Bars {
    Bars { equal: bars.equal.min(0.5), ..bars }
}

/// An App with the facade's plugins and a headless target, on which scenes replace each other.
pub(crate) struct Stage {
    pub(crate) app: App,
    /// The root entities of the current scene.
    spawned: Vec<Entity>,
    /// Equal meshes share a handle, as they would in an App.
    meshes: Vec<(Mesh, Handle<Mesh>)>,
}

impl Stage {
    /// A floating-point target on which meshes are drawn as they are.
    pub(crate) fn new(width: u32, height: u32) -> Self {
        Self::drawn_by(choice(), width, height)
    }

    /// The same, always drawn by the CPU.
    pub(crate) fn on_the_cpu(width: u32, height: u32) -> Self {
        Self::drawn_by(AdapterChoice::cpu(), width, height)
    }

    fn drawn_by(choice: AdapterChoice, width: u32, height: u32) -> Self {
        let mut app = App::new();
        app.add_plugins(HalfwayPlugins::headless(UVec2::new(width, height)));
        app.world_mut().resource_mut::<Headless>().pixels = Pixels::Float;
        app.insert_resource(ViewTolerance(FULL));
        app.insert_resource(choice);
        Self { app, spawned: Vec::new(), meshes: Vec::new() }
    }

    pub(crate) fn world(&mut self) -> &mut World {
        self.app.world_mut()
    }

    /// Draws the current scene until all requested pipelines are built.
    pub(crate) fn compile(&mut self) {
        self.wait_for(|report| report.pipelines_pending);
    }

    fn wait_for(&mut self, pending: fn(&FrameReport) -> u32) {
        self.frame();
        while pending(self.report()) > 0 {
            std::thread::sleep(Duration::from_millis(2));
            self.frame();
        }
    }

    pub(crate) fn pixels(&mut self, pixels: Pixels) {
        self.world().resource_mut::<Headless>().pixels = pixels;
    }

    /// The encoding of the camera's bytes from now on.
    pub(crate) fn encode(&mut self, encoding: Encoding) {
        let world = self.world();
        for mut camera in world.query::<&mut Camera>().iter_mut(world) {
            camera.encoding = encoding;
        }
    }

    pub(crate) fn target_size(&mut self, width: u32, height: u32) {
        self.world().resource_mut::<Headless>().size = UVec2::new(width, height);
    }

    /// The adapter that has drawn.
    pub(crate) fn adapter(&self) -> Adapter {
        Adapter::from_world(self.app.world()).expect("a frame has been drawn")
    }

    /// Whether the CPU has drawn, without a driver.
    pub(crate) fn is_on_cpu(&self) -> bool {
        matches!(self.adapter(), Adapter::Cpu(_))
    }

    /// The bits of the adapter's grid within a pixel.
    pub(crate) fn grid_bits(&self) -> u32 {
        // One adapter draws all tests of a process, and some are drawn by the CPU in any case.
        static BITS: OnceLock<u32> = OnceLock::new();
        let bits = || self.adapter().sub_pixel_bits().unwrap_or_else(|error| panic!("{error}"));
        if self.is_on_cpu() { bits() } else { *BITS.get_or_init(bits) }
    }

    /// `bars` adjusted to the adapter's rounding to bytes.
    pub(crate) fn rounding(&self, bars: Bars) -> Bars {
        if self.is_hardware() { of_hardware(bars) } else { bars }
    }

    pub(crate) fn is_hardware(&self) -> bool {
        matches!(self.adapter(), Adapter::Gpu(gpu) if !gpu.is_software())
    }

    /// Whether a floating-point picture may show blended objects.
    pub(crate) fn blends_floats(&self) -> bool {
        self.adapter().blends_floats()
    }

    pub(crate) fn report(&self) -> &FrameReport {
        self.app.world().resource::<FrameReport>()
    }

    /// Replaces the current scene by `scene`; returns its objects, in order.
    pub(crate) fn set(&mut self, scene: &Scene) -> Vec<Entity> {
        for entity in std::mem::take(&mut self.spawned) {
            // A test may have despawned it.
            if let Ok(entity) = self.world().get_entity_mut(entity) {
                entity.despawn();
            }
        }
        self.world().insert_resource(GlobalAmbient(scene.ambient));
        let camera = self.spawn((scene.camera, scene.eye));
        if let Some(shading) = scene.view_shading {
            self.world().entity_mut(camera).insert(shading);
        }
        if let Some(reflectance) = scene.view_reflectance {
            self.world().entity_mut(camera).insert(reflectance);
        }
        let things: Vec<Entity> = scene.things.iter().map(|thing| self.thing(thing)).collect();
        for lamp in &scene.lamps {
            self.lamp(lamp, camera, &things);
        }
        if let Some(Around { map, strength, rotation, sky }) = scene.environment.clone() {
            let map = self.world().resource_mut::<Assets<EnvironmentMap>>().add(map);
            self.spawn(EnvironmentLight { map, strength, rotation, sky });
        }
        things
    }

    /// Spawns one more entity that goes with the scene.
    pub(crate) fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        let entity = self.world().spawn(bundle).id();
        self.spawned.push(entity);
        entity
    }

    /// The oracle of the scene as of the last frame.
    pub(crate) fn oracle(&mut self) -> Oracle {
        let size = self.world().resource::<Headless>().size;
        Oracle::new(self.world(), size).unwrap_or_else(|error| panic!("{error}"))
    }

    fn thing(&mut self, thing: &Thing) -> Entity {
        let handle = self.handle(&thing.mesh);
        let (own, parents) = thing.frames.split_last().expect("an object has a transform");
        let mut parent = None;
        for frame in parents {
            parent = Some(self.child(*frame, parent));
        }
        let mut maps = Maps::default();
        for (kind, map) in &thing.maps {
            let Map { image, sampling, transform, uv_set, channel, amount, far_normals } = map;
            let texture = self.world().resource_mut::<Assets<Texture>>().add(Texture::from(image.clone()));
            let map = SurfaceMap {
                texture,
                sampling: *sampling,
                uv_set: *uv_set,
                transform: *transform,
                channel: *channel,
                amount: *amount,
                far_normals: *far_normals,
            };
            maps.set(*kind, Some(map));
        }
        let entity = self.child((*own, Mesh3d(handle), thing.material), parent);
        let mut entity = self.world().entity_mut(entity);
        if let Some(name) = &thing.name {
            entity.insert(Name::new(name.clone()));
        }
        if let Some(back) = thing.back {
            entity.insert(BackMaterial(back));
        }
        if let Some(shading) = thing.shading {
            entity.insert(shading);
        }
        if let Some(reflectance) = thing.reflectance {
            entity.insert(reflectance);
        }
        if let Some(faces) = thing.faces {
            entity.insert(faces);
        }
        if maps.iter().next().is_some() {
            entity.insert(maps);
        }
        if let Some(solid) = thing.solid {
            entity.insert(solid);
        }
        if let Some(colors) = thing.colors {
            entity.insert(colors);
        }
        if thing.mask.is_some() || thing.blend {
            entity.insert(AlphaMode::new(thing.mask, thing.blend));
        }
        entity.id()
    }

    fn lamp(&mut self, lamp: &Lamp, camera: Entity, things: &[Entity]) {
        let parent = match lamp.on {
            On::World => None,
            On::Camera => Some(camera),
            On::Thing(thing) => Some(things[thing]),
        };
        match lamp.kind.clone() {
            Kind::Directional(light) => self.child((light, lamp.at), parent),
            Kind::Point(light) => self.child((light, lamp.at), parent),
            Kind::Spot(light) => self.child((light, lamp.at), parent),
            Kind::Hemisphere(light) => self.child((light, lamp.at), parent),
        };
    }

    fn child(&mut self, bundle: impl Bundle, parent: Option<Entity>) -> Entity {
        match parent {
            Some(parent) => self.world().spawn((bundle, ChildOf(parent))).id(),
            None => self.spawn(bundle),
        }
    }

    /// The handle of a mesh; equal meshes get the same one.
    pub(crate) fn handle(&mut self, mesh: &Mesh) -> Handle<Mesh> {
        if let Some((_, handle)) = self.meshes.iter().find(|(known, _)| known == mesh) {
            return handle.clone();
        }
        let handle = self.world().resource_mut::<Assets<Mesh>>().add(mesh.clone());
        self.meshes.push((mesh.clone(), handle.clone()));
        handle
    }

    pub(crate) fn try_draw(&mut self) -> Result<Picture, RenderError> {
        render_picture(&mut self.app)
    }

    /// A frame without reading its picture: for counters and for errors.
    pub(crate) fn frame(&mut self) -> &FrameReport {
        self.app.update();
        self.report()
    }

    /// Draws the current scene into floating point; no error may be reported.
    pub(crate) fn float(&mut self) -> Rgba32FImage {
        self.pixels(Pixels::Float);
        match self.try_draw() {
            Ok(Picture::Float(image)) => image,
            Ok(Picture::Byte(_)) => panic!("asked for a floating-point picture and got bytes"),
            Err(error) => panic!("{error}"),
        }
    }

    /// Draws the current scene into 8 bits; no error may be reported.
    pub(crate) fn bytes(&mut self) -> RgbaImage {
        self.pixels(Pixels::Byte);
        match self.try_draw() {
            Ok(Picture::Byte(image)) => image,
            Ok(Picture::Float(_)) => panic!("asked for a picture of bytes and got floating point"),
            Err(error) => panic!("{error}"),
        }
    }

    pub(crate) fn draw(&mut self, scene: &Scene) -> Rgba32FImage {
        self.set(scene);
        self.float()
    }

    pub(crate) fn draw_bytes(&mut self, scene: &Scene) -> RgbaImage {
        self.set(scene);
        self.bytes()
    }
}
