//! Doors: the imports between crates that are permitted.

use std::path::Path;

use super::metadata::{Package, packages};
use super::none_of;
use crate::failure::Result;

/// A crate, the crates of the workspace that it may import, and the crates from outside that it must not use.
struct CrateRule {
    name: &'static str,
    imports: &'static [&'static str],
    not: &'static [&'static str],
}

const fn rule(name: &'static str, imports: &'static [&'static str], not: &'static [&'static str]) -> CrateRule {
    CrateRule { name, imports, not }
}

const NO_GPU: &[&str] = &["wgpu", "naga", "winit"];
const NO_WINDOW: &[&str] = &["winit"];
/// The rules of docs/architecture.md; `*` stands for every crate further up in this table.
const RULES: [CrateRule; 19] = [
    rule("halfway_asset", &[], NO_GPU),
    rule("halfway_mesh", &["halfway_asset"], NO_GPU),
    rule("halfway_texture", &["halfway_asset"], NO_GPU),
    rule("halfway_lighting", &[], NO_GPU),
    rule("halfway_reference", &["halfway_asset", "halfway_mesh", "halfway_texture", "halfway_lighting"], NO_GPU),
    rule(
        "halfway_raster",
        &["halfway_lighting", "halfway_texture"],
        &["wgpu", "naga", "winit", "bevy_ecs", "bevy_app"],
    ),
    rule("halfway_frame", &["halfway_asset", "halfway_mesh", "halfway_texture", "halfway_lighting"], NO_GPU),
    rule(
        "halfway_render",
        &["halfway_asset", "halfway_mesh", "halfway_texture", "halfway_lighting", "halfway_frame", "halfway_raster"],
        NO_WINDOW,
    ),
    rule("halfway_record", &["halfway_render", "halfway_reference", "halfway_lighting"], NO_WINDOW),
    rule("halfway_golden", &["halfway_record", "halfway_render", "halfway_reference", "halfway_lighting"], NO_WINDOW),
    rule("halfway_window", &["halfway_render", "halfway_lighting"], &[]),
    rule("halfway_scene", &["halfway_asset", "halfway_mesh", "halfway_texture", "halfway_lighting"], NO_GPU),
    rule("halfway", &["*"], NO_WINDOW),
    rule("halfway_viewer", &["halfway"], &[]),
    rule("halfway_chart", &["*"], NO_WINDOW),
    rule("halfway_wild", &["halfway"], NO_WINDOW),
    rule("halfway_command", &["*"], NO_WINDOW),
    rule("halfway_python", &["halfway"], NO_GPU),
    rule("xtask", &[], NO_GPU),
];

/// Checks every manifest of the workspace in `root`.
pub(crate) fn run(root: &Path) -> Result {
    none_of(&faults(&packages(root)?))
}

fn faults(packages: &[Package]) -> Vec<String> {
    packages.iter().flat_map(forbidden).collect()
}

fn forbidden(package: &Package) -> Vec<String> {
    let name = &package.name;
    let Some(place) = RULES.iter().position(|rule| rule.name == name) else {
        return vec![format!("{name} is missing from the table of doors")];
    };
    let rule = &RULES[place];
    let below = |other: &str| RULES[..place].iter().any(|rule| rule.name == other);
    let may = |other: &str| rule.imports.contains(&other) || rule.imports.contains(&"*") && below(other);
    let inside = package.dependencies.iter().filter(|other| other.inside && !may(&other.name));
    let outside = package.dependencies.iter().filter(|other| !other.inside && rule.not.contains(&other.name.as_str()));
    let inside = inside.map(|other| format!("{name} must not import {}", other.name));
    inside.chain(outside.map(|other| format!("{name} must not depend on {}", other.name))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::metadata::Dependency;

    fn package(name: &str, inside: &[&str], outside: &[&str]) -> Package {
        let dependency = |name: &&str, inside| Dependency { name: (*name).into(), inside };
        let inside = inside.iter().map(|name| dependency(name, true));
        let dependencies = inside.chain(outside.iter().map(|name| dependency(name, false))).collect();
        Package { name: name.into(), dependencies, ..Package::default() }
    }

    /// A crate, its imports, its other dependencies, and the start of its fault.
    type Row<'a> = (&'a str, &'a [&'a str], &'a [&'a str], Option<&'a str>);

    #[test]
    fn doors_that_must_not_be_are_found() {
        let rows: [Row; 10] = [
            ("halfway_render", &["halfway_mesh", "halfway_lighting"], &["wgpu"], None),
            ("halfway_render", &["halfway_reference"], &[], Some("halfway_render must not import halfway_reference")),
            ("halfway_mesh", &["halfway_lighting"], &[], Some("halfway_mesh must not import halfway_lighting")),
            ("halfway_mesh", &[], &["wgpu"], Some("halfway_mesh must not depend on wgpu")),
            (
                "halfway_raster",
                &["halfway_lighting"],
                &["bevy_ecs"],
                Some("halfway_raster must not depend on bevy_ecs"),
            ),
            ("halfway", &["halfway_scene", "halfway_window"], &[], None),
            ("halfway", &["halfway_command"], &[], Some("halfway must not import halfway_command")),
            ("halfway_command", &["halfway", "halfway_chart"], &["clap"], None),
            ("xtask", &["halfway"], &[], Some("xtask must not import halfway")),
            ("halfway_new", &[], &[], Some("halfway_new is missing from the table")),
        ];
        for (name, inside, outside, expected) in rows {
            let found = faults(&[package(name, inside, outside)]);
            assert_eq!(found.len(), usize::from(expected.is_some()), "{name}: {found:?}");
            assert!(found.iter().all(|fault| fault.starts_with(expected.unwrap_or_default())), "{found:?}");
        }
    }
}
