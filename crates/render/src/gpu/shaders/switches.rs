//! The switches of a shader text: constants of WGSL, and conditions of its lines. The test of the twins of the surface's
//! functions is a user of this file too, so it needs no other.

/// Concatenates files to a text in which each switch is a constant. The lines between `#if NAME` and `#end`, or
/// `#else`, are in it where the switch is on; `#if !NAME` where it is off. Conditions may nest.
///
/// # Panics
/// A condition names no switch, or is not closed. The texts are the project's own, and tests assemble all of them.
pub(crate) fn assembled(files: &[&str], switches: &[(&str, bool)]) -> String {
    let mut text = String::new();
    for (name, on) in switches {
        text.extend(["const ", name, ": bool = ", if *on { "true" } else { "false" }, ";\n"]);
    }
    // Whether the lines of each open condition are included.
    let mut open = Vec::new();
    for line in files.iter().flat_map(|file| file.lines()) {
        if let Some(name) = line.strip_prefix("#if ") {
            let (name, wanted) = name.strip_prefix('!').map_or((name, true), |name| (name, false));
            let switch = switches.iter().find(|switch| switch.0 == name);
            open.push(switch.unwrap_or_else(|| panic!("{line}: there is no such switch")).1 == wanted);
        } else if line == "#else" {
            let last = open.last_mut().unwrap_or_else(|| panic!("#else without #if"));
            *last = !*last;
        } else if line == "#end" {
            open.pop().unwrap_or_else(|| panic!("#end without #if"));
        } else if !open.contains(&false) {
            text.push_str(line);
            text.push('\n');
        }
    }
    assert!(open.is_empty(), "a condition is not closed");
    text
}
