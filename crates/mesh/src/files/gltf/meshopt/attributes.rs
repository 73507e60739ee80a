//! Mode 0: items of vertices, whose bytes are packed by their differences from item to item.

use super::bytes::Bytes;

/// Items that are packed as one group.
const GROUP: usize = 16;

/// So many items of so many bytes, a multiple of 4; `None` where the stream does not hold just them.
pub(super) fn decode(data: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    let (is_new, least_tail) = match data.first()? {
        0xa0 => (false, 32),
        0xa1 => (true, 24),
        _ => return None,
    };
    // The first item is a difference, too: from the one in the tail. Streams of version 1 have their channels after it.
    let channel_count = if is_new { stride / 4 } else { 0 };
    let tail = stride + channel_count;
    let body = data.len().checked_sub(1 + tail.max(least_tail))?;
    let (mut body, tail) = (Bytes(&data[1..=body]), &data[data.len() - tail..]);
    let (base, channels) = tail.split_at(stride);
    let channels = if is_new { channels.to_vec() } else { vec![0; stride / 4] };
    if !channels.iter().all(|channel| matches!(channel, 0 | 1) || channel & 15 == 2) {
        return None;
    }

    let mut items = vec![0; count * stride];
    let mut last = base.to_vec();
    let block = ((8192 / stride) & !(GROUP - 1)).min(256);
    for items in items.chunks_mut(block * stride) {
        let count = items.len() / stride;
        let control = if is_new { Some(body.take(stride / 4)?) } else { None };
        let mut deltas = vec![0; stride * block];
        for (k, deltas) in deltas.chunks_exact_mut(block).enumerate() {
            let bits = match control.map(|control| control[k / 4] >> (2 * (k % 4)) & 3) {
                None => [0, 2, 4, 8],
                Some(0) => [0, 1, 2, 4],
                Some(1) => [1, 2, 4, 8],
                Some(2) => continue,
                Some(_) => {
                    deltas[..count].copy_from_slice(body.take(count)?);
                    continue;
                }
            };
            column(&mut body, bits, &mut deltas[..count.next_multiple_of(GROUP)])?;
        }
        for (channel, mode) in channels.iter().enumerate() {
            let four = |i: usize| std::array::from_fn(|k| deltas[(4 * channel + k) * block + i]);
            let last = &mut last[4 * channel..][..4];
            for (i, item) in items.chunks_exact_mut(stride).enumerate() {
                let next = after([last[0], last[1], last[2], last[3]], four(i), *mode);
                last.copy_from_slice(&next);
                item[4 * channel..][..4].copy_from_slice(&next);
            }
        }
    }
    body.0.is_empty().then_some(items)
}

/// The differences of one byte of the items of a block, group by group, each of which says which of these numbers of bits
/// its differences have.
fn column(body: &mut Bytes, bits: [u32; 4], deltas: &mut [u8]) -> Option<()> {
    let groups = deltas.len() / GROUP;
    let header = body.take(groups.div_ceil(4))?;
    for (g, group) in deltas.chunks_exact_mut(GROUP).enumerate() {
        let bits = bits[usize::from(header[g / 4] >> (2 * (g % 4)) & 3)];
        match bits {
            0 => {}
            8 => group.copy_from_slice(body.take(GROUP)?),
            _ => {
                let packed = body.take(GROUP * bits as usize / 8)?;
                let (each, all_ones) = (8 / bits as usize, (1_u8 << bits) - 1);
                for (i, delta) in group.iter_mut().enumerate() {
                    // The first ones are in the high bits, but for single bits.
                    let place = if bits == 1 { i % each } else { each - 1 - i % each };
                    let small = packed[i / each] >> (place as u32 * bits) & all_ones;
                    *delta = if small == all_ones { body.byte()? } else { small };
                }
            }
        }
    }
    Some(())
}

/// Four bytes of an item, by those of the item before and their differences.
fn after(last: [u8; 4], delta: [u8; 4], mode: u8) -> [u8; 4] {
    let zigzag = |v: u16| (v >> 1) ^ (v & 1).wrapping_neg();
    match mode & 15 {
        0 => std::array::from_fn(|k| last[k].wrapping_add(zigzag(u16::from(delta[k])) as u8)),
        1 => {
            let half = |four: [u8; 4], k: usize| u16::from_le_bytes([four[2 * k], four[2 * k + 1]]);
            let [a, b] = [0, 1].map(|k| half(last, k).wrapping_add(zigzag(half(delta, k))).to_le_bytes());
            [a[0], a[1], b[0], b[1]]
        }
        _ => {
            let turned = u32::from_le_bytes(delta).rotate_right(u32::from(mode >> 4));
            (u32::from_le_bytes(last) ^ turned).to_le_bytes()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_of_the_specification() {
        let bytes = [0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
        let mut deltas = [0; 16];
        // A header for one group, of 4 bits.
        let stream = [&[2][..], &bytes].concat();
        column(&mut Bytes(&stream), [0, 2, 4, 8], &mut deltas).unwrap();
        let differences = deltas.map(|delta| after([0; 4], [delta; 4], 0)[0] as i8);
        assert_eq!(differences, [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]);
    }
}
