//! Streams that meshoptimizer's own encoder made of numbers by formula.

use super::*;

fn hex(text: &str) -> Vec<u8> {
    let digits: Vec<char> = text.chars().filter(|c| !c.is_whitespace()).collect();
    digits
        .chunks(2)
        .map(|two| two.iter().fold(0, |byte, digit| byte * 16 + digit.to_digit(16).unwrap() as u8))
        .collect()
}

fn packed(mode: Mode, filter: Filter, [count, byte_stride]: [usize; 2]) -> Packed {
    Packed { buffer: 0, byte_offset: 0, byte_length: 0, byte_stride, count, mode, filter }
}

/// Forty items of three numbers.
fn items() -> Vec<u8> {
    let item = |i: u32| {
        let third = if i.is_multiple_of(7) { i.wrapping_mul(2_654_435_761) } else { 70_000 * i };
        [i * i, 1000 + 3 * i + i % 5, third]
    };
    (0..40).flat_map(item).flat_map(u32::to_le_bytes).collect()
}

const VERSION_0: &str = "a01f0002060a0e12161a1e22262a2e32363a3e42464a4e52565a5e62666a6e72767affff00007e82868a8e92969a14800200808080000000002a088881888818888188881888818888188881888800000000010000800000001f00e0e0e0e0e0e06eade0e0e0e0e0033be0e0e0e0e07536e0e0e0e0e0e7a8e0e0ffff0000e0e0e0a6e5e0e0e01f002222242224222970222422242275bc2422222422c1f72422222422f2ab2422ffff0000242222a65f242224152aabeaaffcf70910aabeaafeeee9151a04abea0000e2dd150003c00fa6a5b1b2003c00f00b0c9c9b03c00000bdbe000000000000000000000000000000000000000000000000e803000000000000";
const VERSION_1: [&str; 3] = [
    "a1a5a5550f0002060a0e12161a1e22262a2e32363a3e42464a4e52565a5e62666a6e72767aff007e82868a8e92969a14000080020080808000002a08888188881888818888188881888818888188880000000000000102000000000f00e0e0e0e0e0e06eade0e0e0e0e0033be0e0e0e0e07536e0e0e0e0e0e7a8e0e0ff00e0e0e0a6e5e0e0e00f002222242224222970222422242275bc2422222422c1f72422222422f2ab2422ff00242222a65f242224152aabeaaffcf70910aabeaafeeee9151a04abea0000e2dd0080c1a6a5b1b260300b0c9c9b1800bdbe00000000000000000000000000e803000000000000000000",
    "a1a3a15f0002060a0e12161a1e22262a2e32363a3e42464a4e52565a5e62666a6e72767a7e82868a8e92969a2880020080808000002a0888818888188881888818888188881888818888000000000100010200e0e0e0e0e0e06eade0e0e0e0e0033be0e0e0e0e07536e0e0e0e0e0e7a8e0e0e0e0e0a6e5e0e0e0002222242224222970222422242275bc2422222422c1f72422222422f2ab2422242222a65f242224152aabeaaffcf70910aabeaafeeee9151a04abea0000e2dd0080c1a6a5b1b260300b0c9c9b1800bdbe00000000000000000000000000e803000000000000000000",
    "a1aba95f0002060a0e12161a1e22262a2e32363a3e42464a4e52565a5e62666a6e72767a7e82868a8e92969a2a08888188881888818888188881888818888188880000000000e0e0e0e0e0e06eade0e0e0e0e0033be0e0e0e0e07536e0e0e0e0e0e7a8e0e0e0e0e0a6e5e0e0e0002222242224222970222422242275bc2422222422c1f72422222422f2ab2422242222a65f242224152aabeaaffcf70910aabeaafeeee9151a04abea0000e2dd0080c1a6a5b1b260300b0c9c9b1800bdbe00000000000000000000000000e803000000000000010100",
];

#[test]
fn items_come_back_in_both_versions() {
    let attributes = packed(Mode::Attributes, Filter::None, [40, 12]);
    for text in [VERSION_0].iter().chain(&VERSION_1) {
        assert_eq!(attributes.unpacked(&hex(text)), Some(items()), "{text}");
    }
}

#[test]
fn words_come_back_by_differences_and_by_bits() {
    let text = "a175152aaaaaaaaaaaaaaaaaaa0000152aaaaaaaaaaaaaaaaaaa000000575757575757575757575757575757575757575757575757575757575757575757575757575757152aaaaaaaaaaaaaaaaaaa0000000000000000000000000000000000000000000000409c01";
    let words =
        (0..40_u32).flat_map(|i| [i * 257 % 65_536, 40_000 - i * 300]).flat_map(|word| (word as u16).to_le_bytes());
    let unpacked = packed(Mode::Attributes, Filter::None, [40, 4]).unpacked(&hex(text));
    assert_eq!(unpacked, Some(words.collect()));

    let text =
        "a19a1a01317131f13171310ff1317131f13171310f0fdddd00000f030703000000000000000000000000000000000000000000341222";
    let words = (0..40_u32).map(|i| (i.wrapping_mul(0x9E37_79B1) & 15) << 14 | 0x1234_0000).flat_map(u32::to_le_bytes);
    let unpacked = packed(Mode::Attributes, Filter::None, [40, 4]).unpacked(&hex(text));
    assert_eq!(unpacked, Some(words.collect()));
}

#[test]
fn triangles_come_back_but_for_their_first_corner() {
    let text = "e1fe1e100e100e100e100efe1e190e180e170e160eff1e160e160e160e160eff1e160e160e160e160eff1e160e160e160e160effff0f0c9f025f090c5f090c5f090cff0045226f1b0c007687566778a9866589689801690000";
    let square = |i: u32| {
        let p = i / 5 * 6 + i % 5;
        [[p, p + 1, p + 6], [p + 6, p + 1, p + 7]]
    };
    let mut expected: Vec<[u32; 3]> = (0..25).flat_map(square).collect();
    expected.extend([[35, 0, 17], [3, 33, 9]]);
    for stride in [2, 4] {
        let bytes = packed(Mode::Triangles, Filter::None, [156, stride]).unpacked(&hex(text)).expect("triangles");
        let number = |bytes: &[u8]| bytes.iter().rev().fold(0, |number, byte| number << 8 | u32::from(*byte));
        let corners: Vec<u32> = bytes.chunks(stride).map(number).collect();
        assert_eq!(corners.len(), 156);
        for (found, expected) in corners.as_chunks::<3>().0.iter().zip(&expected) {
            let turned = (0..3).map(|k| [expected[k], expected[(k + 1) % 3], expected[(k + 2) % 3]]);
            assert!(turned.into_iter().any(|turned| turned == *found), "{found:?} is not {expected:?}");
        }
    }
}

#[test]
fn indices_come_back() {
    let expected = [0, 10, 1, 11, 2, 12, 3, 13, 100_000, 4, 14, 0_u32];
    let unpacked =
        packed(Mode::Indices, Filter::None, [12, 4]).unpacked(&hex("d1002822282228222881b51822283600000000"));
    assert_eq!(unpacked, Some(expected.into_iter().flat_map(u32::to_le_bytes).collect()));
}

/// The largest difference of two lists of integers of so many bytes.
fn difference(a: &[u8], b: &[u8], width: usize) -> i64 {
    let number = |bytes: &[u8]| {
        if width == 1 { i64::from(bytes[0] as i8) } else { i64::from(i16::from_le_bytes([bytes[0], bytes[1]])) }
    };
    assert_eq!(a.len(), b.len());
    a.chunks(width).zip(b.chunks(width)).map(|(a, b)| (number(a) - number(b)).abs()).max().unwrap()
}

#[test]
fn filters_give_what_the_original_decoder_gives() {
    // Filter, bytes of an item and of a number, the stream, and what comes out of it, up to one step.
    let rows = [
        (
            Filter::Octahedral,
            4,
            1,
            "a0013fff0000aeb877f2451373013fff0000516b66b6de85ac00000000000000000000000000000000000000000000000000000000000034bf7f81",
            "4f9e0f81e5f38581e07b0881e4be978137e56f8101782a81f4227a81e85eae81",
        ),
        (
            Filter::Octahedral,
            8,
            2,
            "a0013fff0000c86b78bd69b8a0013ff70000150c07100307013fff0000daa93685096fea0203ffae7c000000001a19000000000000000000000000000000000000000000000000000000004103edfbff070180",
            "3b4fcc9c4410018023e4c1f2c7830180d6df9a7b6c080180e8e33dbd799601802e3832e4996f0180db01b078982a018062f44722c67a01800fe9515e91ac0180",
        ),
        (
            Filter::Quaternion,
            8,
            2,
            "a0013fff0000ef09e13c417dc5013bff000011100d070604013fff00006e803591d2d1da013fff000006110c0f040610013cff00007cae45c72767020137425700000000010d7d0000060403000000000000000000000000000000000000000000000000003c05d3000b06fc07",
            "0a5a3f3b54096644656564db6622d23b7de65cbf082959631402c1fbf1700b3cd810896023ee9eaf67bf94bfbe179556e7f4bc7893de36e8716627fc443ca5d0",
        ),
        (
            Filter::Color,
            4,
            1,
            "a1ff00311753763954b0009eb9467e51dbba0020099544280c1e002b468fb46d162e000000000000000000000000000000000000008dda08d500",
            "5f95abab858c337f217b89c465068734bd6361e8635a597b198aeb90bff1d7bf",
        ),
        (
            Filter::Color,
            8,
            2,
            "a1fff700e858b47f52a5fa000101050803060a00043c6e17f40a53000a0b0408030d0c0005b58c4e68f8270123ea0000090400c776e6bbdbafe6000306090c0702020000000000000000000000000000de0897fd91005a0d0000",
            "465ef9966aab4aabd885088eb332c77e2220177b48893cc6d664100518878334abbd86636661cee8966455591559077bf117e88bdeeb08906bbe7ef28dd77bbe",
        ),
    ];
    for (filter, stride, width, stream, expected) in rows {
        let found = packed(Mode::Attributes, filter, [8, stride]).unpacked(&hex(stream)).expect("items");
        assert!(difference(&found, &hex(expected), width) <= 1, "{expected}");
    }
    let (stream, expected) = (
        "a0013fff0000b95cf354be7cfe013fff0000a40f5fa2c19a7d01219900000124010000013ff3000047a33c7e78da013fff0000091c3e176a21ab01026100000124010000013fff000016faef4250c826013fff00003b72a32a4619790119210000012401000000000000000000000000000000000000000000006fc0fffd6ce3fffd2d1600fd",
        "0044fec400a064c4006831440090904400e006c50000f9c30000a443005018c400d4c64400e894c40040b143000c83c400c0af440000adc10020bac300c4d6c4003cd24400303c4400683c44003c8e4400a0ae4300d01fc4001048c4000c48c4",
    );
    let found = packed(Mode::Attributes, Filter::Exponential, [8, 12]).unpacked(&hex(stream));
    assert_eq!(found, Some(hex(expected)));
}

#[test]
fn streams_that_are_no_whole_ones_give_nothing() {
    let streams = [(Mode::Attributes, 12, VERSION_0), (Mode::Attributes, 12, VERSION_1[1])];
    for (mode, stride, text) in streams {
        let whole = hex(text);
        for length in 0..whole.len() {
            assert_eq!(packed(mode, Filter::None, [40, stride]).unpacked(&whole[..length]), None, "{length}");
        }
        for count in [1, 32, 80, 1000] {
            assert_eq!(packed(mode, Filter::None, [count, stride]).unpacked(&whole), None, "{count}");
        }
    }
    for data in [&[][..], &[0xe1], &[0xd1, 0, 0], &[0xa0; 33], &[0xa2; 99], &[0xe1; 18]] {
        for mode in [Mode::Attributes, Mode::Triangles, Mode::Indices] {
            assert_eq!(packed(mode, Filter::None, [3, 4]).unpacked(data), None);
        }
    }
}
