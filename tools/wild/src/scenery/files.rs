//! The files that scenes name.

/// The images that random scenes name, relative to the folder of the scene, and their contents: environments, and
/// normal maps.
pub const IMAGES: [(&str, &[u8]); 9] = [
    ("environments/dusk.png", include_bytes!("../../../../tests/wild/environments/dusk.png")),
    ("environments/ball.png", include_bytes!("../../../../tests/wild/environments/ball.png")),
    ("environments/right.png", include_bytes!("../../../../tests/wild/environments/right.png")),
    ("environments/left.png", include_bytes!("../../../../tests/wild/environments/left.png")),
    ("environments/above.png", include_bytes!("../../../../tests/wild/environments/above.png")),
    ("environments/below.png", include_bytes!("../../../../tests/wild/environments/below.png")),
    ("environments/front.png", include_bytes!("../../../../tests/wild/environments/front.png")),
    ("environments/behind.png", include_bytes!("../../../../tests/wild/environments/behind.png")),
    ("images/furrows.png", include_bytes!("../../../../tests/wild/images/furrows.png")),
];

/// The models that random scenes name, likewise: lines and points, points with normals and colours, and a sheet with
/// numbers.
pub const MODELS: [(&str, &[u8]); 3] = [
    ("models/wires.obj", include_bytes!("../../../../tests/wild/models/wires.obj")),
    ("models/cloud.ply", include_bytes!("../../../../tests/wild/models/cloud.ply")),
    ("models/sheet.ply", include_bytes!("../../../../tests/wild/models/sheet.ply")),
];
