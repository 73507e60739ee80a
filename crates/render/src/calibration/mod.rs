//! What drawing costs on an adapter, measured by drawing.

mod scenery;
mod stages;
mod trials;

use crate::device::adapter::Adapter;
use crate::device::costs::VertexPrices;
use crate::error::RenderError;
use stages::{Stages, Times};
use trials::{Trial, Trials};

/// What drawing costs on an adapter, measured by drawing: small scenes that differ in one thing, in turns. Their frames
/// take a second or two on the CPU, and ten to fifteen through a driver that draws on two cores.
///
/// ```no_run
/// # use bevy_app::App;
/// # use halfway_render::{AdapterChoice, Calibration, RenderError};
/// # fn calibrated(app: &mut App) -> Result<(), RenderError> {
/// let adapter = AdapterChoice::default().open()?;
/// let Calibration { prices, .. } = Calibration::measure(&adapter)?;
/// adapter.insert_into(app.world_mut());
/// app.insert_resource(prices);
/// # Ok(())
/// # }
/// ```
///
/// Pictures under [`Shading::Auto`](halfway_lighting::Shading::Auto) keep to the tolerance whatever the prices are, but
/// they are not the same pictures to the byte: do without where they are to repeat on other machines.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// What a light costs at a pixel, in nanoseconds of a frame: what the prices are multiples of.
    pub unit_ns: f64,
    /// What a vertex costs without lights, with its triangles, in nanoseconds of a frame.
    pub vertex_ns: f64,
    /// As they were found, also where they cannot be.
    pub measured: VertexPrices,
    /// What to draw by: those measured, or the adapter's own where these cannot be or draw faster.
    pub prices: VertexPrices,
    /// Why those measured cannot be, in words; none where they can.
    pub doubts: Vec<String>,
    /// How many times what was measured a look and a draw count in `prices`, ¼ to 4; `None` where those are the
    /// adapter's own.
    pub weight: Option<f32>,
    /// How long frames take by the prices measured, with the best such weight, as a multiple of those by the adapter's
    /// own; 1 where they were not tried, since they cannot be.
    pub trial: f64,
}

/// What a price can be. What is outside has been disturbed.
///
/// The first light at a pixel takes no less than nothing, and a light more than the lights after it: -1 where it is
/// free, as on graphics cards that wait for something else meanwhile (-0.6 and -0.7 on an NVIDIA H200), and a tenth for
/// noise. A light at a vertex is found from frames of whose time it is a tenth.
const BELIEVED: [(&str, f32, f32); 6] = [
    ("light", -3.0, 500.0),
    ("pixel", -1.1, 100.0),
    ("look", 0.01, 1e5),
    ("draw", -1.0, 1e7),
    ("diffuse_alone", 0.05, 1.3),
    ("specular_alone", 0.05, 1.3),
];

/// What a light at a vertex is taken for where less was found: as little as on the cheapest adapter that was tried, the
/// CPU without a driver (0.02 to 0.27), but for noise.
const LEAST_LIGHT: f32 = 0.05;

/// What a light can cost at a pixel, in nanoseconds.
const BELIEVED_UNIT: [f64; 2] = [1e-4, 1e4];

/// As how many times what was measured looks and draws are tried. Less where patches beside each other have the same
/// lights, so that one draw is enough for many; more for what no price stands for, as that triangles whose terms are in
/// two places are drawn in a slower way.
const WEIGHTS: [f32; 3] = [0.25, 1.0, 4.0];

impl Calibration {
    /// Draws on the adapter and times it. What else the machine does at that time makes it less exact; prices that
    /// cannot be, or that do not draw faster than the adapter's own, are not taken.
    ///
    /// # Errors
    /// What the adapter could not draw.
    pub fn measure(adapter: &Adapter) -> Result<Self, RenderError> {
        let mut stages = Stages::new(adapter);
        let times = stages.time()?;
        let found = Self::untried(&times, adapter.costs().vertices);
        if !found.doubts.is_empty() {
            return Ok(found);
        }
        let tried = WEIGHTS.map(|weight| taken(found.measured, weight));
        let prices: Vec<_> = [found.prices].into_iter().chain(tried).collect();
        let trials = stages.trials(&prices)?;
        Ok(found.with_trials(&trials))
    }

    /// What was measured, on an adapter with prices of its `own`.
    fn untried(times: &Times, own: VertexPrices) -> Self {
        let (unit_ns, vertex_ns, measured) = times.prices();
        let mut doubts = Vec::new();
        let [least, most] = BELIEVED_UNIT;
        if !(least..=most).contains(&unit_ns) {
            doubts.push(format!("a light at a pixel: {unit_ns} ns; expected {least} to {most}"));
        }
        for ((name, price), (_, least, most)) in measured.named().into_iter().zip(BELIEVED) {
            if !(least..=most).contains(&price) {
                doubts.push(format!("{name}: {price} lights at a pixel; expected {least} to {most}"));
            }
        }
        Self { unit_ns, vertex_ns, measured, prices: own, doubts, weight: None, trial: 1.0 }
    }

    /// With the weight by which frames take the shortest, if they are surely shorter than by the adapter's own prices:
    /// number 0 of `trials`, before those of each of [`WEIGHTS`].
    fn with_trials(self, trials: &Trials) -> Self {
        let by_weight = (1..).zip(WEIGHTS).map(|(number, weight)| (weight, trials.of(number)));
        let finite = by_weight.filter(|(_, trial)| trial.ratio.is_finite());
        let Some((weight, trial)) = finite.min_by(|(_, one), (_, other)| one.ratio.total_cmp(&other.ratio)) else {
            return self;
        };
        let Trial { ratio, .. } = trial;
        if trial.is_faster() {
            Self { prices: taken(self.measured, weight), weight: Some(weight), trial: ratio, ..self }
        } else {
            Self { trial: ratio, ..self }
        }
    }
}

/// The prices to draw by where looks and draws count so many times what was measured; without what noise may have put a
/// little outside of what they can be.
fn taken(
    VertexPrices { light, pixel, look, draw, diffuse_alone, specular_alone }: VertexPrices,
    weight: f32,
) -> VertexPrices {
    VertexPrices {
        light: light.max(LEAST_LIGHT),
        pixel: pixel.max(0.0),
        look: weight * look,
        draw: weight * draw.max(0.0),
        diffuse_alone: diffuse_alone.min(1.0),
        specular_alone: specular_alone.min(1.0),
    }
}

impl Times {
    /// What a light costs at a pixel and a vertex without lights, in nanoseconds; and the prices.
    fn prices(&self) -> (f64, f64, VertexPrices) {
        let unit = self.light_at_pixel;
        let price = |ns: f64| (ns / unit) as f32;
        let prices = VertexPrices {
            light: price(self.light_at_vertex),
            pixel: price(self.first_light_at_pixel - unit),
            look: price(self.look),
            draw: price(self.draw),
            diffuse_alone: price(self.diffuse_at_pixel),
            specular_alone: price(self.specular_at_pixel),
        };
        (unit, self.vertex, prices)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::costs::Costs;
    use crate::device::cpu::Cpu;

    const OWN: VertexPrices = Costs::SOFTWARE.vertices;

    /// A light at a pixel takes 2 ns.
    const TIMES: Times = Times {
        light_at_pixel: 2.0,
        first_light_at_pixel: 3.0,
        diffuse_at_pixel: 1.6,
        specular_at_pixel: 1.8,
        light_at_vertex: 7.0,
        vertex: 30.0,
        look: 24.0,
        draw: 2600.0,
    };

    const FOUND: VertexPrices =
        VertexPrices { light: 3.5, pixel: 0.5, look: 12.0, draw: 1300.0, diffuse_alone: 0.8, specular_alone: 0.9 };

    #[test]
    fn prices_are_in_lights_at_a_pixel() {
        let Calibration { unit_ns, vertex_ns, measured, prices, doubts, weight, trial } =
            Calibration::untried(&TIMES, OWN);
        assert_eq!([unit_ns, vertex_ns, trial].map(f64::to_bits), [2.0, 30.0, 1.0].map(f64::to_bits));
        assert_eq!((measured, prices, weight), (FOUND, OWN, None));
        assert!(doubts.is_empty(), "{doubts:?}");
    }

    #[test]
    fn what_cannot_be_is_not_believed() {
        let rows = [
            ("light", Times { light_at_vertex: -6.1, ..TIMES }),
            ("pixel", Times { first_light_at_pixel: -2.0, ..TIMES }),
            ("look", Times { look: 0.0, ..TIMES }),
            ("draw", Times { draw: f64::INFINITY, ..TIMES }),
            ("diffuse_alone", Times { diffuse_at_pixel: f64::NAN, ..TIMES }),
            ("specular_alone", Times { specular_at_pixel: 3.0, ..TIMES }),
            ("a light at a pixel", Times { light_at_pixel: 1e-9, ..TIMES }),
            ("a light at a pixel", Times { light_at_pixel: f64::NAN, ..TIMES }),
        ];
        for (name, times) in rows {
            let found = Calibration::untried(&times, OWN);
            assert_eq!((found.prices, found.weight), (OWN, None), "{name}");
            assert!(found.doubts.iter().any(|doubt| doubt.starts_with(name)), "{name}: {:?}", found.doubts);
        }
    }

    /// Of two rounds of one scene that take so many times as long by prices of each weight.
    fn trials(of: [f64; 3]) -> Trials {
        Trials { scenes: vec![vec![[1.0].into_iter().chain(of).collect(); 2]] }
    }

    /// What draws the fastest is taken.
    #[test]
    fn prices_are_tried() {
        let with = |of: [f64; 3]| {
            let found = Calibration::untried(&TIMES, OWN).with_trials(&trials(of));
            assert!(found.doubts.is_empty() && found.measured == FOUND, "{found:?}");
            (found.prices, found.weight, (1e3 * found.trial).round())
        };
        let VertexPrices { look, draw, .. } = FOUND;
        assert_eq!(with([1.2, 0.9, 0.95]), (FOUND, Some(1.0), 900.0));
        let cheaper = VertexPrices { look: 0.25 * look, draw: 0.25 * draw, ..FOUND };
        assert_eq!(with([0.8, 0.9, f64::NAN]), (cheaper, Some(0.25), 800.0));
        let dearer = VertexPrices { look: 4.0 * look, draw: 4.0 * draw, ..FOUND };
        assert_eq!(with([f64::INFINITY, 1.4, 0.97]), (dearer, Some(4.0), 970.0));
        assert_eq!(with([1.4, 1.0, 1.1]), (OWN, None, 1000.0), "no faster than the adapter's own");
        assert_eq!(with([1.4, 1.2, 1.1]), (OWN, None, 1100.0));
        assert_eq!(with([f64::NAN; 3]), (OWN, None, 1000.0));
    }

    #[test]
    fn noise_does_not_make_prices_that_are_none() {
        let times = Times {
            first_light_at_pixel: 0.6,
            diffuse_at_pixel: 2.2,
            specular_at_pixel: 2.4,
            light_at_vertex: -5.9,
            draw: -1.0,
            ..TIMES
        };
        let found = Calibration::untried(&times, OWN).with_trials(&trials([2.0, 0.9, 2.0]));
        let prices =
            VertexPrices { light: 0.05, pixel: 0.0, draw: 0.0, diffuse_alone: 1.0, specular_alone: 1.0, ..FOUND };
        assert_eq!((found.prices, found.doubts), (prices, Vec::new()));
        assert_eq!(prices.validate(), Ok(()));
    }

    /// Whatever the machine does meanwhile, what is found can be drawn by.
    #[test]
    fn the_cpu_is_measured() {
        let adapter = Adapter::Cpu(Cpu::open().expect("threads"));
        let found = Calibration::measure(&adapter).expect("it draws");
        println!("{found:#?}");
        assert_eq!(found.prices.validate(), Ok(()));
        assert_eq!(found.prices == adapter.costs().vertices, found.weight.is_none(), "{found:?}");
        assert!(found.doubts.is_empty() || found.weight.is_none(), "{found:?}");
    }
}
