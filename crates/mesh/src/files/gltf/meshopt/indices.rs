//! Modes 1 and 2: triangles, and indices of anything else.

use super::bytes::Bytes;

/// The corners of triangles, so many in all; `None` where the stream does not hold just them.
pub(super) fn triangles(data: &[u8], count: usize) -> Option<Vec<u32>> {
    const TABLE: usize = 16;
    if !count.is_multiple_of(3) || *data.first()? != 0xe1 {
        return None;
    }
    let body = &data[1..data.len().checked_sub(TABLE).filter(|end| *end >= 1)?];
    let table = &data[data.len() - TABLE..];
    let (codes, rest) = body.split_at_checked(count / 3)?;
    let mut reader =
        Reader { rest: Bytes(rest), next: 0, last: 0, edges: Recent::default(), vertices: Recent::default() };
    let mut corners = Vec::with_capacity(count);
    for code in codes {
        corners.extend(reader.triangle(*code, table)?);
    }
    reader.rest.0.is_empty().then_some(corners)
}

/// Indices, so many in all: each a difference from one of the two before.
pub(super) fn sequence(data: &[u8], count: usize) -> Option<Vec<u32>> {
    const TAIL: usize = 4;
    if *data.first()? != 0xd1 {
        return None;
    }
    let mut body = Bytes(&data[1..data.len().checked_sub(TAIL).filter(|end| *end >= 1)?]);
    // Each takes a byte at least.
    if count > body.0.len() {
        return None;
    }
    let mut last = [0_u32; 2];
    let mut indices = Vec::with_capacity(count);
    for _ in 0..count {
        let value = body.varint()?;
        let last = &mut last[(value & 1) as usize];
        *last = last.wrapping_add(unzigzag(value >> 1));
        indices.push(*last);
    }
    body.0.is_empty().then_some(indices)
}

/// The indices in 2 or 4 bytes each.
pub(super) fn to_bytes(indices: &[u32], stride: usize) -> Vec<u8> {
    match stride {
        2 => indices.iter().flat_map(|index| (*index as u16).to_le_bytes()).collect(),
        _ => indices.iter().flat_map(|index| index.to_le_bytes()).collect(),
    }
}

fn unzigzag(v: u32) -> u32 {
    (v >> 1) ^ (v & 1).wrapping_neg()
}

/// The last sixteen of something.
#[derive(Default)]
struct Recent<T> {
    all: [Option<T>; 16],
    at: usize,
}

impl<T: Copy> Recent<T> {
    fn push(&mut self, value: T) {
        self.all[self.at] = Some(value);
        self.at = (self.at + 1) % 16;
    }

    /// The value that was pushed so many before the last one; `None` where there was none.
    fn get(&self, before: u8) -> Option<T> {
        self.all[(self.at + 15 - usize::from(before)) % 16]
    }
}

struct Reader<'a> {
    rest: Bytes<'a>,
    /// The least index that has not been seen.
    next: u32,
    /// The last index that was written out.
    last: u32,
    edges: Recent<[u32; 2]>,
    vertices: Recent<u32>,
}

impl Reader<'_> {
    fn triangle(&mut self, code: u8, table: &[u8]) -> Option<[u32; 3]> {
        let (x, y) = (code >> 4, code & 15);
        if x < 15 {
            return self.beside_edge(x, y);
        }
        let (a, zw) = if y < 14 {
            (self.fresh(), table[usize::from(y)])
        } else {
            let zw = self.rest.byte()?;
            if zw == 0 {
                self.next = 0;
            }
            (if y == 14 { self.fresh() } else { self.written()? }, zw)
        };
        let may_be_written = y >= 14;
        let (z, w) = (zw >> 4, zw & 15);
        let b = self.corner(z, may_be_written)?;
        let c = self.corner(w, may_be_written)?;
        for edge in [[b, a], [c, b], [a, c]] {
            self.edges.push(edge);
        }
        self.vertices.push(a);
        for (how, vertex) in [(z, b), (w, c)] {
            if how == 0 || how == 15 {
                self.vertices.push(vertex);
            }
        }
        Some([a, b, c])
    }

    /// A triangle on an edge of an earlier one.
    fn beside_edge(&mut self, edge: u8, how: u8) -> Option<[u32; 3]> {
        let [a, b] = self.edges.get(edge)?;
        let c = match how {
            0 => self.fresh(),
            1..13 => self.vertices.get(how)?,
            13 | 14 => {
                self.last = if how == 13 { self.last.wrapping_sub(1) } else { self.last.wrapping_add(1) };
                self.last
            }
            _ => self.written()?,
        };
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        if how == 0 || how >= 13 {
            self.vertices.push(c);
        }
        Some([a, b, c])
    }

    /// The second or third corner of a triangle by itself.
    fn corner(&mut self, how: u8, may_be_written: bool) -> Option<u32> {
        match how {
            0 => Some(self.fresh()),
            15 if may_be_written => self.written(),
            15 => None,
            _ => self.vertices.get(how - 1),
        }
    }

    fn fresh(&mut self) -> u32 {
        let index = self.next;
        self.next = index.wrapping_add(1);
        index
    }

    fn written(&mut self) -> Option<u32> {
        self.last = self.last.wrapping_add(unzigzag(self.rest.varint()?));
        Some(self.last)
    }
}
