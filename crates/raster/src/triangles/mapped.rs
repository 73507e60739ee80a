//! Triangles of draws with images or a mask. Their data is stored once a triangle and not once a pixel, so that other
//! draws do not pay for it.

use crate::input::attributes::{FRAME, GROUPS, GROUPS_BUT_SOLID, OF_VERTICES, PARTS, PLACE};
use crate::input::pieces::PIECE_TRIANGLES;
use crate::lighting::state::{Stage, State};
use crate::lighting::{Irradiance, ambient_part, diffuse_part, specular_part};
use crate::simd::lanes::{F, Simd, V3, each, splat};
use crate::triangles::planes::{CutCorner, Gradient, Planes, Slopes};
use crate::vertices::lane_triangles::{LaneTriangles, spread};
use crate::vertices::transform::Vertices;
use halfway_lighting::record::MaterialRecord;

/// The parts of I that images multiply separately: ambient, diffuse and specular.
pub(crate) type PartsOf = [[f32; 3]; 3];

/// Inputs of a triangle's pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MappedTriangle {
    /// How the nearness grows from pixel to pixel.
    pub(crate) nearness: [f32; 2],
    /// Their base is the first pixel of the tile that may be covered: farther away, small differences between steep
    /// slopes would be lost to rounding.
    pub(crate) groups: [Slopes; GROUPS],
    pub(crate) first: [f32; 2],
    /// Its own normal.
    pub(crate) face: [f32; 3],
    /// For flat triangles the parts, and the opacity of the vertices.
    pub(crate) parts: PartsOf,
    pub(crate) alpha: f32,
    /// The color of the vertices.
    pub(crate) color: [f32; 3],
}

impl MappedTriangle {
    /// A triangle near the tile, from the slopes of four numbers by their values at the corners.
    #[inline(always)]
    pub(crate) fn small(
        vertices: &Vertices,
        (numbers, back): ([usize; 3], bool),
        (state, planes): (&State, &Planes),
        (first, mut slopes): ([i32; 2], impl FnMut([&[f32; 4]; 3]) -> Slopes),
    ) -> Self {
        let mut groups = [Slopes::default(); GROUPS];
        for number in groups_of(state) {
            let side = back && is_of_side(state, number);
            groups[number] = slopes(numbers.map(|vertex| vertices.mapped.at(side, number, vertex)));
        }
        Self::with(&groups, first, planes)
    }

    /// Any other triangle, by its clipped corners.
    pub(crate) fn large(
        vertices: &Vertices,
        (triangle, back): ([u8; 3], bool),
        (state, planes): (&State, &Planes),
        (first, gradient): ([i32; 2], &Gradient),
        corners: &[CutCorner; 3],
    ) -> Self {
        let gradient = gradient.beginning_at(first);
        let mut groups = [Slopes::default(); GROUPS];
        for number in groups_of(state) {
            let side = back && is_of_side(state, number);
            let values = corners.map(|(inverse_w, weights)| {
                let mut sum = [0.0_f64; 4];
                for (corner, weight) in triangle.into_iter().zip(weights) {
                    let vertex = usize::from(corner);
                    let w = 1.0 / f64::from(vertices.inverse_w[vertex]);
                    let over_w = vertices.mapped.at(side, number, vertex);
                    for (sum, number) in sum.iter_mut().zip(over_w) {
                        *sum += weight * w * f64::from(*number);
                    }
                }
                sum.map(|number| (number * f64::from(inverse_w)) as f32)
            });
            groups[number] = gradient.slopes(values.each_ref());
        }
        Self::with(&groups, first, planes)
    }

    fn with(groups: &[Slopes; GROUPS], first: [i32; 2], planes: &Planes) -> Self {
        let Slopes { dx, dy, .. } = &planes.lead;
        let first = first.map(|pixels| pixels as f32);
        Self { nearness: [dx[0], dy[0]], groups: *groups, first, face: planes.face, ..Self::default() }
    }
}

/// The groups that a state's triangles need.
fn groups_of(state: &State) -> impl Iterator<Item = usize> + use<> {
    let (surrounded, solid) =
        state.maps.as_ref().map_or((false, false), |maps| (maps.surrounded, maps.solid.is_some()));
    let first = match state.stage {
        Stage::Unlit | Stage::Vertex if surrounded => GROUPS_BUT_SOLID,
        Stage::Unlit | Stage::Flat => 2,
        Stage::Vertex => PARTS + 3,
        Stage::Fragment => FRAME + 1,
        Stage::Mixed => GROUPS_BUT_SOLID,
    };
    (0..first).chain(solid.then_some(PLACE))
}

/// The parts of flat triangles, one a lane, front and back.
pub(crate) struct FlatParts {
    /// Ambient, diffuse, specular: a number that is the opacity of the vertices with the first, and three.
    pub(crate) each: [[[[f32; 4]; PIECE_TRIANGLES]; 3]; 2],
    /// The colors of the vertices.
    colors: [[f32; 4]; PIECE_TRIANGLES],
    /// Their own normals, of the front.
    pub(crate) normals: [[f32; 4]; PIECE_TRIANGLES],
}

impl FlatParts {
    pub(crate) fn new() -> Self {
        Self {
            each: [[[[0.0; 4]; PIECE_TRIANGLES]; 3]; 2],
            colors: [[0.0; 4]; PIECE_TRIANGLES],
            normals: [[0.0; 4]; PIECE_TRIANGLES],
        }
    }

    #[inline(always)]
    pub(crate) fn store<S: Simd>(
        &mut self,
        simd: S,
        terms: &Irradiance<S>,
        side: &MaterialRecord,
        back: bool,
        own: Option<[F<S>; 4]>,
        of: &LaneTriangles,
    ) {
        let one = splat(simd, 1.0);
        let [r, g, b, alpha] = own.unwrap_or([one; 4]);
        let parts = parts_of(simd, terms, side, [r, g, b]);
        spread::<S>([r, g, b, alpha], of, &mut self.colors);
        for (part, to) in parts.into_iter().zip(&mut self.each[usize::from(back)]) {
            spread::<S>([alpha, part[0], part[1], part[2]], of, to);
        }
    }

    pub(crate) fn set(&self, (triangle, state): (&mut MappedTriangle, &State), back: bool, number: usize) {
        if state.stage == Stage::Flat {
            triangle.face = each!(axis in 3 => self.normals[number][axis]);
            triangle.color = each!(c in 3 => self.colors[number][c]);
        }
        let each = &self.each[usize::from(back)];
        triangle.alpha = each[0][number][0];
        triangle.parts = each!(part in 3 => each!(c in 3 => each[part][number][c + 1]));
    }
}

#[inline(always)]
pub(crate) fn parts_of<S: Simd>(simd: S, terms: &Irradiance<S>, side: &MaterialRecord, color: V3<S>) -> [V3<S>; 3] {
    [
        ambient_part(simd, terms, side, color, true),
        diffuse_part(simd, terms, side, color),
        specular_part(simd, terms, side),
    ]
}

/// Whether a group differs between a state's sides.
fn is_of_side(state: &State, group: usize) -> bool {
    match state.stage {
        Stage::Vertex => (PARTS..PARTS + 3).contains(&group),
        Stage::Mixed => (OF_VERTICES..GROUPS_BUT_SOLID).contains(&group),
        Stage::Unlit | Stage::Flat | Stage::Fragment => false,
    }
}
