//! The pictures of a scene with mistakes.

use std::sync::OnceLock;

use halfway_lighting::Encoding;
use rayon::prelude::*;

use super::steps::{Steps, could_show, encoded, is_of_picture};
use crate::Oracle;
use crate::mistakes::{Mistake, Mistakes};
use crate::oracle::HitSheet;

/// Chosen pixels of a scene, and the pictures of them with each mistake.
#[derive(Debug)]
pub(super) struct MistakenPictures {
    pub(super) sheet: HitSheet,
    pub(super) encoding: Encoding,
    /// The columns and rows of the pixels.
    pub(super) places: Vec<(u32, u32)>,
    right: Vec<[f64; 3]>,
    /// The intensities with single mistakes, drawn when they are needed first.
    drawn: Vec<OnceLock<Vec<[f64; 3]>>>,
    possible: OnceLock<Vec<Mistake>>,
}

impl MistakenPictures {
    /// For every `step`-th pixel of every `step`-th row.
    pub(super) fn new(oracle: &Oracle, step: u32, encoding: Encoding) -> Self {
        let sheet = HitSheet::new(oracle, step);
        Self {
            places: sheet.places().collect(),
            right: sheet.drawn(Mistakes::NONE),
            sheet,
            encoding,
            drawn: Mistake::ALL.iter().map(|_| OnceLock::new()).collect(),
            possible: OnceLock::new(),
        }
    }

    /// The mistakes that could change pictures of the scene.
    pub(super) fn possible(&self) -> &[Mistake] {
        self.possible.get_or_init(|| {
            let possible = |it: &Mistake| could_show(*it, self.encoding) && self.sheet.could_show(*it);
            let possible: Vec<Mistake> = Mistake::ALL.iter().copied().filter(possible).collect();
            // Drawn here, by all threads for each: pixels of one picture share what its vertices have been shaded with.
            possible.iter().filter(|it| !is_of_picture(**it)).for_each(|it| {
                self.single(*it);
            });
            possible
        })
    }

    fn single(&self, mistake: Mistake) -> &[[f64; 3]] {
        self.drawn[mistake as usize].get_or_init(|| self.sheet.drawn(mistake.into()))
    }

    /// The pixels of these numbers of the picture with mistakes.
    pub(super) fn picture(&self, mistakes: Mistakes, numbers: &[usize]) -> Vec<Steps> {
        let of_scene: Vec<Mistake> =
            Mistake::ALL.iter().copied().filter(|mistake| mistakes.has(*mistake) && !is_of_picture(*mistake)).collect();
        let encode = |intensities: &[[f64; 3]]| {
            numbers.par_iter().map(|number| encoded(intensities[*number], self.encoding, mistakes)).collect()
        };
        match of_scene[..] {
            [] => encode(&self.right),
            [single] => encode(self.single(single)),
            _ => encode(&self.sheet.drawn(of_scene.into_iter().fold(Mistakes::NONE, Mistakes::with))),
        }
    }
}
