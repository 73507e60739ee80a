//! The table of where maps.wgsl finds a fragment on its images, and of what it filters there.

use halfway_lighting::equations::vector::length;
use halfway_texture::{UvTransform, lookup};

use crate::adapter::Kind;
use crate::images::{COLOR, HEIGHT, IMAGES, Look, amount_of, largest, rows_of};
use crate::inputs::wide;
use crate::map_inputs as inputs;
use crate::map_rows::{GROSS, ULP, exact, of_place, of_set, row};
use crate::table::Row;

/// Results below the normal numbers may be 0.
const LEAST: f64 = f32::MIN_POSITIVE as f64;

/// The slot, the look, and both sets of coordinates with their ways to the next pixels, as a row's input has them.
struct Placed {
    slot: usize,
    look: Look,
    uv: [f64; 2],
    ways: [[f64; 2]; 2],
}

impl Placed {
    fn from_input(x: &[f32]) -> Self {
        let look = Look::from_bits(x[1]);
        Self { slot: x[0] as usize, look, uv: of_set(look, x, 2), ways: [6, 10].map(|at| of_set(look, x, at)) }
    }

    fn place(&self) -> [f64; 2] {
        UvTransform::apply(&rows_of(self.slot), self.uv)
    }

    /// The largest that the sums of [`place`](Self::place) could be.
    fn gross(&self) -> [f64; 2] {
        UvTransform::apply(&rows_of(self.slot).map(|row| row.map(f64::abs)), self.uv.map(f64::abs))
    }

    fn footprint(&self) -> [[f64; 2]; 2] {
        self.ways.map(|way| way_on(self.slot, way))
    }

    fn level(&self) -> f64 {
        lookup::level(IMAGES[self.slot].size(), self.footprint())
    }

    /// The longer side of the footprint is off by what its sums are, four roundings each, and by four more; the
    /// logarithm, of a square, by 2⁻²¹ or 3 ULP of it.
    fn of_level(&self) -> f64 {
        let size = IMAGES[self.slot].size().map(f64::from);
        let sides = |way: [f64; 2]| length([way[0] * size[0], way[1] * size[1], 0.0]);
        let longest = self.footprint().map(sides).into_iter().fold(0.0, f64::max);
        let gross = self.ways.map(|way| sides(gross_way(self.slot, way))).into_iter().fold(0.0, f64::max);
        4.0 * ULP * (gross / longest + 1.0) / std::f64::consts::LN_2 + 0.5f64.powi(21) + 3.0 * ULP * self.level().abs()
    }

    fn at_footprint(&self) -> [f64; 4] {
        lookup::filtered(&IMAGES[self.slot], &self.look.sampling(), self.place(), self.footprint())
    }

    fn filtered(&self) -> [f64; 4] {
        self.at_footprint().map(|number| number.clamp(0.0, 1.0))
    }

    /// The place is off by three roundings of its sums; a level, all of a level's numbers.
    fn of_filtered(&self) -> f64 {
        let (gross, size) = (self.gross(), IMAGES[self.slot].size().map(f64::from));
        let blur = std::array::from_fn(|k| 3.0 * ULP * gross[k] * size[k]);
        let (sampling, d) = (self.look.sampling(), self.level());
        let of_place =
            of_place(self.slot, self.place(), blur, |uv| lookup::at_level(&IMAGES[self.slot], &sampling, uv, d));
        of_place.into_iter().fold(0.0, f64::max) + 2.0 * GROSS * largest(self.slot) * self.of_level()
    }
}

fn linear_part(slot: usize) -> [[f64; 3]; 2] {
    rows_of(slot).map(|[a, b, _]| [a, b, 0.0])
}

fn way_on(slot: usize, way: [f64; 2]) -> [f64; 2] {
    UvTransform::apply(&linear_part(slot), way)
}

fn gross_way(slot: usize, way: [f64; 2]) -> [f64; 2] {
    UvTransform::apply(&linear_part(slot).map(|row| row.map(f64::abs)), way.map(f64::abs))
}

/// `Coordinates` of an input, for the text of a call.
macro_rules! placed {
    ($before:literal, $after:literal) => {
        concat!(
            $before,
            "u32(s(i, 1)), Coordinates(vec4f(v(i, 2), s(i, 5)), vec4f(v(i, 6), s(i, 9)), vec4f(v(i, 10), s(i, 13))))",
            $after
        )
    };
}

pub(crate) fn place_rows() -> Vec<Row> {
    let filtered: fn(&[f32]) -> Vec<f64> = |x| Placed::from_input(x).filtered().to_vec();
    let of_filtered: fn(&[f32], &[f64]) -> Vec<f64> = |x, _| vec![Placed::from_input(x).of_filtered(); 4];
    let factor: fn(&[f32]) -> Vec<f64> = |x| {
        let a = amount_of(x[0] as usize);
        Placed::from_input(x).filtered().map(|t| 1.0 + a * (t - 1.0)).to_vec()
    };
    let of_factor: fn(&[f32], &[f64]) -> Vec<f64> = |x, _| {
        let a = amount_of(x[0] as usize).abs();
        vec![a * Placed::from_input(x).of_filtered() + 3.0 * ULP * (1.0 + 2.0 * a); 4]
    };
    vec![
        row(
            ("way_on", "way_on(u32(s(i, 0)), v(i, 6).xy)"),
            Kind::Pair,
            inputs::placed(),
            |x| way_on(x[0] as usize, wide(&x[6..])).to_vec(),
            |x, _| gross_way(x[0] as usize, wide(&x[6..])).map(|gross| 2.0 * ULP * gross + LEAST).to_vec(),
        ),
        row(
            ("place_on", placed!("place_on(u32(s(i, 0)), ", "")),
            Kind::Pair,
            inputs::placed(),
            |x| Placed::from_input(x).place().to_vec(),
            |x, _| Placed::from_input(x).gross().map(|gross| 3.0 * ULP * gross + LEAST).to_vec(),
        ),
        row(
            ("level_on", placed!("level_on(u32(s(i, 0)), ", "")),
            Kind::Scalar,
            inputs::placed(),
            |x| vec![Placed::from_input(x).level()],
            |x, _| vec![Placed::from_input(x).of_level()],
        ),
        // The footprint of a point has no logarithm: whatever an adapter makes of it, the image is enlarged.
        row(
            ("level_on", placed!("select(0.0, 1.0, level_on(u32(s(i, 0)), ", " > 0.0)")),
            Kind::Scalar,
            inputs::points(),
            |_| vec![0.0],
            exact,
        ),
        row(
            ("at_footprint", placed!("at_footprint(height_image, 7u, ", "")),
            Kind::Texel,
            inputs::placed_on(HEIGHT),
            |x| Placed::from_input(x).at_footprint().to_vec(),
            of_filtered,
        ),
        row(
            ("filtered", placed!("filtered(color_image, 0u, ", "")),
            Kind::Texel,
            inputs::placed_on(COLOR),
            filtered,
            of_filtered,
        ),
        row(
            ("filtered", placed!("filtered(height_image, 7u, ", "")),
            Kind::Texel,
            inputs::placed_on(HEIGHT),
            filtered,
            of_filtered,
        ),
        row(
            ("factor", placed!("factor(color_image, 0u, ", "")),
            Kind::Texel,
            inputs::placed_on(COLOR),
            factor,
            of_factor,
        ),
        row(
            ("factor", placed!("factor(height_image, 7u, ", "")),
            Kind::Texel,
            inputs::placed_on(HEIGHT),
            factor,
            of_factor,
        ),
    ]
}
