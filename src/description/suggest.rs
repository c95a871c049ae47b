//! The nearest valid name to one that is not.

/// The candidate that a slip of the pen would turn into `name`: at most a third of its letters wrong
/// (Damerau–Levenshtein), letter case and `-` for `_` not counted; or only its unit left out.
pub(crate) fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > 200 {
        return None;
    }
    let folded = fold(name);
    candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= 200)
        .map(|candidate| (distance(&folded, &fold(candidate)), candidate))
        .filter(|(wrong, candidate)| {
            *wrong <= (candidate.chars().count().max(folded.chars().count()) / 3).max(1)
        })
        .filter(|(wrong, candidate)| *wrong < candidate.chars().count())
        .min_by_key(|(wrong, _)| *wrong)
        .map(|(_, candidate)| candidate)
}

/// `` ; did you mean `…`? `` or nothing.
pub(crate) fn question<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    nearest(name, candidates).map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

/// `` `a`, `b`, `c` ``, at most twenty of them.
pub(crate) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    let shown: Vec<String> = names.iter().take(20).map(|name| format!("`{name}`")).collect();
    let more = if names.len() > 20 { format!(" and {} more", names.len() - 20) } else { String::new() };
    format!("{}{more}", shown.join(", "))
}

/// Wrong letters; a unit that was left out (`fov` for `fov_deg`) counts as one.
fn distance(name: &str, candidate: &str) -> usize {
    let without_unit = candidate.strip_prefix(name).is_some_and(|rest| rest.starts_with('_'));
    if without_unit { 1 } else { strsim::damerau_levenshtein(name, candidate) }
}

fn fold(name: &str) -> String {
    name.to_lowercase().replace(['-', ' '], "_")
}
