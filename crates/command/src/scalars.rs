//! `--scalars` and `--legend`: numbers of a model, shown by colours.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use halfway::lighting::View;
use halfway::scene::{CameraEntry, ColorMap, MeshEntry, ObjectEntry, ScalarsEntry, SceneFile};

use crate::choices::{choice, values};

/// The options hold for all models.
#[derive(Args, Clone, Debug)]
pub(crate) struct ScalarArgs {
    /// Show this property of the models, such as a PLY's temperature, by colours; `halfway info` lists the properties
    #[arg(long, value_name = "PROPERTY")]
    scalars: Option<String>,
    /// The colours of the numbers [default: viridis]
    #[arg(long, requires = "scalars", value_parser = maps())]
    map: Option<ColorMap>,
    /// The numbers that the colours begin and end with [default: the least and the greatest]
    #[arg(long, requires = "scalars", value_name = "A..B", value_parser = parse_range, allow_hyphen_values = true)]
    range: Option<[f32; 2]>,
    /// Draw N lines of equal numbers, 1 to 100
    #[arg(long, requires = "scalars", value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100))]
    isolines: Option<u32>,
    /// Draw a legend of the colours with this title into the picture
    #[arg(long, value_name = "TITLE")]
    legend: Option<String>,
}

impl ScalarArgs {
    /// Changes the objects and the cameras of the scene.
    pub(crate) fn apply(&self, scene: &mut SceneFile) {
        if let Some(property) = &self.scalars {
            let scalars = ScalarsEntry {
                map: self.map.unwrap_or_default(),
                range: self.range,
                isolines: self.isolines.unwrap_or_default(),
                ..ScalarsEntry::of_property(property)
            };
            let is_model = |object: &&mut ObjectEntry| matches!(object.mesh, MeshEntry::Path(_) | MeshEntry::Model(_));
            for object in scene.objects.iter_mut().filter(is_model) {
                object.scalars = Some(scalars.clone());
                (object.maps, object.displacement) = (None, None);
            }
        }
        if self.legend.is_some() {
            if scene.camera.is_none() && scene.cameras.is_empty() {
                scene.camera = Some(CameraEntry { view: Some(View::default()), ..CameraEntry::default() });
            }
            scene.all_cameras_mut().for_each(|camera| camera.legend.clone_from(&self.legend));
        }
    }
}

fn maps() -> impl TypedValueParser<Value = ColorMap> {
    PossibleValuesParser::new(values::<ColorMap>()).try_map(|text| choice(&text).ok_or("not one of the values"))
}

fn parse_range(text: &str) -> Result<[f32; 2], String> {
    let ends =
        text.split_once("..").and_then(|(low, high)| Some([low.trim().parse().ok()?, high.trim().parse().ok()?]));
    ends.filter(|[low, high]: &[f32; 2]| low.is_finite() && high.is_finite() && low < high)
        .ok_or_else(|| "expected A..B, two numbers, the lower first, such as -1..2.5".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges() {
        assert_eq!(parse_range("-1..2.5"), Ok([-1.0, 2.5]));
        assert_eq!(parse_range("1e-3 .. 1e3"), Ok([1e-3, 1e3]));
        for bad in ["", "1", "1..1", "2..1", "a..b", "0..inf", "nan..1", "0..1..2"] {
            assert!(parse_range(bad).is_err(), "{bad}");
        }
    }
}
