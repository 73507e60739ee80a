//! Quadrics and discs, in closed form.

use bevy_math::DVec3;
use halfway_mesh::{Disc, Quadric};

use super::ray::{Ray, SurfaceHit};

/// Pieces are enlarged by this fraction of their size, so that rounding loses no ray on the edge between two.
const SLACK: f64 = 1e-12;

/// A gradient has vanished if it is at most this fraction of the terms that it is the sum of.
const VANISHED: f64 = 1e-12;

/// A discriminant counts as 0 if it is negative by at most this fraction of its terms: a few of their rounding errors.
const TOUCHING: f64 = 4.0 * f64::EPSILON;

pub(super) fn meet_quadric(quadric: &Quadric, ray: &Ray, hits: &mut Vec<SurfaceHit>) {
    let (min, max) = (quadric.min(), quadric.max());
    let slack = DVec3::splat(SLACK * (max - min).max_element());
    let (beside, t_beside) = ray.beside(0.5 * min + 0.5 * max);
    let roots = roots(quadric, &beside);
    for root in roots.into_iter().flatten() {
        let (t, position) = (t_beside + root, beside.at(root));
        let inside = position.cmpge(min - slack).all() && position.cmple(max + slack).all();
        if inside && t > 0.0 {
            hits.push(SurfaceHit { t, position, normal: normal(quadric, position, ray.direction) });
        }
    }
}

/// The solutions of a·t² + 2b·t + c = 0 along the ray: the sum with which −b does not cancel, and the other from the
/// product of both, which is c / a.
fn roots(quadric: &Quadric, ray: &Ray) -> [Option<f64>; 2] {
    let (o, d) = (ray.origin.extend(1.0), ray.direction.extend(0.0));
    let (q_o, q_d) = (quadric.matrix() * o, quadric.matrix() * d);
    let (a, b, c) = (d.dot(q_d), o.dot(q_d), o.dot(q_o));
    let discriminant = difference_of_products(b, b, a, c);
    if discriminant < -TOUCHING * (b * b + (a * c).abs()) {
        return [None; 2];
    }
    let sum = -(b + discriminant.max(0.0).sqrt().copysign(b));
    // Along a cylinder's axis or a cone's side there is one root, or none: the quotient is not finite.
    [sum / a, c / sum].map(|t| Some(t).filter(|t| t.is_finite()))
}

/// a·b − c·d, corrected by the rounding error of the products (W. Kahan, "On the Cost of Floating-Point Computation
/// Without Extra-Precise Arithmetic", 2004).
fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let cd = c * d;
    let error = c.mul_add(-d, cd);
    a.mul_add(b, -cd) + error
}

fn normal(quadric: &Quadric, p: DVec3, direction: DVec3) -> DVec3 {
    let gradient = quadric.gradient(p);
    let matrix = quadric.matrix();
    let terms = p.abs().extend(1.0);
    let largest = (0..3).map(|i| 2.0 * matrix.row(i).abs().dot(terms)).fold(0.0, f64::max);
    if gradient.length() > VANISHED * largest {
        return gradient.normalize();
    }
    let middle = 0.5 * quadric.min() + 0.5 * quadric.max();
    (p - middle).try_normalize().unwrap_or_else(|| -direction.normalize())
}

pub(super) fn meet_disc(disc: &Disc, ray: &Ray, hits: &mut Vec<SurfaceHit>) {
    let (beside, t_beside) = ray.beside(disc.center());
    // Not finite if the ray runs along the disc.
    let root = (disc.center() - beside.origin).dot(disc.normal()) / ray.direction.dot(disc.normal());
    let (t, position) = (t_beside + root, beside.at(root));
    if t.is_finite() && t > 0.0 && position.distance(disc.center()) <= disc.radius() * (1.0 + SLACK) {
        hits.push(SurfaceHit { t, position, normal: disc.normal() });
    }
}
