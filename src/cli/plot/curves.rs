//! Curves of the histories of runs.

use crate::case;
use crate::cli::print::{Outcome, note, print};
use crate::draw::curves::{Chart, Charts, Mark, Series, Style};
use crate::draw::history::{self, Run, Shown, TIME};
use crate::draw::{self, Format, INK};
use crate::error::{Error, Result, shown};
use crate::io::atomic;
use crate::io::run_folder::{RunFolder, Runs, Standing};
use crate::io::table::{Column, Table};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub struct Args {
    /// The column along the horizontal axis, as `head.uy` or with its unit [default: time; of a sweep its first parameter]
    #[arg(long, value_name = "COLUMN")]
    pub x: Option<String>,
    /// The columns along the vertical axis [default: load over displacement where the history has both, else all over time]
    #[arg(long, value_name = "COLUMN,…", value_delimiter = ',')]
    pub y: Vec<String>,
    /// A factor of the horizontal axis, such as -1
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true)]
    pub scale_x: f64,
    /// A factor of the vertical axis
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true)]
    pub scale_y: f64,
    /// Values to compare with, drawn as circles: two columns with headings, as they are to be shown
    #[arg(long, value_name = "FILE.csv")]
    reference: Vec<PathBuf>,
    /// A horizontal line at a value, or NAME=VALUE
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    line: Vec<String>,
    /// The name of a curve in the legend, one for each curve in their order
    #[arg(long, value_name = "TEXT")]
    label: Vec<String>,
    /// Axes with logarithms: x, y or xy
    #[arg(long, value_name = "AXES", value_parser = ["x", "y", "xy"])]
    log: Option<String>,
    /// Let the vertical axis grow downwards, as for a depth
    #[arg(long)]
    down: bool,
    /// Iterations, sizes and halvings of the steps over time, in place of the history
    #[arg(long, conflicts_with_all = ["x", "y", "scale_x", "scale_y", "reference", "line", "label", "log", "down"])]
    pub iterations: bool,
    /// Columns of the balance of energy (energy.csv) in place of the history [default: all that are not zero, over time]
    #[arg(long, conflicts_with = "iterations")]
    pub energy: bool,
    /// The title [default: that of the case]
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// Of a sweep: the share of the runs that have less than a value, in place of a quantity over a parameter
    #[arg(long, conflicts_with_all = ["x", "scale_x"])]
    pub distribution: bool,
    /// List the columns, with their ranges, and draw nothing
    #[arg(long)]
    pub list: bool,
}

impl Args {
    /// The first option that only curves have, if one is given.
    pub fn first_given(&self) -> Option<&'static str> {
        let given = [
            (self.x.is_some(), "--x"),
            (!self.y.is_empty(), "--y"),
            (self.scale_x != 1.0, "--scale-x"),
            (self.scale_y != 1.0, "--scale-y"),
            (self.iterations, "--iterations"),
            (self.energy, "--energy"),
            (self.distribution, "--distribution"),
            (self.list, "--list"),
            (!self.reference.is_empty(), "--reference"),
            (!self.line.is_empty(), "--line"),
            (!self.label.is_empty(), "--label"),
            (self.log.is_some(), "--log"),
            (self.down, "--down"),
        ];
        given.into_iter().find(|(given, _)| *given).map(|(_, name)| name)
    }

    /// The same of those that a curve along a line has not.
    pub fn first_of_histories(&self) -> Option<&'static str> {
        self.first_given().filter(|name| !["--reference", "--line", "--label", "--log", "--down"].contains(name))
    }
}

pub fn run(cases: &[PathBuf], output: Option<&Path>, args: &Args, unfinished: bool) -> Outcome {
    let found: Vec<Found> = cases.iter().map(|case| find(case, unfinished)).collect::<Result<_>>()?;
    let mut runs = Vec::with_capacity(found.len());
    for (i, Found { run, title, path }) in found.iter().enumerate() {
        // A title that two runs have tells neither.
        let alone = found.iter().enumerate().all(|(j, other)| i == j || other.title != *title);
        let name = title.clone().filter(|_| alone).unwrap_or_else(|| path.display().to_string());
        let read = Run::read(run, name)?;
        if let Some(state) = &read.unfinished {
            note(&format!("note: {}: {state}", run.path().display()));
        }
        runs.push(if args.energy { read.of_energy()? } else { read });
    }
    if args.list {
        return print(&runs.iter().map(list).collect::<String>());
    }
    let mut charts = charts(&runs, args)?;
    if charts.iter().all(|chart| chart.series.iter().all(|series| series.places.is_empty())) {
        let place = found.first().map_or_else(String::new, |found| found.run.path().display().to_string());
        let problem = if args.iterations { "no step has converged" } else { "the history has no quantities to draw" };
        return Err(Error::input(place, problem, "let `output.history` of the case name some, and solve it").into());
    }
    finish(&mut charts, args)?;
    let one = |values: Vec<Option<&String>>| match &values[..] {
        [value] => value.cloned(),
        [first, rest @ ..] if rest.iter().all(|value| value == first) => first.cloned(),
        _ => None,
    };
    let title = args.title.clone().or_else(|| one(found.iter().map(|found| found.title.as_ref()).collect()));
    let remark = match &runs[..] {
        [run] => run.unfinished.clone().unwrap_or_default(),
        runs => runs.iter().filter(|run| run.unfinished.is_some()).fold(String::new(), |text, run| {
            let before = if text.is_empty() { "not finished: " } else { ", " };
            format!("{text}{before}{}", run.name)
        }),
    };
    let folder = found.first().map(|found| found.run.path()).unwrap_or(Path::new(""));
    let path =
        output.map_or_else(|| folder.join(if args.energy { "energy.svg" } else { "history.svg" }), Path::to_owned);
    Format::of(&path)?;
    draw::write(&Charts { title: title.unwrap_or_default(), remark, charts }, &path)?;
    print(&format!("{}\n", path.display()))
}

/// A run, with the title of its case where that is known, and what it was called on the command line.
struct Found {
    run: RunFolder,
    title: Option<String>,
    path: PathBuf,
}

/// The run of a case, or that in an output folder.
fn find(path: &Path, unfinished: bool) -> Result<Found> {
    let is_case = path.is_file() || path.join("case.yaml").is_file();
    let folder = match (is_case, path.is_dir()) {
        (true, true) => path.join("out"),
        (true, false) => path.parent().unwrap_or(Path::new("")).join("out"),
        (false, true) => path.to_owned(),
        (false, false) => return Err(Error::input(path.display(), "there is no such case or folder", "name one")),
    };
    // The picture goes there, too.
    atomic::refuse_link(&folder)?;
    let runs = Runs::of(&folder);
    let Some(run) = runs.with_history(unfinished) else {
        let problem = "there is no history.csv of a run";
        return Err(Error::input(folder.display(), problem, "solve the case, or name the output folder of a run"));
    };
    let beside = run == runs.main && runs.beside.history().is_file();
    if beside && !unfinished && run.standing()? == Standing::Finished {
        note(&format!(
            "note: {}: a later run that is not finished is there too; `--unfinished` draws it",
            folder.display()
        ));
    }
    // A case with mistakes may have results all the same; its folder names it then.
    let title = is_case.then(|| case::load(path, &[]).ok()).flatten().map(|loaded| loaded.case.title);
    Ok(Found { run, title: title.filter(|title| !title.is_empty()), path: path.to_owned() })
}

/// The columns of each run, with their ranges.
fn list(run: &Run) -> String {
    let said = |column: &Column| (column.heading(), range(column.values.iter().copied()).unwrap_or_default());
    listed(&run.name, run.table.rows(), run.table.columns.iter().map(said).collect())
}

/// The headings of a table and what is said of each column, in lines.
pub fn listed(name: &str, rows: usize, columns: Vec<(String, String)>) -> String {
    let width = columns.iter().map(|(heading, _)| heading.chars().count()).max().unwrap_or(0);
    let line = |(heading, said)| format!("  {heading:<width$}  {said}\n");
    format!("{name}: {rows} rows\n") + &columns.into_iter().map(line).collect::<String>()
}

/// The least and the greatest of some values; `None` without any.
pub fn range(values: impl Iterator<Item = f64>) -> Option<String> {
    let range = values.map(|v| [v, v]).reduce(|[low, high], [v, _]| [low.min(v), high.max(v)]);
    range.map(|[low, high]| format!("{low} … {high}"))
}

fn charts(runs: &[Run], args: &Args) -> Result<Vec<Chart>> {
    if args.iterations {
        return Ok(history::work(runs));
    }
    if args.x.is_none() && args.y.is_empty() {
        if [args.scale_x, args.scale_y] != [1.0, 1.0] {
            let problem = "the default curves have signs of their own";
            return Err(Error::input("--scale-x, --scale-y", problem, "choose columns with --x and --y"));
        }
        return Ok(if args.energy { history::energy(runs) } else { history::usual(runs) });
    }
    let x = column(runs, args.x.as_deref().unwrap_or(TIME))?;
    let ys = match &args.y[..] {
        [] => {
            let others = history::columns(runs).into_iter().filter(|other| other.name != x);
            others.map(|other| other.name.clone()).collect()
        }
        names => names.iter().map(|name| column(runs, name)).collect::<Result<Vec<_>>>()?,
    };
    let y = |column| Shown { column, scale: args.scale_y };
    Ok(history::chosen(runs, &Shown { column: x, scale: args.scale_x }, &ys.into_iter().map(y).collect::<Vec<_>>()))
}

/// The name of a column that all runs have.
fn column(runs: &[Run], name: &str) -> Result<String> {
    let mut found = String::new();
    for run in runs {
        let Some(column) = run.table.column(name) else {
            let names: Vec<&str> = run.table.columns.iter().map(|column| column.name.as_str()).collect();
            let problem = format!("{} has no column `{}`", run.name, shown(name));
            return Err(Error::input("--x, --y", problem, near(name, &names)));
        };
        found.clone_from(&column.name);
    }
    Ok(found)
}

/// Names that may be meant: the most like it, a few.
pub fn near(name: &str, names: &[&str]) -> String {
    /// Names that are told.
    const TOLD: usize = 4;
    let mut names: Vec<(f64, &str)> = names.iter().map(|other| (strsim::jaro_winkler(name, other), *other)).collect();
    names.sort_by(|a, b| b.0.total_cmp(&a.0));
    let names: Vec<String> = names.iter().take(TOLD).map(|(_, name)| format!("`{name}`")).collect();
    format!("near to it are {}; `--list` lists all", names.join(", "))
}

/// Names the curves, sets the axes, and adds the values to compare with.
pub fn finish(charts: &mut [Chart], args: &Args) -> Result<()> {
    let count: usize = charts.iter().map(|chart| chart.series.len()).sum();
    if !args.label.is_empty() && args.label.len() != count {
        let problem = format!("there are {} names for {count} curves", args.label.len());
        return Err(Error::input("--label", problem, "give one for each curve, or none"));
    }
    for (series, label) in charts.iter_mut().flat_map(|chart| &mut chart.series).zip(&args.label) {
        series.name.clone_from(label);
    }
    compare(charts, args)?;
    let log = ["x", "y"].map(|axis| args.log.as_ref().is_some_and(|axes| axes.contains(axis)));
    let mut left_out = 0;
    for chart in charts {
        (chart.log, chart.down, chart.named) = (log, args.down, !args.label.is_empty());
        let lacks = |place: &&[f64; 2]| (0..2).any(|d| log[d] && place[d] <= 0.0);
        let places = || chart.series.iter().flat_map(|series| &series.places);
        let lacking = places().filter(lacks).count();
        if lacking > 0 && lacking == places().count() {
            let remedy = "take `--log` out, or turn the sign with --scale-x or --scale-y -1";
            return Err(Error::input("--log", "no value is positive, as a logarithm needs", remedy));
        }
        left_out += lacking;
    }
    if left_out > 0 {
        note(&format!("note: {left_out} places are left out: they have no logarithm, as they are not positive"));
    }
    Ok(())
}

/// Adds the values to compare with.
fn compare(charts: &mut [Chart], args: &Args) -> Result<()> {
    if args.reference.is_empty() && args.line.is_empty() {
        return Ok(());
    }
    let [chart] = charts else {
        let problem = format!("there are {} charts, and nothing says which one it belongs to", charts.len());
        return Err(Error::input("--reference, --line", problem, "choose the columns of one unit with --x and --y"));
    };
    for path in &args.reference {
        let table = Table::read(path, "name a CSV file")?;
        let [x, y] = &table.columns[..] else {
            let problem = format!("it has {} columns, not two", table.columns.len());
            return Err(Error::input(
                path.display(),
                problem,
                "give it the headings of two columns, and two numbers a row",
            ));
        };
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let places = x.values.iter().zip(&y.values).map(|(x, y)| [*x, *y]).collect();
        chart.series.push(Series { name, style: Style::Points, colour: INK, places });
    }
    for line in &args.line {
        let (name, value) = line.rsplit_once('=').unwrap_or((line, line));
        let at = value.trim().parse().ok().filter(|at: &f64| at.is_finite()).ok_or_else(|| {
            Error::input("--line", format!("`{}` is no number", shown(value)), "write --line 5.14, or --line 2+π=5.14")
        })?;
        chart.levels.push(Mark { at, name: name.trim().to_owned() });
    }
    Ok(())
}
