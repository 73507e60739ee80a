//! An explanation as LaTeX.

use halfway_lighting::{Encoding, Frequency, Intensity, Reflectance};

use super::numbers::{self, is_black};
use super::{ExplainedLayer, ExplainedLight, ExplainedPoint, Explanation, LightWay, shading_name};

impl Explanation {
    /// One `align*` block, which needs the package `amsmath`. Colours are (r, g, b), and their products are channel by
    /// channel. Of several samples the first is explained, and the others are given with their colours.
    pub fn to_latex(&self) -> String {
        let mut lines = Lines::default();
        let [x, y] = self.pixel;
        lines.say(&format!("Pixel ({x}, {y})"));
        for (number, sample) in self.samples.iter().enumerate() {
            if self.samples.len() > 1 {
                lines.say(&format!("Sample {} of {}", number + 1, self.samples.len()));
            }
            if number == 0 {
                lines.equal("I_b", &[color(sample.background)]);
                for layer in &sample.layers {
                    lines.layer(layer, self);
                }
            } else {
                lines.equal(&format!("I_{{{}}}", number + 1), &[color(sample.color)]);
            }
        }
        lines.end(self);
        lines.block()
    }
}

/// The lines of the block.
#[derive(Default)]
struct Lines(Vec<String>);

impl Lines {
    /// A line of words.
    fn say(&mut self, words: &str) {
        self.0.push(format!("&\\textbf{{{}}}", escaped(words)));
    }

    /// `left = a = b …`
    fn equal(&mut self, left: &str, right: &[String]) {
        self.0.push(format!("{left} &= {}", right.join(" = ")));
    }

    /// Several equations in one line.
    fn row(&mut self, equations: &[(String, String)]) {
        let Some(((left, right), others)) = equations.split_first() else { return };
        let mut line = format!("{left} &= {right}");
        for (left, right) in others {
            line.extend([",\\quad ", left, " = ", right]);
        }
        self.0.push(line);
    }

    fn block(&self) -> String {
        format!("\\begin{{align*}}\n{}\n\\end{{align*}}", self.0.join(" \\\\\n"))
    }

    fn layer(&mut self, layer: &ExplainedLayer, whole: &Explanation) {
        let side = if layer.front { "front" } else { "back" };
        let triangle = layer.triangle.map_or(String::new(), |triangle| format!(", triangle {}", triangle.number));
        self.say(&format!("{}{triangle}, {side}", layer.name));
        self.say(&shading_name(layer));
        self.equal("\\mathbf{p}", &[vector(layer.position)]);
        self.equal("\\mathbf{n}", &[vector(layer.normal)]);
        let material = &layer.material;
        if layer.lit {
            self.0.push(format!(
                "k_a &= {},\\quad k_d = {},\\quad k_s = {},\\quad k_e = {},\\quad {} = {}",
                given(material.ka),
                given(material.kd),
                given(material.ks),
                given(material.ke),
                exponent(layer),
                short(material.shininess)
            ));
            let steady = layer.points.iter().flat_map(|point| &point.lights).any(|light| light.is_steady);
            let sum = if steady { "k_a \\Bigl(G_a + \\sum_i L_{a,i}\\Bigr)" } else { "k_a\\, G_a" };
            self.equal("G_a", &[given(whole.global_ambient)]);
            self.equal("I_a", &[sum.to_owned(), color(layer.steady_ambient)]);
        } else {
            self.equal("k_d", &[given(material.ka)]);
        }
        for (place, point) in layer.points.iter().enumerate().filter(|_| layer.lit) {
            self.point(layer, point, place % 3 + 1);
        }
        self.interpolation(layer);
        self.sum(layer, whole);
    }

    fn point(&mut self, layer: &ExplainedLayer, point: &ExplainedPoint, corner: usize) {
        match (point.at, point.corner) {
            (Frequency::Triangle, _) => self.say("At the centroid of the triangle"),
            (_, Some((vertex, weight))) => {
                self.say(&format!("Corner {corner}, vertex {vertex}"));
                self.equal(&format!("w_{corner}"), &[scalar(weight)]);
            }
            _ if layer.points.len() > 1 => self.say("At the visible point"),
            _ => {}
        }
        if point.corner.is_some() || point.at == Frequency::Triangle {
            self.equal("\\mathbf{p}", &[vector(point.position)]);
            self.equal("\\mathbf{n}", &[vector(point.normal)]);
        }
        self.equal("\\mathbf{v}", &[vector(point.view)]);
        for (i, light) in (1..).zip(&point.lights).filter(|(_, light)| point.lists(light)) {
            self.light(layer, point, light, i);
        }
    }

    fn light(&mut self, layer: &ExplainedLayer, point: &ExplainedPoint, light: &ExplainedLight, i: usize) {
        self.say(&format!("Light {i}, {}, {}", light.name, light.kind.name()));
        let Some((colors, way)) = light.colors.zip(light.way) else {
            let mixture = "k_d\\, \\mathrm{lerp}\\bigl(L_{\\mathrm{ground}}, L_{\\mathrm{sky}}, \
                           (1 + \\mathbf{n}\\cdot\\mathbf{d})/2\\bigr)";
            self.equal(&format!("I_{{d,{i}}}"), &[mixture.to_owned(), color(light.terms.diffuse)]);
            return;
        };
        let mut way_of = vec![(format!("\\mathbf{{l}}_{{{i}}}"), vector(way.l))];
        let mut weight = String::new();
        let mut factor = |name: &str, value: f64, way_of: &mut Vec<(String, String)>| {
            let symbol = format!("\\mathrm{{{name}}}_{{{i}}}");
            weight += &symbol;
            weight += "\\,";
            way_of.push((symbol, scalar(value)));
        };
        if let Some(distance) = way.distance {
            way_of.push((format!("d_{{{i}}}"), scalar(distance)));
            let divisor = way.divisor(&format!("d_{{{i}}}"), &format!("d_{{{i}}}^2"), "\\,");
            factor("att", way.attenuation, &mut way_of);
            if let Some((_, value)) = way_of.last_mut() {
                *value = format!("1/({divisor}) = {value}");
            }
        }
        if way.has_range() {
            factor("range", way.window, &mut way_of);
        }
        if let Some(cos_phi) = way.cos_phi {
            way_of.push((format!("\\cos\\varphi_{{{i}}}"), scalar(cos_phi)));
            factor("spot", way.spot, &mut way_of);
        }
        self.row(&way_of);
        let colors_of =
            [("a", colors.la), ("d", colors.ld), ("s", colors.ls)].into_iter().filter(|(_, it)| !is_black(*it));
        self.row(&colors_of.map(|(name, it)| (format!("L_{{{name},{i}}}"), given(it))).collect::<Vec<_>>());
        if !light.is_steady && !is_black(colors.la) {
            let term = format!("{weight}k_a\\, L_{{a,{i}}}");
            self.equal(&format!("I_{{a,{i}}}"), &[term, color(light.terms.ambient)]);
        }
        let facing = format!("\\mathbf{{n}}\\cdot\\mathbf{{l}}_{{{i}}}");
        if way.is_behind {
            let n_dot_l = scalar(way.n_dot_l);
            self.0.push(format!("{facing} &= {n_dot_l}\\quad\\text{{(behind the surface: no diffuse, no specular)}}"));
            return;
        }
        self.equal(&facing, &[scalar(way.n_dot_l)]);
        if layer.terms.diffuse == point.at {
            let term = format!("{weight}k_d\\, L_{{d,{i}}}\\,({facing})");
            self.equal(&format!("I_{{d,{i}}}"), &[term, color(light.terms.diffuse)]);
        }
        if layer.terms.specular == point.at && !is_black(point.material.ks) {
            self.specular(layer, (light, &way), &weight, i);
        }
    }

    fn specular(&mut self, layer: &ExplainedLayer, (light, way): (&ExplainedLight, &LightWay), weight: &str, i: usize) {
        let is_phong = layer.reflectance == Reflectance::Phong;
        let (direction, cosine) = if is_phong {
            let r = format!("\\mathbf{{r}}_{{{i}}}");
            (r.clone(), format!("{r}\\cdot\\mathbf{{v}}"))
        } else {
            let h = format!("\\mathbf{{h}}_{{{i}}}");
            (h.clone(), format!("\\mathbf{{n}}\\cdot{h}"))
        };
        let power = format!("({cosine})^{{{}}}", short(way.exponent));
        let direction = way.direction.map(|value| (direction, vector(value)));
        let of_power = [(cosine, scalar(way.cosine)), (power.clone(), scalar(way.power))];
        self.row(&direction.into_iter().chain(of_power).collect::<Vec<_>>());
        let term = format!("{weight}k_s\\, L_{{s,{i}}}\\,{power}");
        self.equal(&format!("I_{{s,{i}}}"), &[term, color(light.terms.specular)]);
    }

    /// The corners' sums with their weights.
    fn interpolation(&mut self, layer: &ExplainedLayer) {
        let corners: Vec<_> = layer.points.iter().filter_map(|point| Some((point.corner?.1, &point.sums))).collect();
        if corners.is_empty() || !layer.lit {
            return;
        }
        self.say("Interpolated with the weights of the corners");
        for (k, name) in ["a", "d", "s"].into_iter().enumerate() {
            if corners.iter().all(|(_, sums)| is_black(sums.each()[k])) {
                continue;
            }
            let weighted =
                corners.iter().map(|(weight, sums)| format!("{}\\cdot{}", scalar(*weight), color(sums.each()[k])));
            self.equal(&format!("I_{name}"), &[weighted.collect::<Vec<_>>().join(" + ")]);
        }
    }

    fn sum(&mut self, layer: &ExplainedLayer, whole: &Explanation) {
        let around = &layer.environment;
        if !is_black(around.ambient) || !is_black(around.specular) {
            self.say("Environment");
            self.equal("k_d\\, E(\\mathbf{n})", &[color(around.ambient)]);
            self.equal("k_s\\, L(\\mathbf{r})", &[color(around.specular)]);
        }
        if !layer.factors.are_one() {
            let it = &layer.factors;
            self.say("Factors of images: of ambient and diffuse, of occlusion, of specular, of emission");
            let surface = [0, 1, 2].map(|k| it.color[k] * it.solid[k]);
            self.0.push(format!(
                "&{},\\quad {},\\quad {},\\quad {}",
                color(surface),
                scalar(it.occlusion),
                color(it.specular),
                color(it.emission)
            ));
        }
        let parts = layer.sums.each().map(color).join(" + ");
        self.equal(
            "I",
            &[
                "I_a + I_d + I_s + k_e".to_owned(),
                format!("{parts} + {}", color(layer.emission)),
                color(layer.intensity),
            ],
        );
        let mut written = layer.intensity;
        if whole.clamps_surfaces && written.iter().any(|channel| *channel > 1.0) {
            written = written.map(|channel| channel.min(1.0));
            self.equal("\\min(I, 1)", &[color(written)]);
        }
        if layer.opacity < 1.0 {
            let [opacity, rest] = [layer.opacity, 1.0 - layer.opacity].map(scalar);
            let blend = format!("{opacity}\\cdot{} + {rest}\\cdot{}", color(written), color(layer.behind));
            self.equal("I_b", &[blend, color(layer.blended)]);
        }
    }

    fn end(&mut self, whole: &Explanation) {
        if whole.samples.len() > 1 {
            self.equal("\\bar{I}", &[color(whole.mean)]);
        }
        match (whole.policy, whole.divisor) {
            (Intensity::Clamp, _) => {}
            (_, Some(divisor)) => self.equal(&format!("I / {}", scalar(divisor)), &[color(whole.color)]),
            (policy, None) => {
                self.equal(&format!("\\mathrm{{{}}}(I)", escaped(policy.name())), &[color(whole.color)]);
            }
        }
        let curve = match whole.encoding {
            Encoding::Srgb => "\\mathrm{sRGB}(I)",
            Encoding::Raw => "I",
        };
        self.equal(curve, &[color(whole.encoded)]);
        let [r, g, b] = whole.bytes;
        self.equal(&format!("255\\,{curve}"), &[format!("({r},\\ {g},\\ {b})")]);
    }
}

fn exponent(layer: &ExplainedLayer) -> &'static str {
    if layer.reflectance == Reflectance::BlinnPhong { "\\beta" } else { "\\alpha" }
}

fn vector(values: [f64; 3]) -> String {
    typeset(&numbers::vector(values))
}

fn color(values: [f64; 3]) -> String {
    typeset(&numbers::color(values))
}

/// A colour that was given.
fn given(values: [f64; 3]) -> String {
    typeset(&numbers::given_color(values))
}

/// A number that was given.
fn short(value: f64) -> String {
    typeset(&numbers::given(value))
}

fn scalar(value: f64) -> String {
    typeset(&numbers::number(value))
}

/// Numbers with their powers of ten as LaTeX has them, and with spaces between them.
fn typeset(numbers: &str) -> String {
    let one = |text: &str| match text.split_once('e') {
        Some((digits, power)) => {
            let (power, end) = power.strip_suffix(')').map_or((power, ""), |power| (power, ")"));
            format!("{digits}\\cdot 10^{{{power}}}{end}")
        }
        None => text.to_owned(),
    };
    numbers.split(", ").map(one).collect::<Vec<_>>().join(",\\ ")
}

/// Words without characters that LaTeX takes as commands; others than those of ASCII are kept where LaTeX has them.
fn escaped(words: &str) -> String {
    let mut text = String::new();
    for c in words.chars() {
        match c {
            '\\' => text.push_str("\\textbackslash{}"),
            '~' => text.push_str("\\textasciitilde{}"),
            '^' => text.push_str("\\textasciicircum{}"),
            '#' | '$' | '%' | '&' | '_' | '{' | '}' => text.extend(['\\', c]),
            _ => text.push(c),
        }
    }
    text
}
