//! A user's hands on the panels: events as a window sends them, without a window.

use egui::accesskit::{Node, TreeUpdate};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, Role, pos2, vec2};
use halfway::lighting::{Edges, Projection, Show, Upright, Width};
use halfway::mesh::UvSphere;
use halfway::scene::{EdgesEntry, LightEntry, LightsEntry, MaterialEntry, MeshEntry, ObjectEntry, SceneFile};

use super::*;
use crate::projected::pixels_of;
use halfway::lighting::Part;
use halfway::record::{FrameToDraw, ReferenceDrawing};
use std::ops::ControlFlow;

const WINDOW: Rect = Rect { min: Pos2::ZERO, max: pos2(1280.0, 720.0) };

/// A viewer in an App, and the pointer over it.
struct Hands {
    app: App,
    viewer: SceneViewer,
    time: f64,
    seen: TreeUpdate,
}

impl Hands {
    fn new(scene: SceneFile) -> Self {
        let mut app = App::new();
        app.add_plugins(HalfwayPlugins::reference());
        app.finish();
        app.cleanup();
        let mut viewer = SceneViewer::new(Document::new(scene, "", "scene.json"));
        viewer.settings = Settings { remembers: false, ..Settings::default() };
        viewer.context.enable_accesskit();
        viewer.live = Some(Live::new(&viewer.document, app.world_mut()).expect("the scene is valid"));
        let mut hands = Self { app, viewer, time: 0.0, seen: empty() };
        hands.orbit();
        hands.frames(3);
        hands
    }

    /// Gives the camera an orbit, as the window does.
    fn orbit(&mut self) {
        let camera = self.camera();
        let world = self.app.world_mut();
        if world.get::<OrbitCamera>(camera).is_none() {
            let transform = *world.get::<Transform>(camera).expect("cameras have one");
            world.entity_mut(camera).insert(OrbitCamera::resume(&transform, transform.translation.length()));
        }
    }

    fn camera(&self) -> Entity {
        self.viewer.live.as_ref().expect("a scene is shown").spawned.camera
    }

    fn scene(&self) -> &SceneFile {
        &self.viewer.document.scene
    }

    fn frame(&mut self, events: Vec<Event>) {
        self.time += 1.0 / 60.0;
        let input = RawInput {
            screen_rect: Some(WINDOW),
            time: Some(self.time),
            focused: true,
            max_texture_side: Some(8192),
            events,
            ..RawInput::default()
        };
        let output = self.viewer.run(input, self.app.world_mut());
        self.seen = output.accesskit_update.unwrap_or_else(empty);
        self.app.update();
        self.orbit();
    }

    fn frames(&mut self, count: usize) {
        (0..count).for_each(|_| self.frame(Vec::new()));
    }

    /// The node with this role and the text in its name or value.
    fn find(&self, role: Role, text: &str) -> Option<Rect> {
        let has_text = |node: &Node| {
            let of = [node.label(), node.value()];
            of.into_iter().flatten().any(|found| found == text)
        };
        self.seen.nodes.iter().find(|(_, node)| node.role() == role && has_text(node)).and_then(|(_, node)| place(node))
    }

    /// All places of a role in the values of what is selected, from the top.
    fn values(&self, role: Role) -> Vec<Rect> {
        let nodes = self.seen.nodes.iter().filter(|(_, node)| node.role() == role && !node.is_disabled());
        let mut places: Vec<Rect> = nodes.filter_map(|(_, node)| place(node)).collect();
        places.retain(|rect| rect.left() > 900.0 && rect.top() > 20.0 && rect.bottom() < WINDOW.bottom());
        places.sort_by(|a, b| (a.top(), a.left()).partial_cmp(&(b.top(), b.left())).expect("they are numbers"));
        places
    }

    fn press(&mut self, at: Pos2, pressed: bool) {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        self.frame(vec![Event::PointerMoved(at), Event::PointerButton { pos: at, button, pressed, modifiers }]);
    }

    fn click(&mut self, at: Pos2) {
        self.frame(vec![Event::PointerMoved(at)]);
        self.press(at, true);
        self.press(at, false);
        // Not a part of a double click.
        self.time += 1.0;
        self.frames(2);
    }

    fn drag(&mut self, from: Pos2, by: egui::Vec2) {
        self.frame(vec![Event::PointerMoved(from)]);
        self.press(from, true);
        for step in 1..=4 {
            self.frame(vec![Event::PointerMoved(from + by * (step as f32 / 4.0))]);
        }
        self.press(from + by, false);
        self.frames(2);
    }

    fn key(&mut self, key: Key, modifiers: Modifiers) {
        let event = |pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
        let input = vec![event(true), event(false)];
        self.frame(input);
        self.frames(1);
    }

    fn choose(&mut self, button: &str) {
        let at = self.find(Role::Button, button).unwrap_or_else(|| panic!("no {button:?} among {:?}", self.texts()));
        self.click(at.center());
    }

    fn texts(&self) -> Vec<String> {
        self.seen.nodes.iter().filter_map(|(_, node)| node.label().or(node.value()).map(str::to_owned)).collect()
    }
}

fn empty() -> TreeUpdate {
    TreeUpdate {
        nodes: Vec::new(),
        tree: None,
        tree_id: egui::accesskit::TreeId::ROOT,
        focus: egui::accesskit::NodeId(0),
    }
}

fn place(node: &Node) -> Option<Rect> {
    let bounds = node.bounds()?;
    let [x0, y0, x1, y1] = [bounds.x0, bounds.y0, bounds.x1, bounds.y1].map(|at| at as f32);
    Some(Rect::from_min_max(pos2(x0, y0), pos2(x1, y1)))
}

fn ball(name: &str) -> ObjectEntry {
    let material = Some(MaterialEntry::Values(Material::BRASS));
    let name = Some(name.to_owned());
    ObjectEntry { material, name, ..ObjectEntry::new(MeshEntry::UvSphere(UvSphere::default())) }
}

fn scene(lights: Vec<LightEntry>) -> SceneFile {
    let camera = Some(halfway::scene::CameraEntry { position: [0.0, 1.0, 6.0], ..Default::default() });
    SceneFile { camera, lights: Some(lights.into()), objects: vec![ball("ball")], ..SceneFile::default() }
}

fn named(kind: LightKind, position: [f64; 3]) -> LightEntry {
    let [x, y, z] = position;
    LightEntry { name: Some("lamp".into()), position: [x, y, z, 1.0], ..LightEntry::white(kind) }
}

/// Whatever can be selected: what to click, with the scene in which it is.
fn selections() -> Vec<(&'static str, SceneFile)> {
    let mut soft = named(LightKind::Spot, [1.0, 2.0, 1.0]);
    soft.cone.inner_deg = Some(10.0);
    let mut near = named(LightKind::Point, [1.0, 2.0, 1.0]);
    near.light.range = Some(20.0);
    let mut homogeneous = named(LightKind::Homogeneous, [1.0, 2.0, 1.0]);
    homogeneous.cone.cutoff_deg = 45.0;
    let mut two_sided = scene(Vec::new());
    two_sided.objects[0].back_material = Some(MaterialEntry::Values(Material::BRASS));
    vec![
        ("Scene", scene(Vec::new())),
        (
            "Scene",
            SceneFile { edges: Some(EdgesEntry { width: Width::Pixels(4.0), ..look::thin() }), ..scene(Vec::new()) },
        ),
        ("Camera", scene(Vec::new())),
        ("lamp", scene(vec![near])),
        ("lamp", scene(vec![soft])),
        ("lamp", scene(vec![named(LightKind::Directional, [0.0; 3])])),
        ("lamp", scene(vec![homogeneous])),
        ("lamp", scene(vec![named(LightKind::Hemisphere, [0.0; 3])])),
        ("ball", scene(Vec::new())),
        ("ball", two_sided),
    ]
}

/// The scene and the camera, as text.
fn state(hands: &Hands) -> String {
    let camera = hands.app.world().get::<Camera>(hands.camera());
    let orbit = hands.app.world().get::<OrbitCamera>(hands.camera());
    format!("{} {camera:?} {orbit:?}", hands.scene().to_json().expect("panels leave a valid scene"))
}

/// Every slider, number and check box of every selection changes something when it is used; the scene stays valid, and
/// undoing gives the first one back.
#[test]
fn every_value_can_be_changed_and_undone() {
    let mut used = 0;
    for (selection, scene) in selections() {
        for role in [Role::Slider, Role::SpinButton, Role::CheckBox] {
            let mut number = 0;
            loop {
                let mut hands = Hands::new(scene.clone());
                hands.choose(selection);
                let Some(place) = hands.values(role).get(number).copied() else { break };
                number += 1;
                let before = state(&hands);
                assert_eq!(hands.scene(), &scene, "{selection}: looking at values changes none");
                match role {
                    Role::CheckBox => hands.click(place.left_center() + vec2(8.0, 0.0)),
                    Role::Slider => hands.drag(place.center(), vec2(-31.0, 0.0)),
                    _ => hands.drag(place.center(), vec2(25.0, 0.0)),
                }
                if role == Role::SpinButton && state(&hands) == before {
                    // It is at its upper end.
                    hands.drag(place.center(), vec2(-25.0, 0.0));
                }
                assert_ne!(state(&hands), before, "{selection}: {role:?} {number} at {place:?}");
                used += 1;
                if selection != "Camera" {
                    hands.key(Key::Z, Modifiers::COMMAND);
                    assert_eq!(hands.scene(), &scene, "{selection}: {role:?} {number} is undone");
                }
            }
        }
    }
    // As many as there are; a panel that is left out would go unseen otherwise.
    assert!(used > 60, "{used}");
}

/// Every list offers something else, which changes the scene when it is chosen.
#[test]
fn every_choice_can_be_made() {
    let mut used = 0;
    for (selection, scene) in selections() {
        let mut number = 0;
        loop {
            let mut hands = Hands::new(scene.clone());
            hands.choose(selection);
            let Some(place) = hands.values(Role::ComboBox).get(number).copied() else { break };
            number += 1;
            let before: Vec<String> = hands.texts();
            let first = state(&hands);
            hands.click(place.center());
            // The one that is nearest: a long list shows only some.
            let offered = hands.texts().into_iter().filter(|text| !before.contains(text));
            let away = |text: &str| hands.find(Role::Button, text).map(|rect| rect.center().distance(place.center()));
            let near = offered.filter_map(|text| Some((away(&text)?, text))).min_by(|a, b| a.0.total_cmp(&b.0));
            let (_, other) = near.unwrap_or_else(|| panic!("{selection}: list {number} offers nothing else"));
            hands.choose(&other);
            assert_ne!(state(&hands), first, "{selection}: list {number}, {other:?}");
            assert!(hands.scene().validate().is_ok(), "{selection}: {other:?}");
            used += 1;
        }
    }
    assert!(used > 12, "{used}");
}

#[test]
fn a_light_is_added_moved_and_removed() {
    let mut hands = Hands::new(scene(Vec::new()));
    hands.key(Key::A, Modifiers::NONE);
    let light = |hands: &Hands| match &hands.scene().lights {
        Some(LightsEntry::List(list)) => list.clone(),
        other => panic!("{other:?}"),
    };
    assert_eq!(light(&hands).len(), 1);
    assert_eq!(hands.viewer.selected, Selected::Light(0));
    assert_eq!(hands.app.world_mut().query::<&PointLight>().iter(hands.app.world()).count(), 1);

    let [x, y, z, _] = light(&hands)[0].position;
    let at = {
        let world = hands.app.world();
        let projected = Projected::new(hands.camera(), hands.viewer.area, world).expect("there is a camera");
        projected.place(DVec3::new(x, y, z).as_vec3()).expect("the light is seen")
    };
    hands.drag(at, vec2(-60.0, 30.0));
    let [moved_x, moved_y, moved_z, _] = light(&hands)[0].position;
    assert!(moved_x < x && moved_y < y, "{:?}", light(&hands)[0].position);
    let (from, to) = (DVec3::new(x, y, z), DVec3::new(moved_x, moved_y, moved_z));
    let placed = hands.app.world_mut().query::<(&PointLight, &Transform)>().single(hands.app.world()).unwrap().1;
    assert!(placed.translation.as_dvec3().distance(to) < 1e-5, "the world follows");
    assert!(from.distance(to) > 0.1);

    hands.choose("Remove this light");
    assert_eq!(light(&hands).len(), 0);
    for count in [1, 1, 0] {
        hands.key(Key::Z, Modifiers::COMMAND);
        assert_eq!(light(&hands).len(), count);
    }
    for count in [1, 1, 0] {
        hands.key(Key::Y, Modifiers::COMMAND);
        assert_eq!(light(&hands).len(), count);
    }
}

#[test]
fn keys_do_what_their_list_says() {
    let mut hands = Hands::new(scene(vec![named(LightKind::Point, [1.0, 2.0, 3.0])]));
    hands.key(Key::Num1, Modifiers::NONE);
    assert_eq!(hands.scene().shading, Shading::Flat);
    hands.key(Key::B, Modifiers::NONE);
    assert_eq!(hands.scene().reflectance, Reflectance::Phong);
    hands.key(Key::I, Modifiers::NONE);
    assert_ne!(hands.scene().intensity, Intensity::Clamp);
    hands.key(Key::T, Modifiers::NONE);
    assert!(hands.scene().tolerance.is_some());
    for key in [Key::E, Key::W, Key::N] {
        let before = hands.scene().clone();
        hands.key(key, Modifiers::NONE);
        assert_ne!(hands.scene(), &before, "{key:?}");
        let camera = hands.app.world().entity(hands.camera());
        assert_eq!(
            camera.contains::<Edges>() || camera.contains::<Show>(),
            key != Key::E || hands.scene().edges.is_some()
        );
    }
    hands.key(Key::O, Modifiers::NONE);
    let projection = |hands: &Hands| hands.app.world().get::<Camera>(hands.camera()).unwrap().projection;
    assert!(matches!(projection(&hands), Projection::Orthographic { .. }));
    hands.key(Key::U, Modifiers::NONE);
    let orbit = hands.app.world().get::<OrbitCamera>(hands.camera()).unwrap().orbit;
    assert!(orbit.pitch > 1.5, "from above: {orbit:?}");
    hands.key(Key::H, Modifiers::NONE);
    assert!(hands.texts().iter().any(|text| text == "isometric view"), "{:?}", hands.texts());
    hands.key(Key::Escape, Modifiers::NONE);
    assert!(!hands.texts().iter().any(|text| text == "isometric view"), "the list is closed");
    assert!(hands.app.should_exit().is_none(), "and not the window");
    hands.key(Key::P, Modifiers::NONE);
    assert!(hands.find(Role::Button, "Open").is_none(), "the panels are hidden");
    hands.key(Key::P, Modifiers::NONE);
    assert!(hands.find(Role::Button, "Open").is_some());
    // Changes are not lost by one key.
    let closes = |hands: &Hands| hands.app.should_exit().is_some();
    hands.key(Key::Q, Modifiers::NONE);
    assert!(!closes(&hands));
    hands.key(Key::Q, Modifiers::NONE);
    assert!(closes(&hands));
}

#[test]
fn the_divider_has_a_second_camera_that_sees_the_same() {
    let mut hands = Hands::new(scene(vec![named(LightKind::Point, [1.0, 2.0, 3.0])]));
    hands.key(Key::D, Modifiers::NONE);
    hands.frames(2);
    let cameras = |hands: &mut Hands| {
        let world = hands.app.world_mut();
        world
            .query_filtered::<(&GlobalTransform, Option<&Shading>), With<Camera>>()
            .iter(world)
            .map(|(at, shading)| (*at, shading.copied()))
            .collect::<Vec<_>>()
    };
    let both = cameras(&mut hands);
    assert_eq!(both.len(), 2);
    assert_eq!(both[0].0, both[1].0, "they are in one place");
    assert!(both.iter().any(|(_, shading)| *shading == Some(Shading::Gouraud)));
    // The divider is dragged, and the second camera's part with it.
    let part = |hands: &mut Hands| {
        let world = hands.app.world_mut();
        world.query::<&halfway::lighting::Viewport>().iter(world).map(|viewport| viewport.part).collect::<Vec<_>>()
    };
    let before = part(&mut hands);
    let middle = hands.viewer.area.center();
    hands.drag(middle, vec2(100.0, 0.0));
    hands.frames(1);
    assert_ne!(part(&mut hands), before);
    hands.key(Key::D, Modifiers::NONE);
    assert_eq!(cameras(&mut hands).len(), 1);
    assert_eq!(part(&mut hands).len(), 1, "the picture between the panels is the camera's own again");
    hands.key(Key::P, Modifiers::NONE);
    assert_eq!(part(&mut hands), [], "without panels it has the window");
}

#[test]
fn the_reference_is_drawn_beside_the_window() {
    let mut hands = Hands::new(scene(vec![named(LightKind::Point, [1.0, 2.0, 3.0])]));
    hands.viewer.split = Some(Split::new(Way::Oracle));
    let has_texture = |hands: &Hands| {
        let painted = hands.viewer.painted.lock().unwrap();
        painted.primitives.iter().any(|primitive| match &primitive.primitive {
            egui::epaint::Primitive::Mesh(mesh) => mesh.texture_id != egui::TextureId::default(),
            egui::epaint::Primitive::Callback(_) => false,
        })
    };
    let mut before = None;
    // Without lines, and with lines along edges.
    for edges in [false, true] {
        if edges {
            hands.key(Key::E, Modifiers::NONE);
            hands.frames(2);
        }
        let mut waits = 0;
        while !has_texture(&hands) {
            assert!(waits < 600, "no picture of the reference renderer");
            waits += 1;
            std::thread::sleep(Duration::from_millis(50));
            hands.frames(1);
        }
        let drawn = hands.viewer.split.as_ref().and_then(Split::reference_picture).expect("it is shown").to_vec();
        let Part::Pixels([left, top, width, height]) = pixels_of(hands.viewer.area, 1.0).part else { unreachable!() };
        let frame = FrameToDraw { number: 0, size: UVec2::new(1280, 720), pixels: Pixels::Byte };
        let goes_on = |_, _| ControlFlow::Continue(());
        let whole = ReferenceDrawing::default().picture(&mut hands.app, frame, &goes_on).expect("a picture");
        let Picture::Byte(part) = whole.part(UVec2::new(left, top), UVec2::new(width, height)) else { unreachable!() };
        let expected: Vec<u8> = part.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]]).collect();
        assert!(drawn == expected, "edges: {edges}");
        assert!(before.replace(drawn) != Some(expected), "edges: {edges}");
    }
}

#[test]
fn a_scene_that_is_saved_and_opened_is_the_same() {
    let folder = std::env::temp_dir().join(format!("halfway_viewer_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut hands = Hands::new(scene(vec![named(LightKind::Spot, [1.0, 2.0, 3.0])]));
    hands.viewer.document.file = folder.join("scene.json");
    hands.viewer.document.base_dir = folder.clone();
    hands.key(Key::Num2, Modifiers::NONE);
    hands.key(Key::A, Modifiers::NONE);
    assert!(hands.viewer.document.is_changed());
    hands.key(Key::S, Modifiers::COMMAND);
    hands.frames(2);
    hands.choose_last("Save");
    assert!(!hands.viewer.document.is_changed(), "{:?}", hands.viewer.message);
    let saved = SceneFile::read(&folder.join("scene.json")).unwrap();
    let world = hands.app.world();
    let shown = hands.viewer.live.as_ref().unwrap().scene_to_save(&hands.viewer.document, world);
    assert_eq!((&saved.camera, &saved.lights), (&shown.camera, &shown.lights));
    assert_eq!(saved, shown);
    assert_eq!((saved.shading, &saved.lights), (Shading::Gouraud, &hands.scene().lights));

    // Another program changes the file, and the window follows.
    let changed = SceneFile { shading: Shading::Flat, ..saved };
    std::thread::sleep(Duration::from_millis(20));
    changed.write(&folder.join("scene.json")).unwrap();
    for _ in 0..100 {
        hands.frames(1);
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(hands.scene().shading, Shading::Flat);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_pixel_is_explained() {
    let mut hands = Hands::new(scene(vec![named(LightKind::Point, [1.0, 2.0, 3.0])]));
    let middle = hands.viewer.area.center();
    // The camera of the window is asked, though the divider has another.
    hands.key(Key::D, Modifiers::NONE);
    hands.frame(vec![Event::PointerMoved(middle - vec2(20.0, 0.0))]);
    hands.key(Key::X, Modifiers::NONE);
    let text = hands.viewer.explained.clone().expect("the ball is there");
    for expected in ["ball", "lamp", "n·l"] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    hands.frame(vec![Event::PointerMoved(pos2(5.0, 5.0))]);
    hands.viewer.explained = None;
    hands.key(Key::X, Modifiers::NONE);
    assert_eq!(hands.viewer.explained, None, "the panels have no pixels");
}

#[test]
fn cameras_that_share_the_picture_share_the_place_between_the_panels() {
    let part = |from: f32| Some(halfway::lighting::Viewport::fractions([from, 0.0, 0.5, 1.0]));
    let json = r#"{
        "camera": {"position": [0, 1, 6], "viewport": {"fractions": [0.0, 0.0, 0.5, 1.0]}},
        "cameras": [{"position": [0, 6, 1], "viewport": {"fractions": [0.5, 0.0, 0.5, 1.0]}}],
        "objects": [{"mesh": {"box": {}}, "material": "brass"}]
    }"#;
    let shared = SceneFile::from_json(json, "two cameras").expect("it is valid");
    let mut hands = Hands::new(shared);
    let parts = |hands: &mut Hands| {
        let live = hands.viewer.live.as_ref().unwrap();
        let world = hands.app.world();
        live.spawned.cameras.iter().map(|camera| world.get::<Viewport>(*camera).copied()).collect::<Vec<_>>()
    };
    let rectangles: Vec<[u32; 4]> =
        parts(&mut hands).iter().map(|part| part.unwrap().rectangle([1280, 720]).unwrap()).collect();
    let [left, right] = rectangles[..] else { panic!("{rectangles:?}") };
    assert!(left[0] > 150 && left[0] + left[2] == right[0] && right[0] + right[2] < 1100, "{left:?} {right:?}");
    assert_eq!(hands.viewer.area.left() as u32, left[0], "handles are the first one's");
    // Both show a change of the scene.
    hands.key(Key::E, Modifiers::NONE);
    hands.frames(2);
    let cameras = hands.viewer.live.as_ref().unwrap().spawned.cameras.clone();
    assert!(cameras.iter().all(|camera| hands.app.world().entity(*camera).contains::<Edges>()));
    hands.key(Key::P, Modifiers::NONE);
    let own = |from: f32, order: i32| part(from).map(|part| part.with_order(order));
    assert_eq!(parts(&mut hands), [own(0.0, 0), own(0.5, 1)], "without panels they have the window");
}

#[test]
fn a_camera_is_turned_upright_and_saved_so() {
    let mut hands = Hands::new(scene(Vec::new()));
    hands.choose("Camera");
    let list = hands.values(Role::ComboBox)[0];
    hands.click(list.center());
    hands.choose("z");
    let camera = hands.camera();
    let world = hands.app.world();
    let up = world.get::<OrbitCamera>(camera).unwrap().orbit.up;
    assert_eq!((up, world.get::<Upright>(camera)), (Vec3::Z, Some(&Upright(Vec3::Z))));
    // The plugins of the window would do this.
    let transform = {
        let orbit = world.get::<OrbitCamera>(camera).unwrap().orbit;
        Transform::from_translation(orbit.eye()).with_rotation(orbit.rotation())
    };
    assert!(transform.rotation.mul_vec3(Vec3::Y).z > 0.9, "z is up in the picture");
    hands.app.world_mut().entity_mut(camera).insert(transform);
    let live = hands.viewer.live.as_ref().unwrap();
    let entry = live.scene_to_save(&hands.viewer.document, hands.app.world()).camera.unwrap();
    assert_eq!(Vec3::from(entry.up), Vec3::Z);
}

#[test]
fn values_are_changed_without_a_mouse() {
    let mut hands = Hands::new(scene(Vec::new()));
    let focused = |hands: &Hands| {
        let focus = hands.seen.focus;
        hands.seen.nodes.iter().find(|(id, _)| *id == focus).map(|(_, node)| node.role())
    };
    // The first number is the tolerance, among the values of the scene; it is written where it stands.
    for _ in 0..60 {
        hands.key(Key::Tab, Modifiers::NONE);
        if matches!(focused(&hands), Some(Role::SpinButton | Role::TextInput)) {
            break;
        }
    }
    hands.key(Key::A, Modifiers::COMMAND);
    hands.frame(vec![Event::Text("2".to_owned())]);
    hands.key(Key::Enter, Modifiers::NONE);
    assert_eq!(hands.scene().tolerance, Some(Tolerance { steps: 2.0, pixels: 0.0 }), "{:?}", focused(&hands));
}

#[test]
fn a_change_that_cannot_be_shown_is_taken_back() {
    let mut hands = Hands::new(scene(Vec::new()));
    hands.key(Key::Num1, Modifiers::NONE);
    let before = hands.scene().clone();
    hands.viewer.document.scene.samples = 3;
    (hands.viewer.is_changing, hands.viewer.revision) = (true, hands.viewer.revision + 1);
    hands.frames(2);
    assert_eq!(hands.scene(), &before, "the last step stays");
    let (message, _) = hands.viewer.message.as_ref().expect("it is said");
    assert!(message.contains("samples"), "{message}");
    hands.key(Key::Z, Modifiers::COMMAND);
    assert_eq!(hands.scene().shading, Shading::Phong, "and can be undone");
}

#[test]
fn an_environment_is_not_left_over() {
    let shape = halfway::scene::EnvironmentEntry::new(vec!["missing.png".into()]);
    let mut hands = Hands::new(SceneFile { environment: Some(shape), ..scene(Vec::new()) });
    let count = |hands: &mut Hands| {
        let world = hands.app.world_mut();
        world.query::<&halfway::texture::environment::EnvironmentLight>().iter(world).count()
    };
    assert_eq!(count(&mut hands), 1);
    // Another mesh needs another scene.
    hands.viewer.document.scene.objects[0].mesh = MeshEntry::Box(Cuboid::default());
    (hands.viewer.is_changing, hands.viewer.revision) = (true, hands.viewer.revision + 1);
    hands.frames(2);
    assert_eq!(count(&mut hands), 1);
}

#[test]
fn a_file_that_cannot_be_opened_leaves_the_scene() {
    let mut hands = Hands::new(scene(Vec::new()));
    let before = hands.scene().clone();
    hands.viewer.to_open = Some("there/is/none.obj".into());
    hands.frames(2);
    assert_eq!(hands.scene(), &before);
    let (message, _) = hands.viewer.message.as_ref().expect("it is said");
    assert!(message.contains("none.obj"), "{message}");
}

impl Hands {
    /// Clicks the button of this name that comes last: dialogs come after the panels.
    fn choose_last(&mut self, button: &str) {
        let has_text = |node: &Node| node.role() == Role::Button && node.label() == Some(button);
        let found = self.seen.nodes.iter().filter(|(_, node)| has_text(node)).filter_map(|(_, node)| place(node));
        let lowest = found.max_by(|a, b| a.top().total_cmp(&b.top())).unwrap_or_else(|| panic!("no {button:?}"));
        self.click(lowest.center());
    }
}
