//! Which mistakes explain a picture.

use std::borrow::Cow;
use std::collections::HashMap;

use bevy_ecs::entity::Entity;
use halfway_lighting::{Encoding, Intensity};
use rayon::prelude::*;

use super::pictures::MistakenPictures;
use super::score::{error, total};
use super::steps::{Steps, encoded, is_move, put};
use crate::metrics::SizeMismatch;
use crate::mistakes::{Mistake, Mistakes};
use crate::{Image, Oracle};

/// At most about this many pixels are drawn with every mistake.
const PIXELS: u32 = 20_000;
/// Mistakes that explain this share of the difference are named.
const EXPLAINS: f64 = 0.95;
/// Pairs are tried where the best single mistake leaves this share of the pixels wrong.
const LEFT_WRONG: f64 = 0.01;
/// A pair is named where it leaves at most this part of what the best single mistake leaves.
const PAIR_LEAVES: f64 = 0.25;
/// The number of single mistakes that pairs begin with.
const BEGINNINGS: usize = 8;
/// Pictures are equal that differ in fewer of their pixels, and by less of what one of them differs from the right one.
const EQUAL_PIXELS: f64 = 0.005;
const EQUAL_ERROR: f64 = 0.02;
/// How much of the difference beside silhouettes counts where mistakes are ranked.
const BESIDE_WEIGHT: f64 = 0.05;
/// The share of the difference on either side that an area leaves out.
const BESIDE: f64 = 0.02;

/// The mistakes that explain the difference of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnosis {
    /// The share of right pixels among those that show an object or should, 0 to 1; those on silhouettes do not count.
    pub right: f64,
    /// The explanations, the best first; empty where no listed mistake explains the difference.
    pub explanations: Vec<Finding>,
    /// The mistake that comes nearest where none explains the difference.
    pub nearest: Option<Finding>,
}

/// One mistake, or two at once, that explain a difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// One or two causes; all of them are there.
    pub causes: Vec<Cause>,
    /// The share of the difference that they explain, at most 1.
    pub share: f64,
    /// Where.
    pub area: Area,
    /// The object on which they explain most; `None` if that is the background.
    pub object: Option<Entity>,
}

/// A mistake, or several that draw the same picture of this scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cause {
    /// The likeliest first.
    pub alternatives: Vec<Mistake>,
}

/// A rectangle of the picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// The first column and row, from 0 at the top left.
    pub from: (u32, u32),
    /// The last column and row.
    pub to: (u32, u32),
}

/// Finds the mistakes in pictures of one scene.
///
/// It draws the scene with each mistake that could change it, at up to about 20,000 evenly spaced pixels; pixels
/// beside the silhouette of an object are left out, unless only they differ. The share of the difference that a
/// mistake explains is 1 − e(actual, mistaken)/e(actual, right), where e is the sum of the differences above one step
/// of 1/255, at most 64 for each channel. Mistakes are named that explain 95 % or more. Where the best leaves 1 % of
/// the pixels wrong pairs are tried as well, beginning with the eight best mistakes; a pair is named if it leaves at
/// most a quarter of what the best single one leaves.
#[derive(Debug)]
pub struct Marker {
    pictures: MistakenPictures,
    size: (u32, u32),
}

impl Diagnosis {
    /// The share of the difference that the best explanation explains, or the nearest mistake; 0 if there is none.
    pub fn share(&self) -> f64 {
        self.explanations.first().or(self.nearest.as_ref()).map_or(0.0, |it| it.share)
    }
}

impl Marker {
    /// For pictures of what `oracle` draws, one sample a pixel, in bytes of this encoding. Pictures of bytes need an oracle
    /// that [clamps](Oracle::with_clamping).
    pub fn new(oracle: &Oracle, encoding: Encoding) -> Self {
        Self::with_samples(oracle, encoding, false)
    }

    /// The same for pictures whose pixels are the mean of several samples; four are taken.
    pub fn smoothed(oracle: &Oracle, encoding: Encoding) -> Self {
        Self::with_samples(oracle, encoding, true)
    }

    fn with_samples(oracle: &Oracle, encoding: Encoding, is_smooth: bool) -> Self {
        let step = match oracle.policy() {
            // The brightest pixel matters.
            Intensity::Renormalize { .. } => 1,
            _ => step(oracle.size()),
        };
        Self { pictures: MistakenPictures::new(oracle, (step, is_smooth), encoding), size: oracle.size() }
    }

    /// Finds the mistakes that explain how `actual` differs from the right picture.
    ///
    /// # Errors
    /// [`SizeMismatch`].
    pub fn diagnose(&self, actual: &Image) -> Result<Diagnosis, SizeMismatch> {
        if actual.dimensions() != self.size {
            return Err(SizeMismatch { actual: actual.dimensions(), expected: self.size });
        }
        Ok(Examination::new(&self.pictures, actual).diagnosis())
    }
}

/// A picture beside those with mistakes.
struct Examination<'a> {
    pictures: &'a MistakenPictures,
    size: (u32, u32),
    /// All of its pixels.
    actual: Vec<Steps>,
    /// The numbers of the pixels: those that count, then those beside silhouettes.
    order: Vec<usize>,
    /// How many count.
    counted: usize,
    /// The right picture, in that order.
    right: Vec<Steps>,
    /// The examined one, in that order.
    as_is: Vec<Steps>,
    /// The difference of the two on the pixels that count.
    difference: f64,
}

/// Mistakes and the picture with them.
struct Candidate {
    mistakes: Vec<Mistake>,
    /// The pixels in the examination's order.
    picture: Vec<Steps>,
    /// The rest of the difference on the pixels that count.
    left: f64,
    /// The same with a little of the difference beside silhouettes, which decides between mistakes that are equal
    /// elsewhere.
    rank: f64,
}

impl<'a> Examination<'a> {
    fn new(pictures: &'a MistakenPictures, actual: &Image) -> Self {
        let bytes = actual.pixels().par_iter().map(|i| encoded(*i, pictures.encoding, Mistakes::NONE)).collect();
        let counts = &pictures.counts;
        let (inside, beside): (Vec<usize>, Vec<usize>) = (0..counts.len()).partition(|number| counts[*number]);
        let mut it = Self {
            pictures,
            size: actual.dimensions(),
            actual: bytes,
            counted: inside.len(),
            order: inside.into_iter().chain(beside).collect(),
            right: Vec::new(),
            as_is: Vec::new(),
            difference: 0.0,
        };
        it.right = it.picture(&[]);
        it.as_is = it.moved(Mistakes::NONE);
        it.difference = it.counted_error(&it.as_is, &it.right);
        if it.difference == 0.0 {
            it.counted = it.order.len();
            it.difference = it.counted_error(&it.as_is, &it.right);
        }
        it
    }

    /// The difference of two pictures on the pixels that count.
    fn counted_error(&self, a: &[Steps], b: &[Steps]) -> f64 {
        total(&a[..self.counted], &b[..self.counted])
    }

    /// The examined picture's pixels, from where somebody who makes these mistakes puts them.
    fn moved(&self, mistakes: Mistakes) -> Vec<Steps> {
        let pixel = |number: &usize| {
            let (x, y) = put(self.pictures.places[*number], self.size, mistakes);
            self.actual[y as usize * self.size.0 as usize + x as usize]
        };
        self.order.iter().map(pixel).collect()
    }

    fn seen(&self, mistakes: &[Mistake]) -> Cow<'_, [Steps]> {
        if mistakes.iter().any(|it| is_move(*it)) {
            Cow::Owned(self.moved(mistakes.iter().copied().collect()))
        } else {
            Cow::Borrowed(&self.as_is)
        }
    }

    /// The pixels of a picture with mistakes.
    fn picture(&self, mistakes: &[Mistake]) -> Vec<Steps> {
        let picture = self.pictures.picture(mistakes);
        self.order.iter().map(|number| picture[*number]).collect()
    }

    fn candidate(&self, mistakes: &[Mistake]) -> Candidate {
        let picture = self.picture(mistakes);
        let seen = self.seen(mistakes);
        let left = self.counted_error(&seen, &picture);
        let rank = left + BESIDE_WEIGHT * (total(&seen, &picture) - left);
        Candidate { mistakes: mistakes.to_vec(), picture, left, rank }
    }

    fn diagnosis(self) -> Diagnosis {
        let right = self.right_share();
        if self.difference == 0.0 {
            return Diagnosis { right, explanations: Vec::new(), nearest: None };
        }
        let possible = self.pictures.possible();
        let mut singles: Vec<Candidate> = possible.par_iter().map(|mistake| self.candidate(&[*mistake])).collect();
        singles.retain(|single| self.shows(single));
        singles.sort_by(|a, b| a.rank.total_cmp(&b.rank));
        let pair = singles.first().filter(|best| self.wrong_share(best) >= LEFT_WRONG);
        let pair = pair.and_then(|_| self.best_pair(&singles));
        let mut explanations = Vec::new();
        if let Some(pair) = &pair {
            let set = |mistake: Mistake| {
                let single = singles.iter().find(|single| single.mistakes == [mistake]);
                single.map_or_else(|| Cause { alternatives: vec![mistake] }, |single| self.cause(single, &singles))
            };
            explanations.push(self.explanation(pair, pair.mistakes.iter().map(|it| set(*it)).collect()));
        }
        let mut named: Vec<Mistake> = pair.iter().flat_map(|pair| pair.mistakes.iter().copied()).collect();
        for single in &singles {
            if self.share(single) < EXPLAINS || single.mistakes.iter().any(|it| named.contains(it)) {
                continue;
            }
            let cause = self.cause(single, &singles);
            named.extend(&cause.alternatives);
            explanations.push(self.explanation(single, vec![cause]));
        }
        let nearest = singles.first().filter(|best| explanations.is_empty() && self.share(best) > 0.0);
        let nearest = nearest.map(|best| self.explanation(best, vec![self.cause(best, &singles)]));
        Diagnosis { right, explanations, nearest }
    }

    /// Whether a mistake changes the picture of this scene.
    fn shows(&self, candidate: &Candidate) -> bool {
        candidate.mistakes.iter().any(|it| is_move(*it)) || self.counted_error(&candidate.picture, &self.right) > 0.0
    }

    fn share(&self, candidate: &Candidate) -> f64 {
        1.0 - candidate.left / self.difference
    }

    /// The share of the counted pixels that a candidate leaves wrong.
    fn wrong_share(&self, candidate: &Candidate) -> f64 {
        let seen = self.seen(&candidate.mistakes);
        let pairs = seen.iter().zip(&candidate.picture).take(self.counted);
        let wrong = pairs.filter(|(a, b)| error(**a, **b) > 0.0).count();
        wrong as f64 / self.counted.max(1) as f64
    }

    /// The pair that explains most, if it explains enough and much more than the best single mistake.
    fn best_pair(&self, singles: &[Candidate]) -> Option<Candidate> {
        let first = singles.iter().take(BEGINNINGS).enumerate();
        let pairs: Vec<[Mistake; 2]> =
            first.flat_map(|(i, a)| singles[i + 1..].iter().map(move |b| [a.mistakes[0], b.mistakes[0]])).collect();
        let ranks = pairs.par_iter().enumerate().map(|(number, pair)| (self.candidate(pair).rank, number));
        // Of equal ones the first, whatever the threads.
        let (_, best) = ranks.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
        let best = self.candidate(&pairs[best]);
        let enough = self.share(&best) >= EXPLAINS && best.left <= PAIR_LEAVES * singles.first()?.left;
        enough.then_some(best)
    }

    /// The mistake of a candidate, and those that draw the same picture.
    fn cause(&self, of: &Candidate, singles: &[Candidate]) -> Cause {
        let moves = |candidate: &Candidate| candidate.mistakes.iter().copied().find(|it| is_move(*it));
        // On all pixels: no renderer's edges matter between pictures of the oracle.
        let all = |mistakes: &[Mistake]| self.pictures.picture(mistakes);
        let (picture, differs) = (all(&of.mistakes), total(&all(&of.mistakes), &all(&[])));
        let is_like = |other: &[Steps]| {
            let unlike = other.iter().zip(&*picture).filter(|(a, b)| error(**a, **b) > 0.0).count();
            (unlike as f64) < EQUAL_PIXELS * other.len() as f64 && total(other, &picture) <= EQUAL_ERROR * differs
        };
        let equal = |other: &&Candidate| {
            other.mistakes == of.mistakes || (moves(other) == moves(of) && is_like(&all(&other.mistakes)))
        };
        let mut alternatives: Vec<Mistake> = of.mistakes.clone();
        let others = singles.iter().filter(equal).flat_map(|other| other.mistakes.iter().copied());
        alternatives.extend(others.filter(|other| *other != of.mistakes[0]));
        Cause { alternatives }
    }

    fn explanation(&self, candidate: &Candidate, causes: Vec<Cause>) -> Finding {
        let after = self.seen(&candidate.mistakes);
        let gain = |i: usize| error(self.as_is[i], self.right[i]) - error(after[i], candidate.picture[i]);
        let gains: Vec<f64> = (0..self.counted).map(|i| gain(i).max(0.0)).collect();
        let mut by_object: HashMap<Option<Entity>, f64> = HashMap::new();
        for (i, gain) in gains.iter().enumerate().filter(|(_, gain)| **gain > 0.0) {
            *by_object.entry(self.pictures.sheet.object(self.order[i])).or_default() += gain;
        }
        let object = by_object.into_iter().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        Finding {
            causes,
            share: self.share(candidate),
            area: self.area(&gains),
            object: object.and_then(|(object, _)| object),
        }
    }

    /// The rectangle that holds nearly all of these gains of the counted pixels.
    fn area(&self, gains: &[f64]) -> Area {
        let ends = |of: fn((u32, u32)) -> u32| {
            let mut along: Vec<(u32, f64)> = gains
                .iter()
                .zip(&self.order)
                .map(|(gain, number)| (of(self.pictures.places[*number]), *gain))
                .collect();
            along.sort_unstable_by_key(|(at, _)| *at);
            let all: f64 = gains.iter().sum();
            let first_above = |share: f64| {
                let mut sum = 0.0;
                let is_above = |(_, gain): &&(u32, f64)| {
                    sum += gain;
                    sum > share * all
                };
                along.iter().find(is_above).map_or(0, |(at, _)| *at)
            };
            (first_above(BESIDE), first_above(1.0 - BESIDE))
        };
        let ((left, right), (top, bottom)) = (ends(|at| at.0), ends(|at| at.1));
        Area { from: (left, top), to: (right, bottom) }
    }

    /// The share of right pixels among those that show an object or should.
    fn right_share(&self) -> f64 {
        let (mut right, mut all) = (0_usize, 0_usize);
        for (i, number) in self.order[..self.counted].iter().enumerate() {
            let is_right = error(self.as_is[i], self.right[i]) <= 0.0;
            if !is_right || self.pictures.sheet.object(*number).is_some() {
                all += 1;
                right += usize::from(is_right);
            }
        }
        if all == 0 { 1.0 } else { right as f64 / all as f64 }
    }
}

/// The distance between chosen pixels, along rows and columns.
fn step((width, height): (u32, u32)) -> u32 {
    let pixels = f64::from(width) * f64::from(height) / f64::from(PIXELS);
    (pixels.sqrt().ceil() as u32).max(1)
}
