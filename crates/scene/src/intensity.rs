//! The key of a scene file that says what becomes of intensities above 1.

use halfway_lighting::Intensity;

use crate::check::Limits;
use crate::keys::{Fill, Key, Keys, Object, Visit, keys};

impl Keys for Intensity {
    const NAME: &'static str = "Intensity";
    const MEANING: &'static str = "`intensity`: what becomes of intensities above 1. `clamp` acts on each surface, the \
                                   others on the finished picture.";
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("clamp", Self::Clamp, "min(I, 1) for every channel."),
        (
            RENORMALISE.name,
            Self::Renormalize { smoothing: 0.0 },
            "Where any channel exceeds 1, all of the picture are divided by the largest.",
        ),
        (
            REINHARD.name,
            Self::Reinhard { white: Self::WHITE },
            "I·(1 + I/w²)/(1 + I) for every channel, with a white point w of 4.",
        ),
        ("aces", Self::Aces, "I·(2.51·I + 0.03)/(I·(2.43·I + 0.59) + 0.14), at most 1, for every channel."),
    ];

    fn blank() -> Self {
        Self::default()
    }

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        match *self {
            Self::Renormalize { smoothing } => visitor.key(&RENORMALISE, Some(&Renormalise { smoothing })),
            Self::Reinhard { white } => visitor.key(&REINHARD, Some(&Reinhard { white })),
            _ => Ok(()),
        }
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        from.key(&RENORMALISE, |Renormalise { smoothing }| *self = Self::Renormalize { smoothing })?;
        from.key(&REINHARD, |Reinhard { white }| *self = Self::Reinhard { white })
    }
}

impl Object for Intensity {
    const ONE_KEY: bool = true;
    const EXAMPLES: &'static [&'static str] =
        &["{\"renormalise\": {\"smoothing\": 0.9}}", "{\"reinhard\": {\"white\": 4}}"];
}

const RENORMALISE: Key =
    Key::required("renormalise", "As `renormalise`, with a divisor that follows from frame to frame.");
const REINHARD: Key = Key::required("reinhard", "As `reinhard`, with a white point of its own.");

keys! {
    /// The value of `{"renormalise": …}`.
    #[derive(Clone, Copy, PartialEq)]
    struct Renormalise {
        [optional]
        /// The share of the last frame's divisor that stays, from 0 to below 1.
        smoothing: f32 = 0.0 => Limits::Numbers(Intensity::SMOOTHING_RANGE),
    }
}

impl Object for Renormalise {
    const EXPECTED: &'static str = "an object such as {\"smoothing\": 0.9}";
}

keys! {
    /// The value of `{"reinhard": …}`.
    #[derive(Clone, Copy, PartialEq)]
    struct Reinhard {
        [optional]
        /// The intensity that becomes 1, itself 1 or more.
        white: f32 = Intensity::WHITE => Limits::Numbers(Intensity::WHITE_RANGE),
    }
}

impl Object for Reinhard {
    const EXPECTED: &'static str = "an object such as {\"white\": 4}";
}
