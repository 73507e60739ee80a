//! Shows the CPU's pictures in a window: a buffer of the window system, without a graphics driver.

use crate::error::WindowError;
use crate::overlay::Overlay;
use bevy_math::UVec2;
use softbuffer::{Context, SoftBufferError, Surface};
use std::num::NonZeroU32;
use std::sync::Arc;
use winit::event_loop::OwnedDisplayHandle;
use winit::window::Window;

/// The buffer of a window.
pub(crate) struct WindowBuffer {
    surface: Surface<OwnedDisplayHandle, Arc<Window>>,
    /// Its current size.
    size: UVec2,
}

impl WindowBuffer {
    pub(crate) fn new(display: &OwnedDisplayHandle, window: &Arc<Window>) -> Result<Self, WindowError> {
        let context = Context::new(display.clone()).map_err(refused)?;
        let surface = Surface::new(&context, Arc::clone(window)).map_err(refused)?;
        Ok(Self { surface, size: UVec2::ZERO })
    }

    /// Shows a picture of this size: four bytes a pixel, red, green, blue and one more, row by row from the top; and the
    /// overlay over it.
    pub(crate) fn show(
        &mut self,
        size: UVec2,
        picture: &[u8],
        overlay: Option<&mut (dyn Overlay + 'static)>,
    ) -> Result<(), WindowError> {
        let (Some(width), Some(height)) = (NonZeroU32::new(size.x), NonZeroU32::new(size.y)) else { return Ok(()) };
        if size != self.size {
            self.surface.resize(width, height).map_err(refused)?;
            self.size = size;
        }
        let mut buffer = self.surface.buffer_mut().map_err(refused)?;
        for (shown, &[red, green, blue, _]) in buffer.iter_mut().zip(picture.as_chunks().0) {
            *shown = u32::from_be_bytes([0, red, green, blue]);
        }
        if let Some(overlay) = overlay {
            overlay.paint(&mut buffer, size);
        }
        buffer.present().map_err(refused)
    }
}

fn refused(error: SoftBufferError) -> WindowError {
    WindowError::Surface(error.to_string())
}
