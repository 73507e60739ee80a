//! How the lights of a draw reach its shader: at fixed places, or by lists.

/// Up to this many lights in a scene are all shaded everywhere; of more, each patch has those that it needs.
pub(crate) const COUNTED_LIGHTS: u32 = 8;

/// How the lights reach the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Lists {
    /// These are bound, for both stages.
    Counted(Counted),
    /// These are bound, the fragment shader's before the vertex shader's.
    Split {
        /// Those of the vertex shader.
        vertex: Counted,
        /// Those of the fragment shader.
        fragment: Counted,
    },
    /// All are bound, and the record's lists name some.
    Listed,
}

/// Lights at fixed places: the numbers of directional, point and spot lights, in this order, and how many of them have
/// highlights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Counted {
    pub(crate) counts: [u8; 3],
    pub(crate) highlights: Highlights,
}

impl Counted {
    pub(crate) const NONE: Self = Self { counts: [0; 3], highlights: Highlights::All };

    pub(crate) fn new(counts: [u32; 3], highlights: Highlights) -> Self {
        Self { counts: counts.map(|n| n as u8), highlights }
    }

    /// How many lights.
    pub(crate) fn len(self) -> u32 {
        self.counts.map(u32::from).iter().sum()
    }
}

/// How many of the lights that are bound have specular terms: the first of each kind. Few choices, since each makes
/// pipelines of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Highlights {
    None,
    /// Of an odd number the smaller half.
    Half,
    All,
}

impl Lists {
    /// For a scene with these numbers of directional, point and spot lights.
    pub(crate) fn new(counts: [u32; 3]) -> Self {
        if counts.iter().sum::<u32>() <= COUNTED_LIGHTS {
            Self::Counted(Counted::new(counts, Highlights::All))
        } else {
            Self::Listed
        }
    }

    /// What the vertex shader and the fragment shader know of the lights: which are bound for it, and from which on.
    pub(crate) fn of_stages(self) -> [(Counted, u32); 2] {
        match self {
            Self::Counted(counted) => [(counted, 0); 2],
            Self::Split { vertex, fragment } => [(vertex, fragment.len()), (fragment, 0)],
            Self::Listed => [(Counted::NONE, 0); 2],
        }
    }
}

impl Highlights {
    /// The fewest that are at least `needed` of `counts` lights of each kind.
    pub(crate) fn at_least(needed: [u32; 3], counts: [u32; 3]) -> Self {
        let suffice = |share: &Self| needed.into_iter().zip(counts).all(|(needed, count)| needed <= share.of(count));
        [Self::None, Self::Half].into_iter().find(suffice).unwrap_or(Self::All)
    }

    /// How many of `count` lights of one kind.
    pub(crate) fn of(self, count: u32) -> u32 {
        self.halves() * count / 2
    }

    /// How many halves of each kind.
    pub(crate) fn halves(self) -> u32 {
        match self {
            Self::None => 0,
            Self::Half => 1,
            Self::All => 2,
        }
    }
}

/// The numbers of directional, point and spot lights that have pipelines of their own where patches are lit by few of
/// many lights. A patch with other numbers is filled up with black ones, up to what the scene has of the kind; one with
/// more reads lists.
const STEPS: [&[u32]; 3] = [&[0, 1, 2, 4, 8, 12, 16], &[0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32], &[0, 1, 2, 4, 8, 16]];

/// The numbers of lights of each kind to fill `counts` up to, of a scene with `all` of them, which no patch exceeds;
/// `None` where they are too many.
pub(crate) fn filled_up(counts: [u32; 3], all: [u32; 3]) -> Option<[u32; 3]> {
    let mut filled = [0; 3];
    for (((filled, steps), count), all) in filled.iter_mut().zip(STEPS).zip(counts).zip(all) {
        *filled = all.min(*steps.iter().find(|&&step| step >= count)?);
    }
    Some(filled)
}

/// The same for lights that are shaded at the vertices beside others: fewer steps, as there are fewer vertices than
/// pixels where that is worth it, and each makes pipelines of its own.
pub(crate) fn filled_up_roughly(counts: [u32; 3], all: [u32; 3]) -> Option<[u32; 3]> {
    let mut filled = [0; 3];
    for ((filled, count), all) in filled.iter_mut().zip(counts).zip(all) {
        *filled = match count {
            0 => 0,
            count => all.min(count.next_power_of_two().max(4)),
        };
    }
    (filled.iter().sum::<u32>() <= BOUND_LIGHTS).then_some(filled)
}

/// The most lights that are bound at fixed places.
pub(crate) const BOUND_LIGHTS: u32 = 16 + 32 + 16;
