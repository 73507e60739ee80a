//! The event loop: one update of the App a redraw.

use crate::display::has_display;
use crate::error::{WindowError, reason};
use crate::open::Open;
use crate::problems::{Said, say};
use crate::title::{FrameTime, title};
use bevy_app::{App, AppExit, PluginsState};
use bevy_math::UVec2;
use halfway_render::{FrameReport, RenderError};
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::WindowId;

/// Between looks at whether a hidden window is back.
const SELDOM: Duration = Duration::from_millis(250);

/// Between titles: long enough to read one.
const TITLE: Duration = Duration::from_millis(500);

/// The plugin's settings for the window.
pub(crate) struct Settings {
    pub(crate) title: String,
    /// In logical pixels.
    pub(crate) size: UVec2,
    /// Whether the title shows counters.
    pub(crate) status: bool,
}

/// Runs `app` in a window until it is closed.
pub(crate) fn run(mut app: App, settings: Settings) -> AppExit {
    let event_loop = match open_display() {
        Ok(event_loop) => event_loop,
        Err(error) => return failed(&error),
    };
    finish_plugins(&mut app);
    let mut runner = Runner::new(app, settings);
    if let Err(error) = event_loop.run_app(&mut runner) {
        return failed(&WindowError::Display(reason(&error)));
    }
    runner.exit.unwrap_or(AppExit::Success)
}

fn open_display() -> Result<EventLoop<()>, WindowError> {
    if !has_display() {
        return Err(WindowError::NoDisplay);
    }
    EventLoop::new().map_err(|error| WindowError::Display(reason(&error)))
}

fn failed(error: &WindowError) -> AppExit {
    say(error);
    error.exit()
}

fn finish_plugins(app: &mut App) {
    while app.plugins_state() == PluginsState::Adding {
        std::thread::sleep(Duration::from_millis(1));
    }
    if app.plugins_state() == PluginsState::Ready {
        app.finish();
        app.cleanup();
    }
}

/// The App, its window and what was last said about them.
struct Runner {
    app: App,
    settings: Settings,
    open: Option<Open>,
    /// The window system says that nothing of the window can be seen.
    covered: bool,
    minimised: bool,
    exit: Option<AppExit>,
    frames: u64,
    /// The shortest time from frame to frame.
    pace: Duration,
    said: Said,
    next_look: Instant,
    shown_title: String,
    /// When the title was made, and after how many frames.
    titled: Option<(Instant, u64)>,
}

impl Runner {
    fn new(app: App, settings: Settings) -> Self {
        Self {
            app,
            open: None,
            covered: false,
            minimised: false,
            exit: None,
            frames: 0,
            pace: Duration::ZERO,
            said: Said::default(),
            next_look: Instant::now(),
            shown_title: settings.title.clone(),
            titled: None,
            settings,
        }
    }

    /// Updates and draws, unless nothing of it could be seen, and arranges for the next time.
    fn frame(&mut self, event_loop: &ActiveEventLoop) {
        let start = Instant::now();
        // Before the frame, at once after the display has been listened to: winit panics where one that is gone
        // meanwhile is asked for something.
        if self.exit.is_none() && !self.hidden() && start >= self.next_look {
            self.next_look = start + SELDOM;
            self.now_and_then(event_loop);
        }
        if self.hidden() || self.exit.is_some() {
            return;
        }
        self.app.update();
        if let Some(exit) = self.app.should_exit() {
            return self.end(event_loop, exit);
        }
        let Some(open) = &mut self.open else { return };
        let presented = match open.settle(self.app.world_mut()) {
            Ok(presented) => presented,
            Err(error) => return self.end(event_loop, failed(&error)),
        };
        let took = start.elapsed();
        if took < self.pace {
            event_loop.set_control_flow(ControlFlow::WaitUntil(start + self.pace));
        } else {
            event_loop.set_control_flow(ControlFlow::Wait);
            open.window.request_redraw();
        }
        if presented {
            self.frames += 1;
            // The first frame builds pipelines and takes up meshes, and is no measure of the others.
            if self.frames > 1 {
                self.app.world_mut().get_resource_or_init::<FrameTime>().push(took);
            }
        }
        self.say_errors();
    }

    fn hidden(&self) -> bool {
        self.covered || self.minimised
    }

    fn say_errors(&mut self) {
        let Some(report) = self.app.world().get_resource::<FrameReport>() else { return };
        let (losses, others): (Vec<_>, Vec<_>) =
            report.errors.iter().partition(|error| matches!(error, RenderError::DeviceLost(_)));
        // One report has it; the next loss is another one, though it reads the same.
        losses.into_iter().for_each(say);
        self.said.say_new(others);
    }

    /// Work that costs too much for every frame: the title, and asking about the window and its display.
    fn now_and_then(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &self.open else { return };
        self.pace = open.pace();
        // The title is about a frame that has been shown.
        if self.settings.status && self.frames > 0 && self.titled.is_none_or(|(when, _)| when.elapsed() >= TITLE) {
            self.set_title();
        }
        self.look(event_loop);
    }

    fn set_title(&mut self) {
        let now = Instant::now();
        let before = self.titled.replace((now, self.frames));
        let rate = before.map(|(when, frames)| (self.frames - frames) as f64 / (now - when).as_secs_f64());
        let program = self.settings.title.clone();
        let title = self.app.world_mut().run_system_cached_with(title, (program, rate));
        if let (Some(open), Ok(title)) = (&self.open, title)
            && title != self.shown_title
        {
            open.window.set_title(&title);
            self.shown_title = title;
        }
    }

    /// Sees whether the window is minimised; not every window system says so by itself.
    fn look(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &self.open else { return };
        self.minimised = open.size.min_element() == 0 || open.window.is_minimized() == Some(true);
        if self.minimised {
            event_loop.set_control_flow(ControlFlow::WaitUntil(Instant::now() + SELDOM));
        }
    }

    fn redraw(&self) {
        if let Some(open) = &self.open
            && !self.hidden()
        {
            open.window.request_redraw();
        }
    }

    /// The close button: a last update, in which systems see the message.
    fn close(&mut self, event_loop: &ActiveEventLoop) {
        self.app.world_mut().write_message(AppExit::Success);
        self.app.update();
        let exit = self.app.should_exit().unwrap_or(AppExit::Success);
        self.end(event_loop, exit);
    }

    fn end(&mut self, event_loop: &ActiveEventLoop, exit: AppExit) {
        self.say_errors();
        self.exit = Some(exit);
        event_loop.exit();
    }
}

impl ApplicationHandler for Runner {
    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if matches!(cause, StartCause::ResumeTimeReached { .. }) {
            event_loop.set_control_flow(ControlFlow::Wait);
            self.look(event_loop);
            self.redraw();
        }
    }

    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        // Some systems resume more than once.
        if self.open.is_some() {
            return;
        }
        match Open::new(event_loop, &self.settings.title, self.settings.size, self.app.world_mut()) {
            Ok(open) => self.open = Some(open),
            Err(error) => return self.end(event_loop, failed(&error)),
        }
        self.redraw();
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        open.input.event(&event, open.window.scale_factor(), self.app.world_mut());
        match event {
            WindowEvent::RedrawRequested => self.frame(event_loop),
            // A change of the scale factor is followed by one of the size, but not everywhere.
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => {
                open.follow_size(self.app.world_mut());
                self.look(event_loop);
                self.redraw();
            }
            WindowEvent::Occluded(covered) => {
                self.covered = covered;
                self.redraw();
            }
            WindowEvent::CloseRequested => self.close(event_loop),
            // Taken away by the display; there is nothing left to draw in.
            WindowEvent::Destroyed => self.end(event_loop, AppExit::Success),
            _ => {}
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        if let Some(open) = self.open.take() {
            open.close(self.app.world_mut());
        }
    }
}
