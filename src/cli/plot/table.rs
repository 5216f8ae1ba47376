//! Curves of the table of a sweep: a quantity over a parameter, or how it is distributed over the runs.

use super::curves::{Args, finish, listed, near, range};
use crate::cli::print::{Outcome, print};
use crate::draw::curves::{Chart, Charts, Series, Style, of_unit};
use crate::draw::history::Shown;
use crate::draw::{self, COLOURS, Format, colour};
use crate::error::{Error, Result, shown};
use crate::io::sweep_table::{FILE, SweepTable, short};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The share of the runs (-) at which values of a distribution are told.
const SHARES: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

/// The table that a path of the command line means: a CSV file, or that in the folder of a sweep.
pub fn of(path: &Path) -> Option<PathBuf> {
    if path.is_dir() {
        let is_sweep = !path.join("case.yaml").exists() && !path.join("history.csv").exists();
        return Some(path.join(FILE)).filter(|table| is_sweep && table.is_file());
    }
    path.extension().is_some_and(|kind| kind.eq_ignore_ascii_case("csv")).then(|| path.to_owned())
}

/// Draws the columns that are asked for.
pub fn run(path: &Path, output: Option<&Path>, args: &Args) -> Outcome {
    let table = SweepTable::read(path, "name the table of a sweep, or run `mpm sweep`")?;
    if args.list {
        return print(&list(&table));
    }
    if args.y.is_empty() {
        let remedy = "name one with --y, such as --y 'top.uy last'; `--list` lists the columns";
        return Err(Error::input(path.display(), "no quantity of the table is chosen", remedy).into());
    }
    let ys = args.y.iter().map(|name| column(&table, name)).collect::<Result<Vec<_>>>()?;
    let (charts, told) = if args.distribution {
        distributions(&table, &ys, args)?
    } else {
        (over(&table, horizontal(&table, args)?, &ys, args)?, String::new())
    };
    let mut charts = charts;
    let is_shown = |place: &[f64; 2]| place.iter().all(|v| v.is_finite());
    if !charts.iter().flat_map(|chart| &chart.series).flat_map(|series| &series.places).any(is_shown) {
        let problem = match args.distribution {
            true => "no row has a number in a column of --y",
            false => "no row has a number in both columns",
        };
        return Err(Error::input(path.display(), problem, "choose others; `--list` lists them").into());
    }
    finish(&mut charts, args)?;
    let remark = match table.unfinished() {
        0 => String::new(),
        count => format!("{count} of {} runs are not finished", table.rows.len()),
    };
    let path = match output {
        Some(output) => output.to_owned(),
        None if table.is_sweep() || path.ends_with(FILE) => path.with_extension("svg"),
        // A picture of the same name beside any other table may be someone else's.
        None => {
            let problem = "is not the table of a sweep, whose picture has a name of its own";
            return Err(Error::input(path.display(), problem, "name the picture with -o").into());
        }
    };
    Format::of(&path)?;
    draw::write(&Charts { title: args.title.clone().unwrap_or_default(), remark, charts }, &path)?;
    print(&format!("{told}{}\n", path.display()))
}

/// The columns, with the ranges of those that are numeric.
fn list(table: &SweepTable) -> String {
    let said = |k: usize| match table.numbers(k) {
        Ok(numbers) => range(numbers.into_iter().flatten()).unwrap_or_else(|| "empty".to_owned()),
        Err(_) => "texts".to_owned(),
    };
    let columns = table.columns.iter().enumerate().map(|(k, column)| (column.heading(), said(k)));
    listed(&table.name, table.rows.len(), columns.collect())
}

fn column(table: &SweepTable, name: &str) -> Result<usize> {
    table.position(name).ok_or_else(|| {
        let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        Error::input("--x, --y", format!("{} has no column `{}`", table.name, shown(name)), near(name, &names))
    })
}

/// The column along the horizontal axis: without a choice the first parameter.
fn horizontal(table: &SweepTable, args: &Args) -> Result<usize> {
    match (&args.x, table.parameters().next()) {
        (Some(name), _) => column(table, name),
        (None, Some(first)) => Ok(first),
        (None, None) => {
            let problem = "it is not the table of a sweep, and has no first parameter";
            Err(Error::input(&table.name, problem, "name the column along the horizontal axis with --x"))
        }
    }
}

/// Rows that belong together, with what they are called.
type Group = (String, Vec<usize>);

/// The rows of a curve over column `x`: those that have the same values of all other parameters. One group, that is no curve, where `x` is no parameter or
/// there would be more curves than colours.
fn groups(table: &SweepTable, x: usize) -> (Vec<Group>, Style) {
    let all = || vec![(String::new(), (0..table.rows.len()).collect())];
    if !table.parameters().contains(&x) {
        return (all(), Style::Points);
    }
    let varies = |&k: &usize| k != x && table.rows.iter().any(|row| row[k] != table.rows[0][k]);
    let others: Vec<usize> = table.parameters().filter(varies).collect();
    let mut groups: Vec<Group> = Vec::new();
    for (i, row) in table.rows.iter().enumerate() {
        let values: Vec<String> = others.iter().map(|&k| format!("{} = {}", table.columns[k].name, row[k])).collect();
        let name = values.join(", ");
        match groups.iter_mut().find(|(known, _)| *known == name) {
            Some((_, rows)) => rows.push(i),
            None => groups.push((name, vec![i])),
        }
        if groups.len() > COLOURS.len() {
            return (all(), Style::Points);
        }
    }
    (groups, Style::Line)
}

/// The columns `ys` over `x`; those of one unit share a chart.
fn over(table: &SweepTable, x: usize, ys: &[usize], args: &Args) -> Result<Vec<Chart>> {
    let along = table.numbers(x)?;
    let (groups, style) = groups(table, x);
    let mut charts: Vec<(String, Chart)> = Vec::new();
    for &y in ys {
        let up = table.numbers(y)?;
        for (name, rows) in &groups {
            let place = |&row: &usize| Some([args.scale_x * along[row]?, args.scale_y * up[row]?]);
            let mut places: Vec<[f64; 2]> = rows.iter().filter_map(place).collect();
            if style == Style::Line {
                places.sort_by(|a, b| a[0].total_cmp(&b[0]));
            }
            let column = &table.columns[y];
            let axes = [(x, args.scale_x), (y, args.scale_y)].map(|axis| title(table, axis));
            let chart = of_unit(&mut charts, &column.unit, axes);
            let name = match (ys.len(), name.is_empty()) {
                (1, _) => name.clone(),
                (_, true) => column.name.clone(),
                _ => format!("{}, {name}", column.name),
            };
            chart.series.push(Series { name, style, colour: colour(chart.series.len()), places });
        }
    }
    Ok(charts.into_iter().map(|(_, chart)| chart).collect())
}

/// The title of the axis of a column times a factor.
fn title(table: &SweepTable, (column, scale): (usize, f64)) -> String {
    let column = &table.columns[column];
    Shown { column: column.name.clone(), scale }.title(&column.unit)
}

/// How columns are distributed over all rows: charts of the share of the runs that have less, and what is told of each.
fn distributions(table: &SweepTable, ys: &[usize], args: &Args) -> Result<(Vec<Chart>, String)> {
    let (mut charts, mut told): (Vec<Chart>, String) = Default::default();
    for &y in ys {
        let (mut values, others): (Vec<f64>, Vec<f64>) =
            table.numbers(y)?.into_iter().flatten().map(|v| args.scale_y * v).partition(|v| v.is_finite());
        values.sort_by(f64::total_cmp);
        let (n, axis) = (values.len(), title(table, (y, args.scale_y)));
        let places = values.iter().enumerate().map(|(i, &v)| [v, (i as f64 + 0.5) / n as f64]).collect();
        let series = Series { name: String::new(), style: Style::Line, colour: colour(0), places };
        let axes = [axis.clone(), "share of the runs with less [-]".to_owned()];
        charts.push(Chart { axes, series: vec![series], ..Chart::default() });
        let mut parts = vec![format!("{n} {}", if n == 1 { "run" } else { "runs" })];
        let mean = values.iter().sum::<f64>() / n as f64;
        if n > 0 {
            parts.push(format!("mean {}", short(mean)));
        }
        if n > 1 {
            let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n as f64 - 1.0);
            parts.push(format!("standard deviation {}", short(square.sqrt())));
        }
        if !others.is_empty() {
            parts.push(format!("{} left out, not finite", others.len()));
        }
        let _ = writeln!(told, "{axis}: {}", parts.join(", "));
        if n > 0 {
            let shares = SHARES.map(|share| format!("{} % {}", 100.0 * share, short(below(&values, share))));
            let _ = writeln!(told, "  {}", shares.join(", "));
        }
    }
    Ok((charts, told))
}

/// The value that a share of ascending values is below, linear between them where value i of n has the share (i − 1/2)/n.
fn below(values: &[f64], share: f64) -> f64 {
    let at = (share * values.len() as f64 - 0.5).clamp(0.0, values.len() as f64 - 1.0);
    let (low, part) = (at.floor() as usize, at.fract());
    let high = (low + 1).min(values.len() - 1);
    values[low] + part * (values[high] - values[low])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_linear_between_the_values() {
        let values = [1.0, 2.0, 4.0, 8.0];
        for (share, value) in [(0.0, 1.0), (0.125, 1.0), (0.25, 1.5), (0.5, 3.0), (0.875, 8.0), (1.0, 8.0)] {
            assert!((below(&values, share) - value).abs() < 1e-12, "{share}");
        }
        assert_eq!(below(&[3.0], 0.5), 3.0);
    }
}
