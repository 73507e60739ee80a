//! The triangles around each place, in one list.

/// The numbers of the triangles around places, in an order that stays.
pub(super) struct TriangleFans {
    /// Where in the list the triangles of each place begin, and how many there are.
    spans: Vec<(u32, u32)>,
    triangles: Vec<u32>,
}

impl TriangleFans {
    /// Of triangles between places, which are numbered below `count`.
    pub(super) fn new(triangles: &[[u32; 3]], count: usize) -> Self {
        let mut spans = vec![(0, 0); count];
        for &place in triangles.as_flattened() {
            spans[place as usize].0 += 1;
        }
        let mut before = 0;
        for (start, _) in &mut spans {
            before += std::mem::replace(start, before);
        }
        let mut fans = Self { spans, triangles: vec![0; 3 * triangles.len()] };
        for (number, triangle) in (0..).zip(triangles) {
            for &place in triangle {
                let (start, len) = &mut fans.spans[place as usize];
                fans.triangles[(*start + *len) as usize] = number;
                *len += 1;
            }
        }
        fans
    }

    pub(super) fn of(&self, place: u32) -> &[u32] {
        let (start, len) = self.spans[place as usize];
        &self.triangles[start as usize..(start + len) as usize]
    }

    /// Leaves some triangles of a place.
    pub(super) fn retain(&mut self, place: u32, is_kept: impl Fn(u32) -> bool) {
        let (start, len) = &mut self.spans[place as usize];
        let mut kept = *start as usize;
        for at in *start as usize..(*start + *len) as usize {
            let number = self.triangles[at];
            self.triangles[kept] = number;
            kept += usize::from(is_kept(number));
        }
        *len = kept as u32 - *start;
    }

    /// Puts the triangles of a place behind those of another.
    pub(super) fn append(&mut self, from: u32, to: u32) {
        let start = self.triangles.len() as u32;
        for place in [to, from] {
            let (first, len) = self.spans[place as usize];
            self.triangles.extend_from_within(first as usize..(first + len) as usize);
        }
        self.spans[to as usize] = (start, self.triangles.len() as u32 - start);
        self.spans[from as usize].1 = 0;
    }
}
