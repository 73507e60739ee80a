//! The viewer: an overlay of the window with panels, handles and keys.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use bevy_ecs::prelude::*;
use egui::{Align2, Context, Id, Panel, Ui, vec2};
use egui_winit::State;
use egui_winit::winit::event::WindowEvent;
use egui_winit::winit::window::Window;
use halfway::lighting::{Choices, Part, Projection, View, Viewport};
use halfway::prelude::*;
use halfway::render::{AdapterChoice, FrameTimes, WindowPass};
use halfway::scene::LightKind;
use halfway::window::{OrbitCamera, Overlay, WindowOverlay};

use crate::document::Document;
use crate::error::ViewerError;
use crate::files::{Ended, FileDialog, Purpose};
use crate::handles::{self, Around};
use crate::keys::{self, Command};
use crate::live::Live;
use crate::paint::Painted;
use crate::paint::cpu::Painter;
use crate::paint::gpu::PaintPass;
use crate::panels::{self, Selected, look};
use crate::pictures::{Drawing, Wanted};
use crate::projected::{Projected, pixels_of, points_of, within};
use crate::settings::Settings;
use crate::split::{Split, Way, seen_by};
use crate::times::Times;

/// How often the opened file is looked at.
const WATCH: Duration = Duration::from_millis(500);

/// How long a message is shown.
const MESSAGE: Duration = Duration::from_secs(6);

/// Panels over a window that shows a scene: see the [crate's page](crate).
pub struct SceneViewer {
    document: Document,
    /// `None` until the scene is in the world.
    live: Option<Live>,
    context: Context,
    /// `None` until there is a window.
    input: Option<State>,
    painted: Arc<Mutex<Painted>>,
    painter: Painter,
    settings: Settings,
    selected: Selected,
    split: Option<Split>,
    dialog: Option<FileDialog>,
    /// The file that was chosen to be shown next.
    to_open: Option<PathBuf>,
    /// A picture that is being written.
    drawing: Option<Drawing>,
    help: bool,
    times: Times,
    /// The explanation of a pixel.
    explained: Option<String>,
    /// The part of the window that the picture has, in points.
    area: egui::Rect,
    message: Option<(String, Instant)>,
    /// Whether a change goes on, such as a drag.
    is_changing: bool,
    /// Whether closing would lose changes, and the user was told so.
    asked_to_close: bool,
    /// Another number whenever the scene is another one.
    revision: u64,
    /// The revision that the world shows.
    followed: u64,
    watched: Instant,
}

impl SceneViewer {
    /// A viewer of a document.
    pub fn new(document: Document) -> Self {
        Self {
            document,
            live: None,
            context: context(),
            input: None,
            painted: Arc::default(),
            painter: Painter::default(),
            settings: Settings::read(),
            selected: Selected::Scene,
            split: None,
            dialog: None,
            to_open: None,
            drawing: None,
            help: false,
            times: Times::default(),
            explained: None,
            area: egui::Rect::ZERO,
            message: None,
            is_changing: false,
            asked_to_close: false,
            revision: 0,
            followed: 0,
            watched: Instant::now(),
        }
    }

    /// Puts the scene into the App's world, and the viewer over its window. Returns the scene's warnings.
    ///
    /// # Errors
    /// [`ViewerError::Scene`] where the scene cannot be shown.
    pub fn insert_into(mut self, app: &mut App) -> Result<Vec<String>, ViewerError> {
        let world = app.world_mut();
        let live = Live::new(&self.document, world)?;
        let warnings = live.spawned.warnings.clone();
        self.live = Some(live);
        world.insert_resource(WindowPass(Box::new(PaintPass::new(Arc::clone(&self.painted)))));
        world.insert_non_send(WindowOverlay(Box::new(self)));
        Ok(warnings)
    }

    /// Shows one frame, and leaves it to be painted.
    fn run(&mut self, input: egui::RawInput, world: &mut World) -> egui::PlatformOutput {
        let context = self.context.clone();
        if let Some(times) = world.get_resource::<FrameTimes>() {
            self.times.push(times.newest().total().as_secs_f32() * 1e3);
        }
        context.set_zoom_factor(self.settings.zoom);
        let output = context.run_ui(input, |ui| self.show(ui, world));
        if let Some(file) = self.to_open.take() {
            self.open(&file, false, world);
        }
        let mut painted = self.painted.lock().unwrap_or_else(PoisonError::into_inner);
        painted.textures.append(output.textures_delta);
        painted.scale = output.pixels_per_point;
        painted.primitives = context.tessellate(output.shapes, output.pixels_per_point);
        output.platform_output
    }

    /// One frame of the panels, which may change the scene.
    fn show(&mut self, ui: &mut Ui, world: &mut World) {
        let Some(live) = self.live.take() else { return };
        let mut changed = false;
        for command in keys::commands(ui.ctx()) {
            changed |= self.obey(command, &live, world);
        }
        if self.settings.panels {
            changed |= self.show_panels(ui, &live, world);
        }
        self.area = if self.settings.panels { ui.available_rect_before_wrap() } else { ui.ctx().content_rect() };
        self.draw_in_area(ui.ctx(), &live, world);
        changed |= self.show_over_picture(ui.ctx(), &live, world);
        self.show_windows(ui.ctx(), &live, world);
        self.live = Some(live);
        self.after_changes(ui.ctx(), changed, world);
        self.watch(world);
        if let Some(sentence) = self.drawing.as_ref().and_then(Drawing::ended) {
            self.drawing = None;
            self.say(&sentence);
        }
    }

    /// Does what a command asks for; returns whether the scene has changed.
    fn obey(&mut self, command: Command, live: &Live, world: &mut World) -> bool {
        let scene = &mut self.document.scene;
        match command {
            Command::Shading(number) => {
                let Some(choice) = Shading::CHOICES.get(number) else { return false };
                scene.shading = choice.value;
                // Objects with a shading of their own are compared, too.
                scene
                    .objects
                    .iter_mut()
                    .filter_map(|object| object.shading.as_mut())
                    .for_each(|own| *own = choice.value);
                for camera in scene.all_cameras_mut() {
                    camera.shading = None;
                }
                return true;
            }
            Command::Reflectance => {
                let phong = scene.reflectance == Reflectance::Phong;
                let next = if phong { Reflectance::BlinnPhong } else { Reflectance::Phong };
                scene.reflectance = next;
                scene.objects.iter_mut().filter_map(|object| object.reflectance.as_mut()).for_each(|own| *own = next);
                return true;
            }
            Command::Intensity => {
                let all = look::INTENSITIES;
                let here = all.iter().position(|(policy, _)| *policy == scene.intensity).unwrap_or(0);
                scene.intensity = all[(here + 1) % all.len()].0;
                return true;
            }
            Command::Tolerance => {
                let now = scene.tolerance.unwrap_or(Tolerance::EXACT);
                let steps = [0.5, 1.0, 2.0, 4.0, 8.0].into_iter().find(|steps| *steps > now.steps).unwrap_or(0.0);
                let next = Tolerance { steps, ..now };
                scene.tolerance = Some(next).filter(|tolerance| *tolerance != Tolerance::EXACT);
                return true;
            }
            Command::Edges => {
                scene.edges = if scene.edges.is_some() { None } else { Some(look::thin()) };
                return true;
            }
            Command::Wireframe => {
                let is_on = scene.edges.as_ref().is_some_and(|edges| !edges.surface);
                scene.edges = Some(look::wireframe(scene.background)).filter(|_| !is_on);
                return true;
            }
            Command::Normals => {
                scene.show.normals ^= true;
                return true;
            }
            Command::AddLight => {
                self.selected = Selected::Light(live.light_entries(scene, world).len());
                return panels::add_light(scene, LightKind::Point, live, world);
            }
            Command::Remove => {
                let Selected::Light(index) = self.selected else { return false };
                self.selected = Selected::Scene;
                return panels::remove_light(scene, index, live, world);
            }
            Command::Undo | Command::Redo => {
                let is_done = if command == Command::Undo { self.document.undo() } else { self.document.redo() };
                self.revision += u64::from(is_done);
                if !is_done {
                    self.say(if command == Command::Undo { "nothing to undo" } else { "nothing to redo" });
                }
            }
            Command::View(number) => {
                if let Some(choice) = View::CHOICES.get(number) {
                    look::look_from(choice.value, live.spawned.camera, world);
                }
            }
            Command::Orthographic => {
                let camera = live.spawned.camera;
                let distance = world.get::<OrbitCamera>(camera).map_or(1.0, |orbit| orbit.orbit.distance);
                if let Some(mut camera) = world.get_mut::<Camera>(camera) {
                    camera.projection = look::other_projection(camera.projection, distance);
                }
            }
            Command::Panels => self.set(|settings| settings.panels ^= true),
            Command::Handles => self.set(|settings| settings.handles ^= true),
            Command::Help => self.help ^= true,
            Command::Split => self.toggle_split(world),
            Command::Save => self.ask(Purpose::SaveScene),
            Command::Open => self.ask(Purpose::Open),
            Command::Picture => self.ask(Purpose::SavePicture),
            Command::Turntable => self.ask(Purpose::SaveTurntable),
            Command::Explain => self.explain(live, world),
            Command::Leave => {
                let was_open =
                    self.dialog.take().is_some() || std::mem::take(&mut self.help) || self.explained.take().is_some();
                if !was_open {
                    self.close(world);
                }
            }
            Command::Close => self.close(world),
        }
        false
    }

    /// Closes the window, unless there are changes that no file holds: then only when it is asked for once more.
    fn close(&mut self, world: &mut World) {
        if !self.document.is_changed() || std::mem::replace(&mut self.asked_to_close, true) {
            world.write_message(AppExit::Success);
        } else {
            self.say("the scene has changed: Ctrl+S saves it, the same key once more closes without");
        }
    }

    fn toggle_split(&mut self, world: &mut World) {
        if let Some(split) = self.split.take() {
            split.end(world);
        } else {
            let is_phong = self.document.scene.shading == Shading::Phong;
            let other = if is_phong { Shading::Gouraud } else { Shading::Phong };
            self.split = Some(Split::new(Way::Shading(other)));
        }
    }

    fn show_panels(&mut self, ui: &mut Ui, live: &Live, world: &mut World) -> bool {
        let mut commands = Vec::new();
        Panel::top("bar").show(ui, |ui| {
            ui.horizontal(|ui| self.bar(ui, &mut commands));
        });
        let mut changed = false;
        panels::side(true).show(ui, |ui| {
            self.status(ui, world);
            ui.separator();
            changed |= panels::tree(ui, &mut self.document.scene, &mut self.selected, live, world);
        });
        panels::side(false).show(ui, |ui| {
            changed |= panels::inspector(ui, &mut self.document.scene, &mut self.selected, live, world);
        });
        for command in commands {
            changed |= self.obey(command, live, world);
        }
        changed
    }

    fn bar(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let mut button = |ui: &mut Ui, text: &str, hint: &str, command, is_on: bool| {
            if ui.add_enabled(is_on, egui::Button::new(text)).on_hover_text(hint).clicked() {
                commands.push(command);
            }
        };
        button(ui, "Open", "Open a scene or a model", Command::Open, true);
        button(ui, "Save", "Save the scene as a scene file", Command::Save, true);
        button(ui, "Picture", "Save a picture of what is seen", Command::Picture, true);
        button(ui, "Turn", "Save a full turn of the camera as an animated PNG", Command::Turntable, true);
        ui.separator();
        button(ui, "Undo", "Take back the last change", Command::Undo, self.document.can_undo());
        button(ui, "Redo", "Make it again", Command::Redo, self.document.can_redo());
        ui.separator();
        button(ui, "Keys", "All keys", Command::Help, true);
        button(ui, "Divide", "Compare two ways of drawing", Command::Split, true);
        if let Some(split) = &mut self.split {
            egui::ComboBox::from_id_salt("way").selected_text(split.way.name()).show_ui(ui, |ui| {
                for way in Way::all() {
                    ui.selectable_value(&mut split.way, way, way.name());
                }
            });
        }
        let mark = if self.document.is_changed() { "*" } else { "" };
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(format!("{}{mark}", self.document.name()));
        });
    }

    fn status(&self, ui: &mut Ui, world: &World) {
        self.times.show(ui);
        if let Some(report) = world.get_resource::<FrameReport>() {
            let text = format!("{} of {} objects seen", report.visible, report.objects);
            let more = format!("{} triangles in {} draws, {} lights", report.triangles, report.draws, report.lights);
            ui.add(egui::Label::new(text).truncate()).on_hover_text(more);
            for error in report.errors.iter().take(3) {
                ui.colored_label(ui.visuals().error_fg_color, error.to_string());
            }
        }
    }

    /// Has the camera draw between the panels, so that they hide nothing of the picture, and show at least as much as the
    /// scene's own picture does.
    ///
    /// Cameras that share the picture share the place between the panels, and handles are those of the first one's part.
    fn draw_in_area(&mut self, context: &Context, live: &Live, world: &mut World) {
        let camera = live.spawned.camera;
        let scale = context.pixels_per_point();
        let area = pixels_of(self.area, scale);
        if live.parts.len() > 1 {
            for (camera, own) in &live.parts {
                let part = own.map(|own| within(own, area));
                give_part(*camera, if self.settings.panels { part } else { *own }, world);
                if let (true, Some(part)) = (*camera == live.spawned.camera, part) {
                    self.area = points_of(part, scale);
                }
            }
            return;
        }
        give_part(camera, self.settings.panels.then_some(area), world);
        let [width, height] = self.document.scene.size.map(|pixels| pixels as f32);
        if let Some(mut camera) = world.get_mut::<Camera>(camera) {
            let (Projection::Perspective { mut film, .. } | Projection::Orthographic { mut film, .. }) =
                camera.projection;
            if film.aspect.is_none() {
                film.aspect = Some(width / height);
                camera.projection = camera.projection.with_film(film);
            }
        }
    }

    /// Handles of lights, and the divider.
    fn show_over_picture(&mut self, context: &Context, live: &Live, world: &mut World) -> bool {
        let camera = live.spawned.camera;
        if let Some(split) = &mut self.split {
            let left = self.document.scene.shading.choice().map_or("", |choice| choice.name);
            split.show(context, self.area, left, (camera, self.revision), world);
        }
        if !self.settings.handles {
            return false;
        }
        let Some(orbit) = world.get::<OrbitCamera>(camera).map(|orbit| orbit.orbit) else { return false };
        let Some(projected) = Projected::new(camera, self.area, world) else { return false };
        let around = Around { target: orbit.target, distance: orbit.distance };
        let selected = if let Selected::Light(index) = self.selected { Some(index) } else { None };
        let mut lights = live.light_entries(&self.document.scene, world);
        let handled = handles::show(context, &mut lights, (&projected, around, live.spawned.origin), selected);
        if let Some(index) = handled.light {
            self.selected = Selected::Light(index);
        }
        if handled.changed {
            live.edit_lights(&mut self.document.scene, world, |list| *list = lights);
        }
        handled.changed
    }

    /// Windows over the picture: the list of keys, dialogs, messages.
    fn show_windows(&mut self, context: &Context, live: &Live, world: &mut World) {
        egui::Window::new("Keys")
            .open(&mut self.help)
            .pivot(Align2::CENTER_CENTER)
            .default_pos(context.content_rect().center())
            .vscroll(true)
            .default_height(600.0)
            .show(context, keys::show);
        let mut is_open = self.explained.is_some();
        if let Some(text) = &self.explained {
            egui::Window::new("This pixel")
                .open(&mut is_open)
                .default_width(460.0)
                .default_height(420.0)
                .pivot(Align2::LEFT_BOTTOM)
                .default_pos(self.area.left_bottom() + vec2(12.0, -12.0))
                .scroll([true, true])
                .show(context, |ui| {
                    ui.add(egui::Label::new(text).selectable(true).extend());
                });
        }
        if !is_open {
            self.explained = None;
        }
        if let Some(mut dialog) = self.dialog.take() {
            match dialog.show(context) {
                None => self.dialog = Some(dialog),
                Some(Ended::Closed) => {}
                Some(Ended::Chosen(file)) => self.chosen(dialog.purpose, &file, live, world),
            }
        }
        if let Some((message, when)) = &self.message {
            let message = message.clone();
            if when.elapsed() > MESSAGE {
                self.message = None;
            }
            egui::Area::new(Id::unique("message"))
                .anchor(Align2::CENTER_BOTTOM, vec2(0.0, -16.0))
                .show(context, |ui| egui::Frame::popup(ui.style()).show(ui, |ui| ui.label(message)));
        } else if !self.settings.panels {
            egui::Area::new(Id::unique("hint"))
                .anchor(Align2::LEFT_BOTTOM, vec2(8.0, -8.0))
                .interactable(false)
                .show(context, |ui| ui.small("P panels · H keys"));
        }
    }

    /// Has the world follow the document, and ends a change when the pointer is released.
    fn after_changes(&mut self, context: &Context, changed: bool, world: &mut World) {
        self.is_changing |= changed;
        self.revision += u64::from(changed);
        if self.followed != self.revision
            && let Some(live) = &mut self.live
            && let Err(error) = live.follow(&self.document, world)
        {
            self.document.reject();
            self.is_changing = false;
            return self.say(&error.to_string());
        }
        self.followed = self.revision;
        let is_held = context.input(|input| input.pointer.any_down()) || context.text_edit_focused();
        if self.is_changing && !is_held {
            (self.is_changing, self.asked_to_close) = (false, false);
            self.document.settle();
        }
    }

    /// Opens the file again when it was written by another program.
    fn watch(&mut self, world: &mut World) {
        if self.watched.elapsed() < WATCH || self.is_changing {
            return;
        }
        self.watched = Instant::now();
        if !self.document.is_written_anew() {
            return;
        }
        if self.document.is_changed() {
            self.say("the file was changed by another program; open it again to see that, or save over it");
            return;
        }
        let file = self.document.file.clone();
        self.open(&file, true, world);
    }

    /// Shows another file, or the same one again.
    fn open(&mut self, file: &Path, is_again: bool, world: &mut World) {
        let opened = Document::open(file).and_then(|document| {
            let document = document.seen_from(self.document.camera.clone().filter(|_| is_again));
            Live::new(&document, world).map(|live| (document, live))
        });
        let (document, live) = match opened {
            Ok(opened) => opened,
            Err(error) => return self.say(&error.to_string()),
        };
        if let Some(before) = self.live.replace(live) {
            if let Some(split) = self.split.take() {
                split.end(world);
            }
            let place = (
                world.get::<Transform>(before.spawned.camera).copied(),
                world.get::<OrbitCamera>(before.spawned.camera).cloned(),
            );
            before.spawned.despawn(world);
            if let ((Some(transform), Some(orbit)), Some(live), true) = (place, &self.live, is_again) {
                world.entity_mut(live.spawned.camera).insert((transform, orbit));
            }
        }
        self.document = document;
        self.selected = Selected::Scene;
        self.is_changing = false;
        self.revision += 1;
        if let Some(mut title) = world.get_resource_mut::<WindowTitle>() {
            title.0 = self.document.name();
        }
        let name = self.document.name();
        self.say(&if is_again { format!("{name} was changed, and is shown anew") } else { name });
    }

    fn ask(&mut self, purpose: Purpose) {
        let picture = |ending: &str| self.document.file.with_extension(ending);
        let file: PathBuf = match purpose {
            Purpose::Open => self.document.file.clone(),
            Purpose::SaveScene => self.document.file_to_save(),
            Purpose::SavePicture => picture("png"),
            Purpose::SaveTurntable => picture("turn.png"),
        };
        self.dialog = Some(FileDialog::new(purpose, &file));
    }

    fn chosen(&mut self, purpose: Purpose, file: &Path, live: &Live, world: &mut World) {
        let scene = live.scene_to_save(&self.document, world);
        let done = match purpose {
            Purpose::Open => {
                // After the frame, since the scene is in use here.
                self.to_open = Some(file.to_owned());
                return;
            }
            Purpose::SaveScene => self.document.save(file, scene),
            Purpose::SavePicture | Purpose::SaveTurntable => {
                self.drawing = Some(Drawing::begin(Wanted {
                    scene,
                    base_dir: self.document.base_dir.clone(),
                    file: file.to_owned(),
                    turns: purpose == Purpose::SaveTurntable,
                    choice: world.get_resource::<AdapterChoice>().cloned().unwrap_or_default(),
                }));
                return self.say("drawing …");
            }
        };
        match done {
            Ok(()) => self.say(&format!("saved {}", file.display())),
            Err(error) => self.say(&error.to_string()),
        }
    }

    /// Explains the pixel under the pointer, by the reference renderer.
    fn explain(&mut self, live: &Live, world: &mut World) {
        let Some(at) = self.context.pointer_latest_pos().filter(|at| self.area.contains(*at)) else {
            return self.say("the pointer is not on the picture");
        };
        let scale = self.context.pixels_per_point();
        let Part::Pixels([left, top, width, height]) = pixels_of(self.area, scale).part else { return };
        let pixel = |at: f32, first: u32, count: u32| ((at * scale) as u32).saturating_sub(first).min(count - 1);
        let (x, y) = (pixel(at.x, left, width), pixel(at.y, top, height));
        let oracle = seen_by(live.spawned.camera, UVec2::new(width, height), world);
        match oracle.and_then(|oracle| oracle.explain(x, y)) {
            Ok(explanation) => self.explained = Some(explanation.to_string()),
            Err(error) => self.say(&error.to_string()),
        }
    }

    fn say(&mut self, message: &str) {
        self.message = Some((message.to_owned(), Instant::now()));
    }

    fn set(&mut self, change: impl FnOnce(&mut Settings)) {
        change(&mut self.settings);
        if self.settings.remembers {
            self.settings.write();
        }
    }
}

/// Has a camera draw into a part of the window, or all of it.
fn give_part(camera: Entity, part: Option<Viewport>, world: &mut World) {
    if world.get::<Viewport>(camera).copied() == part {
        return;
    }
    match part {
        Some(part) => drop(world.entity_mut(camera).insert(part)),
        None => drop(world.entity_mut(camera).remove::<Viewport>()),
    }
}

/// One font, for all text.
fn fonts() -> egui::FontDefinitions {
    let mut fonts = egui::FontDefinitions::empty();
    let files = [("text", epaint_default_fonts::UBUNTU_LIGHT), ("icons", epaint_default_fonts::EGUI_ICONS)];
    for (name, bytes) in files {
        fonts.font_data.insert(name.to_owned(), Arc::new(egui::FontData::from_static(bytes)));
        for family in [egui::FontFamily::Proportional, egui::FontFamily::Monospace] {
            fonts.families.entry(family).or_default().push(name.to_owned());
        }
    }
    fonts
}

/// Panels in the dark, with corners and lines that do not draw the eye from the picture.
fn context() -> Context {
    let context = Context::default();
    context.set_fonts(fonts());
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        style.spacing.slider_width = 90.0;
        style.spacing.item_spacing = vec2(6.0, 4.0);
        style.interaction.tooltip_delay = 0.6;
        style.visuals.panel_fill = egui::Color32::from_rgba_unmultiplied(27, 28, 31, 235);
        style.visuals.window_fill = egui::Color32::from_rgba_unmultiplied(27, 28, 31, 245);
    });
    context
}

impl Overlay for SceneViewer {
    fn event(&mut self, window: &Window, event: &WindowEvent, world: &mut World) -> bool {
        if let WindowEvent::DroppedFile(file) = event {
            self.open(file, false, world);
            return true;
        }
        let Some(input) = &mut self.input else { return false };
        let is_taken = input.on_window_event(window, event).consumed;
        match event {
            WindowEvent::MouseInput { state, .. } => is_taken && state.is_pressed(),
            WindowEvent::MouseWheel { .. } | WindowEvent::KeyboardInput { .. } => is_taken,
            _ => false,
        }
    }

    fn frame(&mut self, window: &Window, world: &mut World) {
        let context = self.context.clone();
        let input = self.input.get_or_insert_with(|| {
            let scale = Some(window.scale_factor() as f32);
            State::new(context.clone(), egui::ViewportId::ROOT, window, scale, None, Some(8192))
        });
        let raw = input.take_egui_input(window);
        let output = self.run(raw, world);
        if let Some(input) = &mut self.input {
            input.handle_platform_output(window, output);
        }
    }

    fn paint(&mut self, pixels: &mut [u32], size: UVec2) {
        let mut painted = self.painted.lock().unwrap_or_else(PoisonError::into_inner);
        self.painter.paint(&mut painted, pixels, size);
    }
}

#[cfg(test)]
mod tests;
