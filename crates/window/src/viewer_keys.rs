//! The viewer's keys: shading frequency, reflectance, intensity policy, tolerance, close.

use crate::keys;
use crate::orbit_camera::modified;
use bevy_app::{App, AppExit, Plugin, PreUpdate};
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use bevy_input::keyboard::{KeyCode, KeyboardInput};
use bevy_input::{ButtonInput, InputPlugin, InputSystems};
use halfway_lighting::{Camera, Choices, Intensity, Reflectance, Shading, Tolerance, ViewTolerance};
use halfway_render::ModelView;

/// Keys to compare shadings, read in `PreUpdate`:
///
/// | key | effect |
/// |---|---|
/// | 1, 2, 3, 4 | flat, Gouraud, Phong shading; unlit |
/// | T | cycles through tolerances: exact, ½, 1, 2, 4, 8 steps; the tolerance in pixels stays |
/// | B | switches between Phong and Blinn–Phong reflectance |
/// | I | cycles through tone mapping: clamp, renormalise, renormalise smoothly, Reinhard, ACES |
/// | Escape, Q | closes: [`AppExit::Success`] |
///
/// A choice is set on every camera and on every object that has a choice of its own. B selects Phong if anything drawn
/// is Blinn–Phong, and then returns to the previous kind of Blinn–Phong. Keys with Control, Alt or Super are ignored.
/// `InputPlugin` is added where the App has none yet (add your own before). May be added more than once.
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewerKeysPlugin;

impl Plugin for ViewerKeysPlugin {
    fn build(&self, app: &mut App) {
        if app.is_plugin_added::<Self>() {
            return;
        }
        if !app.is_plugin_added::<InputPlugin>() {
            app.add_plugins(InputPlugin);
        }
        app.init_resource::<Pressed>();
        let systems = (read, (shading, reflectance, intensity, tolerance, close)).chain();
        app.add_systems(PreUpdate, systems.after(InputSystems));
    }

    fn is_unique(&self) -> bool {
        false
    }
}

/// The commands of this frame.
#[derive(Resource, Default)]
struct Pressed(Vec<char>);

const ESCAPE: char = '\u{1b}';

impl Pressed {
    fn has(&self, command: char) -> bool {
        self.0.contains(&command)
    }
}

fn read(mut presses: MessageReader<KeyboardInput>, keys: Res<ButtonInput<KeyCode>>, mut pressed: ResMut<Pressed>) {
    pressed.0.clear();
    let commands = presses.read().filter(|key| key.state.is_pressed() && !key.repeat).filter_map(|key| {
        if key.key_code == KeyCode::Escape { Some(ESCAPE) } else { keys::command(key.key_code, &key.logical_key) }
    });
    if modified(&keys) {
        commands.for_each(drop);
    } else {
        pressed.0.extend(commands);
    }
}

/// The entities that may have a choice of `T`: cameras, drawn objects, and all that have one already.
type Choosers<'w, 's, T> = Query<'w, 's, (Entity, Option<&'static mut T>, Has<Camera>, Has<ModelView>)>;

/// Sets `value` on every camera and on every entity that has one of its own.
fn choose<T>(value: T, choosers: &mut Choosers<T>, commands: &mut Commands)
where
    T: Component<Mutability = Mutable> + Copy,
{
    for (entity, own, is_camera, _) in choosers {
        match own {
            Some(mut own) => *own = value,
            None if is_camera => {
                commands.entity(entity).insert(value);
            }
            None => {}
        }
    }
}

fn shading(pressed: Res<Pressed>, mut choosers: Choosers<Shading>, mut commands: Commands) {
    let keys = ('1'..='9').zip(Shading::CHOICES);
    for (_, shading) in keys.filter(|&(key, _)| pressed.has(key)) {
        choose(shading.value, &mut choosers, &mut commands);
    }
}

fn reflectance(
    pressed: Res<Pressed>,
    mut choosers: Choosers<Reflectance>,
    mut last_blinn: Local<Reflectance>,
    mut commands: Commands,
) {
    if !pressed.has('b') {
        return;
    }
    let next = match shown_blinn(&choosers) {
        Some(blinn) => {
            *last_blinn = blinn;
            Reflectance::Phong
        }
        None => *last_blinn,
    };
    choose(next, &mut choosers, &mut commands);
}

/// The Blinn–Phong reflectance of any drawn object, or of the view if nothing is drawn.
fn shown_blinn(choosers: &Choosers<Reflectance>) -> Option<Reflectance> {
    let view = choosers.iter().find(|(_, _, is_camera, _)| *is_camera).and_then(|(_, own, ..)| own.copied());
    let view = view.unwrap_or_default();
    let drawn = choosers.iter().filter(|(.., is_drawn)| *is_drawn).map(|(_, own, ..)| own.copied().unwrap_or(view));
    let mut shown = drawn.peekable();
    if shown.peek().is_none() {
        return Some(view).filter(|&view| view != Reflectance::Phong);
    }
    shown.find(|&shown| shown != Reflectance::Phong)
}

/// The policies that I cycles through.
const POLICIES: [Intensity; 5] = [
    Intensity::Clamp,
    Intensity::Renormalize { smoothing: 0.0 },
    // At 60 frames a second the rest of a change falls to 1/e in a third of a second.
    Intensity::Renormalize { smoothing: 0.95 },
    Intensity::Reinhard { white: Intensity::WHITE },
    Intensity::Aces,
];

/// Sets the next policy on every camera; a policy that is not in the list counts as the first of its kind.
fn intensity(pressed: Res<Pressed>, mut cameras: Query<&mut Camera>) {
    if !pressed.has('i') {
        return;
    }
    for mut camera in &mut cameras {
        let kind = std::mem::discriminant(&camera.intensity);
        let same = POLICIES.iter().position(|policy| *policy == camera.intensity);
        let here = same.or_else(|| POLICIES.iter().position(|policy| std::mem::discriminant(policy) == kind));
        camera.intensity = POLICIES[here.map_or(0, |here| (here + 1) % POLICIES.len())];
    }
}

/// The steps that T cycles through.
const STEPS: [f32; 6] = [0.0, 0.5, 1.0, 2.0, 4.0, 8.0];

fn tolerance(pressed: Res<Pressed>, of_view: Option<ResMut<ViewTolerance>>, mut own: Query<&mut Tolerance>) {
    let Some(mut of_view) = of_view.filter(|_| pressed.has('t')) else { return };
    let steps = STEPS.into_iter().find(|&steps| steps > of_view.0.steps).unwrap_or(STEPS[0]);
    of_view.0.steps = steps;
    own.iter_mut().for_each(|mut own| own.steps = steps);
}

fn close(pressed: Res<Pressed>, mut exits: MessageWriter<AppExit>) {
    if pressed.has('q') || pressed.has(ESCAPE) {
        exits.write(AppExit::Success);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_input::ButtonState;
    use bevy_input::keyboard::Key;

    fn app() -> App {
        let mut app = App::new();
        // Twice, which must not switch twice.
        app.add_plugins((ViewerKeysPlugin, ViewerKeysPlugin));
        app
    }

    fn press(app: &mut App, key_code: KeyCode, text: &str) {
        for state in [ButtonState::Pressed, ButtonState::Released] {
            let (logical_key, window) = (Key::Character(text.into()), Entity::PLACEHOLDER);
            let key = KeyboardInput { key_code, logical_key, state, text: None, repeat: false, window };
            app.world_mut().write_message(key);
            app.update();
        }
    }

    fn drawn() -> ModelView {
        ModelView::default()
    }

    #[test]
    fn digit_keys_set_the_shading_of_cameras_and_objects() {
        let rows = [
            (KeyCode::Digit1, "1", Shading::Flat),
            (KeyCode::Digit2, "2", Shading::Gouraud),
            (KeyCode::Numpad3, "3", Shading::Phong),
            (KeyCode::Digit4, "4", Shading::Unlit),
        ];
        for before in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
            for (key_code, text, expected) in rows {
                let mut app = app();
                let bare_camera = app.world_mut().spawn(Camera::default()).id();
                let camera = app.world_mut().spawn((Camera::default(), before)).id();
                let own = app.world_mut().spawn((drawn(), before)).id();
                let bare = app.world_mut().spawn(drawn()).id();
                press(&mut app, key_code, text);
                for entity in [bare_camera, camera, own] {
                    assert_eq!(app.world().get::<Shading>(entity), Some(&expected), "{text} after {before:?}");
                }
                assert_eq!(app.world().get::<Shading>(bare), None, "{text}: an object without its own keeps none");
            }
        }
    }

    #[test]
    fn b_switches_the_reflectance() {
        use Reflectance::{BlinnPhong, BlinnPhongMatched, Phong};
        // The camera's own, the objects' own, and what all have after one press and after two.
        let rows = [
            ("no choice anywhere", None, &[None][..], Phong, BlinnPhong),
            ("no objects", None, &[], Phong, BlinnPhong),
            ("no objects, a Phong camera", Some(Phong), &[], BlinnPhong, Phong),
            ("the camera's Phong", Some(Phong), &[None], BlinnPhong, Phong),
            ("the object's Phong", None, &[Some(Phong)], BlinnPhong, Phong),
            ("the object's Phong wins", Some(BlinnPhong), &[Some(Phong)], BlinnPhong, Phong),
            ("mixed", None, &[Some(Phong), Some(BlinnPhong)], Phong, BlinnPhong),
            ("matched comes back matched", Some(BlinnPhongMatched), &[None], Phong, BlinnPhongMatched),
        ];
        for (name, on_camera, on_objects, first, second) in rows {
            let mut app = app();
            let camera = app.world_mut().spawn(Camera::default()).id();
            let mut with_own = vec![camera];
            if let Some(own) = on_camera {
                app.world_mut().entity_mut(camera).insert(own);
            }
            for own in on_objects {
                let object = app.world_mut().spawn(drawn()).id();
                if let Some(own) = *own {
                    app.world_mut().entity_mut(object).insert(own);
                    with_own.push(object);
                }
            }
            for expected in [first, second] {
                press(&mut app, KeyCode::KeyB, "b");
                for &entity in &with_own {
                    assert_eq!(app.world().get::<Reflectance>(entity), Some(&expected), "{name}");
                }
            }
        }
    }

    #[test]
    fn t_goes_through_the_steps_of_the_tolerance() {
        let mut app = app();
        app.insert_resource(ViewTolerance::default());
        let own = app.world_mut().spawn(Tolerance { steps: 3.0, pixels: 2.0 }).id();
        for steps in [0.5, 1.0, 2.0, 4.0, 8.0, 0.0] {
            press(&mut app, KeyCode::KeyT, "t");
            assert_eq!(app.world().resource::<ViewTolerance>().0, Tolerance { steps, pixels: 0.0 });
            assert_eq!(app.world().get::<Tolerance>(own), Some(&Tolerance { steps, pixels: 2.0 }));
        }
    }

    #[test]
    fn i_goes_through_the_policies() {
        let mut app = app();
        let camera = app.world_mut().spawn(Camera::default()).id();
        for expected in [1, 2, 3, 4, 0, 1] {
            press(&mut app, KeyCode::KeyI, "i");
            let found = app.world().get::<Camera>(camera).unwrap().intensity;
            assert_eq!((found, found.validate()), (POLICIES[expected], Ok(())));
        }
        app.world_mut().get_mut::<Camera>(camera).unwrap().intensity = Intensity::Reinhard { white: 9.0 };
        press(&mut app, KeyCode::KeyI, "i");
        assert_eq!(app.world().get::<Camera>(camera).unwrap().intensity, Intensity::Aces);
    }

    #[test]
    fn escape_and_q_close() {
        for (key_code, text) in [(KeyCode::Escape, ""), (KeyCode::KeyQ, "q"), (KeyCode::KeyA, "Q")] {
            let mut app = app();
            app.update();
            assert_eq!(app.should_exit(), None);
            press(&mut app, key_code, text);
            assert_eq!(app.should_exit(), Some(AppExit::Success), "{key_code:?}");
        }
    }

    #[test]
    fn shortcuts_of_others_are_left_alone() {
        let mut app = app();
        let (logical_key, window, state) = (Key::Control, Entity::PLACEHOLDER, ButtonState::Pressed);
        let key_code = KeyCode::ControlLeft;
        app.world_mut().write_message(KeyboardInput {
            key_code,
            logical_key,
            state,
            text: None,
            repeat: false,
            window,
        });
        app.update();
        press(&mut app, KeyCode::KeyQ, "q");
        assert_eq!(app.should_exit(), None);
    }
}
