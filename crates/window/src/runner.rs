//! The event loop: one update of the App a redraw.

use crate::display::has_display;
use crate::error::{WindowError, reason};
use crate::open::Open;
use crate::overlay::{Overlay, WindowOverlay};
use crate::problems::{self, Reported};
use crate::title::{FrameTime, title};
use bevy_app::{App, AppExit, PluginsState};
use bevy_math::UVec2;
use halfway_render::{FrameReport, RenderError};
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::WindowId;

/// The interval at which a hidden window is polled.
const HIDDEN_POLL: Duration = Duration::from_millis(250);

/// The interval between titles: long enough to read one.
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
    problems::report(error);
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

/// The App, its window and their state.
struct Runner {
    app: App,
    settings: Settings,
    open: Option<Open>,
    overlay: Option<Box<dyn Overlay>>,
    /// The window system reports that the window is fully covered.
    covered: bool,
    minimised: bool,
    exit: Option<AppExit>,
    frames: u64,
    /// The shortest time from frame to frame.
    pace: Duration,
    reported: Reported,
    next_poll: Instant,
    shown_title: String,
    /// The time of the last title, and the number of frames then.
    titled: Option<(Instant, u64)>,
}

impl Runner {
    fn new(mut app: App, settings: Settings) -> Self {
        let overlay = app.world_mut().remove_non_send::<WindowOverlay>().map(|overlay| overlay.0);
        Self {
            app,
            open: None,
            overlay,
            covered: false,
            minimised: false,
            exit: None,
            frames: 0,
            pace: Duration::ZERO,
            reported: Reported::default(),
            next_poll: Instant::now(),
            shown_title: settings.title.clone(),
            titled: None,
            settings,
        }
    }

    /// Updates and draws, unless the window is hidden, and schedules the next frame.
    fn frame(&mut self, event_loop: &ActiveEventLoop) {
        let start = Instant::now();
        // Before the frame, right after the display's events were read: winit panics if it queries a display that
        // closed meanwhile.
        if self.exit.is_none() && !self.hidden() && start >= self.next_poll {
            self.next_poll = start + HIDDEN_POLL;
            self.poll(event_loop);
        }
        if self.hidden() || self.exit.is_some() {
            return;
        }
        if let (Some(overlay), Some(open)) = (&mut self.overlay, &self.open) {
            overlay.frame(&open.window, self.app.world_mut());
        }
        self.app.update();
        if let Some(exit) = self.app.should_exit() {
            return self.end(event_loop, exit);
        }
        let Some(open) = &mut self.open else { return };
        let presented = match open.present(self.app.world_mut(), self.overlay.as_deref_mut()) {
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
            // The first frame builds pipelines and uploads meshes, so it does not represent the others.
            if self.frames > 1 {
                self.app.world_mut().get_resource_or_init::<FrameTime>().push(took);
            }
        }
        self.report_errors();
    }

    fn hidden(&self) -> bool {
        self.covered || self.minimised
    }

    fn report_errors(&mut self) {
        let Some(report) = self.app.world().get_resource::<FrameReport>() else { return };
        let (losses, others): (Vec<_>, Vec<_>) =
            report.errors.iter().partition(|error| matches!(error, RenderError::DeviceLost(_)));
        // Each loss is reported, though the text repeats.
        losses.into_iter().for_each(problems::report);
        self.reported.report_new(others);
    }

    /// Work that is too slow for every frame: setting the title, and polling the window and its display.
    fn poll(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &self.open else { return };
        self.pace = open.pace();
        // The title describes a frame that was shown.
        if self.settings.status && self.frames > 0 && self.titled.is_none_or(|(when, _)| when.elapsed() >= TITLE) {
            self.set_title();
        }
        self.poll_minimised(event_loop);
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

    /// Polls whether the window is minimised; not every window system sends an event for it.
    fn poll_minimised(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &self.open else { return };
        self.minimised = open.size.min_element() == 0 || open.window.is_minimized() == Some(true);
        if self.minimised {
            event_loop.set_control_flow(ControlFlow::WaitUntil(Instant::now() + HIDDEN_POLL));
        }
    }

    fn redraw(&self) {
        if let Some(open) = &self.open
            && !self.hidden()
        {
            open.window.request_redraw();
        }
    }

    /// The close button: runs a last update, in which systems receive the message.
    fn close(&mut self, event_loop: &ActiveEventLoop) {
        self.app.world_mut().write_message(AppExit::Success);
        self.app.update();
        let exit = self.app.should_exit().unwrap_or(AppExit::Success);
        self.end(event_loop, exit);
    }

    fn end(&mut self, event_loop: &ActiveEventLoop, exit: AppExit) {
        self.report_errors();
        self.exit = Some(exit);
        event_loop.exit();
    }
}

impl ApplicationHandler for Runner {
    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if matches!(cause, StartCause::ResumeTimeReached { .. }) {
            event_loop.set_control_flow(ControlFlow::Wait);
            self.poll_minimised(event_loop);
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
        let world = self.app.world_mut();
        let is_kept = self.overlay.as_mut().is_some_and(|overlay| overlay.event(&open.window, &event, world));
        if !is_kept {
            open.input.event(&event, open.window.scale_factor(), world);
        }
        match event {
            WindowEvent::RedrawRequested => self.frame(event_loop),
            // Not every window system follows a change of the scale factor with one of the size.
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => {
                open.follow_size(self.app.world_mut());
                self.poll_minimised(event_loop);
                self.redraw();
            }
            WindowEvent::Occluded(covered) => {
                self.covered = covered;
                self.redraw();
            }
            WindowEvent::CloseRequested => self.close(event_loop),
            // The display destroyed the window.
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
