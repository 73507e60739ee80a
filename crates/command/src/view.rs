//! `halfway view`.

use clap::Args;
use halfway::prelude::*;

use crate::drawing::DrawingArgs;
use crate::failure::Failure;
use crate::input::SceneInput;

#[derive(Args, Debug)]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
}

pub(crate) fn run(args: &ViewArgs) -> Result<(), Failure> {
    args.drawing.input.without_picture()?;
    let input = SceneInput::read(&args.drawing)?;
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins).insert_resource(WindowTitle(input.name()));
    app.insert_resource(args.drawing.adapter.choice());
    input.spawn(&mut app)?;
    match app.run() {
        AppExit::Success => Ok(()),
        // The error was already printed.
        AppExit::Error(code) => Err(Failure::already_printed(code.get())),
    }
}
