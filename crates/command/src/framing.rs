//! `--view`, `--up`, `--ortho`, `--fit` and `--zoom`: the side from which the model is seen, and how large.

use clap::Args;
use halfway::lighting::{Framing, View};
use halfway::prelude::Vec3;
use halfway::scene::{CameraEntry, SceneFile};

/// The options replace the camera of a scene file, as far as they say otherwise.
#[derive(Args, Clone, Debug)]
pub(crate) struct FramingArgs {
    /// The side seen: front, back, left, right, top, bottom, iso, or azimuth and elevation in degrees, such as 30,20
    /// [default: the scene's camera; 30,20 for a model]
    #[arg(long, value_name = "SIDE|AZ,EL", allow_hyphen_values = true)]
    view: Option<View>,
    /// The direction that is upright in the model: y, or z as in CAD, x, -x, -y, -z [default: the scene's; y]
    #[arg(long, value_name = "AXIS", value_parser = parse_up, allow_hyphen_values = true)]
    pub(crate) up: Option<Vec3>,
    /// Look without perspective: parallel rays, and lengths that can be measured
    #[arg(long)]
    pub(crate) ortho: bool,
    /// The share of the picture that the model fills, above 0 and at most 1 [default: the scene's; 0.9 for a model]
    #[arg(long, value_name = "SHARE", value_parser = parse_fit)]
    fit: Option<f32>,
    /// Magnify the middle of the picture, so many times
    #[arg(long, value_name = "FACTOR", value_parser = parse_zoom)]
    pub(crate) zoom: Option<f32>,
}

impl FramingArgs {
    /// Changes the camera of the scene.
    pub(crate) fn apply(&self, scene: &mut SceneFile) {
        let Self { view, up, ortho, fit, zoom } = *self;
        if !self.is_given() {
            return;
        }
        let framed = CameraEntry { view: Some(View::default()), ..CameraEntry::default() };
        let camera = scene.camera.get_or_insert(framed);
        camera.view = view.or(camera.view);
        camera.up = up.map_or(camera.up, |up| up.to_array());
        camera.ortho |= ortho;
        camera.fit = fit.or(camera.fit);
        camera.zoom *= zoom.unwrap_or(1.0);
    }

    /// Whether any of them is given.
    pub(crate) fn is_given(&self) -> bool {
        let Self { view, up, ortho, fit, zoom } = self;
        view.is_some() || up.is_some() || *ortho || fit.is_some() || zoom.is_some()
    }

    /// The upright axis of the model: that of `--up`, or of a camera of the scene that frames all objects.
    pub(crate) fn upright(&self, scene: &SceneFile) -> Vec3 {
        let of_camera = || scene.camera.as_ref().filter(|camera| camera.view.is_some()).map(|camera| camera.up.into());
        self.up.or_else(of_camera).and_then(Vec3::try_normalize).unwrap_or(Vec3::Y)
    }

    /// The framing from another view.
    pub(crate) fn seen_from(&self, view: View) -> Framing {
        let framing = Framing::new(view, self.up.unwrap_or(Vec3::Y));
        Framing { fit: self.fit.unwrap_or(framing.fit), zoom: self.zoom.unwrap_or(framing.zoom), ..framing }
    }
}

fn parse_up(text: &str) -> Result<Vec3, String> {
    let (sign, axis) =
        text.strip_prefix('-').map_or((1.0, text.strip_prefix('+').unwrap_or(text)), |axis| (-1.0, axis));
    let axis = match axis {
        "x" | "X" => Vec3::X,
        "y" | "Y" => Vec3::Y,
        "z" | "Z" => Vec3::Z,
        _ => return Err("expected x, y, z, -x, -y or -z".to_owned()),
    };
    Ok(axis * sign)
}

fn parse_fit(text: &str) -> Result<f32, String> {
    let share = text.parse().ok().filter(|share| *share > 0.0 && *share <= 1.0);
    share.ok_or_else(|| "expected a share above 0 and at most 1, such as 0.9".to_owned())
}

fn parse_zoom(text: &str) -> Result<f32, String> {
    let zoom = text.parse().ok().filter(|zoom: &f32| (1e-3..=1e6).contains(zoom));
    zoom.ok_or_else(|| "expected a factor from 0.001 to 1000000, such as 2".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_shares_and_factors() {
        assert_eq!(parse_up("z"), Ok(Vec3::Z));
        assert_eq!(parse_up("-Y"), Ok(Vec3::NEG_Y));
        assert!(["", "w", "--z", "zz"].iter().all(|text| parse_up(text).is_err()));
        assert_eq!(parse_fit("0.5"), Ok(0.5));
        assert!(["", "0", "1.1", "-1", "nan"].iter().all(|text| parse_fit(text).is_err()));
        assert_eq!(parse_zoom("2"), Ok(2.0));
        assert!(["", "0", "inf", "-2"].iter().all(|text| parse_zoom(text).is_err()));
    }
}
