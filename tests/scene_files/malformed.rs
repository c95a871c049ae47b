//! Malformed texts of every sort are refused, and none of them makes the reader fall over.

use super::{CAMERA, FULL_RON, FULL_TOML, full};
use std::path::Path;
use terrarium::description::{Format, load_str};

/// Reads a text and lays out the report; only panics matter.
fn survives(text: &str, format: Format) {
    if let Err(report) = full(text, format, &[]) {
        assert!(!report.to_string().is_empty());
        assert!(report.errors().next().is_some());
    }
}

#[test]
fn scenes_cut_off_at_any_byte_are_refused_without_panic() {
    for (text, format) in [(FULL_RON, Format::Ron), (FULL_TOML, Format::Toml)] {
        for end in (0..text.len()).filter(|end| text.is_char_boundary(*end)) {
            survives(&text[..end], format);
        }
    }
}

#[test]
fn scenes_with_random_bytes_are_read_without_panic() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    let snippets: Vec<&[u8]> = vec![
        b"(",
        b")",
        b"\"",
        b"{",
        b"}",
        b"[",
        b"]",
        b":",
        b"=",
        b",",
        b"'",
        b"\\",
        b"1e999",
        b"NaN",
        b"-",
        b"r#\"",
        b"/*",
        b"//",
        b"\0",
        b"0x",
        b"\xc3\xa9",
        b"Some(",
        b"b\"",
        b"..",
        b"\n",
    ];
    for round in 0..4000 {
        let (text, format) = if round % 2 == 0 { (FULL_RON, Format::Ron) } else { (FULL_TOML, Format::Toml) };
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..1 + random(4) {
            let at = random(bytes.len());
            match random(4) {
                0 => bytes[at] = random(256) as u8,
                1 => drop(bytes.drain(at..(at + 1 + random(20)).min(bytes.len()))),
                2 => drop(bytes.splice(at..at, snippets[random(snippets.len())].iter().copied())),
                _ => {
                    let part = bytes[at..(at + random(60)).min(bytes.len())].to_vec();
                    let to = random(bytes.len());
                    bytes.splice(to..to, part);
                }
            }
            bytes.push(b' ');
        }
        survives(&String::from_utf8_lossy(&bytes), format);
    }
}

#[test]
fn deep_nesting_is_refused() {
    for open in ["(", "[", "{\"a\":", "a(", "(a:", "Some(", "/*"] {
        let report =
            load_str(&open.repeat(100_000), Format::Ron, Path::new(""), &[]).expect_err("it is too deep");
        assert_eq!(report.exit_code(), 2, "{open}");
    }
    for text in [
        "a = ".to_owned() + &"[".repeat(100_000),
        "a.".repeat(100_000) + "a = 1",
        "a = {a = ".repeat(100_000),
        format!("[{}a]", "a.".repeat(100_000)),
    ] {
        assert!(load_str(&text, Format::Toml, Path::new(""), &[]).is_err());
    }
    let mut groups = "(shape: sphere())".to_owned();
    for _ in 0..25 {
        groups = format!("(shape: group(objects: [{groups}]), material: \"m\")");
    }
    let text = format!("({CAMERA}, materials: {{ \"m\": () }}, objects: [{groups}])");
    assert!(load_str(&text, Format::Ron, Path::new(""), &[]).is_ok());
    let path = "a.".repeat(50_000) + "a=1";
    assert!(full(FULL_RON, Format::Ron, &[&path]).is_err());
}

/// A table that is no scene at all: told by its first thousand names, at once.
#[test]
fn a_hundred_thousand_unknown_fields_are_refused_within_a_second() {
    let text: String = (0..100_000).map(|i| format!("k{i} = {i}\n")).collect();
    let began = std::time::Instant::now();
    let report = load_str(&text, Format::Toml, Path::new(""), &[]).expect_err("no scene");
    assert!(began.elapsed().as_secs_f64() < 1.0, "{:?}", began.elapsed());
    assert!(report.diagnostics.len() >= 999, "{}", report.diagnostics.len());
    assert!(report.diagnostics.iter().any(|d| d.message == "there is no field `k7` here"));
}
