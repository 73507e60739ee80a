//! One type name for one thing: no two types of the house that others can see share a name.

use std::collections::BTreeMap;
use std::path::Path;

use super::metadata::packages;
use super::none_of;
use super::source::Crate;
use crate::failure::Result;

/// Names that mean the same wherever they stand, each with its reason.
const ALLOWED: [(&str, &str); 4] = [
    ("Cone", "the cone of a spot light, and the surface: both are called so, and refused input names the first"),
    ("Failure", "what a program prints and its exit code: the command's and the chores'"),
    ("Irradiance", "the rasterizer's twin of the equations'"),
    ("Options", "what one chore of xtask is given; always written with its chore, `demo::Options`"),
];

/// For each name, the files that define it, once for each time.
type Places = BTreeMap<String, Vec<String>>;

/// Looks through every crate of the workspace in `root`.
pub(crate) fn run(root: &Path) -> Result {
    let mut places = Places::new();
    for package in packages(root)? {
        for first in &package.roots {
            collect(&Crate::read(first)?, root, &mut places);
        }
    }
    none_of(&repeated(&places, &ALLOWED))
}

fn collect(krate: &Crate, root: &Path, places: &mut Places) {
    for module in &krate.modules {
        let file = module.file.strip_prefix(root).unwrap_or(&module.file).display();
        for name in &module.types {
            places.entry(name.clone()).or_default().push(file.to_string());
        }
    }
}

fn repeated(places: &Places, allowed: &[(&str, &str)]) -> Vec<String> {
    let is_allowed = |name: &str| allowed.iter().any(|(other, _)| *other == name);
    let more = places.iter().filter(|(name, places)| places.len() > 1 && !is_allowed(name));
    let mut faults: Vec<String> =
        more.map(|(name, places)| format!("{name} ×{}: {}", places.len(), places.join(", "))).collect();
    let once = |name: &str| places.get(name).is_none_or(|places| places.len() < 2);
    let idle = allowed.iter().filter(|(name, _)| once(name));
    faults.extend(idle.map(|(name, _)| format!("{name} may repeat, but does not: take it from the list")));
    faults
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::source::tests::planted;

    #[test]
    fn names_that_repeat_are_found() {
        let (folder, krate) = planted(&[
            ("lib.rs", "mod a;\nmod b;\npub struct Once;"),
            ("a.rs", "pub(crate) struct Plan;\nstruct Own;\npub trait Allowed {}"),
            ("b.rs", "struct Own;\n\npub enum Plan {}\npub union Allowed { a: u8 }\n#[cfg(test)]\npub struct Once;"),
        ]);
        let mut places = Places::new();
        collect(&krate, folder.path(), &mut places);
        assert_eq!(repeated(&places, &[("Allowed", "a test")]), ["Plan ×2: a.rs, b.rs"]);
        let idle = repeated(&places, &[("Allowed", "a test"), ("Plan", "a test"), ("Once", "a test")]);
        assert_eq!(idle, ["Once may repeat, but does not: take it from the list"]);
    }
}
