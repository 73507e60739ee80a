//! The keys of a scene file for numbers on a mesh.

use bevy_color::{ColorToComponents as _, LinearRgba};
use halfway_lighting::{Choices, Range};
use halfway_mesh::{Property, ScalarValues};

use crate::check::{Check, KeyProblem, Limits};
use crate::keys::{Keys, Object, Words, keys, named_words};
use crate::scalars::{ColorMap, MOST_LINES, Scalars};

keys! {
    /// `scalars`: numbers on the mesh, shown by a colour map. They are a property of the model file, or written out at the
    /// vertices or on the faces.
    #[derive(Clone, Debug, PartialEq)]
    pub struct ScalarsEntry {
        [optional]
        /// The name of a property of the model file, which `halfway info` lists; null: the numbers are written out.
        property: Option<String> = None,
        /// The colours.
        map: ColorMap = ColorMap::default(),
        /// The numbers that the map begins and ends with; numbers beyond have the colours of its ends. null: the least and
        /// the greatest.
        range: Option<[f32; 2]> = None,
        /// The color of numbers that are infinite or missing, linear RGB. 0 to 1e12.
        missing: [f32; 3] = Scalars::MISSING => Limits::Numbers(Range::CHANNEL),
        /// How many lines of equal numbers are drawn, evenly between the ends of the range: 0 to 100.
        isolines: u32 = 0 => Limits::Counts(0, MOST_LINES),
        [left out]
        /// One number for each vertex.
        at_vertices: Vec<f32>,
        /// One number for each triangle.
        on_faces: Vec<f32>,
    }
}

impl Keys for ColorMap {
    const NAME: &'static str = "ColorMap";
    const MEANING: &'static str = "`map`: the colours of numbers, from the lower to the upper end of their range.";
    const WORDS: Words<Self> = &named_words::<Self, { Self::CHOICES.len() }>();

    fn blank() -> Self {
        Self::default()
    }
}

impl Object for ColorMap {}

impl Object for ScalarsEntry {
    const EXPECTED: &'static str = "an object such as {\"property\": \"temperature\"}";

    fn check_whole(&self) -> Check {
        let given = [self.property.is_some(), self.at_vertices.is_some(), self.on_faces.is_some()];
        if given.iter().filter(|given| **given).count() != 1 {
            return Err(KeyProblem::new("", "expected one of the keys property, at_vertices and on_faces"));
        }
        match self.range {
            Some([low, high]) if low >= high => {
                Err(KeyProblem::new("range", format!("is [{low}, {high}]; expected the lower number first")))
            }
            _ => Ok(()),
        }
    }
}

impl ScalarsEntry {
    /// Shows a property of the model file from its least to its greatest number.
    ///
    /// ```
    /// use halfway_scene::{ColorMap, MeshEntry, ObjectEntry, ScalarsEntry};
    ///
    /// let heat = ScalarsEntry { map: ColorMap::Inferno, ..ScalarsEntry::of_property("heat") };
    /// let engine = MeshEntry::Path("engine.ply".into());
    /// let engine = ObjectEntry { scalars: Some(heat), ..ObjectEntry::new(engine) };
    /// ```
    pub fn of_property(name: impl Into<String>) -> Self {
        Self { property: Some(name.into()), ..Self::default() }
    }

    /// The numbers for the mesh of a part, from among the properties of its model; `None` for a part without. An error is
    /// a sentence.
    pub(crate) fn scalars(&self, properties: &[Property], part: usize) -> Result<Option<Scalars>, String> {
        let values = match (&self.property, &self.at_vertices, &self.on_faces) {
            (Some(name), ..) => {
                let named = || properties.iter().filter(|property| property.name == *name);
                if named().next().is_none() {
                    let mut known: Vec<_> = properties.iter().map(|property| format!("{:?}", property.name)).collect();
                    known.dedup();
                    let known = match known.as_slice() {
                        [] => "it has none; PLY files may have some".to_owned(),
                        names => format!("it has {}", names.join(", ")),
                    };
                    return Err(format!("the mesh has no property {name:?}; {known}"));
                }
                match named().find(|property| property.part == part) {
                    Some(property) => property.values.clone(),
                    None => return Ok(None),
                }
            }
            (None, Some(values), _) => ScalarValues::Vertices(values.clone()),
            (None, None, values) => ScalarValues::Faces(values.clone().unwrap_or_default()),
        };
        let missing = LinearRgba::from_f32_array_no_alpha(self.missing);
        Ok(Some(Scalars { values, range: self.range, map: self.map, missing, isolines: self.isolines }))
    }
}
