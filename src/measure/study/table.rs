//! A study as a table: `study.csv`, a row a rung.

use super::record::{Rung, Study, Summary};

/// The columns of `study.csv`, in order. Errors are fractions: 0.01 is 1 %. What does not apply is empty.
pub const COLUMNS: [&str; 22] = [
    "rung",
    "knob",
    "line",
    "value",
    "number",
    "passes",
    "set",
    "seeds",
    "seconds",
    "seconds_least",
    "seconds_most",
    "error",
    "error_least",
    "error_most",
    "rel_mse",
    "stated_error",
    "stated_low",
    "stated_high",
    "peak_bytes",
    "camera_rays",
    "pareto",
    "near_reference",
];

/// A slope: two digits behind the point, with a real minus.
pub fn signed(slope: f64) -> String {
    format!("{slope:.2}").replace('-', "−")
}

/// Rungs that were rendered, with a line of titles (RFC 4180, but lines end with a newline alone).
pub fn csv(study: &Study) -> String {
    let mut text = COLUMNS.join(",") + "\n";
    for (rung, result) in study.rendered() {
        let cells: Vec<String> = row(rung, result).iter().map(|cell| quoted(cell)).collect();
        text += &cells.join(",");
        text.push('\n');
    }
    text
}

fn row(rung: &Rung, result: &Summary) -> [String; 22] {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let end = |i: usize| number(result.interval.map(|interval| interval[i]));
    let [seconds, error] = [result.seconds, result.error].map(|values| values.map(|v| v.to_string()));
    let [[s, s0, s1], [e, e0, e1]] = [seconds, error];
    [
        rung.name.clone(),
        rung.knob.key().to_owned(),
        rung.line.clone(),
        rung.value.clone(),
        number(rung.x),
        rung.passes.to_string(),
        rung.set.join(" "),
        rung.runs.len().to_string(),
        s,
        s0,
        s1,
        e,
        e0,
        e1,
        result.rel_mse[0].to_string(),
        number(result.stated.map(|stated| stated[0])),
        end(0),
        end(1),
        result.peak_bytes.map_or(String::new(), |bytes| bytes.to_string()),
        result.camera_rays.to_string(),
        result.pareto.to_string(),
        result.near_reference.to_string(),
    ]
}

fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

/// Three digits that count, without zeros that say nothing: `0.0123`, `1.5`, `240`.
pub fn figures(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let decimals = (2.0 - libm::floor(libm::log10(x.abs()))).clamp(0.0, 9.0) as usize;
    let text = format!("{x:.decimals$}");
    if decimals == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').to_owned() }
}

/// The error of a rung in per cent.
pub fn percent(error: f64) -> String {
    format!("{} %", figures(100.0 * error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_three_digits_that_count() {
        let told = [0.012_345, 1.5, 239.7, 0.0, 12_345.0, 0.999_6].map(figures);
        assert_eq!(told, ["0.0123", "1.5", "240", "0", "12345", "1"]);
    }

    #[test]
    fn cells_with_commas_are_quoted() {
        assert_eq!(quoted("adaptive(0.1, 2)"), "\"adaptive(0.1, 2)\"");
        assert_eq!(quoted("say \"x\""), "\"say \"\"x\"\"\"");
        assert_eq!(quoted("plain"), "plain");
    }
}
