//! A drawing as SVG, with the fonts of whoever looks at it.

use super::marks::{Anchor, Colour, Drawing, Mark};
use std::fmt::Write as _;

/// The whole file, which can stand in a page as well. Dots with a name have it in `data-rung`.
pub fn svg(drawing: &Drawing) -> String {
    let Drawing { width, height, marks } = drawing;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"Helvetica, Arial, sans-serif\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    for mark in marks {
        // writing to a string cannot fail
        let _ = match mark {
            Mark::Line { points, colour, width, dashed } => {
                let points: Vec<String> =
                    points.iter().map(|[x, y]| format!("{},{}", short(*x), short(*y))).collect();
                let dashes = if *dashed { " stroke-dasharray=\"6 5\"" } else { "" };
                writeln!(
                    text,
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\" \
                     stroke-linejoin=\"round\" stroke-linecap=\"round\"{dashes}/>",
                    points.join(" "),
                    hex(*colour)
                )
            }
            Mark::Dot { at: [x, y], radius, colour, filled, name, title } => {
                let colour = hex(*colour);
                let fill = if *filled { colour.as_str() } else { "none" };
                let class =
                    if name.is_empty() { String::new() } else { format!(" data-rung=\"{}\"", escaped(name)) };
                writeln!(
                    text,
                    "<circle cx=\"{}\" cy=\"{}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{colour}\" \
                     stroke-width=\"1.5\"{class}><title>{}</title></circle>",
                    short(*x),
                    short(*y),
                    escaped(title)
                )
            }
            Mark::Text { at: [x, y], size, anchor, colour, upright, text: words } => {
                let anchor = match anchor {
                    Anchor::Start => "start",
                    Anchor::Middle => "middle",
                    Anchor::End => "end",
                };
                let (x, y) = (short(*x), short(*y));
                let turn =
                    if *upright { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
                writeln!(
                    text,
                    "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{}\"{turn}>{}</text>",
                    hex(*colour),
                    escaped(words)
                )
            }
        };
    }
    text + "</svg>\n"
}

fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A hundredth of a point is more than can be seen.
fn short(x: f64) -> f64 {
    (100.0 * x).round() / 100.0
}

/// Text within XML or HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
