//! An explanation as LaTeX.

use halfway_lighting::{Encoding, Frequency, Intensity, Reflectance};

use super::numbers::{self, is_black};
use super::{ExplainedLayer, ExplainedLight, ExplainedPoint, Explanation, LightWay, shading_name};

impl Explanation {
    /// `align*` blocks, one a surface, corner or light, which need the package `amsmath`. Colours are (r, g, b), and
    /// their products are channel by channel. Of several samples the first is explained, and the others are given with
    /// their colours. Lines are broken where they would be wider than the text of an article on a letter or an A4.
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
        lines.blocks()
    }
}

/// The most that a line may have of [`width`]: in an article of 10 points, whose text is 345 points wide, a unit takes
/// 4.5 points.
const WIDEST: usize = 66;

/// Where a line may be broken: what stands there when it is not.
#[derive(Clone, Copy)]
enum Joint {
    Comma,
    Equals,
    Plus,
}

impl Joint {
    fn unbroken(self) -> &'static str {
        match self {
            Self::Comma => ",\\quad ",
            Self::Equals => " = ",
            Self::Plus => " + ",
        }
    }

    /// The end of the line before, and the begin of the next.
    fn broken(self) -> (&'static str, &'static str) {
        match self {
            Self::Comma => (",", "&\\quad "),
            Self::Equals => ("", "&= "),
            Self::Plus => ("", "&\\quad + "),
        }
    }
}

/// The lines of the blocks, and how many of them are in those before the last.
#[derive(Default)]
struct Lines {
    each: Vec<String>,
    blocks: Vec<usize>,
    is_heading: bool,
}

impl Lines {
    /// A line of words. It begins a block, for pages are broken between blocks only, unless one stands before it.
    fn say(&mut self, words: &str) {
        if !self.is_heading {
            self.blocks.push(self.each.len());
        }
        self.each.push(format!("&\\textbf{{{}}}", escaped(words)));
        self.is_heading = true;
    }

    /// `left = a = b …`
    fn equal(&mut self, left: &str, right: &[String]) {
        let Some((first, others)) = right.split_first() else { return };
        self.broken(format!("{left} &= {first}"), others.iter().map(|it| (Joint::Equals, it.clone())));
    }

    /// Several equations in one line.
    fn row(&mut self, equations: &[(String, String)]) {
        let Some(((left, right), others)) = equations.split_first() else { return };
        let others = others.iter().map(|(left, right)| (Joint::Comma, format!("{left} = {right}")));
        self.broken(format!("{left} &= {right}"), others);
    }

    /// A line that is broken where it would be too wide.
    fn broken(&mut self, first: String, others: impl Iterator<Item = (Joint, String)>) {
        let mut line = first;
        for (joint, part) in others {
            let unbroken = joint.unbroken();
            if width(&line) + width(unbroken) + width(&part) <= WIDEST {
                line.extend([unbroken, &part]);
            } else {
                let (end, begin) = joint.broken();
                self.each.push(line + end);
                line = format!("{begin}{part}");
            }
        }
        self.each.push(line);
        self.is_heading = false;
    }

    fn blocks(&self) -> String {
        let ends = self.blocks[1..].iter().copied().chain([self.each.len()]);
        let block = |(begin, end): (&usize, usize)| {
            format!("\\begin{{align*}}\n{}\n\\end{{align*}}", self.each[*begin..end].join(" \\\\\n"))
        };
        self.blocks.iter().zip(ends).map(block).collect::<Vec<_>>().join("\n")
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
            let colors = [("k_a", material.ka), ("k_d", material.kd), ("k_s", material.ks), ("k_e", material.ke)];
            let colors = colors.map(|(name, color)| (name.to_owned(), given(color)));
            let exponent = (exponent(layer).to_owned(), short(material.shininess));
            self.row(&colors.into_iter().chain([exponent]).collect::<Vec<_>>());
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
            let behind = "\\text{behind the surface: no diffuse, no specular}".to_owned();
            self.broken(format!("{facing} &= {}", scalar(way.n_dot_l)), std::iter::once((Joint::Comma, behind)));
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
            let mut parts = weighted.map(|part| (Joint::Plus, part));
            let Some((_, first)) = parts.next() else { continue };
            self.broken(format!("I_{name} &= {first}"), parts);
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
            self.say("Factors of images");
            let surface = [0, 1, 2].map(|k| it.color[k] * it.solid[k]);
            for (of, factor) in [
                ("ambient and diffuse", color(surface)),
                ("occlusion", scalar(it.occlusion)),
                ("specular", color(it.specular)),
                ("emission", color(it.emission)),
            ] {
                self.broken(format!("&\\text{{of {of}: }}{factor}"), std::iter::empty());
            }
        }
        let [ambient, diffuse, specular] = layer.sums.each().map(color);
        let parts = [
            (Joint::Equals, ambient),
            (Joint::Plus, diffuse),
            (Joint::Plus, specular),
            (Joint::Plus, color(layer.emission)),
            (Joint::Equals, color(layer.intensity)),
        ];
        self.broken("I &= I_a + I_d + I_s + k_e".to_owned(), parts.into_iter());
        let mut written = layer.intensity;
        if whole.clamps_surfaces && written.iter().any(|channel| *channel > 1.0) {
            written = written.map(|channel| channel.min(1.0));
            self.equal("\\min(I, 1)", &[color(written)]);
        }
        if layer.opacity < 1.0 {
            let [opacity, rest] = [layer.opacity, 1.0 - layer.opacity].map(scalar);
            let parts =
                [(Joint::Plus, format!("{rest}\\cdot{}", color(layer.behind))), (Joint::Equals, color(layer.blended))];
            self.broken(format!("I_b &= {opacity}\\cdot{}", color(written)), parts.into_iter());
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

/// About how wide a text is printed, in digits: a sign between two numbers has room around it, other commands and
/// characters are as wide as a digit.
fn width(latex: &str) -> usize {
    let mut characters = latex.chars().peekable();
    let mut width = 0;
    while let Some(c) = characters.next() {
        match c {
            '\\' => {
                let mut name = String::new();
                while let Some(letter) = characters.next_if(char::is_ascii_alphabetic) {
                    name.push(letter);
                }
                width += match &*name {
                    "quad" => 3,
                    "cdot" => 2,
                    // They only say how the words after them are set.
                    "mathrm" | "mathbf" | "text" | "textbf" | "Bigl" | "Bigr" | "bigl" | "bigr" => 0,
                    "" => usize::from(characters.next().is_some_and(|c| !matches!(c, ',' | ' '))),
                    _ => 1,
                };
            }
            '{' | '}' | '^' | '_' | '&' | ' ' => {}
            '+' | '=' => width += 3,
            _ => width += 1,
        }
    }
    width
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_characters_are_counted() {
        for (latex, expected) in [
            ("k_a &= (0.2,\\ 0.2,\\ 0.2)", 18),
            ("\\mathbf{n}\\cdot\\mathbf{l}_{1} &= 0.3478", 14),
            ("\\mathrm{att}_{1} = 1/(0.5 + 0.5\\,d_{1}^2)", 23),
            ("6.273\\cdot 10^{-52},\\quad \\cos\\varphi_{3}", 19),
            ("&\\textbf{lamp\\_1}", 6),
        ] {
            assert_eq!(width(latex), expected, "{latex}");
        }
    }

    #[test]
    fn wide_lines_are_broken_and_pages_between_headings() {
        let mut lines = Lines::default();
        lines.say("Pixel");
        lines.say("Surface");
        let term = || "(0.1234,\\ 0.5678,\\ 0.9012)".to_owned();
        lines.equal("I", &["a + b".to_owned(), term(), term()]);
        lines.say("Light");
        lines.row(&[("a".to_owned(), term()), ("b".to_owned(), term()), ("c".to_owned(), "1".to_owned())]);
        lines.broken(format!("x &= {}", term()), [(Joint::Plus, term()), (Joint::Plus, term())].into_iter());
        let term = term();
        assert_eq!(
            lines.blocks(),
            format!(
                "\\begin{{align*}}\n&\\textbf{{Pixel}} \\\\\n&\\textbf{{Surface}} \\\\\nI &= a + b = {term} = {term}\n\\end{{align*}}\n\
                 \\begin{{align*}}\n&\\textbf{{Light}} \\\\\na &= {term},\\quad b = {term},\\quad c = 1 \\\\\n\
                 x &= {term} + {term} \\\\\n&\\quad + {term}\n\\end{{align*}}"
            )
        );
    }
}
