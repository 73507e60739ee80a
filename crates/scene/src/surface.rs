//! Surfaces by formula in scene files, each with its name, its lengths and how finely it is cut into triangles.

use std::ops::Bound::Included;
use std::path::{Path, PathBuf};

use bevy_math::{DVec3, Vec3};
use halfway_lighting::Range;
use halfway_mesh::{
    BezierPatch, Capsule, Cone, Cylinder, Disc, Ellipsoid, HeightField, Hyperboloid, HyperboloidSheet, Icosphere, Mesh,
    Paraboloid, ParametricSurface, SurfaceError, Tessellation, Torus, tessellate,
};
use halfway_texture::TexelMeaning;

use crate::check::{Check, KeyProblem, Limits};
use crate::keys::{Fill, Key, Object, Visit, keys};

/// A length of a surface.
pub(crate) const LENGTH: Limits =
    Limits::Numbers(Range::new(Included(1e-30), Included(1e30), "a length from 1e-30 to 1e30"));
const ROWS: Limits = Limits::Counts(1, Tessellation::MAX_ROWS);
const COLUMNS: Limits = Limits::Counts(1, Tessellation::MAX_COLUMNS);
const CHORD_ERROR: Limits = Limits::Numbers(Range::POSITIVE);

/// Why a surface cannot be made.
pub(crate) enum SurfaceFault {
    /// Of the fields of a surface.
    Surface(SurfaceError),
    /// Of a file, as a sentence.
    File(String),
}

impl From<SurfaceError> for SurfaceFault {
    fn from(error: SurfaceError) -> Self {
        Self::Surface(error)
    }
}

/// Generates the entries of surfaces from a table: each with its keys and those of its fineness, and an enum of all.
macro_rules! surfaces {
    ($(
        $(#[doc = $about:literal])*
        $kind:ident $name:ident $entry:ident {
            $($(#[doc = $doc:literal])* $key:ident: $type:ty = $default:expr $(=> $limits:expr)?,)*
            $([left out] $($(#[doc = $odoc:literal])* $okey:ident: $otype:ty $(=> $olimits:expr)?,)*)?
        }
        cut into [$rows:literal, $columns:literal]
        by $make:expr;
    )*) => {
        $(keys! {
            $(#[doc = $about])*
            #[derive(Clone, Debug, PartialEq)]
            pub struct $entry {
                [optional]
                $($(#[doc = $doc])* $key: $type = $default $(=> $limits)?,)*
                /// Rows of cells along its first parameter, 1 to 2048.
                rows: u32 = $rows => ROWS,
                /// Columns of cells along its second parameter, 1 to 4096.
                columns: u32 = $columns => COLUMNS,
                /// In place of `rows` and `columns`: how far a point of the surface may be from its triangle, above 0;
                /// null: as many as they say.
                chord_error: Option<f32> = None => CHORD_ERROR,
                $([left out] $($(#[doc = $odoc])* $okey: $otype $(=> $olimits)?,)*)?
            }
        }

        impl Object for $entry {
            const EXPECTED: &'static str = concat!("an object with the keys of `", stringify!($name), "`");
        })*

        /// A surface by formula.
        #[derive(Clone, Debug, PartialEq)]
        pub enum SurfaceEntry {
            $($(#[doc = $about])* $kind($entry)),*
        }

        /// The keys of all surfaces.
        pub(crate) const SURFACES: &[&str] = &[$(stringify!($name)),*];

        impl SurfaceEntry {
            pub(crate) fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
                match self {
                    $(Self::$kind(entry) => {
                        visitor.key(&Key::required(stringify!($name), concat!($($about),*)), Some(entry))
                    })*
                }
            }

            pub(crate) fn fill<F: Fill>(from: &mut F, mut put: impl FnMut(Self)) -> Result<(), F::Error> {
                $(from.key(&Key::required(stringify!($name), concat!($($about),*)), |entry| put(Self::$kind(entry)))?;)*
                Ok(())
            }

            /// Its key.
            pub(crate) fn name(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => stringify!($name)),*
                }
            }

            /// The surface and its fineness. Files are relative to `base_dir`.
            fn surface(&self, base_dir: &Path) -> Result<(Box<dyn ParametricSurface>, Tessellation), SurfaceFault> {
                match self {
                    $(Self::$kind(entry) => {
                        let make: fn(&$entry, &Path) -> Result<Box<dyn ParametricSurface>, SurfaceFault> = $make;
                        let &$entry { rows, columns, chord_error, .. } = entry;
                        let surface = make(entry, base_dir)?;
                        // A height field has a cell for each of its samples' at least, which an image may have many of.
                        let least = if stringify!($name) == "height_field" { surface.least_counts() } else { [0; 2] };
                        let by_count = Tessellation::Count { rows: rows.max(least[0]), columns: columns.max(least[1]) };
                        let fineness = chord_error.map_or(by_count, |error| Tessellation::ChordError(error.into()));
                        Ok((surface, fineness))
                    })*
                }
            }
        }
    };
}

surfaces! {
    /// An ellipsoid about the origin.
    Ellipsoid ellipsoid EllipsoidEntry {
        /// Half its lengths along x, y and z: 1e-30 to 1e30.
        radii: Vec3 = Vec3::ONE => LENGTH,
    }
    cut into [16, 32]
    by |it, _| Ok(Box::new(Ellipsoid { radii: it.radii }));

    /// A cylinder about the Y axis, its middle at the origin.
    Cylinder cylinder CylinderEntry {
        /// 1e-30 to 1e30.
        radius: f32 = 1.0 => LENGTH,
        /// 1e-30 to 1e30.
        height: f32 = 2.0 => LENGTH,
        /// Whether discs close both ends.
        capped: bool = true,
    }
    cut into [1, 32]
    by |it, _| Ok(Box::new(Cylinder { radius: it.radius, height: it.height, capped: it.capped }));

    /// A cone about the Y axis, its tip above.
    Cone cone ConeMeshEntry {
        /// Of the base: 1e-30 to 1e30.
        radius: f32 = 1.0 => LENGTH,
        /// 1e-30 to 1e30.
        height: f32 = 2.0 => LENGTH,
        /// Whether a disc closes the base.
        capped: bool = true,
    }
    cut into [4, 32]
    by |it, _| Ok(Box::new(Cone { radius: it.radius, height: it.height, capped: it.capped }));

    /// A ring about the Y axis: a tube around a circle.
    Torus torus TorusEntry {
        /// Of the circle: 1e-30 to 1e30.
        radius: f32 = 1.0 => LENGTH,
        /// Radius of the tube, less than that of the circle: 1e-30 to 1e30.
        tube: f32 = 0.25 => LENGTH,
    }
    cut into [16, 48]
    by |it, _| Ok(Box::new(Torus { radius: it.radius, tube: it.tube }));

    /// A cylinder about the Y axis with hemispheres at its ends.
    Capsule capsule CapsuleEntry {
        /// 1e-30 to 1e30.
        radius: f32 = 0.5 => LENGTH,
        /// The length of the cylinder: 1e-30 to 1e30.
        length: f32 = 1.0 => LENGTH,
    }
    cut into [24, 32]
    by |it, _| Ok(Box::new(Capsule { radius: it.radius, length: it.length }));

    /// A flat disc.
    Disc disc DiscEntry {
        /// Its middle.
        center: [f32; 3] = [0.0; 3],
        /// The direction that it faces, of any length above 0.
        normal: [f32; 3] = [0.0, 1.0, 0.0],
        /// 1e-30 to 1e30.
        radius: f32 = 1.0 => LENGTH,
    }
    cut into [1, 48]
    by |it, _| Ok(Box::new(Disc::new(Vec3::from(it.center).into(), Vec3::from(it.normal).into(), it.radius.into())?));

    /// A paraboloid about the Y axis, open below.
    Paraboloid paraboloid ParaboloidEntry {
        /// Of the rim: 1e-30 to 1e30.
        radius: f32 = 1.0 => LENGTH,
        /// 1e-30 to 1e30.
        height: f32 = 1.0 => LENGTH,
    }
    cut into [16, 32]
    by |it, _| Ok(Box::new(Paraboloid { radius: it.radius, height: it.height }));

    /// A hyperboloid of one sheet about the Y axis, open at both ends.
    Hyperboloid hyperboloid HyperboloidEntry {
        /// The radius in the middle: 1e-30 to 1e30.
        waist: f32 = 0.5 => LENGTH,
        /// The radius of the rims, greater than the waist: 1e-30 to 1e30.
        radius: f32 = 1.0 => LENGTH,
        /// 1e-30 to 1e30.
        height: f32 = 2.0 => LENGTH,
    }
    cut into [16, 32]
    by |it, _| Ok(Box::new(Hyperboloid { waist: it.waist, radius: it.radius, height: it.height }));

    /// One of the two sheets of a hyperboloid about the Y axis.
    HyperboloidSheet hyperboloid_sheet HyperboloidSheetEntry {
        /// The distance between the tips of both sheets: 1e-30 to 1e30.
        gap: f32 = 1.0 => LENGTH,
        /// The radius of the rim: 1e-30 to 1e30.
        radius: f32 = 1.0 => LENGTH,
        /// From the tip to the rim: 1e-30 to 1e30.
        height: f32 = 1.0 => LENGTH,
        /// Whether it is the upper sheet, which opens upward. It shows its outside to the other one.
        upper: bool = true,
    }
    cut into [16, 32]
    by |it, _| {
        let &HyperboloidSheetEntry { gap, radius, height, upper, .. } = it;
        Ok(Box::new(HyperboloidSheet { gap, radius, height, upper }))
    };

    /// A Bézier patch.
    Bezier bezier BezierEntry {
        /// Its control points [x, y, z]: a list of 2 to 33 rows of 2 to 33 points each.
        points: Vec<Vec<[f32; 3]>> = vec![
            vec![[1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]],
            vec![[1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]],
        ],
    }
    cut into [16, 16]
    by |it, _| {
        let (columns, points) = rows_of_points(&it.points, "points")?;
        Ok(Box::new(BezierPatch::new(columns, points)?))
    };

    /// A polynomial patch: the sum of c·uⁱ·vʲ, u and v from 0 to 1, c being the j-th coefficient in the i-th row.
    Polynomial polynomial PolynomialEntry {
        /// The coefficients [x, y, z]: a list of 2 to 33 rows of 2 to 33 each.
        coefficients: Vec<Vec<[f32; 3]>> = vec![
            vec![[1.0, 0.0, -1.0], [-2.0, 0.0, 0.0]],
            vec![[0.0, 0.0, 2.0], [0.0, 0.0, 0.0]],
        ],
    }
    cut into [16, 16]
    by |it, _| {
        let (columns, points) = rows_of_points(&it.coefficients, "coefficients")?;
        Ok(Box::new(BezierPatch::from_polynomial(columns, points)?))
    };

    /// Heights over a rectangle in the xz plane, which a smooth surface goes through; it faces +Y.
    HeightField height_field HeightFieldEntry {
        /// The lengths of the rectangle along x and z: 1e-30 to 1e30.
        size: [f32; 2] = [2.0, 2.0] => LENGTH,
        /// How high a 1 is.
        amount: f32 = 1.0,
        [left out]
        /// An image file, as a PNG or EXR, relative to the scene file, whose first channel has the heights, its top row at
        /// the far side; or `heights`. 2 to 2049 rows of 2 to 4097 pixels.
        path: PathBuf,
        /// Rows of heights from −z to +z, each from −x to +x; or `path`.
        heights: Vec<Vec<f32>>,
    }
    cut into [64, 64]
    by height_field;
}

/// Rows of points as one list, and how many points a row has.
fn rows_of_points(rows: &[Vec<[f32; 3]>], name: &str) -> Result<(usize, Vec<DVec3>), SurfaceFault> {
    let columns = same_lengths(rows, name)?;
    Ok((columns, rows.iter().flatten().map(|point| Vec3::from(*point).as_dvec3()).collect()))
}

/// How many items each row has.
fn same_lengths<T>(rows: &[Vec<T>], name: &str) -> Result<usize, SurfaceFault> {
    let columns = rows.first().map_or(0, Vec::len);
    match rows.iter().position(|row| row.len() != columns) {
        None => Ok(columns),
        Some(row) => {
            let found = rows[row].len();
            Err(SurfaceFault::File(format!("`{name}[{row}]` has {found} items; expected {columns}, as the row before")))
        }
    }
}

fn height_field(it: &HeightFieldEntry, base_dir: &Path) -> Result<Box<dyn ParametricSurface>, SurfaceFault> {
    let [x, z] = it.size;
    let (columns, heights) = match (&it.heights, &it.path) {
        (Some(_), Some(_)) => return Err(SurfaceFault::File("`path` cannot stand beside `heights`".to_owned())),
        (None, None) => return Err(SurfaceFault::File("has no heights; expected `path` or `heights`".to_owned())),
        (Some(rows), None) => (same_lengths(rows, "heights")?, rows.concat()),
        (None, Some(path)) => {
            let image = halfway_texture::load(&base_dir.join(path), TexelMeaning::Data)
                .map_err(|error| SurfaceFault::File(error.to_string()))?;
            (image.size()[0] as usize, image.texels().iter().map(|texel| texel[0]).collect())
        }
    };
    let heights = heights.into_iter().map(|height| it.amount * height).collect();
    let columns = u32::try_from(columns).unwrap_or(u32::MAX);
    Ok(Box::new(HeightField::new(x, z, columns, heights)?))
}

impl SurfaceEntry {
    /// The mesh; an error is a sentence.
    pub(crate) fn mesh(&self, base_dir: &Path) -> Result<Mesh, String> {
        let made =
            self.surface(base_dir).and_then(|(surface, fineness)| Ok(tessellate(&[surface.as_ref()], fineness)?));
        made.map_err(|fault| match fault {
            SurfaceFault::Surface(SurfaceError { field, value, expected, .. }) => {
                format!("{field} is {value}; {expected}")
            }
            SurfaceFault::File(fault) => fault,
        })
    }

    /// Checks the lengths of a surface against one another; files are not looked at.
    pub(crate) fn check(&self) -> Check {
        if matches!(self, Self::HeightField(HeightFieldEntry { path: Some(_), heights: None, .. })) {
            return Ok(());
        }
        let made = self.surface(Path::new(""));
        if let Ok((surface, Tessellation::Count { rows, columns })) = &made {
            let counts = [("rows", *rows), ("columns", *columns)].into_iter().zip(surface.least_counts());
            for ((key, count), least) in counts {
                if count < least {
                    let message = format!("is {count}; expected at least {least} for this surface");
                    return Err(KeyProblem::new(format!("{}.{key}", self.name()), message));
                }
            }
        }
        made.and_then(|(surface, _)| Ok(surface.validate()?)).map_err(|fault| match fault {
            SurfaceFault::Surface(SurfaceError { field, value, expected, .. }) => {
                // Fields of one number of a vector, and counts, which a file has as lists.
                let (key, counts) = match (self, field) {
                    (Self::Bezier(_), _) => ("points", true),
                    (Self::Polynomial(_), _) => ("coefficients", true),
                    (Self::HeightField(_), "x" | "z") => ("size", false),
                    (Self::HeightField(_), _) => ("heights", true),
                    _ => (field.split_once('.').map_or(field, |(field, _)| field), false),
                };
                let message =
                    if counts { format!("{field}: {value}; {expected}") } else { format!("is {value}; {expected}") };
                KeyProblem::new(format!("{}.{key}", self.name()), message)
            }
            SurfaceFault::File(fault) => KeyProblem::new(self.name(), fault),
        })
    }
}

keys! {
    /// The value of `{"icosphere": …}`.
    impl Icosphere {
        [optional]
        /// 1e-30 to 1e30.
        radius: f32 = 1.0 => LENGTH,
        /// How many parts an edge of the icosahedron is cut into: 1 to 512.
        divisions: u32 = 8 => Limits::Counts(1, Icosphere::MAX_DIVISIONS),
    }
}

impl Object for Icosphere {
    const EXPECTED: &'static str = "an object such as {\"radius\": 1}";
}
