//! Inputs of shading from the frame.

use crate::pass::Pass;
use crate::screen::Screen;
use crate::state::State;

/// Inputs of shading a tile from the frame.
#[derive(Clone, Copy)]
pub(crate) struct Look<'a> {
    pub(crate) pass: &'a Pass<'a>,
    pub(crate) states: &'a [State],
    pub(crate) screen: &'a Screen,
    /// Whether anything in the tile [shades apart](State::shades_apart).
    pub(crate) painted: bool,
    /// Column and row of the tile.
    pub(crate) tile: [u32; 2],
}
