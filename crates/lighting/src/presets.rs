//! Textbook materials by name.

use crate::LinearRgba;

use crate::Material;

/// One row of the published table; `shininess` is there a fraction of 128.
const fn row(ambient: [f32; 3], diffuse: [f32; 3], specular: [f32; 3], shininess: f32) -> Material {
    const fn rgb([red, green, blue]: [f32; 3]) -> LinearRgba {
        LinearRgba::rgb(red, green, blue)
    }
    Material {
        ambient: rgb(ambient),
        diffuse: rgb(diffuse),
        specular: rgb(specular),
        shininess: shininess * 128.0,
        ..Material::DEFAULT
    }
}

macro_rules! presets {
    ($($(#[$doc:meta])* $name:ident $key:literal $ambient:expr, $diffuse:expr, $specular:expr, $shininess:expr;)*) => {
        /// # Presets
        /// The materials of the OpenGL sample program `teapots.c` (Mark J. Kilgard, Silicon Graphics 1994), also in the
        /// *OpenGL Programming Guide* and its course notes. The published shininess is a fraction of 128; here it is
        /// multiplied out. The figures were chosen for screens fed without an sRGB curve, so raw output shows them as
        /// their author saw them; here they are taken as linear RGB.
        impl Material {
            $($(#[$doc])* pub const $name: Self = row($ambient, $diffuse, $specular, $shininess);)*

            /// Every preset with its name: lower case, words joined by `_`, in the order of the published table.
            pub const PRESETS: &[(&str, Self)] = &[$(($key, Self::$name)),*];
        }
    };
}

presets! {
    /// Emerald.
    EMERALD "emerald" [0.0215, 0.1745, 0.0215], [0.07568, 0.61424, 0.07568], [0.633, 0.727_811, 0.633], 0.6;
    /// Jade.
    JADE "jade" [0.135, 0.2225, 0.1575], [0.54, 0.89, 0.63], [0.316_228, 0.316_228, 0.316_228], 0.1;
    /// Obsidian.
    OBSIDIAN "obsidian" [0.05375, 0.05, 0.06625], [0.18275, 0.17, 0.22525], [0.332_741, 0.328_634, 0.346_435], 0.3;
    /// Pearl.
    PEARL "pearl" [0.25, 0.20725, 0.20725], [1.0, 0.829, 0.829], [0.296_648, 0.296_648, 0.296_648], 0.088;
    /// Ruby.
    RUBY "ruby" [0.1745, 0.01175, 0.01175], [0.61424, 0.04136, 0.04136], [0.727_811, 0.626_959, 0.626_959], 0.6;
    /// Turquoise.
    TURQUOISE "turquoise" [0.1, 0.18725, 0.1745], [0.396, 0.74151, 0.69102], [0.297_254, 0.30829, 0.306_678], 0.1;
    /// Brass.
    BRASS "brass" [0.329_412, 0.223_529, 0.027_451], [0.780_392, 0.568_627, 0.113_725],
        [0.992_157, 0.941_176, 0.807_843], 0.217_948_72;
    /// Bronze.
    BRONZE "bronze" [0.2125, 0.1275, 0.054], [0.714, 0.4284, 0.18144], [0.393_548, 0.271_906, 0.166_721], 0.2;
    /// Chrome.
    CHROME "chrome" [0.25, 0.25, 0.25], [0.4, 0.4, 0.4], [0.774_597, 0.774_597, 0.774_597], 0.6;
    /// Copper.
    COPPER "copper" [0.19125, 0.0735, 0.0225], [0.7038, 0.27048, 0.0828], [0.256_777, 0.137_622, 0.086_014], 0.1;
    /// Gold.
    GOLD "gold" [0.24725, 0.1995, 0.0745], [0.75164, 0.60648, 0.22648], [0.628_281, 0.555_802, 0.366_065], 0.4;
    /// Silver.
    SILVER "silver" [0.19225, 0.19225, 0.19225], [0.50754, 0.50754, 0.50754], [0.508_273, 0.508_273, 0.508_273], 0.4;
    /// Black plastic.
    BLACK_PLASTIC "black_plastic" [0.0, 0.0, 0.0], [0.01, 0.01, 0.01], [0.5, 0.5, 0.5], 0.25;
    /// Cyan plastic.
    CYAN_PLASTIC "cyan_plastic" [0.0, 0.1, 0.06], [0.0, 0.509_803_9, 0.509_803_9],
        [0.501_960_8, 0.501_960_8, 0.501_960_8], 0.25;
    /// Green plastic.
    GREEN_PLASTIC "green_plastic" [0.0, 0.0, 0.0], [0.1, 0.35, 0.1], [0.45, 0.55, 0.45], 0.25;
    /// Red plastic.
    RED_PLASTIC "red_plastic" [0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.7, 0.6, 0.6], 0.25;
    /// White plastic.
    WHITE_PLASTIC "white_plastic" [0.0, 0.0, 0.0], [0.55, 0.55, 0.55], [0.7, 0.7, 0.7], 0.25;
    /// Yellow plastic.
    YELLOW_PLASTIC "yellow_plastic" [0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.6, 0.6, 0.5], 0.25;
    /// Black rubber.
    BLACK_RUBBER "black_rubber" [0.02, 0.02, 0.02], [0.01, 0.01, 0.01], [0.4, 0.4, 0.4], 0.078_125;
    /// Cyan rubber.
    CYAN_RUBBER "cyan_rubber" [0.0, 0.05, 0.05], [0.4, 0.5, 0.5], [0.04, 0.7, 0.7], 0.078_125;
    /// Green rubber.
    GREEN_RUBBER "green_rubber" [0.0, 0.05, 0.0], [0.4, 0.5, 0.4], [0.04, 0.7, 0.04], 0.078_125;
    /// Red rubber.
    RED_RUBBER "red_rubber" [0.05, 0.0, 0.0], [0.5, 0.4, 0.4], [0.7, 0.04, 0.04], 0.078_125;
    /// White rubber.
    WHITE_RUBBER "white_rubber" [0.05, 0.05, 0.05], [0.5, 0.5, 0.5], [0.7, 0.7, 0.7], 0.078_125;
    /// Yellow rubber.
    YELLOW_RUBBER "yellow_rubber" [0.05, 0.05, 0.0], [0.5, 0.5, 0.4], [0.7, 0.7, 0.04], 0.078_125;
}

impl Material {
    /// The preset of that name. Case, spaces, `-` and `_` make no difference: `red_plastic` is `Red Plastic`.
    ///
    /// `None` where there is none; [`Material::PRESETS`] lists them.
    pub fn named(name: &str) -> Option<Self> {
        let same = |key: &str| letters(key).eq(letters(name));
        Self::PRESETS.iter().find(|(key, _)| same(key)).map(|(_, material)| *material)
    }
}

/// The letters of a name in lower case, without what separates its words.
fn letters(name: &str) -> impl Iterator<Item = char> {
    name.chars().filter(|c| !matches!(c, ' ' | '-' | '_')).map(|c| c.to_ascii_lowercase())
}
