//! 3MF files.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use glam::{DVec3, Vec3, Vec4};
use halfway_mesh::{Format, Model, SourceMaterial, load_bytes};

use crate::common::{check_model, zip, zip_of};

const PART: &str = "3D/3dmodel.model";
const SEED: &str = include_str!("../../../../fuzz/seeds/threemf_model/plates.model");

fn archive(model: &str) -> Vec<u8> {
    zip(&[(PART, model.as_bytes())])
}

fn load(model: &str) -> Model {
    let model = load_bytes(Format::ThreeMf, &archive(model)).unwrap();
    check_model(&model);
    model
}

fn message(file: &[u8]) -> String {
    load_bytes(Format::ThreeMf, file).unwrap_err().to_string()
}

/// A model with a triangle as object 1, and more.
fn model(attributes: &str, more: &str, build: &str) -> String {
    format!(
        "<model {attributes}><resources>{more}<object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>\
         <vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles>\
         <triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object></resources><build>{build}</build></model>"
    )
}

const ITEM: &str = "<item objectid=\"1\"/>";

#[test]
fn the_build_is_read_with_its_places_and_materials() {
    let packed = load_bytes(Format::ThreeMf, include_bytes!("../../../../fuzz/seeds/threemf/plates.3mf")).unwrap();
    let model = load(SEED);
    assert_eq!(packed, model);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    // Three plates: a triangle of the object's material, and one of the colours.
    assert_eq!(model.parts.len(), 6);
    assert!(model.parts.iter().all(|part| part.name == "plate" && part.mesh.triangle_count() == 1));
    let places: Vec<Vec3> =
        model.parts.iter().map(|part| part.world_from_part.transform_point3(Vec3::new(1.0, 1.0, 0.0))).collect();
    // An inch is 25.4 mm; the first item is mirrored, and its second plate two inches off.
    let inches = [[-1.0, 1.0, 5.0], [-3.0, 1.0, 5.0], [1.0, 1.0, 0.0]];
    for (found, expected) in places.chunks(2).zip(inches) {
        for found in found {
            assert!((*found - Vec3::from(expected) * 25.4).length() < 1e-4, "{found} {expected:?}");
        }
    }
    let [SourceMaterial::Mtl(red)] = &model.materials[..] else { panic!("{:?}", model.materials) };
    assert_eq!((red.name.as_str(), red.kd, red.d), ("red", Some([1.0, 0.0, 0.0]), None));
    let (plain, colored) = model.parts[..2].iter().partition::<Vec<_>, _>(|part| part.material == Some(0));
    assert_eq!(plain[0].mesh.colors(), None);
    let green = Vec4::new(0.0, 1.0, 0.0, 1.0);
    assert_eq!(colored[0].mesh.colors().unwrap(), [green, Vec4::ONE, green]);
    // The object is read once.
    assert!(model.parts[0].mesh.is_clone_of(&model.parts[2].mesh));
}

#[test]
fn units_become_millimetres() {
    for (unit, size) in [
        ("micron", 0.001),
        ("millimeter", 1.0),
        ("centimeter", 10.0),
        ("inch", 25.4),
        ("foot", 304.8),
        ("meter", 1000.0),
    ] {
        let found = load(&model(&format!("unit=\"{unit}\""), "", ITEM)).bounds().unwrap().size();
        assert!((found.x / size - 1.0).abs() < 1e-6, "{unit}: {found}");
    }
    assert_eq!(load(&model("", "", ITEM)).bounds().unwrap().size(), Vec3::new(1.0, 1.0, 0.0));
}

/// Where positions are far, and where only transforms are.
#[test]
fn models_far_away_have_an_origin() {
    let far = "<item objectid=\"1\" transform=\"0.1 0 0 0 0.1 0 0 0 1 5000000 400000 0\"/>";
    let placed = load(&model("", "", far));
    let within = load(
        &model("", "", ITEM)
            .replace("x=\"0\"", "x=\"5000000\"")
            .replace("x=\"1\"", "x=\"5000000.1\"")
            .replace("y=\"1\"", "y=\"0.1\""),
    );
    for (model, middle) in [(placed, DVec3::new(5e6, 4e5, 0.0)), (within, DVec3::new(5e6, 0.0, 0.0))] {
        assert!((model.origin - middle).length() < 1.0, "{}", model.origin);
        let size = model.bounds().unwrap().size();
        assert!((size - Vec3::new(0.1, 0.1, 0.0)).length() < 1e-6, "{size}");
    }
}

/// Of the production extension: objects in other parts.
#[test]
fn components_may_lie_in_other_parts() {
    let root = "<model xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" requiredextensions=\"p\">\
        <resources><object id=\"7\"><components><component p:path=\"/3D/Objects/a.model\" objectid=\"1\"/></components></object>\
        </resources><build><item objectid=\"7\"/></build></model>";
    let other = model("", "", "");
    let file = zip(&[(PART, root.as_bytes()), ("3D/Objects/a.model", other.as_bytes())]);
    let model = load_bytes(Format::ThreeMf, &file).unwrap();
    assert_eq!((model.triangle_count(), &model.warnings[..]), (1, &[][..]));
    let missing = message(&archive(root));
    assert!(missing.starts_with("model.3mf: 3D/Objects/a.model: "), "{missing}");
}

#[test]
fn what_is_skipped_is_a_warning() {
    let rows = [
        ("", "<texture2d id=\"9\"/>", "`texture2d` is skipped"),
        ("", "<texture2dgroup id=\"9\"><tex2coord u=\"0\" v=\"0\"/></texture2dgroup>", "`texture2dgroup` is skipped"),
        ("", "<compositematerials id=\"9\"></compositematerials>", "`compositematerials` is skipped"),
        ("", "<multiproperties id=\"9\"></multiproperties>", "`multiproperties` is skipped"),
        ("", "<slicestack id=\"9\"><slice/></slicestack>", "`slicestack` is skipped"),
        ("", "<object id=\"8\" type=\"support\"/>", "objects of the type `support` are shown as others are"),
        ("", "<object id=\"8\"><mesh><beamlattice><beams/></beamlattice></mesh></object>", "`beamlattice` is skipped"),
        ("requiredextensions=\"s\" xmlns:s=\"urn:s\"", "", "the required extension urn:s is not read"),
    ];
    for (attributes, more, expected) in rows {
        assert_eq!(load(&model(attributes, more, ITEM)).warnings, [expected], "{more}");
    }
    for reference in ["pid=\"5\" p1=\"0\"", "pid=\"6\" p1=\"1\"", "pid=\"7\" p1=\"0\" p2=\"1\""] {
        let groups = "<basematerials id=\"6\"><base name=\"a\" displaycolor=\"#010203\"/></basematerials>\
            <colorgroup id=\"7\"><color color=\"#010203\"/></colorgroup>";
        let text = model("", groups, ITEM).replace("v3=\"2\"", &format!("v3=\"2\" {reference}"));
        assert_eq!(load(&text).warnings, ["the properties of 1 triangles are not there"], "{reference}");
    }
}

#[test]
fn malformed_files_are_refused() {
    let rows = [
        (
            model("unit=\"mile\"", "", ITEM),
            "byte 19: `model`: the unit `mile`; micron, millimeter, centimeter, inch, foot or meter is expected",
        ),
        (
            model("", "", "<item objectid=\"2\"/>"),
            "build: the object 2 of 3D/3dmodel.model; an object that is there is expected",
        ),
        (model("", "", "<item/>"), "`item`: no `objectid`; it is expected"),
        (
            model("", "", "<item objectid=\"1\" transform=\"1 0 0\"/>"),
            "`item`: `transform`; twelve numbers are expected",
        ),
        (
            model("", "", "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 inf 0\"/>"),
            "`item`: `transform`; twelve finite numbers are expected",
        ),
        (
            model("", "", ITEM).replace("v3=\"2\"", "v3=\"3\""),
            "`triangle`: the vertex 3; one of the 3 vertices before it, counted from 0, is expected",
        ),
        (
            model("", "", ITEM).replace("v3=\"2\"", "v3=\"-2\""),
            "`triangle`: `v3` \"-2\"; a number from 0 to 4294967295 is expected",
        ),
        (model("", "", ITEM).replace("x=\"1\"", "x=\"nan\""), "`vertex`: `x` \"nan\"; a finite number is expected"),
        (model("", "<object id=\"1\"/>", ITEM), "`object`: a second object 1; one of each number is expected"),
        (
            model("", "<colorgroup id=\"2\"><color color=\"red\"/></colorgroup>", ITEM),
            "`color`: `color` \"red\"; a colour as #RRGGBB or #RRGGBBAA is expected",
        ),
        (model("", "", ITEM).replace("</model>", "</mode>"), "well-formed XML is expected"),
        (model("", "", ITEM)[..200].to_owned(), "expected"),
        (model("", "", ITEM).replace("v3=\"2\"", "v3=2"), "attributes as name=\"value\" are expected"),
        (model("", "", ""), "model.3mf: no triangles, lines or points; at least one is expected"),
        (
            model("", "", "<item objectid=\"1\" transform=\"1e300 0 0 0 1 0 0 0 1 0 0 0\"/>"),
            "build: an object beyond f32; finite positions are expected",
        ),
    ];
    for (text, expected) in rows {
        let message = message(&archive(&text));
        assert!(message.starts_with("model.3mf: ") && message.ends_with(expected), "{text}: {message}");
    }
    assert_eq!(
        message(&zip(&[("a.txt", b"a")])),
        "model.3mf: archive: no model in it; a part that ends in `.model` is expected"
    );
    assert!(message(b"not an archive").ends_with("; a zip archive is expected"));
    // Components within themselves.
    let ring = "<object id=\"2\"><components><component objectid=\"2\"/></components></object>";
    let message = message(&archive(&model("", ring, "<item objectid=\"2\"/>")));
    assert!(message.ends_with("components: more than 32 in one another; fewer are expected"), "{message}");
}

/// A small file cannot ask for much memory or time.
#[test]
fn bombs_are_refused() {
    let spaces = model("", &" ".repeat(1 << 22), ITEM);
    let mut packed = DeflateEncoder::new(Vec::new(), Compression::best());
    packed.write_all(spaces.as_bytes()).unwrap();
    let packed = packed.finish().unwrap();
    let file = zip_of(&[(PART, &packed, 8, spaces.len())], &[(PART, spaces.as_bytes())]);
    let found = message(&file);
    assert!(found.contains("it unpacks to more than 50 times the bytes of the file"), "{found}");

    let double = |id: u32| {
        let one = format!("<component objectid=\"{}\"/>", id - 1);
        format!("<object id=\"{id}\"><components>{one}{one}</components></object>")
    };
    let text: String = (2..30).map(double).collect();
    let found = message(&archive(&model("", &text, "<item objectid=\"29\"/>")));
    assert!(found.contains("build: components within components; at most "), "{found}");
}
