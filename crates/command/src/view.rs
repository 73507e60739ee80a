//! `halfway view`.

use clap::Args;
use halfway::prelude::*;
use halfway::render::Adapter;

use crate::failure::Failure;
use crate::input::SceneInput;
use crate::look::LookArgs;
use crate::prices::PricesInUse;

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
    app.add_systems(Update, take_prices);
    input.spawn(&mut app)?;
    match app.run() {
        AppExit::Success => Ok(()),
        // What went wrong has been said where it happened.
        AppExit::Error(code) => Err(Failure::said(code.get())),
    }
}

/// Draws by the prices that are kept for the adapter, once it is open.
fn take_prices(world: &mut World, mut taken: Local<bool>) {
    let Some(adapter) = Adapter::of(world).filter(|_| !*taken) else { return };
    *taken = true;
    let prices = PricesInUse::of(&adapter);
    if prices.is_kept() {
        eprintln!("note: prices of automatic shading: {}", prices.describe());
    }
    prices.insert_into(world);
}
