//! The mistakes that people make when they write classic lighting and shading for the first time.
//!
//! Each has a name for files and the command line, an explanation and a remedy. The oracle draws a scene with any of them
//! on purpose (`oracle::student`), and a [`Marker`](crate::marking::Marker) finds the ones that explain how a
//! picture differs.

use std::fmt;

/// The table of all mistakes: identifier, name, explanation, remedy.
macro_rules! mistakes {
    ($($id:ident $name:literal $explanation:literal $remedy:literal;)*) => {
        /// A mistake in a renderer. `Display` writes its name.
        ///
        /// ```
        /// use halfway_reference::mistakes::Mistake;
        ///
        /// let mistake = Mistake::from_name("gouraud-for-phong").expect("it is listed");
        /// assert_eq!(mistake, Mistake::GouraudForPhong);
        /// assert!(mistake.explanation().contains("vertices") && mistake.remedy().ends_with('.'));
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Mistake {
            $(#[doc = $explanation] $id),*
        }

        impl Mistake {
            /// All of them, by subject.
            pub const ALL: &'static [Self] = &[$(Self::$id),*];

            /// Its name in rubrics and reports, in lower case with hyphens.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$id => $name),*
                }
            }

            /// Its effect, a sentence.
            pub const fn explanation(self) -> &'static str {
                match self {
                    $(Self::$id => $explanation),*
                }
            }

            /// The way to correct it, a sentence.
            pub const fn remedy(self) -> &'static str {
                match self {
                    $(Self::$id => $remedy),*
                }
            }
        }
    };
}

mistakes! {
    NormalsNotRenormalised "normals-not-renormalised"
        "Interpolated normals are not brought back to unit length."
        "Normalise the normal at every fragment, after the interpolation.";
    NormalsByModelMatrix "normals-by-model-matrix"
        "Normals are transformed by the model matrix M, which tilts them where M scales unevenly."
        "Transform normals by the inverse transpose of M, then normalise them.";
    NormalsInModelSpace "normals-in-model-space"
        "Normals are not transformed at all, while positions and lights are in eye space."
        "Transform normals by the inverse transpose of the model-view matrix.";
    NormalsInWorldSpace "normals-in-world-space"
        "Normals are in world space, while positions and lights are in eye space."
        "Take normals, positions and lights into the same space.";
    NormalsReversed "normals-reversed"
        "All normals point to the other side of the surface."
        "Check the order of the factors of cross products, and the sign of the normal on either side.";
    NormalsNotFlipped "normals-not-flipped"
        "Back faces are shaded with the normal of the front."
        "Use −n where the back of a triangle is seen.";
    FaceNormals "face-normals"
        "Every fragment is shaded with the normal of its triangle instead of the interpolated one."
        "Interpolate the normals of the vertices over the triangle.";

    GouraudForPhong "gouraud-for-phong"
        "Lighting is evaluated at the vertices and colours are interpolated (Gouraud); Phong shading is asked for."
        "Interpolate the normals, and evaluate the lighting at every fragment.";
    PhongForGouraud "phong-for-gouraud"
        "Lighting is evaluated at every fragment (Phong shading); Gouraud shading is asked for."
        "Evaluate the lighting at the vertices, and interpolate the colours.";
    FlatForSmooth "flat-for-smooth"
        "Each triangle has a single shade; Gouraud or Phong shading is asked for."
        "Use the normals of the vertices, and interpolate.";
    GouraudForFlat "gouraud-for-flat"
        "Lighting is evaluated at the vertices and interpolated (Gouraud); flat shading is asked for."
        "Evaluate the lighting once a triangle, at its centroid, with the triangle's own normal.";
    PhongForFlat "phong-for-flat"
        "Lighting is evaluated at every fragment with interpolated normals (Phong shading); flat shading is asked for."
        "Evaluate the lighting once a triangle, at its centroid, with the triangle's own normal.";
    FlatFromFirstVertex "flat-from-first-vertex"
        "A flat triangle has the shade of its first vertex, with that vertex's position and normal."
        "Evaluate flat shading at the centroid, with the triangle's own normal.";
    FlatFromLastVertex "flat-from-last-vertex"
        "A flat triangle has the shade of its last vertex, with that vertex's position and normal."
        "Evaluate flat shading at the centroid, with the triangle's own normal.";
    AffineInterpolation "affine-interpolation"
        "Values are interpolated linearly over the picture, without regard to perspective."
        "Interpolate value/w and 1/w, and divide (perspective-correct interpolation).";

    PhongForBlinn "phong-for-blinn"
        "Highlights are Phong's, (r·v)^α; Blinn–Phong's are asked for."
        "Use (n·h)^β with the halfway vector h.";
    BlinnForPhong "blinn-for-phong"
        "Highlights are Blinn–Phong's, (n·h)^β; Phong's are asked for."
        "Use (r·v)^α with the reflected direction r.";
    ExponentNotMatched "exponent-not-matched"
        "The exponent of Blinn–Phong highlights is the material's own; a matched one is asked for."
        "Use the matched exponent, about four times the material's.";
    ShininessIgnored "shininess-ignored"
        "The cosine of the highlight is not raised to the power of the shininess."
        "Raise (r·v) or (n·h) to the power of the material's shininess.";
    HighlightMissing "highlight-missing"
        "The specular term is missing."
        "Add the specular term ks·Ls·S of every light.";
    HighlightBehind "highlight-behind"
        "Highlights are not cut where the light is behind the surface (n·l ≤ 0)."
        "Set the specular term to 0 where n·l ≤ 0.";
    HighlightTimesCosine "highlight-times-cosine"
        "The specular term is multiplied by n·l, as only the diffuse term should be."
        "Multiply the diffuse term alone by n·l.";
    HighlightInSurfaceColor "highlight-in-surface-color"
        "The specular term takes the diffuse reflectance kd in place of ks."
        "Multiply the specular term by ks.";
    HighlightInDiffuseLight "highlight-in-diffuse-light"
        "The specular term takes the light's diffuse colour Ld in place of its specular colour Ls."
        "Multiply the specular term by Ls.";
    HalfwayNotUnit "halfway-not-unit"
        "The halfway vector is (l + v)/2, which is shorter than 1."
        "Normalise l + v.";
    ReflectionReversed "reflection-reversed"
        "The reflected direction r points into the surface, as reflect(l, n) of GLSL gives it."
        "Use r = 2(n·l)n − l, which is reflect(−l, n) in GLSL.";
    ViewReversed "view-reversed"
        "The view vector points from the eye to the surface."
        "Use v = (eye − p)/‖eye − p‖.";
    ViewNotUnit "view-not-unit"
        "The view vector is not brought to unit length."
        "Normalise v before it is used.";
    ViewerAtInfinity "viewer-at-infinity"
        "The view vector is the same at every point; the viewer's own position is asked for."
        "Use v = (eye − p)/‖eye − p‖ at every point.";
    ViewerLocal "viewer-local"
        "The view vector is taken toward the viewer's position; a viewer at infinity is asked for."
        "Use the constant direction toward the viewer, (0, 0, 1) in eye space.";
    ViewerAtWorldOrigin "viewer-at-world-origin"
        "The view vector is taken toward the origin of the world instead of the camera."
        "Use the camera's position, which is the origin in eye space only.";

    DiffuseMissing "diffuse-missing"
        "The diffuse term is missing."
        "Add the diffuse term kd·Ld·max(n·l, 0) of every light.";
    CosineNotClamped "cosine-not-clamped"
        "Lights behind a surface take light away, since n·l below 0 is not clamped."
        "Use max(n·l, 0).";
    CosineAbsolute "cosine-absolute"
        "Surfaces are lit from behind as well, since the absolute value of n·l is used."
        "Use max(n·l, 0).";
    LightNotUnit "light-not-unit"
        "The vector toward a light is not brought to unit length."
        "Normalise l before it is used.";
    FirstLightOnly "first-light-only"
        "Only the first light counts."
        "Sum the terms of all lights.";
    LastLightOnly "last-light-only"
        "Only the last light counts, as where each light overwrites the one before."
        "Sum the terms of all lights: += in place of =.";
    SpecularSwapped "specular-swapped"
        "The diffuse and the specular reflectance are swapped."
        "Multiply the diffuse term by kd and the specular term by ks.";

    AmbientMissing "ambient-missing"
        "Ambient light is missing."
        "Add ka times the global ambient light and the ambient colours of the lights.";
    AmbientNotTimesKa "ambient-not-times-ka"
        "Global ambient light is added without the material's ka."
        "Multiply the global ambient light by ka.";
    AmbientByKd "ambient-by-kd"
        "Ambient light is multiplied by the diffuse reflectance kd in place of ka."
        "Multiply ambient light by ka.";
    AmbientForEachLight "ambient-for-each-light"
        "Global ambient light is added once for each light."
        "Add the global ambient light once, outside the loop over the lights.";
    LightAmbientMissing "light-ambient-missing"
        "The ambient colours of the lights are missing."
        "Add ka·La of every light.";
    EmissionMissing "emission-missing"
        "The emission of the material is missing."
        "Add ke.";

    AttenuationMissing "attenuation-missing"
        "Lights are equally strong at any distance."
        "Multiply by 1/(a + b·d + c·d²).";
    AttenuationSwapped "attenuation-swapped"
        "The linear and the quadratic coefficient of the attenuation are swapped."
        "Use b for d and c for d².";
    AttenuationInverseSquare "attenuation-inverse-square"
        "Attenuation is 1/d², whatever the coefficients of the light."
        "Use 1/(a + b·d + c·d²).";
    AttenuationOfDirectional "attenuation-of-directional"
        "Directional lights are attenuated, as though their direction were a position."
        "Attenuate only lights that have a position.";
    AttenuationOfDiffuseOnly "attenuation-of-diffuse-only"
        "Attenuation weakens the diffuse term and not the highlight."
        "Multiply both terms by the attenuation.";
    AttenuationByEyeDistance "attenuation-by-eye-distance"
        "Attenuation takes the distance from the eye instead of the distance from the light."
        "Measure d from the light to the surface point.";
    AmbientAttenuated "ambient-attenuated"
        "Attenuation and cones weaken the ambient colours of the lights, too."
        "Leave ambient light as it is unless the light says otherwise.";
    AmbientNotAttenuated "ambient-not-attenuated"
        "Attenuation and cones do not weaken the ambient colours of lights that ask for it."
        "Multiply La by the attenuation and the cone.";
    RangeIgnored "range-ignored"
        "Lights go on beyond their range."
        "Multiply by the range's window, clamp(1 − (d/range)⁴, 0, 1)².";

    CutoffAsFullAngle "cutoff-as-full-angle"
        "The cutoff of spots is taken as the full angle of the cone, so that cones are half as wide."
        "The cutoff is the angle between the axis and the edge: compare cos φ with cos(cutoff).";
    CutoffDoubled "cutoff-doubled"
        "The cones of spots are twice as wide as the cutoff."
        "The cutoff is the angle between the axis and the edge: compare cos φ with cos(cutoff).";
    CutoffInDegrees "cutoff-in-degrees"
        "The cosine of the cutoff is computed from degrees as though they were radians."
        "Convert degrees to radians before taking the cosine.";
    CutoffIgnored "cutoff-ignored"
        "Spots light everything, also outside their cones."
        "Set the light to 0 where cos φ < cos(cutoff).";
    SpotExponentIgnored "spot-exponent-ignored"
        "Spots do not weaken toward the edge of the cone, since their exponent is ignored."
        "Multiply by (cos φ)^e.";
    SpotInnerIgnored "spot-inner-ignored"
        "Spots end in a hard edge, since their inner angle is ignored."
        "Fade from the inner angle to the cutoff.";
    SpotReversed "spot-reversed"
        "Spots shine to the other side."
        "φ is the angle between the spot's direction and −l, the way from the light to the point.";
    SpotDirectionInWorldSpace "spot-direction-in-world-space"
        "The directions of spots are left in world space, while everything else is in eye space."
        "Rotate the directions of spots into eye space.";

    LightPositionInWorldSpace "light-position-in-world-space"
        "The positions of lights are left in world space, so that lights move along with the camera."
        "Transform the positions of lights by the view matrix.";
    LightDirectionInWorldSpace "light-direction-in-world-space"
        "The directions of directional lights are left in world space, so that these lights turn with the camera."
        "Rotate the directions of lights into eye space.";
    LightDirectionReversed "light-direction-reversed"
        "Directional lights shine from the opposite side."
        "l points toward the light, against the direction in which it shines.";
    DirectionAsPosition "direction-as-position"
        "The direction toward a directional light is used as the position of a light."
        "A directional light has the same l at every point.";

    WindingReversed "winding-reversed"
        "Front and back are mistaken for each other: the winding of triangles is read the other way round."
        "A front face winds counter-clockwise as seen.";
    BackFacesNotCulled "back-faces-not-culled"
        "Faces are drawn that should be culled."
        "Cull the side that the object does not show.";
    BackFacesCulled "back-faces-culled"
        "Back faces of two-sided objects are missing."
        "Draw both sides of objects that show both.";
    BackMaterialIgnored "back-material-ignored"
        "Back faces have the material of the front."
        "Use the back's own material where the back of a triangle is seen.";
    DepthTestMissing "depth-test-missing"
        "Surfaces drawn later cover nearer ones: depths are not compared."
        "Keep the nearest surface of every pixel in a depth buffer.";
    DepthTestReversed "depth-test-reversed"
        "The farthest surface is seen instead of the nearest."
        "Turn the comparison of depths, or what the depth buffer is cleared to.";
    VertexColorsIgnored "vertex-colors-ignored"
        "The colours of the vertices are ignored."
        "Multiply the material by the interpolated vertex colour.";
    TexturesIgnored "textures-ignored"
        "Colour images on the objects are ignored."
        "Multiply ambient and diffuse reflectance by the image's colour.";
    OpacityIgnored "opacity-ignored"
        "Translucent objects are drawn as though they were opaque."
        "Blend: opacity·I + (1 − opacity)·(what is behind).";

    ToneMappingMissing "tone-mapping-missing"
        "Intensities are clamped to 1, although the scene asks for tone mapping or renormalisation."
        "Apply the scene's intensity policy to the finished picture.";
    ClampMissing "clamp-missing"
        "Intensities above 1 wrap around to dark colours when they become bytes."
        "Clamp every channel to [0, 1] before it is converted to a byte.";
    GammaMissing "gamma-missing"
        "Linear intensities are stored as they are; the picture is too dark."
        "Encode intensities by the sRGB curve.";
    GammaTwice "gamma-twice"
        "The sRGB curve is applied twice; the picture is too bright."
        "Encode once: neither your file library nor an sRGB target may do so again.";
    GammaUnasked "gamma-unasked"
        "The sRGB curve is applied although the scene asks for raw intensities."
        "Store 255·I.";
    GammaAsPower "gamma-as-power"
        "Intensities are encoded by I^(1/2.2) in place of the sRGB curve."
        "Use the sRGB curve with its linear part near black.";
    UpsideDown "upside-down"
        "The rows of the picture are upside down."
        "Write the top row first; OpenGL reads the bottom row first.";
    Mirrored "mirrored"
        "Left and right of the picture are exchanged."
        "Check the sign of x in the projection and in the viewport.";
    RedAndBlueSwapped "red-and-blue-swapped"
        "Red and blue are swapped."
        "Write the channels in the order red, green, blue (not BGR).";
}

impl Mistake {
    /// The mistake of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|mistake| mistake.name() == name)
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A set of mistakes that are made together.
///
/// ```
/// use halfway_reference::mistakes::{Mistake, Mistakes};
///
/// let both = Mistakes::from(Mistake::GammaTwice).with(Mistake::UpsideDown);
/// assert!(both.has(Mistake::UpsideDown) && !both.has(Mistake::Mirrored));
/// assert!(!Mistakes::NONE.has(Mistake::GammaTwice));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Mistakes(u128);

const _: () = assert!(Mistake::ALL.len() <= 128, "a set has a bit for each");

impl Mistakes {
    /// No mistake: what the oracle draws.
    pub const NONE: Self = Self(0);

    /// The set and one more.
    #[must_use]
    pub const fn with(self, mistake: Mistake) -> Self {
        Self(self.0 | 1 << mistake as u32)
    }

    /// Whether this one is made.
    pub const fn has(self, mistake: Mistake) -> bool {
        self.0 & 1 << mistake as u32 != 0
    }
}

impl From<Mistake> for Mistakes {
    fn from(mistake: Mistake) -> Self {
        Self::NONE.with(mistake)
    }
}

impl FromIterator<Mistake> for Mistakes {
    fn from_iter<I: IntoIterator<Item = Mistake>>(mistakes: I) -> Self {
        mistakes.into_iter().fold(Self::NONE, Self::with)
    }
}
