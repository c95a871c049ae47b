//! Dependencies for `make`: which files an image was made from.
//!
//! One rule, `image…: file…`, and an empty rule for each file, so that a file that is deleted
//! causes a new render (which names it) and not a `make` that stops. The form is that of the
//! compilers' `-MD -MP`.

use super::OutputError;
use std::path::Path;

/// The text of a dependency file.
///
/// Spaces, `#`, `$`, `%` and backslashes before them are escaped; a path with a line break can't
/// be written and is refused.
pub fn rules(images: &[&Path], files: &[&Path]) -> Result<String, OutputError> {
    let images = images.iter().map(|path| escape(path)).collect::<Result<Vec<_>, _>>()?;
    let mut files = files.iter().map(|path| escape(path)).collect::<Result<Vec<_>, _>>()?;
    let mut seen = std::collections::HashSet::new();
    files.retain(|file| seen.insert(file.clone()));

    let mut text = format!("{}:", images.join(" "));
    for file in &files {
        text.push_str(" \\\n  ");
        text.push_str(file);
    }
    text.push('\n');
    for file in &files {
        text.push_str(&format!("\n{file}:\n"));
    }
    Ok(text)
}

/// A path as `make` reads it back.
fn escape(path: &Path) -> Result<String, OutputError> {
    let refused = |reason: &str| {
        OutputError::NotSupported(format!("`{}` in a dependency file: it holds {reason}", path.display()))
    };
    let name = path.to_str().ok_or_else(|| refused("bytes that are not UTF-8"))?;
    if name.is_empty() {
        return Err(refused("nothing"));
    }
    let mut escaped = String::with_capacity(name.len());
    let mut backslashes = 0;
    for character in name.chars() {
        match character {
            '\n' | '\r' => return Err(refused("a line break")),
            ' ' | '\t' | '#' | '%' => {
                // backslashes before an escaped character would escape the escape
                escaped.push_str(&"\\".repeat(backslashes + 1));
                escaped.push(character);
            }
            '$' => escaped.push_str("$$"),
            _ => escaped.push(character),
        }
        backslashes = if character == '\\' { backslashes + 1 } else { 0 };
    }
    Ok(escaped)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_image_depends_on_every_file_and_every_file_may_vanish() {
        let rules = rules(
            &[Path::new("out.exr"), Path::new("out.png")],
            &[Path::new("scene.ron"), Path::new("mesh.obj"), Path::new("scene.ron")],
        );
        let expected =
            "out.exr out.png: \\\n  scene.ron \\\n  mesh.obj\n\nscene.ron:\n\nmesh.obj:\n".to_string();
        assert_eq!(rules.ok(), Some(expected));
    }

    #[test]
    fn what_make_would_misread_is_escaped() {
        for (path, expected) in [
            ("my scene.ron", "my\\ scene.ron"),
            ("a$b", "a$$b"),
            ("a#b", "a\\#b"),
            ("a\\ b", "a\\\\\\ b"),
            ("a\\b", "a\\b"),
        ] {
            assert_eq!(escape(Path::new(path)).ok().as_deref(), Some(expected));
        }
        assert!(escape(Path::new("two\nlines")).is_err() && escape(Path::new("")).is_err());
    }
}
