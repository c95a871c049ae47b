//! The files that a scene names must be there and readable.

use super::{Checker, Kind, Severity};
use crate::description::assets;
use crate::description::suggest::nearest;
use std::path::Path as FilePath;

pub(super) fn check(c: &mut Checker) {
    let mut scene = c.scene.clone();
    let mut named = Vec::new();
    assets::for_each(&mut scene, &mut |path, place| named.push((path.clone(), place.clone())));
    for (path, place) in named {
        if path.is_empty() {
            c.error(&place, "a file's path cannot be empty");
            continue;
        }
        let file = c.folder.join(&path);
        let problem = match std::fs::metadata(&file) {
            Ok(meta) if meta.is_dir() => Some("it is a folder".to_owned()),
            Ok(_) => std::fs::File::open(&file).err().map(|e| e.to_string()),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                Some("there is no such file".to_owned())
            }
            Err(error) => Some(error.to_string()),
        };
        if let Some(problem) = problem {
            let near = neighbour(&file).map(|name| format!("; did you mean `{name}`?")).unwrap_or_default();
            let message = format!("`{}` cannot be read: {problem}{near}", file.display());
            c.report(Severity::Error, Kind::Io, &[&place], message, None);
        }
    }
}

/// A file of the same folder with nearly that name.
fn neighbour(file: &FilePath) -> Option<String> {
    let name = file.file_name()?.to_str()?;
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(FilePath::new("."));
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .ok()?
        .take(10_000)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    names.sort();
    nearest(name, names.iter().map(String::as_str).filter(|other| *other != name)).map(str::to_owned)
}
