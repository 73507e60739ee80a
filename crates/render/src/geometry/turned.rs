//! What turned normals, and interpolation between corners, change of the terms of an object's lights; see
//! [`allowed`](crate::geometry::allowed).

/// How far a group's parts are off; see [`halfway_mesh::PatchGroup`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroupErrors {
    pub(crate) error: f32,
    pub(crate) normal_error: f32,
    pub(crate) normal_spread: f32,
    pub(crate) longest_edge: f32,
    /// Infinite where the surface is [smooth](crate::geometry::corners::reach_of_rough).
    pub(crate) corner_reach: f32,
    /// They are too large for short light lists.
    pub(crate) spoils_lists: bool,
}

impl GroupErrors {
    /// No error is larger than these.
    pub(crate) const LARGEST: Self = Self {
        error: f32::INFINITY,
        normal_error: std::f32::consts::PI,
        normal_spread: std::f32::consts::PI,
        longest_edge: f32::INFINITY,
        corner_reach: f32::INFINITY,
        spoils_lists: true,
    };

    /// The least of each.
    pub(crate) fn min(self, other: Self) -> Self {
        Self {
            error: self.error.min(other.error),
            normal_error: self.normal_error.min(other.normal_error),
            normal_spread: self.normal_spread.min(other.normal_spread),
            longest_edge: self.longest_edge.min(other.longest_edge),
            corner_reach: self.corner_reach.min(other.corner_reach),
            spoils_lists: self.spoils_lists && other.spoils_lists,
        }
    }
}

/// What is cut off of highlights is found for normals that turn by up to this, in radians: 3°.
pub(crate) const TURNED: f32 = 0.05;

/// What a turned normal changes of all lights' diffuse, specular or ambient terms, as parts of what is allowed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TurnedTerms {
    /// The sum of the largest values.
    pub(crate) largest: f32,
    /// The most that a radian of turn changes.
    pub(crate) slope: f32,
    /// A highlight that is cut off.
    pub(crate) cut: f32,
    /// The smaller and the larger of both sides.
    pub(crate) exponents: [f32; 2],
    /// How far h or the reflected vector turns with the normal; 0 where none counts.
    pub(crate) turn: f32,
    /// Of a triangle of a unit of the mesh, its angle as seen from the nearest light, and how far l or h turns within
    /// it.
    pub(crate) seen_from: [f32; 2],
    /// It is shaded at the vertices.
    pub(crate) by_vertices: bool,
}

impl TurnedTerms {
    /// What turned normals change where a group's parts are drawn, as a part of what is allowed; of a term that is
    /// shaded at the vertices, with what interpolation adds.
    pub(crate) fn turned(&self, group: &GroupErrors) -> f32 {
        if self.largest == 0.0 {
            return 0.0;
        }
        let turned = if group.normal_error > 0.0 { self.slope * group.normal_error } else { 0.0 };
        let cut = match group.normal_error {
            0.0 => 0.0,
            turned if turned <= TURNED => self.cut,
            _ => self.largest,
        };
        let interpolated = if self.by_vertices { self.interpolated(group) + self.at_kinks(group) } else { 0.0 };
        turned + cut + interpolated
    }

    /// By how much a point of a triangle may lie outside of what its corners show, as a part of what is allowed.
    pub(crate) fn between_corners(&self, group: &GroupErrors) -> f32 {
        if self.largest == 0.0 { 0.0 } else { self.cut + self.interpolated(group) }
    }

    /// What second-order terms add between the corners of a triangle.
    fn interpolated(&self, group: &GroupErrors) -> f32 {
        let [smaller, larger] = self.exponents;
        let (w, turned) = self.turned_within(group);
        let bent = match turned > 0.0 {
            true if smaller > 0.0 && smaller < 1.0 => f32::INFINITY,
            true => 0.5 * larger.max(1.0) * turned * turned,
            false => 0.0,
        };
        self.largest * (bent + 6.0 * w * w)
    }

    /// What interpolation adds where a cosine falls to 0, and where a highlight is cut off.
    fn at_kinks(&self, group: &GroupErrors) -> f32 {
        let (_, turned) = self.turned_within(group);
        let kink = if self.exponents[0] < 2.0 { 0.5 * self.largest * turned } else { 0.0 };
        if turned > 0.0 { kink.min(self.largest) + self.cut } else { 0.0 }
    }

    /// How large a triangle is as seen from the nearest light, and how far the vectors of a cosine turn against each
    /// other within it.
    fn turned_within(&self, group: &GroupErrors) -> (f32, f32) {
        let size = group.longest_edge / 3f32.sqrt();
        let [w, direction] = self.seen_from.map(|inverse| size * inverse);
        let turned = if self.turn > 0.0 { self.turn * (group.normal_spread + direction) } else { 0.0 };
        (w, turned)
    }
}

/// The steepest slope of cosⁿ f is √n·((n − 1)/n)^((n − 1)/2): √n times 1 at n = 1, and falling to √(n/e).
pub(crate) fn steepest(n: f32) -> f32 {
    n.sqrt() * ((n - 1.0) / n).powf(0.5 * (n - 1.0))
}
