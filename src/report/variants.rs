//! How the results depend on parameters: the variants of a sweep of the case beside the run.

use super::html::Html;
use crate::error::Result;
use crate::io::sweep_table::{FINISHED, STATE, SUMMARIES, SweepTable, short};
use crate::io::table::Table;

/// Variants that are listed one by one; of more the page has their ranges, and the file the rest.
const LISTED: usize = 60;

/// A quantity of the histories in a sweep.
struct Quantity<'a> {
    name: &'a str,
    unit: &'a str,
    /// Last, least and largest value: the column of the table and the value of the run.
    summaries: Vec<(&'static str, Vec<Option<f64>>, f64)>,
    /// Its largest value in the run, to which changes are relative.
    scale: f64,
}

impl Quantity<'_> {
    /// The difference of a value from that of the run, relative to the largest value there.
    fn change(&self, value: f64, base: f64) -> String {
        match 100.0 * (value - base) / self.scale {
            change if change.is_finite() => format!("{change:+.2} %"),
            // Nothing to compare with, or with nothing.
            _ => "-".to_owned(),
        }
    }
}

/// The quantities that both the run and the sweep have.
fn quantities<'a>(table: &SweepTable, run: &'a Table) -> Result<Vec<Quantity<'a>>> {
    let mut quantities = Vec::new();
    for column in &run.columns {
        let values = &column.values;
        let extreme = |pick: fn(f64, f64) -> f64| values.iter().copied().reduce(pick);
        let (Some(&last), Some(min), Some(max)) = (values.last(), extreme(f64::min), extreme(f64::max)) else {
            continue;
        };
        let mut summaries = Vec::new();
        for (how, base) in SUMMARIES.into_iter().zip([last, min, max]) {
            if let Some(k) = table.position(&format!("{} {how}", column.name)) {
                summaries.push((how, table.numbers(k)?, base));
            }
        }
        if !summaries.is_empty() {
            let scale = min.abs().max(max.abs());
            quantities.push(Quantity { name: &column.name, unit: &column.unit, summaries, scale });
        }
    }
    Ok(quantities)
}

/// The variants, and for each quantity by how much it changes against the run.
///
/// # Errors
/// `Input` for a table whose quantities are no numbers.
pub fn variants(table: &SweepTable, run: &Table) -> Result<Html> {
    let said = "A change is the difference from this run, relative to the largest value of the quantity in it. A variant with the same entries as this run has no change.";
    let mut html = Html::of("p", &format!("The variants of {}. {said}", table.name));
    let parameters: Vec<usize> = table.parameters().collect();
    let state = table.position(STATE);
    let is_finished = |row: usize| state.is_none_or(|state| table.rows[row][state] == FINISHED);
    if table.unfinished() > 0 {
        let text = format!(
            "{} of {} variants are not finished. Their values are those reached, and are not included in the ranges.",
            table.unfinished(),
            table.rows.len()
        );
        html = html.and(Html::of("p", &text));
    }
    let quantities = quantities(table, run)?;
    if quantities.is_empty() {
        return Ok(html.and(Html::of("p", "The variants have no quantity of the histories of this run.")));
    }
    let numbers = quantities.iter().flat_map(|quantity| &quantity.summaries).flat_map(|(_, values, _)| values);
    let left_out = numbers.flatten().filter(|value| !value.is_finite()).count();
    if left_out > 0 {
        html = html.and(Html::of(
            "p",
            &format!("{left_out} values are not finite. They have no change and are not included in the ranges."),
        ));
    }
    let called = |row: usize| {
        let pairs = parameters.iter().map(|&k| format!("{} = {}", table.columns[k].name, table.rows[row][k]));
        pairs.collect::<Vec<_>>().join(", ")
    };
    let mut ranges = Vec::new();
    for quantity in &quantities {
        for (how, values, base) in &quantity.summaries {
            let value = |row: usize| Some((values[row].filter(|value| value.is_finite())?, row));
            let found = || (0..table.rows.len()).filter(|&row| is_finished(row)).filter_map(value);
            let least = found().min_by(|a, b| a.0.total_cmp(&b.0));
            let most = found().max_by(|a, b| a.0.total_cmp(&b.0));
            let (Some(least), Some(most)) = (least, most) else { continue };
            let mut cells = vec![format!("{} {how} [{}]", quantity.name, quantity.unit), short(*base)];
            for (value, row) in [least, most] {
                cells.extend([short(value), quantity.change(value, *base), called(row)]);
            }
            ranges.push(cells);
        }
    }
    let headings = ["quantity", "this run", "least", "change", "with", "most", "change", "with"].map(str::to_owned);
    html = html.and(Html::of("h3", "Ranges")).and(Html::table(&headings, &ranges));
    let listed = table.rows.len().min(LISTED);
    for quantity in &quantities {
        let mut headings: Vec<String> = parameters.iter().map(|&k| table.columns[k].name.clone()).collect();
        headings.push(STATE.to_owned());
        headings.extend(quantity.summaries.iter().flat_map(|(how, ..)| [(*how).to_owned(), "change".to_owned()]));
        let row = |row: usize| {
            let mut cells: Vec<String> = parameters.iter().map(|&k| table.rows[row][k].clone()).collect();
            cells.push(state.map_or_else(String::new, |state| table.rows[row][state].clone()));
            for (_, values, base) in &quantity.summaries {
                let value = values[row];
                cells.push(value.map_or_else(String::new, short));
                cells.push(value.map_or_else(String::new, |value| quantity.change(value, *base)));
            }
            cells
        };
        let heading = format!("{} [{}] of the variants", quantity.name, quantity.unit);
        let rows: Vec<Vec<String>> = (0..listed).map(row).collect();
        html = html.and(Html::of("h3", &heading)).and(Html::table(&headings, &rows));
    }
    if listed < table.rows.len() {
        html = html.and(Html::of("p", &format!("{} more are in the table.", table.rows.len() - listed)));
    }
    Ok(html)
}
