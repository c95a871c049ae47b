//! What each knob buys: slopes of its line, and a plain sentence.

use super::record::{Honest, Line, Rung, Study, Summary};
use super::table::{figures, percent, signed};
use super::{Change, Knob, reaches, slope, theory};
use crate::plan::{Antialiasing, PhotonBudget, PhotonEngine, Plan};

/// Logarithms of factors that are none: of error, and of time, which is noisy.
const NOTHING: f64 = 0.01;
const SAME_TIME: f64 = 0.05;

/// Points whose slope stands beside theory: of few passes the law of many does not hold yet.
const LATE: usize = 4;

/// Adds lines and honesty, and says whether every rung has all its runs.
pub fn conclude(study: &mut Study, plan: &Plan) {
    let mut names: Vec<(Knob, String)> = Vec::new();
    for rung in &study.rungs {
        let name = (rung.knob, rung.line.clone());
        if !names.contains(&name) {
            names.push(name);
        }
    }
    study.lines = names.into_iter().filter_map(|(knob, line)| of(study, plan, knob, line)).collect();
    // The same setting may stand on several lines: it counts once.
    let mut shown: Vec<&Rung> = Vec::new();
    for rung in study.rungs.iter().filter(|rung| shows_its_error(rung, plan)) {
        let made = |rung: &Rung| rung.runs.first().map(|run| [run.error.to_bits(), run.seconds.to_bits()]);
        if !shown.iter().any(|other| made(other) == made(rung)) {
            shown.push(rung);
        }
    }
    let stated = shown.into_iter().flat_map(|rung| &rung.runs).filter_map(|r| Some((r.error, r.interval?)));
    study.honest = stated.fold(Honest::default(), |sum, (error, [low, high])| Honest {
        held: sum.held + u32::from((low..=high).contains(&error)),
        of: sum.of + 1,
    });
    study.complete = study.rungs.iter().all(|rung| rung.runs.len() >= study.asked.seeds as usize);
}

/// Whether passes of this rung show all of its error: not where samples, photons or facets are always the same.
fn shows_its_error(rung: &Rung, plan: &Plan) -> bool {
    let antialiasing = match rung.change {
        Some(Change::Antialiasing(kind)) => kind,
        _ => plan.antialiasing,
    };
    let classic = |budget: PhotonBudget| matches!(budget.engine, PhotonEngine::Classic { .. });
    antialiasing == Antialiasing::Progressive
        && !matches!(rung.change, Some(Change::Mesh(_)))
        && !plan.photon_budgets().any(classic)
}

type Point<'a> = (&'a Rung, &'a Summary);

fn of(study: &Study, plan: &Plan, knob: Knob, line: String) -> Option<Line> {
    let points: Vec<Point> = study.rendered().filter(|(r, _)| r.knob == knob && r.line == line).collect();
    let pairs = |of: &dyn Fn(&Point) -> Option<[f64; 2]>| -> Option<f64> {
        slope(&points.iter().filter_map(of).collect::<Vec<_>>())
    };
    let error_by_seconds = pairs(&|(_, s)| Some([s.seconds[0], s.error[0]]));
    let error_by_number = pairs(&|(rung, s)| Some([rung.x?, s.error[0]]));
    let seconds_by_number = pairs(&|(rung, s)| Some([rung.x?, s.seconds[0]]));
    let theory = theory::slopes(plan, knob, &line);
    let mut sentence = sentence(study, knob, &line, &points, error_by_number, seconds_by_number)?;
    let late = &points[points.len().saturating_sub(LATE)..];
    let late = late.iter().filter_map(|(rung, s)| Some([rung.x?, s.error[0]]));
    let late_error_by_number = slope(&late.collect::<Vec<_>>());
    if let Some((found, theory)) = late_error_by_number.zip(theory) {
        let of = if points.len() > LATE { format!(" of the last {LATE}") } else { String::new() };
        let (found, theory) = (signed(found), theory::said(theory));
        sentence += &format!(" Slope{of} in {}: {found}; theory, of many: {theory}.", knob.unit());
    }
    Some(Line {
        knob,
        line,
        error_by_seconds,
        error_by_number,
        seconds_by_number,
        late_error_by_number,
        theory,
        sentence,
    })
}

fn sentence(
    study: &Study,
    knob: Knob,
    line: &str,
    points: &[Point],
    error: Option<f64>,
    seconds: Option<f64>,
) -> Option<String> {
    let ((first, from), (last, to)) = (points.first()?, points.last()?);
    let mut text = match (error, seconds) {
        (Some(error), Some(seconds)) => {
            let (step, factor) = knob.step();
            let step = if line == "progressive" { "four times the passes" } else { step };
            let [error, seconds] = [error, seconds].map(|slope| libm::pow(factor, slope));
            let error = match libm::log(error).abs() < NOTHING {
                true => "as before".to_owned(),
                false => format!("×{}", figures(error)),
            };
            let seconds = match libm::log(seconds).abs() < SAME_TIME {
                true => "in the same time".to_owned(),
                false => format!("for ×{} time", figures(seconds)),
            };
            format!("{}: error {error} {seconds}", capital(step))
        }
        _ => format!(
            "{}: error {} in {} s",
            capital(&first.title()),
            percent(from.error[0]),
            figures(from.seconds[0])
        ),
    };
    if points.len() > 1 {
        let at = |rung: &Rung, s: &Summary| {
            format!("{} in {} s ({})", percent(s.error[0]), figures(s.seconds[0]), rung.value)
        };
        text += &format!("; from {} to {}", at(first, from), at(last, to));
        let (best, least) = points.iter().min_by(|a, b| a.1.error[0].total_cmp(&b.1.error[0]))?;
        if least.error[0] < to.error[0] && best.name != last.name {
            text += &format!("; the least error is at {}: {}", best.value, percent(least.error[0]));
        }
    }
    if line == "adaptive" {
        text += &beside_grid(study, from);
    }
    text.push('.');
    Some(text)
}

/// How adaptive antialiasing compares with the grid of its error: in time, and in camera rays, which do not
/// depend on what else the machine does. Where no grid that was tried has that error, of the adaptive ones that
/// a grid equals the best is compared.
fn beside_grid(study: &Study, own: &Summary) -> String {
    let grid = |of: fn(&Summary) -> f64| -> Vec<[f64; 2]> {
        let grid = study.rendered().filter(|(rung, _)| rung.line == "grid");
        grid.map(|(_, s)| [of(s), s.error[0]]).collect()
    };
    let (by_time, by_rays) = (grid(|s| s.seconds[0]), grid(|s| s.camera_rays as f64));
    let beside = |adaptive: &Summary| {
        let error = adaptive.error[0];
        let [seconds, rays] = [&by_time, &by_rays].map(|grid| reaches(grid, error));
        seconds.zip(rays).map(|(seconds, rays)| {
            format!(
                "takes {} s, {} times as long, and {} times as many camera rays",
                figures(seconds),
                figures(seconds / adaptive.seconds[0]),
                figures(rays / adaptive.camera_rays as f64)
            )
        })
    };
    if let Some(compared) = beside(own) {
        return format!("; a grid of that error {compared}");
    }
    let is_adaptive =
        |rung: &Rung| matches!(rung.change, Some(Change::Antialiasing(Antialiasing::Adaptive { .. })));
    // Grids have one pass.
    let others = study.rendered().filter(|(rung, _)| is_adaptive(rung) && rung.passes == 1);
    let compared = others.filter_map(|(rung, s)| Some((rung, s, beside(s)?)));
    let best = compared.min_by(|(_, a, _), (_, b, _)| a.error[0].total_cmp(&b.error[0]));
    let all_worse = by_time.iter().all(|point| point[1] > own.error[0]);
    let beyond =
        if all_worse { "no grid that was tried is as good" } else { "every grid that was tried is better" };
    match best {
        Some((rung, s, compared)) => {
            let (error, seconds) = (percent(s.error[0]), figures(s.seconds[0]));
            let title = rung.title();
            format!("; {beyond}; with {title}: error {error} in {seconds} s; a grid of that error {compared}")
        }
        None => format!("; {beyond}"),
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().collect::<String>() + letters.as_str())
}
