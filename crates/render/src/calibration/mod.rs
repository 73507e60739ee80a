//! What drawing costs on an adapter, measured by drawing.

mod scenery;

use crate::device::adapter::Adapter;
use crate::device::costs::VertexPrices;
use crate::error::RenderError;
use scenery::{Stages, Times};

/// What drawing costs on an adapter, measured by drawing: small scenes that differ in one thing, in turns. Their frames
/// take a second or two on the CPU and less on a graphics card.
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
    /// What to draw by: those measured, or the adapter's own where these are not believed.
    pub prices: VertexPrices,
    /// Why those measured are not believed, in words; none where they are.
    pub doubts: Vec<String>,
    /// How many times what was measured a look and a draw count in `prices`: 1, or up to 16 where a frame took too long
    /// by less.
    pub caution: f32,
    /// How long a frame takes by the prices measured, with such caution, as a multiple of one by the adapter's own.
    pub trial: f64,
}

/// What a price can be. What is outside has been disturbed.
///
/// The first light at a pixel takes no less than nothing, and a light more than the lights after it: -1 where it is
/// free, as on graphics cards that wait for something else meanwhile (-0.6 and -0.7 on an NVIDIA H200), and a tenth for
/// noise.
const BELIEVED: [(&str, f32, f32); 6] = [
    ("light", 0.02, 500.0),
    ("pixel", -1.1, 100.0),
    ("look", 0.01, 1e5),
    ("draw", -1.0, 1e7),
    ("diffuse_alone", 0.05, 1.3),
    ("specular_alone", 0.05, 1.3),
];

/// What a light can cost at a pixel, in nanoseconds.
const BELIEVED_UNIT: [f64; 2] = [1e-4, 1e4];

/// By how much longer a frame may take by prices that are believed than by the adapter's own: as much as the least
/// times of the same frame differ on a machine that does something else as well.
const MOST_LOST: f64 = 1.05;

/// What no price stands for, as that triangles whose terms are in two places are drawn in a slower way, is told by a
/// frame that takes too long. Then looks and draws are taken for twice as dear, up to so many times: what moves has to
/// save more.
const MOST_CAUTION: f32 = 16.0;

impl Calibration {
    /// Draws on the adapter and times it. What else the machine does at that time makes it less exact; prices that
    /// cannot be are not taken.
    ///
    /// # Errors
    /// What the adapter could not draw.
    pub fn measure(adapter: &Adapter) -> Result<Self, RenderError> {
        let mut stages = Stages::new(adapter)?;
        let times = stages.time()?;
        let (unit_ns, vertex_ns, measured) = times.prices();
        let own = adapter.costs().vertices;
        let untried = Self::of(unit_ns, vertex_ns, measured, own, (1.0, 1.0));
        if !untried.doubts.is_empty() {
            return Ok(untried);
        }
        let (trial, caution) = tried(|caution| stages.trial(own, taken(measured, caution)))?;
        Ok(Self::of(unit_ns, vertex_ns, measured, own, (trial, caution)))
    }

    /// Judges what was measured, and tried with some caution, on an adapter with prices of its `own`.
    fn of(
        unit_ns: f64,
        vertex_ns: f64,
        measured: VertexPrices,
        own: VertexPrices,
        (trial, caution): (f64, f32),
    ) -> Self {
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
        if trial.is_nan() || trial > MOST_LOST {
            doubts.push(format!(
                "a frame by these prices takes {trial:.2} times as long; expected no more than {MOST_LOST}"
            ));
        }
        let prices = if doubts.is_empty() { taken(measured, caution) } else { own };
        Self { unit_ns, vertex_ns, measured, prices, doubts, caution, trial }
    }
}

/// With the least caution by which a frame does not take too long, or the most there is: how long it takes, and that.
fn tried(mut trial: impl FnMut(f32) -> Result<f64, RenderError>) -> Result<(f64, f32), RenderError> {
    let mut caution = 1.0;
    loop {
        let found = trial(caution)?;
        if found <= MOST_LOST || caution >= MOST_CAUTION {
            return Ok((found, caution));
        }
        caution *= 2.0;
    }
}

/// The prices to draw by, with so much caution; without what noise may have put a little outside of what they can be.
fn taken(
    VertexPrices { light, pixel, look, draw, diffuse_alone, specular_alone }: VertexPrices,
    caution: f32,
) -> VertexPrices {
    VertexPrices {
        light,
        pixel: pixel.max(0.0),
        look: caution * look,
        draw: caution * draw.max(0.0),
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
    const FOUND: VertexPrices =
        VertexPrices { light: 2.0, pixel: 0.8, look: 12.0, draw: 500.0, diffuse_alone: 0.7, specular_alone: 0.8 };

    #[test]
    fn prices_are_in_lights_at_a_pixel() {
        let times = Times {
            light_at_pixel: 2.0,
            first_light_at_pixel: 3.0,
            diffuse_at_pixel: 1.6,
            specular_at_pixel: 1.8,
            light_at_vertex: 7.0,
            vertex: 30.0,
            look: 24.0,
            draw: 2600.0,
        };
        let (unit, vertex, prices) = times.prices();
        assert_eq!((unit.to_bits(), vertex.to_bits()), (2f64.to_bits(), 30f64.to_bits()));
        let expected =
            VertexPrices { light: 3.5, pixel: 0.5, look: 12.0, draw: 1300.0, diffuse_alone: 0.8, specular_alone: 0.9 };
        assert_eq!(prices, expected);
    }

    #[test]
    fn what_cannot_be_is_not_believed() {
        let believed = Calibration::of(2.0, 30.0, FOUND, OWN, (1.01, 1.0));
        assert_eq!((believed.prices, believed.doubts.len()), (FOUND, 0));
        let rows = [
            ("light", Calibration::of(2.0, 30.0, VertexPrices { light: -0.1, ..FOUND }, OWN, (1.0, 1.0))),
            ("pixel", Calibration::of(2.0, 30.0, VertexPrices { pixel: -2.0, ..FOUND }, OWN, (1.0, 1.0))),
            ("look", Calibration::of(2.0, 30.0, VertexPrices { look: 0.0, ..FOUND }, OWN, (1.0, 1.0))),
            ("draw", Calibration::of(2.0, 30.0, VertexPrices { draw: f32::INFINITY, ..FOUND }, OWN, (1.0, 1.0))),
            (
                "diffuse_alone",
                Calibration::of(2.0, 30.0, VertexPrices { diffuse_alone: f32::NAN, ..FOUND }, OWN, (1.0, 1.0)),
            ),
            (
                "specular_alone",
                Calibration::of(2.0, 30.0, VertexPrices { specular_alone: 1.5, ..FOUND }, OWN, (1.0, 1.0)),
            ),
            ("a light at a pixel", Calibration::of(0.0, 30.0, FOUND, OWN, (1.0, 1.0))),
            ("a light at a pixel", Calibration::of(f64::NAN, 30.0, FOUND, OWN, (1.0, 1.0))),
            ("a frame by these prices takes 1.06", Calibration::of(2.0, 30.0, FOUND, OWN, (1.06, 1.0))),
            ("a frame by these prices takes NaN", Calibration::of(2.0, 30.0, FOUND, OWN, (f64::NAN, 1.0))),
        ];
        for (name, found) in rows {
            assert_eq!(found.prices, OWN, "{name}");
            assert!(found.doubts.len() == 1 && found.doubts[0].starts_with(name), "{name}: {:?}", found.doubts);
        }
    }

    /// A frame that takes too long by what was measured may not where looks and draws are dearer.
    #[test]
    fn what_takes_too_long_is_tried_with_caution() {
        let of = |frames: [f64; 6]| {
            let mut frames = frames.into_iter();
            let mut asked = Vec::new();
            let found = tried(|caution| {
                asked.push(caution);
                Ok(frames.next().expect("no more is tried"))
            });
            (found.expect("it draws"), asked)
        };
        let never = f64::INFINITY;
        assert_eq!(of([1.05, never, never, never, never, never]), ((1.05, 1.0), vec![1.0]));
        assert_eq!(of([1.16, 1.07, 1.02, never, never, never]), ((1.02, 4.0), vec![1.0, 2.0, 4.0]));
        assert_eq!(of([1.16, 1.16, f64::NAN, 1.2, 1.1, never]), ((1.1, 16.0), vec![1.0, 2.0, 4.0, 8.0, 16.0]));
        let found = Calibration::of(2.0, 30.0, FOUND, OWN, (1.02, 4.0));
        let VertexPrices { look, draw, .. } = FOUND;
        assert_eq!(found.prices, VertexPrices { look: 4.0 * look, draw: 4.0 * draw, ..FOUND });
        assert_eq!((found.measured, found.doubts.len()), (FOUND, 0));
        assert_eq!(Calibration::of(2.0, 30.0, FOUND, OWN, (1.1, 16.0)).prices, OWN);
    }

    #[test]
    fn noise_does_not_make_prices_that_are_none() {
        let found = VertexPrices { pixel: -0.7, draw: -0.5, diffuse_alone: 1.1, specular_alone: 1.19, ..FOUND };
        let prices = Calibration::of(2.0, 30.0, found, OWN, (1.0, 1.0)).prices;
        assert_eq!(prices, VertexPrices { pixel: 0.0, draw: 0.0, diffuse_alone: 1.0, specular_alone: 1.0, ..FOUND });
        assert_eq!(prices.validate(), Ok(()));
    }

    /// Whatever the machine does meanwhile, what is found can be drawn by.
    #[test]
    fn the_cpu_is_measured() {
        let adapter = Adapter::Cpu(Cpu::open().expect("threads"));
        let found = Calibration::measure(&adapter).expect("it draws");
        println!("{found:#?}");
        assert_eq!(found.prices.validate(), Ok(()));
        let own = found.prices == adapter.costs().vertices;
        assert_eq!(own, !found.doubts.is_empty(), "{found:?}");
    }
}
