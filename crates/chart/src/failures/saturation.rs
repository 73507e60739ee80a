//! Intensities above 1 under each policy.

use halfway::reference::Oracle;

use super::prelude::*;

/// The policies by their names.
const POLICIES: [(&str, Intensity); 4] = [
    ("clamp", Intensity::Clamp),
    ("renormalise", Intensity::Renormalize { smoothing: 0.0 }),
    ("Reinhard, white 4", Intensity::Reinhard { white: Intensity::WHITE }),
    ("ACES", Intensity::Aces),
];
const SMOOTHLY: (&str, Intensity) = ("renormalise, smoothing 0.9", Intensity::Renormalize { smoothing: 0.9 });

/// An orange light, three times too bright for the sphere, in front of a grey background.
fn spawn(world: &mut World, intensity: Intensity) {
    camera_of(world, intensity);
    let light = DirectionalLight::new(LinearRgba::rgb(3.0, 1.5, 0.6));
    world.spawn((light, Transform::default().looking_to(-Vec3::new(0.5, 0.2, 1.0), Vec3::Y)));
    let surface = Material { specular: LinearRgba::gray(0.5), ..Material::matte(LinearRgba::gray(0.9)) };
    show(world, UvSphere::new(1.0, 64, 32), surface, Shading::Phong);
}

/// A camera with this policy in front of a grey background.
fn camera_of(world: &mut World, intensity: Intensity) {
    let camera = Camera { intensity, background: LinearRgba::gray(0.25), ..Camera::default() };
    world.spawn((camera, Transform::from_xyz(0.0, 0.0, 2.9).looking_at(Vec3::ZERO, Vec3::Y)));
}

/// Clamped to 0 … 1, as a picture holds it.
fn clamped(image: &Image) -> Image {
    let (width, height) = image.dimensions();
    let pixels = image.pixels().iter().map(|pixel| pixel.map(|channel| channel.min(1.0)));
    let clamped = Image::new(width, height, pixels.collect());
    image.covered().map_or(clamped.clone(), |covered| clamped.with_coverage(covered.to_vec()))
}

/// The intensities, and the picture under each policy.
fn pictures() -> Result<(Image, [Image; 4]), ChartError> {
    let draw = |intensity| {
        let mut app = set_up(|world| spawn(world, intensity));
        Ok::<_, ChartError>(Oracle::new(app.world_mut(), SIZE)?.with_mode(Mode::Surface).draw())
    };
    let [clamp, divided, reinhard, aces] = POLICIES.map(|(_, policy)| draw(policy).map(|image| clamped(&image)));
    Ok((draw(Intensity::Clamp)?, [clamp?, divided?, reinhard?, aces?]))
}

/// The hue of a color in degrees, as in HSV; `None` for grey.
fn hue([r, g, b]: [f64; 3]) -> Option<f64> {
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let range = most - least;
    if range < 1e-9 {
        return None;
    }
    Some(match most {
        most if r >= most => 60.0 * ((g - b) / range),
        most if g >= most => 60.0 * ((b - r) / range + 2.0),
        _ => 60.0 * ((r - g) / range + 4.0),
    })
}

/// The rotation of the hue, in degrees, along the middle row.
fn turns(raw: &Image, shown: &Image) -> Vec<(f64, f64)> {
    let columns = row(raw, SIZE.y / 2).into_iter().map(|(x, _)| x as u32);
    let turn = |x: u32| Some((f64::from(x), hue(shown.pixel(x, SIZE.y / 2))? - hue(raw.pixel(x, SIZE.y / 2))?));
    columns.filter_map(turn).collect()
}

const FRAMES: u32 = 60;

/// The displayed grey background while a small lamp passes a wall of facets, each of which flashes once.
fn flicker(policy: Intensity) -> Result<Vec<(f64, f64)>, ChartError> {
    let mut app = set_up(|world| {
        camera_of(world, policy);
        world.spawn((
            PointLight { attenuation: Attenuation::INVERSE_SQUARE, ..PointLight::white() },
            Transform::default(),
        ));
        let shine =
            Material { specular: LinearRgba::WHITE, shininess: 200.0, ..Material::matte(LinearRgba::gray(0.5)) };
        show(world, UvSphere::new(1.0, 24, 12), shine, Shading::Flat);
    });
    let mut before = None;
    (0..FRAMES)
        .map(|frame| {
            let world = app.world_mut();
            let angle = 1.2 * (2.0 * frame as f32 / FRAMES as f32 - 1.0);
            world.query_filtered::<&mut Transform, With<PointLight>>().iter_mut(world).for_each(|mut at| {
                at.translation = 1.7 * Vec3::new(angle.sin(), 0.3, angle.cos());
            });
            app.update();
            let image = Oracle::new(app.world_mut(), UVec2::splat(64))?.after(before).draw();
            before = image.divisor();
            Ok((f64::from(frame), image.pixel(0, 0)[0].min(1.0)))
        })
        .collect()
}

pub(super) fn page() -> Result<FailurePage, ChartError> {
    let (raw, all) = pictures()?;
    let hues = POLICIES.iter().zip(&all).enumerate();
    let hues = hues.map(|(kind, ((name, _), image))| series(name, kind, &turns(&raw, image), false));
    let middle = format!("row {} of {}", SIZE.y / 2, SIZE.y);
    let mut flickers = Vec::new();
    for (kind, (name, policy)) in [POLICIES[1], SMOOTHLY, POLICIES[2]].into_iter().enumerate() {
        flickers.push(series(name, kind, &flicker(policy)?, false));
    }
    let [clamp, divided, reinhard, aces] = &all;
    Ok(FailurePage {
        id: "saturation",
        title: "Intensities above 1 lose hue and contrast",
        cause: "A picture holds 0 to 1. Clamped, the brightest channel stays behind while the others catch up: hues turn, \
                and what is above 1 becomes one flat patch. A curve for each channel keeps contrast and turns hues too; \
                one divisor for all keeps both, but makes all of the picture dim, and flicker as the brightest spot comes \
                and goes.",
        remedy: "Light scenes so that nothing exceeds 1, where clamping costs nothing and changes nothing. For still \
                 pictures renormalise; for moving ones renormalise with smoothing, or take a curve.",
        test: "clamping_turns_hues_and_divisors_flicker",
        figures: vec![
            figure(
                "saturation-hue",
                "How far hues are turned, across a sphere under an orange light of 3, 1.5, 0.6",
                [Axis::linear("pixel"), Axis::linear("turned by (degrees)")],
                Panel::new(&middle, hues.collect()),
            )
            .named("hue"),
            figure(
                "saturation-flicker",
                "How a background of 0.25 is shown while a lamp passes the facets of a sphere",
                [Axis::linear("frame"), Axis::linear("red (linear)")],
                Panel::new("60 frames, flat shading, shininess 200", flickers),
            )
            .named("flicker"),
        ],
        pictures: shown([("clamp", clamp), ("renormalise", divided), ("Reinhard, white 4", reinhard), ("ACES", aces)]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The fraction of the sphere that shows one and the same red, the brightest.
    fn flat_share(shown: &Image) -> f64 {
        let covered = shown.covered().expect("the oracle knows");
        let reds = || shown.pixels().iter().zip(covered).filter(|(_, covered)| **covered).map(|(pixel, _)| pixel[0]);
        let most = reds().fold(0.0, f64::max);
        reds().filter(|red| most - red < 1.0 / 512.0).count() as f64 / reds().count() as f64
    }

    /// The largest change from one frame to the next.
    fn jump(frames: &[(f64, f64)]) -> f64 {
        frames.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn clamping_turns_hues_and_divisors_flicker() {
        let (raw, all) = pictures().unwrap();
        let turned = all
            .each_ref()
            .map(|image| turns(&raw, image).iter().fold(0.0, |most: f64, (_, turn)| most.max(turn.abs())));
        let [clamp, divided, reinhard, aces] = turned;
        assert!(clamp > 10.0 && divided < 1e-6 && reinhard > 1.0 && aces > 1.0, "{turned:?}");
        let flat = all.each_ref().map(flat_share);
        let [clamp, divided, ..] = flat;
        assert!(clamp > 0.3 && divided < 0.05, "{flat:?}");
        let jumps = [POLICIES[1].1, SMOOTHLY.1, POLICIES[2].1].map(|policy| jump(&flicker(policy).unwrap()));
        let [plain, smooth, curve] = jumps;
        // The smoothing leaves a tenth of each change.
        assert!(plain > 5.0 * smooth && smooth > 0.0 && curve < 1e-9, "{jumps:?}");
    }
}
