//! The study as one page that needs nothing else: pictures are in it, and so is the little script that
//! lays two of them over each other.

use super::plot::{Drawing, escaped, svg};
use super::record::Study;
use super::said;
use super::table::{figures, percent};
use std::fmt::Write as _;
use std::path::Path;

const FORM: &str = include_str!("page.html");

/// Of the study in this folder, whose pictures are written already.
pub fn html(study: &Study, chart: &Drawing, folder: &Path) -> String {
    let image = |file: &str| std::fs::read(folder.join(file)).map_or(String::new(), |bytes| data_uri(&bytes));
    let mut pictures = Vec::new();
    let mut add = |name: &str, title: String, picture: &str, map: Option<&str>| {
        let map = map.map(image).filter(|uri| !uri.is_empty());
        let entry =
            serde_json::json!({ "name": name, "title": title, "picture": image(picture), "map": map });
        pictures.push(entry);
    };
    for (rung, s) in study.rendered() {
        let title = format!("{}: {} in {} s", rung.title(), percent(s.error[0]), figures(s.seconds[0]));
        add(&rung.name, title, &rung.picture(), Some(&rung.error_map()));
    }
    add("reference", "reference".to_owned(), "pictures/reference.png", None);
    // `</script>` within a text would end the script
    let pictures = serde_json::Value::Array(pictures).to_string().replace("</", "<\\/");

    let parts = [
        ("{{scene}}", escaped(&study.scene)),
        ("{{summary}}", summary(study)),
        ("{{sentences}}", sentences(study)),
        ("{{plot}}", svg(chart).replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1)),
        ("{{table}}", table(study)),
        ("{{width}}", study.subject.width.to_string()),
        ("{{pictures}}", pictures),
    ];
    parts.iter().fold(FORM.to_owned(), |page, (mark, text)| page.replace(mark, text))
}

fn summary(study: &Study) -> String {
    let subject = &study.subject;
    let mut lines = vec![
        format!(
            "{} × {} pixels, {} threads, {} seeds a setting, terrarium {}.",
            subject.width, subject.height, study.threads, study.asked.seeds, study.version
        ),
        format!("{}.", said(&study.reference)),
    ];
    if study.honest.of > 0 {
        let honest = study.honest;
        lines.push(format!(
            "The 95 % interval that a render states of itself held its true error in {} of {} renders.",
            honest.held, honest.of
        ));
    }
    if study.rendered().any(|(_, s)| s.near_reference) {
        lines.push(
            "Errors with a * are less than ten times that of the reference, which adds to them: 3 % to one of four times.".to_owned(),
        );
    }
    lines.extend(study.notes.iter().map(|note| format!("{note}.")));
    if !study.complete {
        lines.push("Not all renders are made: the study is to be gone on with.".to_owned());
    }
    let text: Vec<String> = lines.iter().map(|line| escaped(line)).collect();
    text.join("<br>\n")
}

fn sentences(study: &Study) -> String {
    let mut text = String::new();
    for line in &study.lines {
        // writing to a string cannot fail
        let _ = writeln!(
            text,
            "<li><b>{}</b>: {}</li>",
            escaped(&line.line.replace('_', " ")),
            escaped(&line.sentence)
        );
    }
    for left_out in &study.left_out {
        let _ = writeln!(
            text,
            "<li class=\"out\"><b>{}</b>: nothing to change: {}</li>",
            left_out.knob.key().replace('_', " "),
            escaped(&left_out.reason)
        );
    }
    text
}

fn table(study: &Study) -> String {
    let mut text = String::new();
    for (rung, s) in study.rendered() {
        let range = |values: [f64; 3], of: fn(f64) -> String| {
            format!("{} <small>{} to {}</small>", of(values[0]), of(values[1]), of(values[2]))
        };
        let stated = match (s.stated, s.interval) {
            (Some(stated), Some([low, high])) => {
                format!("{} <small>{} to {}</small>", percent(stated[0]), percent(low), percent(high))
            }
            _ => "unknown".to_owned(),
        };
        let set: Vec<String> = rung.set.iter().map(|set| format!("--set '{set}'")).collect();
        let command = format!("--passes {} {}", rung.passes, set.join(" "));
        let memory = s.peak_bytes.map_or(String::new(), |b| format!("{:.0} MiB", b as f64 / 1048576.0));
        let _ = writeln!(
            text,
            "<tr data-rung=\"{}\"{}><td>{}</td><td>{}</td><td>{}</td><td>{}{}</td><td>{}</td><td>{}</td><td>{memory}</td><td><code>{}</code></td></tr>",
            escaped(&rung.name),
            if s.pareto { " class=\"front\"" } else { "" },
            escaped(&rung.line.replace('_', " ")),
            escaped(&rung.value),
            range(s.seconds, figures),
            range(s.error, percent),
            if s.near_reference { " *" } else { "" },
            figures(s.rel_mse[0]),
            stated,
            escaped(command.trim())
        );
    }
    text
}

fn data_uri(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", base64(png))
}

/// RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word =
            chunk.iter().fold(0u32, |word, byte| word << 8 | u32::from(*byte)) << (8 * (3 - chunk.len()));
        for digit in 0..4 {
            let value = word >> (18 - 6 * digit) & 63;
            text.push(if digit <= chunk.len() { char::from(DIGITS[value as usize]) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::base64;

    /// The RFC's own examples.
    #[test]
    fn base64_is_that_of_the_standard() {
        let encoded = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| base64(text.as_bytes()));
        assert_eq!(encoded, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }
}
