//! Numbers as readers like them: `0` is nothing at all, `0.0000` is too little to show.

/// A number with four digits after the point, or with a power of ten where that would hide it.
pub(super) fn number(x: f64) -> String {
    if x != 0.0 && x.abs() < 5e-5 { format!("{x:.3e}") } else { fixed(x) }
}

/// A number that was given, such as an exponent or a coefficient: without the zeros at its end.
pub(super) fn given(x: f64) -> String {
    let text = number(x);
    match text.split_once('.') {
        Some((_, digits)) if !digits.contains('e') => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        _ => text,
    }
}

/// Four digits after the point.
fn fixed(x: f64) -> String {
    if x == 0.0 {
        "0".to_owned()
    } else if x.abs() >= 1e6 {
        format!("{x:.3e}")
    } else {
        let text = format!("{x:.4}");
        if text == "-0.0000" { "0.0000".to_owned() } else { text }
    }
}

/// An intensity or another colour.
pub(super) fn color([r, g, b]: [f64; 3]) -> String {
    format!("({}, {}, {})", fixed(r), fixed(g), fixed(b))
}

/// A colour that was given.
pub(super) fn given_color([r, g, b]: [f64; 3]) -> String {
    format!("({}, {}, {})", given(r), given(g), given(b))
}

/// A position or a direction; where all of it is small, with powers of ten.
pub(super) fn vector(values: [f64; 3]) -> String {
    let is_small = values.iter().all(|x| x.abs() < 1e-3);
    let [x, y, z] = values.map(|x| if is_small { number(x) } else { fixed(x) });
    format!("({x}, {y}, {z})")
}

/// Whether all channels are 0.
pub(super) fn is_black(color: [f64; 3]) -> bool {
    color.iter().all(|channel| *channel == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_show_what_they_are() {
        for (x, expected) in [
            (0.0, "0"),
            (0.5, "0.5000"),
            (-12.345_678, "-12.3457"),
            (2.5e-5, "2.500e-5"),
            (1e12, "1.000e12"),
            (999_999.0, "999999.0000"),
        ] {
            assert_eq!(number(x), expected);
        }
        for (x, expected) in [(f64::from(0.1_f32), "0.1"), (32.0, "32"), (100.0, "100"), (129.284_99, "129.285")] {
            assert_eq!(given(x), expected);
        }
        assert_eq!(given(1e-9), "1.000e-9");
    }

    #[test]
    fn colors_and_vectors_in_brackets() {
        assert_eq!(color([1.0, 0.0, 1e-9]), "(1.0000, 0, 0.0000)");
        assert_eq!(given_color([1.0, 0.0, 0.25]), "(1, 0, 0.25)");
        assert_eq!(vector([1.0, -1e-17, -0.25]), "(1.0000, 0.0000, -0.2500)");
        assert_eq!(vector([1e-18, 0.0, -2e-18]), "(1.000e-18, 0, -2.000e-18)");
        assert!(is_black([0.0; 3]) && !is_black([0.0, 1e-300, 0.0]));
    }
}
