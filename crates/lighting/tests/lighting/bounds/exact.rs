//! The bounds of a patch that is one point with one normal are the terms themselves.

use halfway_lighting::Faces;
use halfway_lighting::bounds::MARGIN;
use halfway_lighting::equations::vector::{dot, length, normalize, sub};
use halfway_lighting::equations::{COINCIDENT, Eye, Incidence, ShadedPoint, incidence};
use proptest::prelude::*;

use super::support::{Kind, Scene, around, cases, exceeds, scene, source};

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn a_single_point_has_its_own_terms(
        scene in scene(),
        source in source(),
        axis in prop::array::uniform3(-1f32..1.0),
    ) {
        prop_assume!(normalize(axis).is_some());
        let scene = Scene { radius: 0.0, cone: Some((axis, 0.0)), faces: Faces::Front, ..scene };
        let mut source = around(&scene, source);
        if let Kind::Spot(cone) = &mut source.kind {
            // On the very edge of a cone, which one of cutoff 0 aimed at the point is, rounding decides.
            cone.cutoff = cone.cutoff.max(0.01);
        }
        let light = source.light::<f64>();
        let normal = normalize(axis.map(f64::from)).expect("not 0");
        let surface = ShadedPoint { position: scene.center.map(f64::from), normal };
        let terms = scene.terms(&surface, &light);
        let bounds = scene.receiver::<f64>().bounds(&light);
        prop_assert!(exceeds(&terms, &bounds, &light).is_none());
        // Where the light counts as being at the point, or the eye is there, the bounds are those of any l or v.
        let eye_inside = matches!(scene.view, Eye::Local(eye) if eye == scene.center);
        let [center, position] = [scene.center, source.position].map(|p| p.map(f64::from));
        if length(sub(position, center)) <= 1.001 * f64::from(COINCIDENT) * length(center) || eye_inside {
            return Ok(());
        }
        // A light that counts as in the plane is bounded as what it is, a little above.
        if let Some(Incidence { l, grazing, .. }) = incidence(&surface, &light)
            && dot(normal, l) <= 1.001 * grazing
        {
            return Ok(());
        }
        for c in 0..3 {
            // The cosines are raised by 32 ε, the exponents reach 4·10⁴: 3·10⁻¹⁰ of the peak.
            let slack = 1e-9 * bounds.diffuse.into_iter().chain(bounds.specular).fold(0.0, f64::max);
            let close = |bound: f64, term: f64| bound <= term * (1.0 + 2.0 * MARGIN) + slack + 1e-30;
            prop_assert!(close(bounds.diffuse[c], terms.diffuse[c]), "{bounds:?} for {terms:?}");
            prop_assert!(close(bounds.specular[c], terms.specular[c]), "{bounds:?} for {terms:?}");
        }
    }
}
