//! Strategies for what a scene says: shapes, transforms and materials as text, and worlds made of them.

use crate::render::meshes::icosphere;
use proptest::prelude::*;
use std::path::PathBuf;
use std::sync::OnceLock;
use tempfile::TempDir;
use terrarium::build::{World, build};
use terrarium::description::{Format, load_str};
use terrarium::math::DVec3;
use terrarium::plan::{Plan, Request};

/// What is known of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A convex solid.
    Solid,
    /// A flat surface without an inside.
    Sheet,
    /// A surface that is neither: open, or with hollows.
    Other,
}

#[derive(Clone, Debug)]
pub struct Form {
    pub text: String,
    pub kind: Kind,
}

fn form(text: String, kind: Kind) -> Form {
    Form { text, kind }
}

fn size() -> impl Strategy<Value = f64> {
    (-1.5..1.0f64).prop_map(|e| libm::pow(10.0, e))
}

/// Every shape that a scene can name, of 3 cm to 10 m.
pub fn shape() -> impl Strategy<Value = Form> {
    let sizes = [size().boxed(), size().boxed(), size().boxed()];
    let solids = ["tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron"];
    prop_oneof![
        size().prop_map(|r| form(format!("sphere(radius: {r})"), Kind::Solid)),
        sizes.clone().prop_map(|[a, b, c]| form(format!("box(size: ({a}, {b}, {c}))"), Kind::Solid)),
        (sizes.clone(), 0.0..1.0f64, any::<bool>()).prop_map(|([r, h, _], top, caps)| {
            let kind = if caps { Kind::Solid } else { Kind::Other };
            form(format!("cone(radius: {r}, height: {h}, top_radius: {}, caps: {caps})", top * r), kind)
        }),
        (sizes.clone(), any::<bool>()).prop_map(|([r, h, _], caps)| {
            let kind = if caps { Kind::Solid } else { Kind::Other };
            form(format!("cylinder(radius: {r}, height: {h}, caps: {caps})"), kind)
        }),
        (size(), 0.0..0.9f64).prop_map(|(r, inner)| form(
            format!("disk(radius: {r}, inner_radius: {})", inner * r),
            Kind::Sheet
        )),
        sizes.prop_map(|[a, b, _]| form(format!("quad(size: ({a}, {b}))"), Kind::Sheet)),
        (size(), 0..5usize).prop_map(move |(r, i)| {
            form(format!("polyhedron(kind: {}, radius: {r})", solids[i]), Kind::Solid)
        }),
        Just(form(r#"mesh(path: "ball.obj")"#.to_owned(), Kind::Solid)),
        Just(form(r#"mesh(path: "ball.obj", smooth: true)"#.to_owned(), Kind::Solid)),
        Just(form(r#"mesh(path: "pair.obj")"#.to_owned(), Kind::Other)),
    ]
}

/// Where a shape is put.
#[derive(Clone, Debug)]
pub struct Place {
    pub text: String,
    /// The centre, scene coordinates.
    pub centre: DVec3,
    /// The mean factor of length.
    pub scale: f64,
}

/// Scales from 1e-6 to 1e6; half of them squashed by up to `squash`, some mirrored; turned; and moved by up to
/// `far` of the size.
pub fn place(squash: f64, far: f64) -> impl Strategy<Value = Place> {
    let mirrored = [any::<bool>(), any::<bool>(), any::<bool>()];
    let stretch = prop_oneof![Just([0.0; 3]), [0.0..1.0f64, 0.0..1.0, 0.0..1.0]];
    let away = prop_oneof![Just(0.0), 0.0..1.0f64];
    (-6.0..6.0f64, stretch, mirrored, unit(), 0.0..360.0f64, unit(), away).prop_map(
        move |(e, stretch, mirrored, axis, deg, way, away)| {
            let mean = libm::pow(10.0, e);
            let factors: [f64; 3] = std::array::from_fn(|i| {
                mean * libm::pow(squash, stretch[i]) * if mirrored[i] { -1.0 } else { 1.0 }
            });
            let sizes = factors.map(f64::abs);
            let most = sizes[0].max(sizes[1]).max(sizes[2]);
            let centre = way * most * libm::pow(far, away);
            let vector = |[x, y, z]: [f64; 3]| format!("({x:e}, {y:e}, {z:e})");
            let text = format!(
                "scale({}), rotate(axis: {}, deg: {deg}), translate({})",
                vector(factors),
                vector(axis.to_array()),
                vector(centre.to_array())
            );
            Place { text, centre, scale: libm::cbrt(sizes.iter().product()) }
        },
    )
}

/// Directions, all alike.
pub fn unit() -> impl Strategy<Value = DVec3> {
    [0.0..1.0f64, 0.0..1.0].prop_map(terrarium::math::sampling::sphere)
}

/// A material's layers.
#[derive(Clone, Debug)]
pub struct Layers {
    pub diffuse: f64,
    pub specular: f64,
    pub shininess: f64,
    pub reflection: f64,
    pub transmission: f64,
    pub ior: f64,
}

impl Layers {
    pub fn text(&self) -> String {
        let Layers { diffuse, specular, shininess, reflection, transmission, ior } = self;
        format!(
            "diffuse: {diffuse}, specular: {specular}, shininess: {shininess}, reflection: {reflection}, transmission: {transmission}, ior: {ior}"
        )
    }
}

/// Materials that send back all that a scene may ask them to.
pub fn material() -> impl Strategy<Value = Layers> {
    let share = || prop_oneof![Just(0.0), Just(1.0), 0.0..1.0f64];
    (share(), share(), share(), share(), 0.0..4.0f64, 0.4..2.8f64).prop_map(|(kd, km, kt, ks, s, ior)| {
        // What the highlight may have is what the layers below it leave.
        let rest = (1.0 - km) * (1.0 - kt) * (1.0 - kd);
        Layers {
            diffuse: kd,
            specular: 0.999 * ks * rest,
            shininess: libm::pow(10.0, s),
            reflection: km,
            transmission: kt,
            ior,
        }
    })
}

/// The files that shapes name: a ball, and two of them apart in one.
pub fn folder() -> PathBuf {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    let made = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        icosphere(2).write(&folder.path().join("ball.obj"));
        let mut other = icosphere(1);
        other.vertices.iter_mut().for_each(|v| v.x += 2.5);
        icosphere(1).with(other).write(&folder.path().join("pair.obj"));
        folder
    });
    made.path().to_owned()
}

/// The world of a scene whose camera looks at `target`.
pub fn world(target: DVec3, size: f64, rest: &str) -> (World, Plan) {
    let text = format!(
        "(camera: (eye: ({:e}, {:e}, {:e}), target: ({:e}, {:e}, {:e})), image: (width: 2, height: 2), {rest})",
        target.x,
        target.y + size,
        target.z + 5.0 * size,
        target.x,
        target.y,
        target.z
    );
    let loaded =
        load_str(&text, Format::Ron, &folder(), &[]).unwrap_or_else(|report| panic!("{report:?}\n{text}"));
    let plan = Plan::new(&loaded.scene, &Request::default()).expect("no overrides");
    let world = build(&loaded.scene, &plan).unwrap_or_else(|error| panic!("{error}\n{text}")).world;
    (world, plan)
}
