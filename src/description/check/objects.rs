//! Shapes, transforms, scatter; names of objects.

use super::Checker;
use crate::description::tree::{Path, number};
use crate::description::{Object, Scatter, Shape, Transform};
use crate::math::{DAffine3, DMat3, MAX_SQUEEZE, Placement, flattens};
use std::collections::HashMap;

/// The place of `objects`.
pub(super) fn list() -> Path {
    Path::of("objects")
}

pub(super) fn check(c: &mut Checker) {
    for (name, object) in c.scene.definitions.iter() {
        check_object(c, &Path::of("definitions").key(name), object, DMat3::IDENTITY);
    }
    let mut names = HashMap::new();
    for (i, object) in c.scene.objects.iter().enumerate() {
        let path = list().index(i);
        check_object(c, &path, object, DMat3::IDENTITY);
        unique_names(c, &path, object, &mut names);
    }
}

fn unique_names<'a>(c: &mut Checker, path: &Path, object: &'a Object, names: &mut HashMap<&'a str, Path>) {
    if let Some(name) = &object.name {
        let here = path.key("name");
        match names.get(name.as_str()) {
            Some(first) => {
                let place = c.sources.place(c.root.find(first).node.span);
                let message = format!("the name `{name}` is given twice; the first is at {place}");
                c.error_about(&[&here, &first.clone()], message);
            }
            None => drop(names.insert(name, here)),
        }
    }
    if let Shape::Group { objects } = &object.shape {
        let list = path.key("shape").key("group").key("objects");
        for (i, object) in objects.iter().enumerate() {
            unique_names(c, &list.index(i), object, names);
        }
    }
}

/// `around`: the product of the transforms of the groups that the object is in.
fn check_object(c: &mut Checker, path: &Path, object: &Object, around: DMat3) {
    if object.name.as_deref() == Some("") {
        c.error(&path.key("name"), "a name cannot be empty");
    }
    let placed = transforms(c, path, &object.transform, around);
    let shape = path.key("shape");
    match &object.shape {
        Shape::Sphere { radius, .. } => c.positive(&shape.key("sphere").key("radius"), *radius),
        Shape::Box { size, .. } => {
            size.iter().enumerate().for_each(|(i, x)| c.positive(&shape.key("box").key("size").index(i), *x));
        }
        Shape::Cone { radius, height, top_radius, .. } => {
            cone(c, &shape.key("cone"), *radius, *height, *top_radius)
        }
        Shape::Cylinder { radius, height, .. } => {
            c.positive(&shape.key("cylinder").key("radius"), *radius);
            c.positive(&shape.key("cylinder").key("height"), *height);
        }
        Shape::Disk { radius, inner_radius } => {
            let (outer, inner) = (shape.key("disk").key("radius"), shape.key("disk").key("inner_radius"));
            c.positive(&outer, *radius);
            c.not_negative(&inner, *inner_radius);
            if inner_radius >= radius && *radius > 0.0 {
                let message = format!("{} is not below `radius`, {}", number(*inner_radius), number(*radius));
                c.error_about(&[&inner, &outer], message);
            }
        }
        Shape::Quad { size } => {
            size.iter()
                .enumerate()
                .for_each(|(i, x)| c.positive(&shape.key("quad").key("size").index(i), *x));
        }
        Shape::Polyhedron { radius, .. } => c.positive(&shape.key("polyhedron").key("radius"), *radius),
        Shape::Group { objects } => {
            let list = shape.key("group").key("objects");
            if objects.is_empty() {
                c.error(&list, "the group is empty");
            }
            for (i, object) in objects.iter().enumerate() {
                check_object(c, &list.index(i), object, placed);
            }
        }
        Shape::Scatter(scatter) => check_scatter(c, &shape.key("scatter"), scatter),
        Shape::Mesh { .. } | Shape::Instance { .. } => {}
    }
}

fn cone(c: &mut Checker, path: &Path, radius: f64, height: f64, top_radius: f64) {
    let (bottom, top) = (path.key("radius"), path.key("top_radius"));
    c.not_negative(&bottom, radius);
    c.not_negative(&top, top_radius);
    if radius == 0.0 && top_radius == 0.0 {
        c.error_about(&[&bottom, &top], "`radius` and `top_radius` cannot both be 0");
    }
    c.positive(&path.key("height"), height);
}

fn check_scatter(c: &mut Checker, path: &Path, scatter: &Scatter) {
    if scatter.of.is_empty() {
        c.error(&path.key("of"), "at least one definition is needed");
    }
    c.within(&path.key("count"), scatter.count.into(), 1.0, 1e7);
    for (i, factor) in scatter.scale.iter().enumerate() {
        c.positive(&path.key("scale").index(i), *factor);
    }
    for (key, [low, high]) in [("scale", scatter.scale), ("turn_deg", scatter.turn_deg)] {
        if low > high {
            c.error(
                &path.key(key),
                format!("the smallest, {}, is above the largest, {}", number(low), number(high)),
            );
        }
    }
    c.within(&path.key("max_slope_deg"), scatter.max_slope_deg, 0.0, 180.0);
    c.within(&path.key("align"), scatter.align, 0.0, 1.0);
}

/// Each step must be invertible, and their product, and that with `around`, which is returned.
fn transforms(c: &mut Checker, object: &Path, steps: &[Transform], around: DMat3) -> DMat3 {
    let path = object.key("transform");
    let mut product = DMat3::IDENTITY;
    let mut sound = true;
    for (i, step) in steps.iter().enumerate() {
        let here = path.index(i);
        // Of a turn only the axis can be wrong.
        if let Transform::Rotate { axis, .. } = step {
            c.direction(&here.key("rotate").key("axis"), *axis);
        }
        let matrix = step.map().matrix3;
        sound &= matrix.is_finite();
        if !matches!(step, Transform::Rotate { .. }) && flattens(&matrix) {
            sound = false;
            let message = if matrix.determinant() == 0.0 {
                "this step flattens the object to nothing: a factor or the determinant is 0".to_owned()
            } else {
                format!("this step squeezes more than {MAX_SQUEEZE:e} times as much one way as another")
            };
            c.error_about(&[&here, &here.key("scale"), &here.key("matrix")], message);
        }
        product = matrix * product;
    }
    // What placing asks for, too: a volume within the range of numbers.
    let places = |matrix: DMat3| Placement::new(DAffine3::from_mat3(matrix)).is_some();
    let all = around * product;
    if sound && !places(product) {
        c.error(&path, "together these steps flatten the object to nothing, or take its volume out of the range of numbers");
    } else if sound && places(around) && !places(all) {
        let message = "together with the transforms of the groups around it these flatten the object to nothing, \
                       or take its volume out of the range of numbers";
        c.error_about(&[&path, object], message);
    }
    all
}
