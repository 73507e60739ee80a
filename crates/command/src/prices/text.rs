//! Kept prices as text: JSON, which says what it is and what it was measured on.

use halfway::render::{Calibration, VertexPrices};
use serde_json::{Map, Value, json};

use super::PricedAdapter;

/// What the first key says. Another is another format: older, newer or none of ours.
const FORMAT: &str = "halfway prices 1";

/// The version that measures: another one may draw otherwise, at other prices.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// By their names; those that are infinite are null.
pub(super) fn prices(prices: &VertexPrices) -> Value {
    let named = prices.named().map(|(name, price)| (name.to_owned(), json!(price)));
    named.into_iter().collect::<Map<_, _>>().into()
}

pub(super) fn written(
    of: &PricedAdapter,
    Calibration { unit_ns, vertex_ns, prices: found, .. }: &Calibration,
) -> String {
    let json = json!({
        "format": FORMAT,
        "halfway": VERSION,
        "measured_on": of.json(),
        "light_at_pixel_ns": unit_ns,
        "vertex_ns": vertex_ns,
        "prices": prices(found),
    });
    format!("{json:#}\n")
}

/// The prices in such a text, measured on this adapter by this version; or what is wrong with it.
pub(super) fn read(text: &str, of: &PricedAdapter) -> Result<VertexPrices, String> {
    let json: Value = serde_json::from_str(text).map_err(|error| format!("damaged: {error}"))?;
    if json["format"] != FORMAT {
        return Err(format!("{} is another format; expected {FORMAT:?}", json["format"]));
    }
    if json["halfway"] != VERSION {
        return Err(format!("measured by version {}; expected {VERSION:?}", json["halfway"]));
    }
    if json["measured_on"] != of.json() {
        return Err("measured on another adapter or driver".to_owned());
    }
    let price = |name: &str| {
        let value = &json["prices"][name];
        // From text, a number may be too large for one of 32 bits.
        let price = value.as_f64().map(|price| price as f32).filter(|price| price.is_finite());
        price.ok_or_else(|| format!("damaged: {name} is {value}; expected a number"))
    };
    let prices = VertexPrices {
        light: price("light")?,
        pixel: price("pixel")?,
        look: price("look")?,
        draw: price("draw")?,
        diffuse_alone: price("diffuse_alone")?,
        specular_alone: price("specular_alone")?,
    };
    prices.validate().map(|()| prices).map_err(|error| format!("damaged: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PRICES: VertexPrices =
        VertexPrices { light: 2.1, pixel: 0.3, look: 7.25, draw: 812.0, diffuse_alone: 0.81, specular_alone: 0.93 };

    fn of(driver: &str) -> PricedAdapter {
        PricedAdapter(vec![("adapter", "a \"quoted\" name".into()), ("driver", driver.into())])
    }

    fn text() -> String {
        let found = Calibration {
            unit_ns: 2.5,
            vertex_ns: 31.0,
            measured: PRICES,
            prices: PRICES,
            doubts: Vec::new(),
            weight: Some(1.0),
            trial: 0.9,
        };
        written(&of("1"), &found)
    }

    #[test]
    fn what_is_written_is_read() {
        assert_eq!(read(&text(), &of("1")), Ok(PRICES));
    }

    #[test]
    fn what_is_damaged_foreign_or_old_is_refused() {
        let text = text();
        assert_eq!(read(&text, &of("2")), Err("measured on another adapter or driver".into()));
        let version = format!("\"{VERSION}\"");
        let rows = [
            ("halfway prices 1", "halfway prices 0", "another format"),
            (version.as_str(), "\"0.0.0\"", "measured by version \"0.0.0\""),
            ("812.0", "-1.0", "damaged: VertexPrices.draw"),
            ("812.0", "null", "damaged: draw is null"),
            ("812.0", "1e300", "damaged: draw is 1e"),
            ("812.0", "\"cheap\"", "damaged: draw is"),
            ("\"draw\"", "\"drawn\"", "damaged: draw is null"),
            ("{", "", "damaged: "),
        ];
        for (from, to, problem) in rows {
            assert!(text.contains(from), "{from} in {text}");
            let found = read(&text.replace(from, to), &of("1")).expect_err(to);
            assert!(found.contains(problem), "{from} → {to}: {found}");
        }
        for bad in ["", "null", "[]", "\0", "{\"format\": {}}"] {
            assert!(read(bad, &of("1")).is_err(), "{bad}");
        }
        // Cut off anywhere, it is no prices.
        for (end, _) in text.trim_end().char_indices() {
            assert!(read(&text[..end], &of("1")).is_err(), "{end} bytes");
        }
    }
}
