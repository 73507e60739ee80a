//! `halfway calibrate`.

use clap::Args;
use halfway::render::{Calibration, VertexPrices};
use serde_json::json;

use crate::adapters::AdapterArgs;
use crate::failure::Failure;
use crate::prices::{PriceFolder, PricedAdapter, keep};

#[derive(Args, Debug)]
pub(crate) struct CalibrateArgs {
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print JSON instead of a table; prices that are infinite are null
    #[arg(long)]
    json: bool,
}

/// What prices are of, in words, in their order.
const MEANINGS: [&str; 6] = [
    "a light at a vertex",
    "that there is any light at a pixel",
    "to bound what a light changes of a patch",
    "to draw a patch with lights of its own",
    "a light's diffuse term alone, at a pixel",
    "its specular term alone",
];

pub(crate) fn run(args: &CalibrateArgs) -> Result<(), Failure> {
    let adapter = args.adapter.choice().open()?;
    let found = Calibration::measure(&adapter)?;
    let own = adapter.costs().vertices;
    let of = PricedAdapter::new(&adapter);
    let file = PriceFolder::of_user().map(|folder| folder.file(&of));
    let kept = match &file {
        _ if !found.doubts.is_empty() => Err("they are not believed".to_owned()),
        None => Err("there is no folder; expected one in HALFWAY_CACHE, XDG_CACHE_HOME or HOME".to_owned()),
        Some(file) => keep(file, &of, &found),
    };
    if args.json {
        let named = |prices: &VertexPrices| {
            let pairs = prices.named().map(|(name, price)| (name.to_owned(), json!(price)));
            serde_json::Value::Object(pairs.into_iter().collect())
        };
        println!(
            "{}",
            json!({
                "adapter": adapter.describe(),
                "light_at_pixel_ns": found.unit_ns,
                "vertex_ns": found.vertex_ns,
                "measured": named(&found.measured),
                "fixed": named(&own),
                "caution": found.caution,
                "prices": named(&found.prices),
                "trial": found.trial,
                "doubts": found.doubts,
                "measured_on": of.json(),
                "file": file.map(|file| file.display().to_string()),
                "kept": kept.is_ok(),
                "not_kept": kept.err(),
            })
        );
        return Ok(());
    }
    println!("{}", adapter.describe());
    println!(
        "a light at a pixel: {:.3} ns of a frame; a vertex without lights: {:.1} ns",
        found.unit_ns, found.vertex_ns
    );
    println!("\n| in lights at a pixel | measured | fixed for its kind |\n|---|---|---|");
    for ((meaning, (_, measured)), (_, own)) in MEANINGS.iter().zip(found.measured.named()).zip(own.named()) {
        println!("| {meaning} | {measured:.2} | {} |", if own.is_finite() { format!("{own}") } else { "never".into() });
    }
    println!("\nA frame of a ball under four lights takes {:.2} times as long by these prices.", found.trial);
    if found.caution > 1.0 {
        println!("By less it took too long: looks and draws count {} times what was measured.", found.caution);
    }
    for doubt in &found.doubts {
        println!("not believed: {doubt}");
    }
    match (kept, file) {
        (Ok(()), Some(file)) => println!("kept in {}, for `halfway view` and `halfway bench`", file.display()),
        (kept, _) => println!("not kept: {}", kept.err().unwrap_or_default()),
    }
    Ok(())
}
