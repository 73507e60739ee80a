//! `halfway calibrate`.

use clap::Args;
use halfway::render::{Calibration, VertexPrices};
use serde_json::json;
use std::io::ErrorKind;
use std::path::Path;

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
        Some(file) if found.weight.is_none() => Err(forget(file)?),
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
                "weight": found.weight,
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
    if found.doubts.is_empty() {
        println!("\nFrames of a dome take {:.2} times as long by these prices as by those fixed", found.trial);
    }
    if let Some(weight) = found.weight {
        println!("where looks and draws count {weight} times what was measured, which was the best of those tried.");
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

/// Removes what was kept before: the adapter's own prices draw faster. Why nothing is kept.
fn forget(file: &Path) -> Result<String, Failure> {
    let why = "those fixed draw as fast";
    match std::fs::remove_file(file) {
        Ok(()) => Ok(format!("{why}; {} is removed", file.display())),
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(why.to_owned()),
        Err(error) => Err(Failure::from(format!("{}: cannot be removed: {error}", file.display()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prices_that_no_longer_pay_are_removed() {
        let folder = std::env::temp_dir().join(format!("halfway_forget_{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("it can be made");
        let file = folder.join("prices.json");
        std::fs::write(&file, "{}").expect("it can be written");
        let said = |file: &Path| forget(file).expect("it is gone");
        assert!(said(&file).ends_with("prices.json is removed") && !file.exists());
        assert_eq!(said(&file), "those fixed draw as fast");
        assert_eq!(said(&std::env::current_exe().expect("a program").join("none")), "those fixed draw as fast");
        let failure = forget(&folder).expect_err("a folder is no file");
        assert!(
            failure.code == 2 && failure.error.is_some_and(|error| error.to_string().contains("cannot be removed"))
        );
        std::fs::remove_dir(&folder).expect("it is empty");
    }
}
