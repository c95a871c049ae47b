//! Optics that a textbook states: a ball lens, a prism, a slab, a rainbow; and plain mirrors.

use super::proofs::prove;
use super::record::{Record, row, sized};
use crate::render::glass::{GLASS, Ruler, fresnel};
use crate::render::meshes::Obj;
use terrarium::math::DVec3;
use terrarium::math::random::{Counter, Stage};
use terrarium::optics::{Interface, reflected, refracted};

fn unit(random: &mut Counter) -> DVec3 {
    DVec3::new(random.value() - 0.5, random.value() - 0.5, random.value() - 0.5).normalize()
}

/// The angle between unit vectors, accurate at both ends.
fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

#[test]
fn s01_mirror_direction() {
    row("S1", |row| {
        let mut random = Counter::new(1, Stage::Test, 0);
        let (mut off, mut aside) = (0.0f64, 0.0f64);
        let pairs = sized(200_000, 1_000_000);
        for _ in 0..pairs {
            let (n, wo) = (unit(&mut random), unit(&mut random));
            let wi = reflected(wo, n);
            off = off.max((angle(wi, n) - angle(wo, n)).abs());
            aside = aside.max(wi.dot(n.cross(wo)).abs());
        }
        row.at_most(&format!("angle out less angle in, {pairs} random pairs"), off, 1e-6);
        row.at_most("how far out of the plane of incidence", aside, 1e-6);
    });
}

#[test]
fn h49_known_optics() {
    row("H49", |row| {
        ball_lens(row);
        prism(row);
        slab(row);
        rainbow(row);
    });
}

fn ball_lens(row: &mut Record) {
    let ruler = Ruler::new(4.0);
    let h = 1e-3;
    let ball = r#"(shape: sphere(), material: "glass")"#;
    let (y, weight) = ruler.measure(DVec3::new(-3.0, h, 0.0), DVec3::X, 2, GLASS, ball);
    // Behind the ball the ray falls by h/1.5 a metre through the focus.
    row.is("paraxial focus of a ball, n = 1.5, radii from its centre", 4.0 + y / (h / 1.5), 1.5, 2e-3);
    row.is_close("what of the light arrives there: (1 − F)²", weight, 0.96f64.powi(2), 1e-6);
}

fn prism(row: &mut Record) {
    let ruler = Ruler::new(2.0);
    let h = 0.75f64.sqrt();
    let outline = [DVec3::new(-0.5, 0.0, 0.0), DVec3::new(0.5, 0.0, 0.0), DVec3::new(0.0, h, 0.0)];
    let vertices = [-1.0, 1.0].iter().flat_map(|&z| outline.map(|p| p + DVec3::Z * z)).collect();
    let faces = vec![vec![0, 2, 1], vec![3, 4, 5], vec![0, 1, 4, 3], vec![1, 2, 5, 4], vec![2, 0, 3, 5]];
    Obj { vertices, normals: Vec::new(), faces }.write(&ruler.folder.path().join("prism.obj"));
    let y0 = 0.3;
    let half = (h - y0) / h * 0.5;
    let mesh = r#"(shape: mesh(path: "prism.obj", smooth: false), material: "glass")"#;
    // At the least deviation the way through is symmetric, so that the exit is at the entry's height.
    let incidence = (1.5f64 * 0.5).asin();
    let up = (incidence - 30f64.to_radians()).tan();
    let dir = DVec3::new(1.0, up, 0.0).normalize();
    let entry = DVec3::new(-half, y0, 0.0);
    let (y, _) = ruler.measure(entry - dir * 1.5, dir, 2, GLASS, mesh);
    let out = ((y - y0) / (2.0 - half)).atan();
    row.is("least deviation of a 60° prism, n = 1.5, degrees", (up.atan() - out).to_degrees(), 37.1808, 2e-4);
    row.is(
        "the same as the least over angles of incidence, by the interface's own functions",
        least_deviation(),
        37.1808,
        1e-4,
    );
}

fn least_deviation() -> f64 {
    let half = 30f64.to_radians();
    let left = DVec3::new(-libm::cos(half), libm::sin(half), 0.0);
    let right = DVec3::new(libm::cos(half), libm::sin(half), 0.0);
    let steps = sized(20_000, 200_000);
    let mut least = f64::INFINITY;
    for i in 0..steps {
        let incidence = (30.0 + 50.0 * f64::from(i) / f64::from(steps)).to_radians();
        // The incoming ray lies below the left face's normal.
        let along = DVec3::new(left.y, -left.x, 0.0);
        let d = (-left * libm::cos(incidence) + along * libm::sin(incidence)).normalize();
        let first = Interface::new(-d.dot(left), 1.5);
        let inside = refracted(-d, left, 1.5, first.cos_t);
        let second = Interface::new(inside.dot(right), 1.0 / 1.5);
        if second.reflectance < 1.0 {
            let out = refracted(-inside, -right, 1.0 / 1.5, second.cos_t);
            least = least.min(angle(out, d).to_degrees());
        }
    }
    least
}

fn slab(row: &mut Record) {
    let ruler = Ruler::new(1.5);
    let slab = r#"(shape: box(size: (1, 50, 50)), material: "glass")"#;
    let (y, weight) = ruler.measure(DVec3::new(-2.0, -2.0, 0.0), DVec3::new(1.0, 1.0, 0.0), 2, GLASS, slab);
    row.is("shift of a ray at 45° by a slab of 1 m, n = 1.5, m", (1.5 - y) / 2f64.sqrt(), 0.329_142, 2e-6);
    let f = fresnel(0.5f64.sqrt(), 1.5);
    row.is_close("what of the light comes through: (1 − F)²", weight, (1.0 - f).powi(2), 1e-6);
    prove(row, "slab");
}

/// Sunlight into a drop, mirrored once inside, out again: the angle at which most comes back, from the point
/// opposite to the sun.
fn rainbow(row: &mut Record) {
    let n = 1.333;
    let steps = sized(20_000, 1_000_000);
    let mut most = 0.0f64;
    for i in 0..steps {
        // Into the sphere at height b, along +x.
        let b = (f64::from(i) + 0.5) / f64::from(steps);
        let d = DVec3::X;
        let p = DVec3::new(-(1.0 - b * b).sqrt(), b, 0.0);
        let enter = Interface::new(-d.dot(p), n);
        let inside = refracted(-d, p, n, enter.cos_t);
        let q = p + inside * (-2.0 * inside.dot(p));
        let back = reflected(-inside, -q);
        let e = q + back * (-2.0 * back.dot(q));
        let leave = Interface::new(back.dot(e), 1.0 / n);
        let out = refracted(-back, -e, 1.0 / n, leave.cos_t);
        most = most.max(angle(out, -d).to_degrees());
    }
    row.is("the rainbow of drops, n = 1.333, degrees from the point opposite to the sun", most, 42.078, 1e-3);
}
