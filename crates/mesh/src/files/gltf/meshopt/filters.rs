//! Filters: numbers in other forms, which pack better.

/// Unit vectors on an octahedron, of 8 bits a number.
pub(super) fn octahedral_8(bytes: &mut [u8]) {
    for item in bytes.as_chunks_mut::<4>().0 {
        let [x, y, one, _] = item.map(|byte| f32::from(byte as i8));
        let unit = unit_vector(x, y, one);
        for (to, from) in item.iter_mut().zip(unit) {
            *to = (from * 127.0).round() as i8 as u8;
        }
    }
}

/// Unit vectors on an octahedron, of 16 bits a number.
pub(super) fn octahedral_16(bytes: &mut [u8]) {
    for item in bytes.as_chunks_mut::<8>().0 {
        let [x, y, one, _] = words(*item).map(|word| f32::from(word as i16));
        for (to, from) in item.as_chunks_mut::<2>().0.iter_mut().zip(unit_vector(x, y, one)) {
            *to = ((from * 32767.0).round() as i16).to_le_bytes();
        }
    }
}

fn unit_vector(x: f32, y: f32, one: f32) -> [f32; 3] {
    let (mut x, mut y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    let below = z.min(0.0);
    x -= below.copysign(x);
    y -= below.copysign(y);
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}

/// Unit quaternions without their largest number.
pub(super) fn quaternion(bytes: &mut [u8]) {
    for item in bytes.as_chunks_mut::<8>().0 {
        let input = words(*item).map(|word| word as i16);
        let one = f32::from(input[3] | 3);
        let [x, y, z] = [0, 1, 2].map(|i| f32::from(input[i]) / one * std::f32::consts::FRAC_1_SQRT_2);
        let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        let largest = usize::from(item[6] & 3);
        for (after, number) in [(1, x), (2, y), (3, z), (0, w)] {
            let word = (number * 32767.0).round() as i16;
            item[2 * ((largest + after) % 4)..][..2].copy_from_slice(&word.to_le_bytes());
        }
    }
}

/// Numbers m·2^e, of 24 and 8 bits.
pub(super) fn exponential(bytes: &mut [u8]) {
    for item in bytes.as_chunks_mut::<4>().0 {
        let word = i32::from_le_bytes(*item);
        let (exponent, mantissa) = (word >> 24, (word << 8) >> 8);
        // In f64, where every such power is a number.
        *item = ((f64::from(exponent).exp2() * f64::from(mantissa)) as f32).to_le_bytes();
    }
}

/// Colors as luma, two differences and alpha, of 8 bits a number.
pub(super) fn color_8(bytes: &mut [u8]) {
    for item in bytes.as_chunks_mut::<4>().0 {
        let [luma, orange, green, alpha] = *item;
        let signed = |byte: u8| i32::from(byte as i8);
        *item = rgba(i32::from(luma), signed(orange), signed(green), u32::from(alpha), 255.0).map(|x| x as u8);
    }
}

/// Colors as luma, two differences and alpha, of 16 bits a number.
pub(super) fn color_16(bytes: &mut [u8]) {
    for item in bytes.as_chunks_mut::<8>().0 {
        let [luma, orange, green, alpha] = words(*item);
        let signed = |word: u16| i32::from(word as i16);
        let color = rgba(i32::from(luma), signed(orange), signed(green), u32::from(alpha), 65535.0);
        for (to, from) in item.as_chunks_mut::<2>().0.iter_mut().zip(color) {
            *to = (from as u16).to_le_bytes();
        }
    }
}

/// The highest bit of alpha says how many bits the numbers have.
fn rgba(luma: i32, orange: i32, green: i32, alpha: u32, most: f32) -> [f32; 4] {
    let scale = (2_u32 << alpha.checked_ilog2().unwrap_or(0)) - 1;
    let half = alpha & (scale >> 1);
    let alpha = (half << 1) | (half & 1);
    let numbers = [luma + orange - green, luma + green, luma - orange - green, alpha as i32];
    numbers.map(|number| (number as f32 * (most / scale as f32)).round())
}

fn words(item: [u8; 8]) -> [u16; 4] {
    std::array::from_fn(|i| u16::from_le_bytes([item[2 * i], item[2 * i + 1]]))
}
