//! The one value that is wanted of a driver's manifest.

/// The value of the key `library_path` of a JSON text, where it is a string.
///
/// Strings are told from the rest and their escapes are resolved; what else the text holds does not matter here, since
/// the Vulkan loader is the judge of it.
pub(crate) fn library_path(json: &str) -> Option<String> {
    let mut rest = json;
    loop {
        let (text, after) = next_string(rest)?;
        rest = after;
        let Some(value) = after.trim_start().strip_prefix(':') else { continue };
        if text == "library_path" {
            let value = value.trim_start();
            return value.starts_with('"').then(|| next_string(value)).flatten().map(|(path, _)| path);
        }
    }
}

/// The first string of a JSON text, and what comes after it.
fn next_string(json: &str) -> Option<(String, &str)> {
    let (_, mut rest) = json.split_once('"')?;
    let mut string = String::new();
    loop {
        let end = rest.find(['"', '\\'])?;
        string.push_str(&rest[..end]);
        if rest[end..].starts_with('"') {
            return Some((string, &rest[end + 1..]));
        }
        let escape = rest[end + 1..].chars().next()?;
        rest = &rest[end + 1 + escape.len_utf8()..];
        string.push(match escape {
            'n' => '\n',
            't' => '\t',
            'r' => '\r',
            'b' => '\u{8}',
            'f' => '\u{c}',
            'u' => {
                let digits = rest.get(..4)?;
                rest = &rest[4..];
                char::from_u32(u32::from_str_radix(digits, 16).ok()?)?
            }
            same => same,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_of_manifests() {
        let rows = [
            ("plain", r#"{"ICD": {"library_path": "/usr/lib/libvulkan_lvp.so"}}"#, Some("/usr/lib/libvulkan_lvp.so")),
            ("spaced", "{ \"ICD\" :\n{ \"library_path\"\t:\n \"a.so\" } }", Some("a.so")),
            ("after other keys", r#"{"file_format_version": "1.0.1", "library_path": "b.so"}"#, Some("b.so")),
            ("as a value first", r#"{"name": "library_path", "library_path": "c.so"}"#, Some("c.so")),
            ("escapes", r#"{"library_path": "C:\\d\/\u0065 \"f\".dll"}"#, Some(r#"C:\d/e "f".dll"#)),
            ("inside a string", r#"{"comment": "\"library_path\": \"x.so\""}"#, None),
            ("not a string", r#"{"library_path": 7, "x": "y.so"}"#, None),
            ("cut short", r#"{"library_path": "/usr/li"#, None),
            ("cut in an escape", r#"{"library_path": "\u00"#, None),
            ("no such key", r#"{"ICD": {}}"#, None),
            ("empty", "", None),
            ("no text", "\u{0}\u{1}é\"é", None),
        ];
        for (name, json, expected) in rows {
            assert_eq!(library_path(json).as_deref(), expected, "{name}");
        }
    }
}
