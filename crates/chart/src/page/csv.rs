//! Tables as comma-separated values, by RFC 4180.

use std::fmt::Write as _;

/// A header row and rows of as many fields, as text. Lines end in CR LF; what holds a comma, a quotation mark or a line
/// break is quoted.
pub fn csv<const N: usize>(header: [&str; N], rows: impl IntoIterator<Item = [String; N]>) -> String {
    let mut text = line(&header);
    for row in rows {
        text.push_str(&line(&row.each_ref().map(String::as_str)));
    }
    text
}

fn line(fields: &[&str]) -> String {
    let mut text = String::new();
    for (i, value) in fields.iter().enumerate() {
        if i > 0 {
            text.push(',');
        }
        if value.contains(['"', ',', '\r', '\n']) {
            let _ = write!(text, "\"{}\"", value.replace('"', "\"\""));
        } else {
            text.push_str(value);
        }
    }
    text + "\r\n"
}

#[cfg(test)]
mod tests {
    use super::csv;

    #[test]
    fn fields_are_quoted_where_they_must_be() {
        let row = ["plain", "a,b", "say \"so\"", "two\nlines"].map(str::to_owned);
        assert_eq!(
            csv(["a", "b (ms)", "c", "d"], [row]),
            "a,b (ms),c,d\r\nplain,\"a,b\",\"say \"\"so\"\"\",\"two\nlines\"\r\n"
        );
    }

    #[test]
    fn a_table_may_be_empty() {
        assert_eq!(csv(["a"], []), "a\r\n");
    }
}
