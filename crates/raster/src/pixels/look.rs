//! The context of shading: the pass and the tile.

use crate::input::pass::Pass;
use crate::lighting::state::State;
use crate::vertices::screen::Screen;

/// The pass and the tile that are shaded.
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
