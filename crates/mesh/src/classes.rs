//! Disjoint sets that are joined pair by pair (Galler and Fischer 1964, "An improved equivalence algorithm").

/// Elements counted from 0, each in one set: at first, each alone in its own.
pub(crate) struct Classes {
    /// An element of the same set, never a later one; the first points to itself.
    earlier: Vec<u32>,
}

impl Classes {
    /// `count` elements, fewer than 2³², each in a set of its own.
    pub(crate) fn new(count: usize) -> Self {
        Self { earlier: (0..count as u32).collect() }
    }

    /// Unites the sets of two elements.
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.earlier[a.max(b) as usize] = a.min(b);
    }

    fn first(&mut self, mut thing: u32) -> u32 {
        while self.earlier[thing as usize] != thing {
            let earlier = self.earlier[thing as usize];
            self.earlier[thing as usize] = self.earlier[earlier as usize];
            thing = earlier;
        }
        thing
    }

    /// The number of each element's set, counted from 0 in the order of their first elements, and how many sets there
    /// are.
    pub(crate) fn numbers(mut self) -> (Vec<u32>, usize) {
        let mut count = 0;
        for thing in 0..self.earlier.len() {
            // The first of a class has its number already when the later ones come.
            let earlier = self.earlier[thing] as usize;
            self.earlier[thing] = if earlier == thing {
                count += 1;
                count - 1
            } else {
                self.earlier[earlier]
            };
        }
        (self.earlier, count as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::Classes;

    #[test]
    fn joined_things_have_one_number() {
        let mut classes = Classes::new(6);
        for (a, b) in [(4, 2), (5, 1), (1, 4), (3, 3)] {
            classes.join(a, b);
        }
        assert_eq!(classes.numbers(), (vec![0, 1, 1, 2, 1, 1], 3));
    }
}
