//! The lights that lists name: of many, those alone are sent.

use crate::lights::gather::Lights;
use halfway_lighting::record::LightRecord;

/// Lights as the shaders read them, each once, in the order in which lists name them.
#[derive(Debug, Default)]
pub struct SentLights {
    /// The records, in the order in which lists name them.
    pub records: Vec<LightRecord>,
    /// The numbers of the lights.
    numbers: Vec<u32>,
    /// The index in `records` of each light; [`NOWHERE`] if no list has named it.
    places: Vec<u32>,
}

const NOWHERE: u32 = u32::MAX;

impl SentLights {
    /// Forgets all, and makes room for a frame's lights.
    pub(super) fn begin(&mut self, lights: &Lights) {
        self.records.clear();
        for number in self.numbers.drain(..) {
            self.places[number as usize] = NOWHERE;
        }
        self.places.resize(lights.len(), NOWHERE);
    }

    /// Adds this light unless `records` has it, and returns its index.
    pub(super) fn place(&mut self, lights: &Lights, number: u32) -> u32 {
        let place = &mut self.places[number as usize];
        if *place == NOWHERE {
            *place = self.records.len() as u32;
            self.records.push(lights.record(number));
            self.numbers.push(number);
        }
        *place
    }
}
