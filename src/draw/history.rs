//! Which curves the histories of runs are: load over displacement, quantities over time, the work of the solver.
//!
//! Load–displacement curves are drawn as a test is plotted: the displacement is positive in the direction in which it goes farthest, and
//! the load where it acts in that direction, on a structure or a side that is moved. `reaction` is the force of what holds or moves it, and
//! is that load itself; `contact` is the force of the soil on it, and the load is its opposite. The titles of the axes say which sign the
//! column of the history has been given.

use super::colour;
use super::curves::{Chart, Mark, Series, Style, of_unit};
use crate::error::{Error, Result};
use crate::io::run_folder::{RunFolder, Standing};
use crate::io::solve_log::{SolveLog, Step};
use crate::io::table::{Column, Table};

/// The column of the time.
pub const TIME: &str = "time";

/// The columns of a search for the factor of safety: what strengths are divided by, and how far the soil has moved.
const SEARCH: [&str; 2] = ["strength_reduction", "soil_moved"];

/// Differences of times (s) that are none, by their last digits in the log.
const SAME_TIME: f64 = 1e-8;

/// A run to draw.
#[derive(Clone, Debug)]
pub struct Run {
    /// What the legend calls it.
    pub name: String,
    pub table: Table,
    /// The balance of energy, where there is one.
    pub energy: Option<Table>,
    pub log: SolveLog,
    /// How far it has come and why it ended, if it is not finished.
    pub unfinished: Option<String>,
}

impl Run {
    /// Reads the history and the log of a run.
    ///
    /// # Errors
    /// `Input` for a history that is missing or no table, `Machine` when a file cannot be read.
    pub fn read(folder: &RunFolder, name: String) -> Result<Self> {
        let table = Table::read(&folder.history(), "run `mpm solve` first")?;
        // A history that has been taken elsewhere comes without a log.
        let log = if folder.log().exists() { SolveLog::read(&folder.log())? } else { SolveLog::default() };
        let energy = folder.energy();
        let energy = energy.exists().then(|| Table::read(&energy, "run `mpm solve` first")).transpose()?;
        let record = folder.record();
        let until = table.column(TIME).and_then(|time| time.values.last()).copied().unwrap_or(0.0);
        let unfinished = record.filter(|_| folder.standing().is_ok_and(|standing| standing != Standing::Finished));
        let unfinished = unfinished.map(|record| {
            let reason = record.sessions.last().and_then(|session| session.reason.clone());
            let reason = reason.unwrap_or_else(|| "it is running, or was killed".to_owned());
            // More digits are rounding.
            let until = format!("{until:.9}");
            let until = until.trim_end_matches('0').trim_end_matches('.');
            format!("not finished, up to t = {until} s: {reason}")
        });
        Ok(Self { name, table, energy, log, unfinished })
    }

    /// The run with its balance of energy in place of its history.
    ///
    /// # Errors
    /// `Input` where it has none.
    pub fn of_energy(mut self) -> Result<Self> {
        let Some(table) = self.energy.take() else {
            return Err(Error::input(&self.name, "has no balance of energy (energy.csv)", "solve it again"));
        };
        Ok(Self { table, ..self })
    }

    fn places(&self, x: &Column, y: &Column, scale: [f64; 2]) -> Vec<[f64; 2]> {
        x.values.iter().zip(&y.values).map(|(x, y)| [scale[0] * x, scale[1] * y]).collect()
    }
}

/// A column of the histories as an axis shows it, times a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    pub column: String,
    pub scale: f64,
}

impl Shown {
    /// The title of its axis: the column with its factor and unit.
    pub fn title(&self, unit: &str) -> String {
        let name = match self.scale {
            1.0 => self.column.clone(),
            -1.0 => format!("−{}", self.column),
            scale => format!("{} × {}", scale.to_string().replace('-', "−"), self.column),
        };
        if unit.is_empty() { name } else { format!("{name} [{unit}]") }
    }
}

/// The columns that a run has, each once.
pub fn columns(runs: &[Run]) -> Vec<&Column> {
    let mut columns: Vec<&Column> = Vec::new();
    for column in runs.iter().flat_map(|run| &run.table.columns) {
        if columns.iter().all(|known| known.name != column.name) {
            columns.push(column);
        }
    }
    columns
}

/// The curves of some columns over one, of the runs that have both; those of one unit share a chart.
pub fn chosen(runs: &[Run], x: &Shown, ys: &[Shown]) -> Vec<Chart> {
    let mut charts: Vec<(String, Chart)> = Vec::new();
    for (run, y) in runs.iter().flat_map(|run| ys.iter().map(move |y| (run, y))) {
        let (Some(along), Some(up)) = (run.table.column(&x.column), run.table.column(&y.column)) else { continue };
        let chart = of_unit(&mut charts, &up.unit, [x.title(&along.unit), y.title(&up.unit)]);
        if chart.series.is_empty() && along.name == TIME && x.scale == 1.0 {
            chart.borders = borders(runs);
        }
        let name = match (runs.len(), ys.len()) {
            (_, 1) => run.name.clone(),
            (1, _) => y.title(""),
            _ => format!("{}: {}", run.name, y.title("")),
        };
        let colour = colour(chart.series.len());
        chart.series.push(Series {
            name,
            style: Style::Line,
            colour,
            places: run.places(along, up, [x.scale, y.scale]),
        });
    }
    charts.into_iter().map(|(_, chart)| chart).collect()
}

/// The charts that show the histories as they are looked at: load over displacement where there is one, else everything.
pub fn usual(runs: &[Run]) -> Vec<Chart> {
    let loads = loads(runs);
    if loads.is_empty() { all(runs) } else { loads.into_iter().map(|(_, chart)| chart).collect() }
}

/// Everything: load over displacement, the curves of searches for the factor of safety, and what these do not show over time.
pub fn all(runs: &[Run]) -> Vec<Chart> {
    let (shown, mut charts): (Vec<[String; 2]>, Vec<Chart>) = loads(runs).into_iter().unzip();
    charts.extend(searches(runs));
    let shown: Vec<String> = shown.concat().into_iter().chain([SEARCH[1].to_owned()]).collect();
    charts.extend(over_time(runs, &shown));
    charts
}

/// How far the soil has moved over the factor that strengths are divided by, a curve for each search.
fn searches(runs: &[Run]) -> Option<Chart> {
    let mut chart: Option<Chart> = None;
    for run in runs {
        let [Some(factor), Some(moved)] = SEARCH.map(|name| run.table.column(name)) else { continue };
        let places = run.places(factor, moved, [1.0, 1.0]);
        // It has not moved as a search begins, nor in other phases.
        let begins = |i: &usize| places[*i][1] == 0.0 && places.get(i + 1).is_some_and(|next| next[1] > 0.0);
        for begin in (0..places.len()).filter(begins) {
            let goes_on = places[begin + 1..].iter().take_while(|place| place[1] > 0.0);
            let axis = |column: &Column| Shown { column: column.name.clone(), scale: 1.0 }.title(&column.unit);
            let chart = chart.get_or_insert_with(|| Chart {
                title: "How far the soil has moved over what strengths are divided by".to_owned(),
                axes: [axis(factor), axis(moved)],
                ..Chart::default()
            });
            let colour = colour(chart.series.len());
            let places = std::iter::once(&places[begin]).chain(goes_on).copied().collect();
            chart.series.push(Series { name: run.name.clone(), style: Style::Line, colour, places });
        }
    }
    chart
}

/// Load over displacement for each entry of the history and direction that has both and moves, with the columns that each shows.
fn loads(runs: &[Run]) -> Vec<([String; 2], Chart)> {
    let mut charts = Vec::new();
    for displacement in columns(runs) {
        let Some((entry, quantity)) = displacement.name.rsplit_once('.') else { continue };
        let Some(axis) = quantity.strip_prefix('u').filter(|axis| ["x", "y", "z"].contains(axis)) else { continue };
        let farthest = farthest(runs, &displacement.name);
        // The direction in which a load acts on it: that of the reaction, against that of the contact.
        let forces =
            [("reaction", 1.0), ("contact", -1.0)].map(|(kind, sign)| (format!("{entry}.{kind}_{axis}"), sign));
        let Some((force, sign)) =
            forces.iter().find(|(force, _)| farthest != 0.0 && self::farthest(runs, force) != 0.0)
        else {
            continue;
        };
        let x = Shown { column: displacement.name.clone(), scale: farthest.signum() };
        let y = Shown { column: force.clone(), scale: sign * farthest.signum() };
        for mut chart in chosen(runs, &x, &[y]) {
            chart.title = format!("Load on {entry} over its displacement, {axis}");
            charts.push(([x.column.clone(), force.clone()], chart));
        }
    }
    charts
}

/// The value of a column that is farthest from zero, with its sign; zero without one.
fn farthest(runs: &[Run], name: &str) -> f64 {
    let values = runs.iter().filter_map(|run| run.table.column(name)).flat_map(|column| &column.values);
    values.fold(0.0, |far: f64, &v| if v.abs() > far.abs() { v } else { far })
}

/// The quantities of each entry over time, those of one unit in one chart, without the columns that are `shown` elsewhere.
fn over_time(runs: &[Run], shown: &[String]) -> Vec<Chart> {
    let entry_of = |name: &str| name.rsplit_once('.').map_or(String::new(), |(entry, _)| entry.to_owned());
    let mut groups: Vec<(String, Vec<Shown>)> = Vec::new();
    for Column { name, .. } in columns(runs).into_iter().filter(|c| c.name != TIME && !shown.contains(&c.name)) {
        let (entry, shown) = (entry_of(name), Shown { column: name.clone(), scale: 1.0 });
        match groups.iter_mut().find(|(known, _)| *known == entry) {
            Some((_, group)) => group.push(shown),
            None => groups.push((entry, vec![shown])),
        }
    }
    let time = Shown { column: TIME.to_owned(), scale: 1.0 };
    groups.iter().flat_map(|(_, columns)| chosen(runs, &time, columns)).collect()
}

/// The balance of energy over time, of runs whose table it is: what was supplied, what is held and what was dissipated, without what is zero.
pub fn energy(runs: &[Run]) -> Vec<Chart> {
    let zero = |name: &String| farthest(runs, name) == 0.0;
    let zeros = columns(runs).into_iter().map(|column| column.name.clone()).filter(zero).collect::<Vec<_>>();
    over_time(runs, &zeros)
}

/// The work of the solver over time: iterations and size of the steps, and how many were halved until then.
pub fn work(runs: &[Run]) -> Vec<Chart> {
    type Value = fn(&Step) -> f64;
    let kinds: [(&str, Value, bool); 3] = [
        ("iterations of a step", |step| step.iterations, false),
        ("size of a step [s]", |step| step.size, false),
        ("halvings, the sum", |step| step.halvings, true),
    ];
    let chart = |(title, value, sums): (&str, Value, bool)| {
        let series = runs.iter().enumerate().map(|(i, run)| {
            let mut sum = 0.0;
            let place = |step: &Step| {
                sum = if sums { sum } else { 0.0 } + value(step);
                [step.time, sum]
            };
            let places = run.log.steps.iter().map(place).collect();
            Series { name: run.name.clone(), style: Style::Line, colour: colour(i), places }
        });
        let axes = [format!("{TIME} [s]"), title.to_owned()];
        Chart { axes, series: series.collect(), borders: borders(runs), ..Chart::default() }
    };
    kinds.into_iter().map(chart).collect()
}

/// Where phases begin, if all runs have them at the same times.
fn borders(runs: &[Run]) -> Vec<Mark> {
    let [first, others @ ..] = runs else { return Vec::new() };
    let phases = first.log.phases();
    let alike = |run: &Run| {
        let other = run.log.phases();
        let same = |(a, b): (&(&str, f64), &(&str, f64))| a.0 == b.0 && (a.1 - b.1).abs() <= SAME_TIME;
        other.len() == phases.len() && other.iter().zip(&phases).all(same)
    };
    if phases.len() < 2 || !others.iter().all(alike) {
        return Vec::new();
    }
    phases.iter().map(|&(name, at)| Mark { at: at.max(0.0), name: name.to_owned() }).collect()
}
