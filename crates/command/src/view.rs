//! `halfway view`.

use clap::Args;
use halfway::prelude::*;
use halfway_viewer::SceneViewer;

use crate::drawing::DrawingArgs;
use crate::failure::Failure;
use crate::input::SceneInput;

#[derive(Args, Debug)]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
    /// Show the picture alone, without panels
    #[arg(long)]
    bare: bool,
}

pub(crate) fn run(args: &ViewArgs) -> Result<(), Failure> {
    args.drawing.input.without_picture()?;
    let input = SceneInput::read(&args.drawing, &args.drawing.options())?;
    if args.drawing.samples.is_some_and(|samples| samples > 4) {
        eprintln!("warning: a window has four samples a pixel; `halfway render` averages more");
    }
    let mut app = App::new();
    // The panels have the keys, too.
    let window = WindowPlugin { viewer_keys: args.bare, ..WindowPlugin::default() };
    app.add_plugins(HalfwayPlugins.set(window)).insert_resource(WindowTitle(input.name()));
    app.insert_resource(args.drawing.adapter.choice());
    if args.bare {
        input.spawn(&mut app)?;
    } else {
        let warnings =
            SceneViewer::new(input.into_document()).insert_into(&mut app).map_err(|error| Failure::new(2, error))?;
        for warning in warnings {
            eprintln!("warning: {warning}");
        }
    }
    match app.run() {
        AppExit::Success => Ok(()),
        // The error was already printed.
        AppExit::Error(code) => Err(Failure::already_printed(code.get())),
    }
}
