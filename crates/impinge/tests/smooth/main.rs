//! Ellipsoids and tapered capsules against an independent search for the best normal.

use impinge::math::na::{Isometry3, Matrix3, Quaternion, UnitQuaternion, Vector3};
use impinge::query::contact;
use impinge::shape::{Ellipsoid, Shape};

struct Rng(u64);
impl Rng {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
    fn s(&mut self) -> f64 {
        self.next() * 2.0 - 1.0
    }
    fn v(&mut self) -> Vector3<f64> {
        loop {
            let v = Vector3::new(self.s(), self.s(), self.s());
            if v.norm() < 1.0 && v.norm() > 0.1 {
                return v.normalize();
            }
        }
    }
}

/// h(n) = n.c - sqrt(n A n) - sqrt(n B n); returns (h, gradient, hessian)
fn height(
    n: &Vector3<f64>,
    a: &Matrix3<f64>,
    b: &Matrix3<f64>,
    c: &Vector3<f64>,
) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let (mut h, mut g, mut k) = (n.dot(c), *c, Matrix3::zeros());
    for m in [a, b] {
        let s = (n.dot(&(m * n))).sqrt();
        let p = m * n / s;
        h -= s;
        g -= p;
        k -= (m - p * p.transpose()) / s;
    }
    (h, g, k)
}

fn best(
    n: Vector3<f64>,
    a: &Matrix3<f64>,
    b: &Matrix3<f64>,
    c: &Vector3<f64>,
) -> (f64, Vector3<f64>) {
    let mut n = n;
    let (mut h, mut g, mut k) = height(&n, a, b, c);
    for _ in 0..200 {
        let p = Matrix3::identity() - n * n.transpose();
        let r = p * g;
        let hess = p * k * p - p * h;
        // negative definite? shift
        let e = hess.symmetric_eigen();
        let mut d = Vector3::zeros();
        for i in 0..3 {
            let u = e.eigenvectors.column(i).into_owned();
            if u.dot(&n).abs() > 0.5 {
                continue;
            }
            let l = e.eigenvalues[i].abs().max(1e-300);
            d += u * (u.dot(&r) / l);
        }
        let mut t = 1.0;
        let mut ok = false;
        for _ in 0..60 {
            let n2 = (n + d * t).normalize();
            let q = height(&n2, a, b, c);
            if q.0 > h {
                n = n2;
                h = q.0;
                g = q.1;
                k = q.2;
                ok = true;
                break;
            }
            t *= 0.5;
        }
        if !ok {
            break;
        }
    }
    (h, n)
}

#[test]
fn ellipsoids() {
    let mut rng = Rng(1);
    for aspect in [1.0f64, 10.0, 100.0, 1e4] {
        for place in [2.0, 1.0, 0.5, 0.1, 0.0] {
            let (mut worst, mut global, mut bad) = (0.0f64, 0.0f64, 0);
            for _ in 0..200 {
                let mut half =
                    || Vector3::new(1.0, aspect.powf(-rng.next()), aspect.powf(-rng.next()));
                let (h1, h2) = (half(), half());
                let (e1, e2) = (Ellipsoid::<f64, 3>::new(h1), Ellipsoid::<f64, 3>::new(h2));
                let mut turn = || {
                    let v = rng.v();
                    UnitQuaternion::new_normalize(Quaternion::new(rng.s(), v.x, v.y, v.z))
                };
                let (q1, q2) = (turn(), turn());
                let c = rng.v() * place * (1.0 + 1.0 / aspect.sqrt());
                let (m1, m2) = (
                    Isometry3::from_parts(Vector3::zeros().into(), q1),
                    Isometry3::from_parts(c.into(), q2),
                );
                let f = contact(&m1, &e1 as &dyn Shape<f64, 3>, &m2, &e2, f64::INFINITY).unwrap();
                let mat = |q: &UnitQuaternion<f64>, h: &Vector3<f64>| {
                    let r = q.to_rotation_matrix().into_inner();
                    r * Matrix3::from_diagonal(&h.component_mul(h)) * r.transpose()
                };
                let (a, b) = (mat(&q1, &h1), mat(&q2, &h2));
                let (near, _) = best(*f.normal, &a, &b, &c);
                let mut glob = near;
                for _ in 0..10 {
                    let (h, _) = best(rng.v(), &a, &b, &c);
                    glob = glob.max(h);
                }
                let e = (near + f.depth).abs();
                worst = worst.max(e);
                if glob + f.depth > 1e-9 {
                    bad += 1;
                }
                global = global.max(glob + f.depth);
            }
            println!(
                "aspect {aspect:8} place {place}: local {worst:.2e} global {global:.2e} bad {bad}"
            );
        }
    }
}

#[test]
fn segments() {
    use impinge::math::Point;
    use impinge::query::{PointQuery, contact as c};
    use impinge::shape::{Segment, TaperedCapsule};
    let mut rng = Rng(5);
    for ratio in [1.0, 30.0, 1000.0] {
        let mut worst = 0.0f64;
        for case in 0..3000 {
            let mut p = |s: f64| Point::from(rng.v() * s);
            let (a, b, ca, cb) = (p(1.0), p(1.0), p(ratio), p(ratio));
            let radii = [rng.next() * ratio, rng.next() * ratio];
            let shift = rng.v() * ratio * 1.5;
            let (a, b) = (a + shift, b + shift);
            let seg = Segment::<f64, 3>::new(a, b);
            for which in 0..2 {
                let t: Box<dyn Shape<f64, 3>> = if which == 0 {
                    Box::new(TaperedCapsule::<f64, 3>::try_from_ends(ca, cb, radii).unwrap())
                } else {
                    Box::new(Ellipsoid::<f64, 3>::new(ca.coords.map(f64::abs)))
                };
                let id = Isometry3::identity();
                if std::env::var("CASE").is_ok_and(|x| x != format!("{ratio}-{case}-{which}")) {
                    continue;
                }
                let f = c(&id, &seg as &dyn Shape<f64, 3>, &id, &*t, f64::INFINITY).unwrap();
                if f.depth > -1e-9 {
                    continue;
                }
                let d = |x: f64| t.distance_to_point(&id, &(a + (b - a) * x), false);
                let (mut lo, mut hi) = (0.0, 1.0);
                for _ in 0..200 {
                    let (m1, m2) = (lo + (hi - lo) / 3.0, hi - (hi - lo) / 3.0);
                    if d(m1) < d(m2) { hi = m2 } else { lo = m1 }
                }
                let best = d(0.0).min(d(1.0)).min(d(0.5 * (lo + hi)));
                let e = (best + f.depth).abs() / ratio;
                if e > worst {
                    worst = e;
                    println!(
                        "{ratio} case {case} {which}: {e:.2e} found {} expected {best} {a:?} {b:?} {ca:?} {cb:?} {radii:?}",
                        -f.depth
                    );
                }
            }
        }
    }
}
