//! Properties of the adapter, measured and compared with environment variables. `cargo xtask adapters` runs these on
//! each.

use halfway::render::{Adapter, AdapterChoice};

/// The adapter that the environment names, else a graphics adapter, since most of these tests are for those.
pub(crate) fn choice() -> AdapterChoice {
    if std::env::var_os("HALFWAY_ADAPTER").is_some() { AdapterChoice::default() } else { AdapterChoice::gpu() }
}

fn adapter() -> Adapter {
    choice().open().unwrap_or_else(|error| panic!("{error}"))
}

// `cargo xtask adapters` sets the name of the tested adapter; programs choose theirs by other variables that it sets.
#[test]
fn the_drawing_adapter_is_the_tested_one() {
    let tested = std::env::var("HALFWAY_TESTED_ADAPTER").unwrap_or_default();
    let said = adapter().describe();
    for part in tested.split_whitespace() {
        assert!(said.contains(part), "{tested} is to be tested, and {said} draws");
    }
}

#[test]
fn the_grid_is_as_fine_as_the_driver_says() {
    let adapter = adapter();
    let bits = adapter.sub_pixel_bits().unwrap_or_else(|error| panic!("{error}"));
    // `subPixelPrecisionBits` of either, and the rasterizer's own.
    let known = [("llvmpipe", 8), ("SwiftShader", 4), ("(cpu", 8)];
    let said = known.into_iter().find(|(name, _)| adapter.describe().contains(name));
    match said {
        Some((name, said)) => assert_eq!(bits, said, "{name}"),
        None => assert!(bits >= 4, "{bits} bits; Vulkan grants 4"),
    }
    assert_eq!(adapter.sub_pixel_bits(), Ok(bits), "measured again");
}
