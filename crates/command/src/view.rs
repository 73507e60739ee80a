//! `halfway view`.

use clap::Args;
use halfway::prelude::*;

use crate::failure::Failure;
use crate::input::SceneInput;
use crate::look::LookArgs;

#[derive(Args, Debug)]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    look: LookArgs,
}

pub(crate) fn run(args: &ViewArgs) -> Result<(), Failure> {
    let input = SceneInput::read(&args.look)?;
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins).insert_resource(WindowTitle(input.name()));
    app.insert_resource(args.look.adapter.choice());
    input.spawn(&mut app)?;
    match app.run() {
        AppExit::Success => Ok(()),
        // The error was already printed.
        AppExit::Error(code) => Err(Failure::said(code.get())),
    }
}
