//! Short numbers for the window's title.

use std::time::Duration;

/// A count and its noun in the right number: "1 draw", "15.9 k triangles", "2 patches".
pub(crate) fn count(value: u64, noun: &str) -> String {
    let ending = match noun {
        _ if value == 1 => "",
        noun if noun.ends_with("ch") || noun.ends_with("sh") => "es",
        _ => "s",
    };
    format!("{} {noun}{ending}", scaled(value))
}

/// Powers of 1000: "0 B", "1.2 kB", "261 MB".
pub(crate) fn bytes(value: u64) -> String {
    let number = scaled(value);
    // A prefix already follows the space.
    if number.contains(' ') { format!("{number}B") } else { format!("{number} B") }
}

/// "0.84 ms", "16.7 ms", "1204 ms".
pub(crate) fn milliseconds(time: Duration) -> String {
    let value = time.as_secs_f64() * 1e3;
    let digits = match value {
        ..0.995 => 2,
        ..99.95 => 1,
        _ => 0,
    };
    format!("{value:.digits$} ms")
}

/// Whole ones, tenths below ten: "60 fps", "4.2 fps".
pub(crate) fn per_second(rate: f64) -> String {
    let digits = usize::from(rate < 9.95);
    format!("{rate:.digits$} fps")
}

/// Exact below a thousand; else three digits at most, with a prefix: "999", "1.0 k", "15.9 k", "261 k".
fn scaled(value: u64) -> String {
    if value < 1000 {
        return value.to_string();
    }
    let mut number = value as f64;
    for prefix in ["k", "M", "G", "T", "P"] {
        number /= 1e3;
        // A number that would round to four digits gets the next prefix.
        if number < 999.5 {
            let digits = usize::from(number < 99.95);
            return format!("{number:.digits$} {prefix}");
        }
    }
    format!("{:.1} E", number / 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts() {
        let rows = [
            (0, "0 draws"),
            (1, "1 draw"),
            (2, "2 draws"),
            (999, "999 draws"),
            (1_000, "1.0 k draws"),
            (15_872, "15.9 k draws"),
            (99_949, "99.9 k draws"),
            (99_950, "100 k draws"),
            (261_120, "261 k draws"),
            (999_499, "999 k draws"),
            (999_500, "1.0 M draws"),
            (1_234_567, "1.2 M draws"),
            (2_240_000_000, "2.2 G draws"),
            (999_999_999_999_999_999, "1.0 E draws"),
            (u64::MAX, "18.4 E draws"),
        ];
        for (value, expected) in rows {
            assert_eq!(count(value, "draw"), expected);
        }
        assert_eq!([count(1, "patch"), count(2, "patch"), count(0, "mesh")], ["1 patch", "2 patches", "0 meshes"]);
    }

    #[test]
    fn amounts() {
        let rows = [
            (0, "0 B"),
            (1, "1 B"),
            (999, "999 B"),
            (1_000, "1.0 kB"),
            (84_000, "84.0 kB"),
            (3_444_444, "3.4 MB"),
            (u64::MAX, "18.4 EB"),
        ];
        for (value, expected) in rows {
            assert_eq!(bytes(value), expected);
        }
    }

    #[test]
    fn times() {
        let rows = [
            (0, "0.00 ms"),
            (4, "0.00 ms"),
            (84, "0.08 ms"),
            (994, "0.99 ms"),
            (995, "1.0 ms"),
            (4_240, "4.2 ms"),
            (16_667, "16.7 ms"),
            (99_960, "100 ms"),
            (1_203_700, "1204 ms"),
        ];
        for (microseconds, expected) in rows {
            assert_eq!(milliseconds(Duration::from_micros(microseconds)), expected);
        }
    }

    #[test]
    fn rates() {
        let rows = [
            (0.0, "0.0 fps"),
            (0.26, "0.3 fps"),
            (9.94, "9.9 fps"),
            (9.96, "10 fps"),
            (59.94, "60 fps"),
            (1204.4, "1204 fps"),
        ];
        for (rate, expected) in rows {
            assert_eq!(per_second(rate), expected);
        }
    }
}
