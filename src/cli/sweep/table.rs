//! The table of a sweep: a row a run, with its values, how it ended, and what its history came to.

use super::axes::{Axis, Run};
use crate::cli::solve;
use crate::cli::stage::Stage;
use crate::error::{Error, Result};
use crate::io::run_folder::{RunFolder, Standing};
use crate::io::sweep_table::{self, FINISHED, RUN, STATE};
use crate::io::table::{Column, Table, guarded};

/// What is told of a quantity of a history: how the heading calls it, and its value.
type Summary = (&'static str, fn(&[f64]) -> Option<f64>);

const SUMMARIES: [Summary; 3] = [
    (sweep_table::SUMMARIES[0], |values| values.last().copied()),
    (sweep_table::SUMMARIES[1], |values| values.iter().copied().reduce(f64::min)),
    (sweep_table::SUMMARIES[2], |values| values.iter().copied().reduce(f64::max)),
];

/// A run as the table has it.
pub struct Row<'a> {
    run: &'a Run,
    state: String,
    history: Table,
}

impl<'a> Row<'a> {
    /// Reads what is in the output folder of a run.
    ///
    /// # Errors
    /// What is there but cannot be read.
    pub fn read(run: &'a Run, stage: &Stage) -> Result<Self> {
        let runs = stage.runs();
        let current = stage.mesh().exists() && stage.points().exists() && solve::is_current(stage)?;
        // Results of earlier entries of the case may be there until this run is finished.
        let shown = if current || runs.beside.standing()? == Standing::Nothing { runs.main } else { runs.beside };
        let state = if current { FINISHED.to_owned() } else { state(&shown)? };
        let history = if shown.history().exists() {
            Table::read(&shown.history(), "run the sweep again")?
        } else {
            Table::default()
        };
        Ok(Self { run, state, history })
    }

    pub fn is_finished(&self) -> bool {
        self.state == FINISHED
    }
}

/// The state of a run that is not finished.
fn state(run: &RunFolder) -> Result<String> {
    let reason = run.record().and_then(|record| record.sessions.last()?.reason.clone());
    Ok(match (run.standing()?, reason) {
        (Standing::Finished, _) => "out of date".to_owned(),
        (_, Some(reason)) => format!("ended early: {reason}"),
        (Standing::Unfinished, None) => "ended early".to_owned(),
        (Standing::Nothing, None) => "not run".to_owned(),
    })
}

/// The table as CSV: `run`, a column an axis, `state`, the time reached, and the last, least and largest value of each column of the
/// histories. A field is empty where a run has no such value.
///
/// # Errors
/// A text that cannot be written as CSV.
pub fn csv(axes: &[Axis], rows: &[Row]) -> Result<Vec<u8>> {
    let mut quantities: Vec<&Column> = Vec::new();
    for column in rows.iter().flat_map(|row| &row.history.columns).filter(|column| column.name != TIME) {
        if !quantities.iter().any(|known| known.name == column.name) {
            quantities.push(column);
        }
    }
    let labels = axes.iter().map(|axis| axis.label.clone());
    let mut header: Vec<String> = std::iter::once(RUN.to_owned()).chain(labels).collect();
    header.extend([STATE.to_owned(), format!("{TIME} [s]")]);
    for Column { name, unit, .. } in &quantities {
        header.extend(SUMMARIES.map(|(how, _)| format!("{name} {how} [{unit}]")));
    }
    let mut lines = vec![header];
    for Row { run, state, history } in rows {
        let values =
            |name: &str| history.columns.iter().find(|column| column.name == name).map(|column| &column.values);
        let text = |number: Option<f64>| {
            let known = number.filter(|number| !number.is_nan());
            known.map_or_else(String::new, |number| format!("{number:?}"))
        };
        let mut line = vec![run.name.clone()];
        line.extend(run.values.iter().cloned());
        line.extend([state.clone(), text(values(TIME).and_then(|times| times.last().copied()))]);
        for quantity in &quantities {
            line.extend(SUMMARIES.map(|(_, of)| text(values(&quantity.name).and_then(|values| of(values)))));
        }
        lines.push(line);
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    let unwritable = |e: &dyn std::fmt::Display| Error::machine("table.csv", e, "");
    for line in lines {
        writer.write_record(line.iter().map(|field| guarded(field).into_owned())).map_err(|e| unwritable(&e))?;
    }
    writer.into_inner().map_err(|e| unwritable(&e))
}

/// The column of the time in histories.
const TIME: &str = "time";
