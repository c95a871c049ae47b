//! The study's plot: error against time on logarithmic axes, a line a knob, with its slope in the legend and
//! the Pareto front behind.

use super::marks::{Anchor, Colour, Drawing, Mark};
use super::scale::Scale;
use crate::measure::study::record::{Rung, Study, Summary};
use crate::measure::study::table::{figures, percent, signed};
use crate::measure::study::theory;

const SIZE: [f64; 2] = [884.0, 520.0];
/// Left, right, top and bottom of the plotted field.
const FIELD: [f64; 4] = [74.0, 560.0, 44.0, 462.0];
const LEGEND: f64 = 584.0;

const INK: Colour = [34, 34, 34];
const GREY: Colour = [110, 110, 110];
const GRID: Colour = [228, 228, 228];
const FRONT: Colour = [205, 214, 226];

/// Okabe & Ito's colours, which colour-blind people tell apart; without the yellow, which is too light, and with a brown.
const COLOURS: [Colour; 8] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [60, 60, 60],
    [140, 86, 75],
];

/// The plot of all rungs that were rendered.
pub fn chart(study: &Study) -> Drawing {
    let mut drawing = Drawing::new(SIZE[0], SIZE[1]);
    let shown: Vec<(&Rung, &Summary)> =
        study.rendered().filter(|(_, s)| s.error[0] > 0.0 && s.seconds[0] > 0.0).collect();
    let x = Scale::of(shown.iter().flat_map(|(_, s)| s.seconds), [FIELD[0], FIELD[1]]);
    let y = Scale::of(shown.iter().flat_map(|(_, s)| s.error), [FIELD[3], FIELD[2]]);
    let at = |s: &Summary| [x.place(s.seconds[0]), y.place(s.error[0])];
    axes(&mut drawing, &x, &y);
    drawing.text([FIELD[0], 24.0], 15.0, Anchor::Start, INK, &format!("Error against time: {}", study.scene));

    let mut front: Vec<[f64; 2]> = shown.iter().filter(|(_, s)| s.pareto).map(|(_, s)| at(s)).collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    drawing.line(front, FRONT, 9.0);
    guides(&mut drawing, study, &shown, &x, &y);

    let mut row = FIELD[2] + 6.0;
    for (i, line) in study.lines.iter().enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        let of = |(rung, _): &&(&Rung, &Summary)| rung.knob == line.knob && rung.line == line.line;
        let points: Vec<&(&Rung, &Summary)> = shown.iter().filter(of).collect();
        drawing.line(points.iter().map(|(_, s)| at(s)).collect(), colour, 1.6);
        for (rung, s) in points {
            ranges(&mut drawing, s, at(s), &x, &y, colour);
            let title = format!("{}: {} in {} s", rung.title(), percent(s.error[0]), figures(s.seconds[0]));
            let (at, name) = (at(s), rung.name.clone());
            drawing.marks.push(Mark::Dot { at, radius: 3.2, colour, filled: true, name, title });
        }
        let label = if line.line == line.knob.key() {
            line.line.replace('_', " ")
        } else {
            format!("{}: {}", line.knob.key(), line.line)
        };
        drawing.line(vec![[LEGEND, row - 4.0], [LEGEND + 22.0, row - 4.0]], colour, 2.4);
        drawing.text([LEGEND + 30.0, row], 13.0, Anchor::Start, INK, &label);
        let mut told = Vec::new();
        if let Some(slope) = line.error_by_seconds {
            told.push(format!("slope {} in time", signed(slope)));
        }
        if let Some(slopes) = line.theory {
            let found = line.late_error_by_number.map(signed);
            told.extend(found.map(|slope| format!("{slope} in {}, at last", line.knob.unit())));
            told.push(format!("theory: {}", theory::said(slopes)));
        }
        for text in told {
            row += 15.0;
            drawing.text([LEGEND + 30.0, row], 11.0, Anchor::Start, GREY, &text);
        }
        row += 24.0;
    }
    drawing.line(vec![[LEGEND, row - 4.0], [LEGEND + 22.0, row - 4.0]], FRONT, 9.0);
    drawing.text([LEGEND + 30.0, row], 13.0, Anchor::Start, INK, "Pareto front");
    row += 15.0;
    drawing.text([LEGEND + 30.0, row], 11.0, Anchor::Start, GREY, "nothing here is faster and better");
    drawing
}

fn axes(drawing: &mut Drawing, x: &Scale, y: &Scale) {
    let [left, right, top, bottom] = FIELD;
    for value in x.ticks() {
        let place = x.place(value);
        drawing.line(vec![[place, top], [place, bottom]], GRID, 1.0);
        drawing.text([place, bottom + 18.0], 12.0, Anchor::Middle, INK, &figures(value));
    }
    for value in y.ticks() {
        let place = y.place(value);
        drawing.line(vec![[left, place], [right, place]], GRID, 1.0);
        drawing.text([left - 8.0, place + 4.0], 12.0, Anchor::End, INK, &percent(value));
    }
    drawing.line(vec![[left, top], [left, bottom], [right, bottom]], INK, 1.2);
    drawing.text([0.5 * (left + right), bottom + 40.0], 13.0, Anchor::Middle, INK, "seconds, whole render");
    drawing.marks.push(Mark::Text {
        at: [20.0, 0.5 * (top + bottom)],
        size: 13.0,
        anchor: Anchor::Middle,
        colour: INK,
        upright: true,
        text: "relative RMS error".to_owned(),
    });
}

/// What theory says of the first line that it says something of, through that line's last point.
fn guides(drawing: &mut Drawing, study: &Study, shown: &[(&Rung, &Summary)], x: &Scale, y: &Scale) {
    let Some(line) = study.lines.iter().find(|line| line.theory.is_some()) else { return };
    let points: Vec<&(&Rung, &Summary)> =
        shown.iter().filter(|(rung, _)| rung.knob == line.knob && rung.line == line.line).collect();
    let (Some((_, from)), Some((_, to))) = (points.first(), points.last()) else { return };
    // Time grows with the samples.
    let samples = f64::from(theory::dimensions(line.knob));
    let mut slopes: Vec<f64> = line.theory.into_iter().flatten().map(|slope| slope / samples).collect();
    slopes.dedup();
    for (i, slope) in slopes.into_iter().enumerate() {
        // Backwards from the last point: there the fixed costs count least.
        let (late, error) = (to.seconds[0], to.error[0]);
        let fits = |seconds: f64| error * libm::pow(seconds / late, slope);
        let highest = libm::exp(y.logs[1] * std::f64::consts::LN_10);
        let mut early = from.seconds[0];
        if fits(early) > highest {
            early = late * libm::pow(highest / error, 1.0 / slope);
        }
        if early < late {
            drawing.dashes(
                vec![[x.place(early), y.place(fits(early))], [x.place(late), y.place(error)]],
                GREY,
                1.0,
            );
            let text = format!("theory {}", signed(slope));
            let place = [x.place(early) + 4.0, y.place(fits(early)) + if i == 0 { -4.0 } else { 12.0 }];
            drawing.text(place, 10.0, Anchor::Start, GREY, &text);
        }
    }
}

/// From the least to the most of all seeds, both ways.
fn ranges(drawing: &mut Drawing, s: &Summary, at: [f64; 2], x: &Scale, y: &Scale, colour: Colour) {
    if s.error[1] > 0.0 && s.error[2] > s.error[1] {
        drawing.line(vec![[at[0], y.place(s.error[1])], [at[0], y.place(s.error[2])]], colour, 1.0);
    }
    if s.seconds[2] > s.seconds[1] {
        drawing.line(vec![[x.place(s.seconds[1]), at[1]], [x.place(s.seconds[2]), at[1]]], colour, 1.0);
    }
}
