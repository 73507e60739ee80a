//! Upper bounds of what a light adds to a patch of surface, to leave out lights that cannot change a pixel.
//!
//! A [`Patch`] is an object or a part of one: a sphere around its points, a cone around its normals, and its thickness.
//! A [`Receiver`] is a patch with its material and its viewer; for any light it gives [`TermBounds`], upper bounds of
//! the three terms of [`equations::light_terms`](crate::equations::light_terms) over all points and normals of the
//! patch. [`Receiver::select`] lists the lights that a patch needs: with a tolerance of 0 it leaves out the terms that
//! are 0 all over the patch, otherwise also the weakest terms, as long as the *sum* of their bounds stays within the
//! tolerance. [`LightTree::select`] gives the same lists without visiting the lights that are out of range.
//! [`linear_tolerance`] converts a tolerance from the picture's encoding to intensities.
//!
//! # The bound
//! With the sphere (c, r) and the cone (k, α) of the patch, D = ‖L − c‖ and sin al = r/D, every l of the patch lies
//! within al of l0 = (L − c)/D, and likewise every v within av of v0; where the light (or the eye) is inside the
//! sphere, al = π, and for a directional light (an infinite viewer) al = 0.
//!
//! | factor | at most | because |
//! |---|---|---|
//! | attenuation and range | their value at the larger of D − r and the distance from the patch's disk | both fall with the distance |
//! | spot | its value at max(∠(−l0, axis) − al, 0) | it falls with the angle |
//! | n·l | cos max(∠(k, l0) − α − al, 0), and cos max(arccos((H + t)/d) − α, 0), H the light's height over the patch's middle plane, t half its thickness | angles between directions obey the triangle inequality |
//! | S of Blinn–Phong | cos^β max(∠(k, h0) − α − ah, 0), h0 = (l0 + v0)/‖l0 + v0‖, sin ah = (2 sin(al/2) + 2 sin(av/2))/‖l0 + v0‖ | l + v moves by at most the sum of the two chords |
//! | S of Phong | cos^α max(∠(r0, v0) − 2α − al − av, 0), r0 = 2(k·l0)k − l0 | turning n by an angle turns r by twice that |
//! | lerp(ground, sky, (1 + n·d)/2) | the larger of its values at cos max(∠(k, d) − α, 0) and −cos max(∠(k, −d) − α, 0), a channel by itself | it is linear in n·d |
//!
//! S is 0 where n·l can only be ≤ 0. Each factor is bounded by itself, so the bound of a term is reached only where one
//! point of the patch is nearest, faces the light most and sees the highlight at once.
//!
//! # Terms that are 0
//! Signs tell first which terms are 0 all over the patch; with a tolerance of 0 that is all that needs to be known. With
//! the light's height H = k·(L − c), its distance ρ from the axis through c along k, and half the thickness t:
//!
//! | term | is 0 where | because |
//! |---|---|---|
//! | all | D − r > R, or the distance from the disk is at least R | the range R ends before the patch |
//! | all | ∠(−l0, axis) − al > cutoff | the cone passes the patch by |
//! | diffuse, specular | H·cos α + ρ·sin α + r ≤ 0 | n·(L − p) is at most that over the sphere, if ∠(k, l0) ≥ α |
//! | diffuse, specular | (H + t)·cos α + (ρ + r)·sin α ≤ 0 | n·(L − p) is at most that over the disk, if H + t ≤ 0 |
//! | specular (Phong) | cos ∠(r0, v0) ≤ −sin(2α + av + al) and 2α + av + al < π/2 | ∠(r, v) is then at least π/2 |
//!
//! # Rounding
//! A bound evaluated in `f32` holds for the exact terms of the same scene: angles are carried as cosine and sine, every
//! cosine is raised by 32 ε of the number type, radii are widened and distances shortened by as much, and the terms are
//! multiplied by 1 + [`MARGIN`]. A sign is trusted only beyond 32 ε of the lengths it is made of. Below the smallest
//! normal number of the type a term counts as 0. The bounds do not include what a renderer's own rounding adds.
//!
//! ```
//! use halfway_lighting::bounds::{NormalCone, Patch, Receiver, STEP, Selected, linear_tolerance};
//! use halfway_lighting::equations::{Coefficients, Light, Eye};
//! use halfway_lighting::{Encoding, Faces, Material, PointLight, Reflectance, Viewer};
//!
//! // A floor tile five units before the eye, and two lights: one above the tile, one below it.
//! let tile = Patch {
//!     center: [0.0f32, -1.0, -5.0],
//!     radius: 1.0,
//!     normals: Some(NormalCone { axis: [0.0, 1.0, 0.0], half_angle: 0.0 }),
//!     half_thickness: 0.0,
//!     faces: Faces::Front,
//! };
//! let lights: [Light<f32>; 2] = [[0.0, 1.0, -5.0], [0.0, -3.0, -5.0]].map(|place| PointLight::white().at(place));
//! let material = Coefficients::from(&Material::BRASS);
//! let receiver = Receiver::new(&tile, &material, &Eye::in_eye_space(Viewer::Local), Reflectance::BlinnPhong);
//!
//! let tolerance = [linear_tolerance(Encoding::Srgb, 0.5 * STEP, 0.0); 3];
//! let mut selected = Selected::default();
//! receiver.select((0..).zip(&lights), tolerance, &mut selected);
//! assert_eq!(selected.diffuse, [0]);
//! ```

mod angle;
mod patch;
mod receiver;
mod tolerance;

pub use crate::light_tree::LightTree;
pub use crate::light_tree::Selected;
pub use patch::{NormalCone, Patch};
pub use receiver::{LitTerms, MARGIN, Receiver, TermBounds};
pub use tolerance::{STEP, linear_tolerance};
