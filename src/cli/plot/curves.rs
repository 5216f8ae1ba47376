//! Curves of the histories of runs.

use crate::cli::print::{Outcome, print};
use crate::draw::curves::{Chart, Charts, Series, Style};
use crate::draw::{self, colour};
use crate::io::run_folder::Runs;
use crate::io::table::Table;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub struct Args {
    /// The column along the horizontal axis [default: time]
    #[arg(long, value_name = "COLUMN", default_value = "time")]
    x: String,
}

pub fn run(cases: &[PathBuf], output: Option<&Path>, args: &Args) -> Outcome {
    let mut charts = Vec::new();
    let mut first = None;
    for case in cases {
        let folder = if case.join("out").is_dir() { case.join("out") } else { case.clone() };
        let table = Table::read(&Runs::of(&folder).main.history(), "run `mpm solve` first")?;
        first.get_or_insert(folder);
        for column in &table.columns {
            let Some(x) = table.column(&args.x) else { continue };
            let places = x.values.iter().zip(&column.values).map(|(x, y)| [*x, *y]).collect();
            let series = Series { name: column.name.clone(), style: Style::Line, colour: colour(0), places };
            charts.push(Chart { axes: [x.heading(), column.heading()], series: vec![series], ..Chart::default() });
        }
    }
    let path = output.map_or_else(|| first.unwrap_or_default().join("history.svg"), Path::to_owned);
    draw::write(&Charts { charts, ..Charts::default() }, &path)?;
    print(&format!("{}\n", path.display()))
}
