//! Every field that is misspelt by one letter is named, with the right one.

use super::{FULL_RON, FULL_TOML, full};
use terrarium::description::Format;

/// The keys of a scene text, `key` followed by `:` or ` =`, with their offsets.
fn keys(text: &str, format: Format) -> Vec<(usize, &str)> {
    let mark = |rest: &str| match format {
        Format::Ron => rest.starts_with(':'),
        Format::Toml => rest.starts_with(" =") || rest.starts_with('.'),
    };
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut found = Vec::new();
    let mut start: Option<usize> = None;
    for (i, c) in text.char_indices() {
        match (word(c), start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                let name: &str = &text[from..i];
                if mark(&text[i..])
                    && name.len() >= 3
                    && name.starts_with(|c: char| c.is_ascii_alphabetic())
                    && text.as_bytes()[from - 1] != b'"'
                {
                    found.push((from, name));
                }
                start = None;
            }
            _ => {}
        }
    }
    found
}

#[test]
fn every_misspelt_field_is_named_and_the_right_one_suggested() {
    let names = [
        "photo", "squares", "cubes", "clouds", "veins", "rings", "wall", "table", "tinted", "glass", "water",
        "mirror", "lamp", "bulb", "cone", "sun", "relief", "mixed", "ball", "panel", "plate", "sky", "blade",
        "ground", "pair", "bark", "leaf", "wood", "tree",
    ];
    let mut tried = 0;
    for (text, format) in [(FULL_RON, Format::Ron), (FULL_TOML, Format::Toml)] {
        for (at, key) in keys(text, format) {
            // names are free, only fields and variants can be misspelt; table headers name several places at once
            let line_start = text[..at].rfind('\n').map_or(0, |i| i + 1);
            let header = text[line_start..].starts_with(['[', '#', '/']);
            if header
                || names.contains(&key)
                    && !text[at..].starts_with("squares =")
                    && !text[at..].starts_with("squares:")
            {
                continue;
            }
            let middle = at + key.len() / 2;
            let wrong = format!("{}{}", &text[..middle], &text[middle + 1..]);
            let misspelt = format!("{}{}", &key[..key.len() / 2], &key[key.len() / 2 + 1..]);
            let report =
                full(&wrong, format, &[]).err().unwrap_or_else(|| panic!("`{misspelt}` at {at} passed"));
            let first = report.diagnostics.iter().find(|d| d.message.contains(&format!("`{misspelt}`")));
            let Some(first) = first else { panic!("`{misspelt}` is not named:\n{report}") };
            assert!(first.message.contains(&format!("did you mean `{key}`?")), "{report}");
            assert_eq!(report.errors().count(), 1, "`{misspelt}`:\n{report}");
            tried += 1;
        }
    }
    assert!(tried > 250, "only {tried} keys were tried");
}
