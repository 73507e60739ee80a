//! The key of a scene file for the policy for intensities above 1.

use halfway_lighting::{Choices, Intensity};

use crate::check::Limits;
use crate::keys::{Fill, Key, Keys, Object, Visit, Words, keys, named_words};

impl Keys for Intensity {
    const NAME: &'static str = "Intensity";
    const MEANING: &'static str = "`intensity`: what becomes of intensities above 1. `clamp` acts on each surface, the \
                                   others on the finished picture.";
    const WORDS: Words<Self> = &named_words::<Self, { Self::CHOICES.len() }>();

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
