//! An explanation as lines of text.

use std::fmt::{self, Display, Formatter};

use halfway_lighting::equations::specular_exponent;
use halfway_lighting::{Choices, Encoding, Frequency, Intensity, Reflectance};

use super::numbers::{color, given, given_color, is_black, number, vector};
use super::{ExplainedLayer, ExplainedLight, ExplainedPoint, ExplainedSample, Explanation, LightWay, shading_name};

/// Lines for a terminal, without an end of line at the end.
///
/// Of several samples that show the same sides of the same triangles, the first is explained and the others are listed
/// with their colours. Numbers are rounded; [`Explanation::to_json`] has all their digits.
impl Display for Explanation {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { pixel: [x, y], size: [width, height], bytes: [r, g, b], .. } = self;
        writeln!(f, "Pixel ({x}, {y}) of {width} × {height}: {r} {g} {b} of 255, intensity {}", color(self.color))?;
        if self.samples.iter().any(|sample| !sample.layers.is_empty()) {
            writeln!(
                f,
                "\nVectors are in eye space: right-handed, the camera at the origin, looking along −Z. Colours are"
            )?;
            writeln!(f, "linear RGB, and their products are channel by channel.")?;
        }
        writeln!(f)?;
        let count = self.samples.len();
        for (number, sample) in self.samples.iter().enumerate() {
            let earlier = self.samples[..number].iter().position(|earlier| earlier.shows_as(sample));
            if number > 0 && earlier.is_none() || number == 1 {
                writeln!(f)?;
            }
            match earlier {
                Some(earlier) => write!(f, "Sample {} of {count}, as sample {}", number + 1, earlier + 1)?,
                None if count == 1 => write!(f, "The point ({}, {})", sample.at[0], sample.at[1])?,
                None => write!(f, "Sample {} of {count}, ({}, {})", number + 1, sample.at[0], sample.at[1])?,
            }
            match earlier {
                Some(_) => writeln!(f, ": {}", color(sample.color))?,
                None => sample.write(f, self)?,
            }
        }
        self.write_end(f)
    }
}

impl Explanation {
    /// From the samples to the bytes.
    fn write_end(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f)?;
        if self.samples.len() > 1 {
            writeln!(f, "Mean of the samples: {}", color(self.mean))?;
        }
        let after = color(self.color);
        match (self.policy, self.divisor) {
            (Intensity::Clamp, _) => {}
            (_, Some(divisor)) => {
                writeln!(f, "The whole picture is divided by its largest channel, {}: {after}", number(divisor))?;
            }
            (policy, None) => writeln!(f, "By the camera's curve, {}: {after}", policy.name())?,
        }
        let [r, g, b] = self.bytes;
        let encoded = color(self.encoded);
        match self.encoding {
            Encoding::Srgb => write!(f, "By the sRGB curve: {encoded}; times 255: {r} {g} {b}"),
            Encoding::Raw => write!(f, "Without a curve: {encoded}; times 255: {r} {g} {b}"),
        }
    }
}

impl ExplainedSample {
    /// Whether both show the same sides of the same triangles.
    fn shows_as(&self, other: &Self) -> bool {
        let of = |layer: &ExplainedLayer| (layer.object, layer.triangle.map(|it| it.number), layer.front);
        self.layers.iter().map(of).eq(other.layers.iter().map(of))
    }

    fn write(&self, f: &mut Formatter<'_>, whole: &Explanation) -> fmt::Result {
        let behind = color(self.background);
        match self.layers.as_slice() {
            [] => return writeln!(f, " meets nothing: the background is {behind}"),
            [_] => writeln!(f, " meets one surface.")?,
            all => {
                writeln!(f, " meets {} surfaces, in the order of drawing over {behind}.", all.len())?;
            }
        }
        for layer in &self.layers {
            layer.write(f, whole)?;
        }
        Ok(())
    }
}

impl ExplainedLayer {
    fn write(&self, f: &mut Formatter<'_>, whole: &Explanation) -> fmt::Result {
        let side = if self.front { "front" } else { "back" };
        let on = self.triangle.map_or("its surface".to_owned(), |triangle| format!("triangle {}", triangle.number));
        writeln!(f, "\n  \"{}\", {on}, seen from the {side}; {}", self.name, shading_name(self))?;
        writeln!(f, "    p   {}, at depth {}", vector(self.position), number(self.depth))?;
        if let Some(triangle) = self.triangle {
            let [a, b, c] = triangle.weights.map(number);
            writeln!(f, "        weights of the corners {a}, {b}, {c}")?;
        }
        writeln!(f, "    n   {}", vector(self.normal))?;
        let material = &self.material;
        if !self.lit {
            writeln!(f, "    kd  {}", given_color(material.ka))?;
            return self.write_sum(f, whole);
        }
        writeln!(f, "    ka  {}   kd  {}", given_color(material.ka), given_color(material.kd))?;
        writeln!(f, "    ks  {}   ke  {}", given_color(material.ks), given_color(material.ke))?;
        writeln!(f, "    {}", self.reflectance_text())?;
        self.write_ambient(f, whole)?;
        for (place, point) in self.points.iter().enumerate() {
            point.write(f, place % 3 + 1, self)?;
        }
        self.write_interpolation(f)?;
        self.write_sum(f, whole)
    }

    /// The exponent and the reflectance.
    fn reflectance_text(&self) -> String {
        let name = self.reflectance.choice().map_or("", |choice| choice.name);
        let shininess = given(self.material.shininess);
        match self.reflectance {
            Reflectance::Phong => format!("α = {shininess}, {name} reflectance"),
            Reflectance::BlinnPhong => format!("β = {shininess}, {name} reflectance"),
            Reflectance::BlinnPhongMatched => {
                let beta = given(specular_exponent(self.reflectance, self.material.shininess));
                format!("α = {shininess}, {name} reflectance: β = {beta}")
            }
        }
    }

    fn write_ambient(&self, f: &mut Formatter<'_>, whole: &Explanation) -> fmt::Result {
        let steady = self.points.iter().flat_map(|point| &point.lights).any(|light| light.is_steady);
        let sum = if steady { "ka·(Ga + ΣLa)" } else { "ka·Ga" };
        writeln!(f, "    Ga  {}   ambient = {sum} = {}", given_color(whole.global_ambient), color(self.steady_ambient))
    }

    /// Writes the corners' sums with their weights.
    fn write_interpolation(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if !self.points.iter().any(|point| point.corner.is_some()) {
            return Ok(());
        }
        writeln!(f, "\n    The corners with their weights")?;
        for (k, name) in TERMS.into_iter().enumerate() {
            let corners = self.points.iter().filter_map(|point| Some((point.corner?.1, point.sums.each()[k])));
            let corners: Vec<_> = corners.filter(|(_, sum)| !is_black(*sum)).collect();
            if !corners.is_empty() {
                let parts: Vec<String> =
                    corners.iter().map(|(weight, sum)| format!("{}·{}", number(*weight), color(*sum))).collect();
                writeln!(f, "      {name:8} = {}", parts.join(" + "))?;
            }
        }
        Ok(())
    }

    fn write_sum(&self, f: &mut Formatter<'_>, whole: &Explanation) -> fmt::Result {
        let around = &self.environment;
        if !is_black(around.ambient) || !is_black(around.specular) {
            writeln!(f, "\n    Environment")?;
            writeln!(f, "      ambient  = kd·E(n) = {}", color(around.ambient))?;
            writeln!(f, "      specular = ks·L(r) = {}", color(around.specular))?;
        }
        if !self.factors.are_one() {
            let it = &self.factors;
            let surface = [0, 1, 2].map(|k| it.color[k] * it.solid[k]);
            writeln!(f, "\n    Factors of images, which are in the sum below")?;
            writeln!(f, "      ambient  {}, by occlusion {}", given_color(surface), given(it.occlusion))?;
            writeln!(f, "      diffuse  {}", given_color(surface))?;
            writeln!(f, "      specular {}", given_color(it.specular))?;
            writeln!(f, "      emission {}", given_color(it.emission))?;
        }
        writeln!(f)?;
        for ((sign, name), sum) in ["I =", "  +", "  +"].into_iter().zip(TERMS).zip(self.sums.each()) {
            writeln!(f, "    {sign} {name:8} {}", color(sum))?;
        }
        writeln!(f, "      + emission {}", color(self.emission))?;
        writeln!(f, "      =          {}", color(self.intensity))?;
        let clamped = self.intensity.map(|channel| if whole.clamps_surfaces { channel.min(1.0) } else { channel });
        if clamped.iter().zip(&self.intensity).any(|(clamped, i)| clamped < i) {
            writeln!(f, "        clamped  {}", color(clamped))?;
        }
        if self.opacity < 1.0 {
            let [opacity, rest] = [self.opacity, 1.0 - self.opacity].map(number);
            let (over, behind, blended) = (color(clamped), color(self.behind), color(self.blended));
            writeln!(f, "    Opacity {opacity}: {opacity}·{over} + {rest}·{behind} = {blended}")?;
        }
        Ok(())
    }
}

/// The names of the terms in the order of [`TermColors::each`](super::TermColors::each).
const TERMS: [&str; 3] = ["ambient", "diffuse", "specular"];

impl ExplainedPoint {
    /// Writes the point; `corner` is its place among the corners, from 1, if it is one.
    fn write(&self, f: &mut Formatter<'_>, corner: usize, layer: &ExplainedLayer) -> fmt::Result {
        match (self.at, self.corner) {
            (Frequency::Triangle, _) => writeln!(f, "\n    The centroid of the triangle")?,
            (_, Some((vertex, weight))) => {
                writeln!(f, "\n    Corner {corner} of 3: vertex {vertex}, with the weight {}", number(weight))?;
            }
            _ if layer.points.len() > 1 => writeln!(f, "\n    The visible point")?,
            _ => {}
        }
        if self.corner.is_some() || self.at == Frequency::Triangle {
            writeln!(f, "    p   {}\n    n   {}", vector(self.position), vector(self.normal))?;
        }
        let material = &self.material;
        if (material.ka, material.kd) != (layer.material.ka, layer.material.kd) {
            writeln!(f, "    ka  {}   kd  {}", given_color(material.ka), given_color(material.kd))?;
        }
        writeln!(f, "    v   {}", vector(self.view))?;
        for light in self.lights.iter().filter(|light| self.lists(light)) {
            light.write(f, self, layer)?;
        }
        let others = self.lights.iter().filter(|light| !self.lists(light)).count();
        if others > 0 {
            writeln!(
                f,
                "\n    {others} more lights add nothing: they are behind the surface, or do not reach the point"
            )?;
        }
        Ok(())
    }
}

impl ExplainedLight {
    #[expect(clippy::float_cmp, reason = "equal colours are written once")]
    fn write(&self, f: &mut Formatter<'_>, point: &ExplainedPoint, layer: &ExplainedLayer) -> fmt::Result {
        write!(f, "\n    Light \"{}\", {}", self.name, self.kind.name())?;
        let Some((colors, way)) = self.colors.zip(self.way) else {
            let term = color(self.terms.diffuse);
            return writeln!(f, "\n      diffuse  = kd·lerp(ground, sky, (1 + n·d)/2) = {term}");
        };
        if colors.ld == colors.ls {
            write!(f, ", Ld = Ls = {}", given_color(colors.ld))?;
        } else {
            write!(f, ", Ld {}, Ls {}", given_color(colors.ld), given_color(colors.ls))?;
        }
        write!(f, "\n      l = {}", vector(way.l))?;
        if let Some(d) = way.distance {
            let (divisor, att) = (way.divisor("d", "d²", "·"), number(way.attenuation));
            write!(f, ", d = {}\n      att = 1/({divisor}) = {att}", number(d))?;
        }
        if way.has_range() {
            write!(f, ", range = {}", number(way.window))?;
        }
        if let Some(cos_phi) = way.cos_phi {
            write!(f, ", cos φ = {}, spot = {}", number(cos_phi), number(way.spot))?;
        }
        writeln!(f)?;
        let weight = way.weight_symbols();
        if !is_black(colors.la) {
            let weight = if self.is_steady { "" } else { &weight };
            let (la, term) = (given_color(colors.la), color(self.terms.ambient));
            writeln!(f, "      ambient  = {weight}ka·La = {term}, La {la}")?;
        }
        if way.is_behind {
            return writeln!(f, "      n·l = {}: behind the surface, no diffuse, no specular", number(way.n_dot_l));
        }
        if way.spot * way.window * way.attenuation == 0.0 {
            return writeln!(f, "      n·l = {}, but it does not reach the point", number(way.n_dot_l));
        }
        if layer.terms.diffuse == point.at {
            let term = color(self.terms.diffuse);
            writeln!(f, "      n·l = {}\n      diffuse  = {weight}kd·Ld·(n·l) = {term}", number(way.n_dot_l))?;
        }
        if layer.terms.specular != point.at || is_black(point.material.ks) {
            return Ok(());
        }
        let Some(direction) = way.direction else {
            return writeln!(f, "      l and v are opposite: there is no h, and no highlight");
        };
        let (name, cosine) = if layer.reflectance == Reflectance::Phong { ("r", "r·v") } else { ("h", "n·h") };
        let power = format!("({cosine})^{}", given(way.exponent));
        let [cosine_is, power_is] = [way.cosine, way.power].map(number);
        writeln!(f, "      {name} = {}, {cosine} = {cosine_is}, {power} = {power_is}", vector(direction))?;
        writeln!(f, "      specular = {weight}ks·Ls·{power} = {}", color(self.terms.specular))
    }
}

impl LightWay {
    /// The factors of distance, range and cone, as symbols.
    fn weight_symbols(&self) -> String {
        let factors =
            [(self.distance.is_some(), "att·"), (self.has_range(), "range·"), (self.cos_phi.is_some(), "spot·")];
        factors.into_iter().filter(|(is_there, _)| *is_there).map(|(_, symbol)| symbol).collect()
    }
}
