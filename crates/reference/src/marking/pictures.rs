//! The pictures of a scene with mistakes.

use std::borrow::Cow;
use std::collections::BTreeMap;

use halfway_lighting::Encoding;
use rayon::prelude::*;

use super::steps::{Steps, could_show, encoded, is_of_picture};
use crate::Oracle;
use crate::mistakes::{Mistake, Mistakes};
use crate::oracle::HitSheet;

/// A colour that differs by more steps between the centre of a pixel and the mean of its samples depends on where they are.
const STEADY: u8 = 1;

/// Chosen pixels of a scene, and the pictures of them with each mistake.
#[derive(Debug)]
pub(super) struct MistakenPictures {
    pub(super) sheet: HitSheet,
    pub(super) encoding: Encoding,
    /// The columns and rows of the pixels.
    pub(super) places: Vec<(u32, u32)>,
    /// Whether each pixel counts: it is neither beside a silhouette nor does its colour depend on where it is sampled.
    pub(super) counts: Vec<bool>,
    right: Drawn,
    /// The pictures with each single mistake that could change them.
    singles: BTreeMap<Mistake, Drawn>,
}

/// The chosen pixels of a picture.
#[derive(Debug)]
struct Drawn {
    /// Empty where they are those of the right picture.
    intensities: Vec<[f64; 3]>,
    bytes: Vec<Steps>,
}

impl Drawn {
    fn new(sheet: &HitSheet, encoding: Encoding, mistakes: Mistakes) -> Self {
        let intensities = sheet.drawn(mistakes);
        let bytes = intensities.par_iter().map(|i| encoded(*i, encoding, mistakes)).collect();
        Self { intensities, bytes }
    }
}

impl MistakenPictures {
    /// For every `step`-th pixel of every `step`-th row, which shows its centre or is smooth.
    pub(super) fn new(oracle: &Oracle, (step, is_smooth): (u32, bool), encoding: Encoding) -> Self {
        let sheet = HitSheet::new(oracle, step, is_smooth);
        let right = Drawn::new(&sheet, encoding, Mistakes::NONE);
        let mut counts: Vec<bool> = sheet.silhouettes().map(|beside| !beside).collect();
        if is_smooth {
            for (i, centre) in sheet.right_at_centres().into_iter().enumerate() {
                let centre = encoded(centre, encoding, Mistakes::NONE);
                counts[i] &= (0..3).all(|k| centre[k].abs_diff(right.bytes[i][k]) <= STEADY);
            }
        }
        let could = |it: &Mistake| could_show(*it, encoding) && sheet.could_show(*it);
        let drawn = |mistake: Mistake| {
            if is_of_picture(mistake) {
                let bytes = right.intensities.iter().map(|i| encoded(*i, encoding, mistake.into())).collect();
                return (mistake, Drawn { intensities: Vec::new(), bytes });
            }
            (mistake, Drawn::new(&sheet, encoding, mistake.into()))
        };
        // One after the other, each by all threads, which share what the vertices have been shaded with.
        let singles = Mistake::ALL.iter().copied().filter(could).map(drawn).collect();
        Self { counts, places: sheet.places().collect(), right, singles, sheet, encoding }
    }

    /// The mistakes that could change pictures of the scene.
    pub(super) fn possible(&self) -> Vec<Mistake> {
        self.singles.keys().copied().collect()
    }

    fn encoded(&self, intensities: &[[f64; 3]], mistakes: Mistakes) -> Vec<Steps> {
        intensities.par_iter().map(|i| encoded(*i, self.encoding, mistakes)).collect()
    }

    /// The pixels of the picture with none, one or more mistakes.
    pub(super) fn picture(&self, mistakes: &[Mistake]) -> Cow<'_, [Steps]> {
        let all: Mistakes = mistakes.iter().copied().collect();
        let of_scene: Vec<Mistake> = mistakes.iter().copied().filter(|it| !is_of_picture(*it)).collect();
        let single = |mistake: &Mistake| self.singles.get(mistake);
        match (mistakes, &of_scene[..]) {
            ([], _) => Cow::Borrowed(&self.right.bytes),
            (_, []) if mistakes.len() > 1 => Cow::Owned(self.encoded(&self.right.intensities, all)),
            ([one], _) if let Some(drawn) = single(one) => Cow::Borrowed(&drawn.bytes),
            (_, [one]) if let Some(drawn) = single(one) => Cow::Owned(self.encoded(&drawn.intensities, all)),
            _ => Cow::Owned(self.encoded(&self.sheet.drawn(of_scene.into_iter().collect()), all)),
        }
    }
}
