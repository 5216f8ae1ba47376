//! One page on a run, which is whole in itself: the scene, its entries, curves, the work of the solver and where all is from.

mod entries;
mod html;
mod scene;
mod variants;

use crate::case::{self, Loaded};
use crate::draw::curves::{Chart, Charts};
use crate::draw::field::Field;
use crate::draw::history::{self, Run, TIME};
use crate::draw::{self, Picture};
use crate::error::Result;
use crate::io::provenance::{Program, Record, Session};
use crate::io::table::Column;
use crate::mesh::Mesh;
use entries::{Kinds, entries, plain};
use serde_json::Value;

pub use html::Html;
pub use variants::variants;

/// Cells from which on a mesh is an image of pixels: as lines it would be a page of many megabytes.
const MANY_CELLS: usize = 4000;
/// The heading of the curves.
const HISTORIES: &str = "Histories";
/// How the result of a search for the factor of safety begins in the log.
const SAFETY: &str = "factor of safety";
/// Remarks of a log that are told, first and last.
const REMARKS: usize = 60;

/// What a report is on.
pub struct Subject<'a> {
    pub loaded: &'a Loaded,
    /// The mesh, or why there is none to show.
    pub mesh: std::result::Result<&'a Mesh<2>, String>,
    pub run: &'a Run,
    /// Pictures of fields, or why there are none.
    pub pictures: std::result::Result<Vec<Field>, String>,
    /// The records of the stages.
    pub records: &'a [Record],
    /// The [`variants`] of the case, or why they cannot be shown, where there is a sweep.
    pub sweep: Option<std::result::Result<Html, String>>,
    /// What the reader must know first, such as that the case has changed since.
    pub cautions: &'a [String],
    /// When the page is written (RFC 3339).
    pub now: String,
}

impl Subject<'_> {
    /// The page.
    ///
    /// # Errors
    /// `Machine` when a picture cannot be drawn.
    pub fn page(&self) -> Result<String> {
        let case = &self.loaded.case;
        let title = if case.title.is_empty() { "A case without a title" } else { &case.title };
        let mut body = Html::of("h1", title).and(Html::of("p", &self.state()));
        for caution in self.cautions {
            body = body.and(Html::element("p", Html::of("strong", caution)));
        }
        let parts: [(&str, Html); 8] = [
            ("Scene", self.scene()?),
            ("Entries of the case", self.entries()),
            ("Numerics that differ from the defaults", self.numerics()),
            (HISTORIES, self.histories()?),
            ("Energy", self.energy()?),
            ("Fields", self.fields()?),
            ("Work of the solver", self.work()?),
            ("Provenance", self.provenance()),
        ];
        for (heading, part) in parts {
            body = body.and(Html::of("h2", heading)).and(part);
            // After the results themselves.
            if let Some(sweep) = self.sweep.as_ref().filter(|_| heading == HISTORIES) {
                let missing = |problem: &String| Html::of("p", &format!("The variants cannot be shown: {problem}"));
                let variants = sweep.as_ref().map_or_else(missing, Html::clone);
                body = body.and(Html::of("h2", "What the results depend on")).and(variants);
            }
        }
        Ok(Html::page(title, &body))
    }

    fn state(&self) -> String {
        let state = match &self.run.unfinished {
            Some(state) => format!("The run is {state}."),
            None => "The run is finished.".to_owned(),
        };
        let time = self.records.iter().find(|record| record.stage == "solve").map_or(0.0, run_time);
        let geometry = self.loaded.source.tree().get("geometry").map_or_else(String::new, plain).replace('_', " ");
        format!(
            "{state} Run time {}. Geometry: {geometry}. Units are kN, m, s, t. Written at {}.",
            duration(time),
            self.now
        )
    }

    fn scene(&self) -> Result<Html> {
        let mesh = match &self.mesh {
            Ok(mesh) => *mesh,
            Err(problem) => return Ok(Html::of("p", &format!("The mesh cannot be shown: {problem}"))),
        };
        let scene = scene::shown(&self.loaded.case, mesh);
        let caption = format!("{} cells, {} nodes", mesh.cells.len(), mesh.nodes.len());
        match mesh.cells.len() {
            ..MANY_CELLS => figure(&scene, &caption),
            _ => Ok(Html::image(&draw::png(&scene)?, scene.size()[0], &caption)),
        }
    }

    fn entries(&self) -> Html {
        let (schema, tree) = (case::schema(), self.loaded.source.tree());
        let kinds = Kinds::of(&schema);
        let named = |block: &str| entries(tree.get(block), name);
        let mut html = Html::default();
        for (heading, kind, first, block) in [
            ("Regions", "Region", "region", "regions"),
            ("Materials", "Material", "", "materials"),
            ("Contacts", "Contact", "", "contacts"),
            ("Supports", "Components", "curve or structure", "supports"),
            ("Phases", "Phase", "", "phases"),
            ("Histories", "History", "", "output.history"),
        ] {
            let found = match block.split_once('.') {
                Some((outer, inner)) => entries(tree.get(outer).and_then(|outer| outer.get(inner)), name),
                None => named(block),
            };
            if !found.is_empty() {
                let wide = matches!(kind, "Material" | "Phase" | "Contact");
                let table = if wide { kinds.columns(kind, first, &found) } else { kinds.rows(kind, first, &found) };
                html = html.and(Html::of("h3", heading)).and(table);
            }
        }
        let told = ["title", "regions", "materials", "contacts", "supports", "phases", "numerics"];
        // The histories have been told.
        let mut tree = tree.clone();
        tree.get_mut("output").and_then(Value::as_object_mut).map(|output| output.remove("history"));
        let others = tree.as_object().into_iter().flatten().filter(|(key, _)| !told.contains(&key.as_str()));
        let rows: Vec<_> = others.map(|(key, value)| vec![key.replace('_', " "), plain(value)]).collect();
        html.and(Html::of("h3", "Other entries")).and(Html::table(&["entry", "value"].map(str::to_owned), &rows))
    }

    fn numerics(&self) -> Html {
        let schema = case::schema();
        let none = Value::Null;
        Kinds::of(&schema).changed("Numerics", self.loaded.source.tree().get("numerics").unwrap_or(&none))
    }

    fn histories(&self) -> Result<Html> {
        let charts = history::all(std::slice::from_ref(self.run));
        if charts.is_empty() {
            return Ok(Html::of("p", "The case asks for no histories (`output.history`)."));
        }
        let found = self.run.log.remarks.iter().filter(|remark| remark.text.starts_with(SAFETY));
        let found = found.fold(Html::default(), |html, remark| html.and(Html::of("p", &remark.text)));
        Ok(found.and(figures(charts)?))
    }

    fn energy(&self) -> Result<Html> {
        let Some(run) = self.run.energy.is_some().then(|| self.run.clone().of_energy()).transpose()? else {
            return Ok(Html::of("p", "The run has no balance of energy (energy.csv)."));
        };
        let last = |column: &Column| column.values.last().copied().unwrap_or(0.0);
        let items = run.table.columns.iter().filter(|column| column.name != TIME && last(column) != 0.0);
        let rows: Vec<_> =
            items.map(|column| vec![column.name.replace('.', ": "), format!("{:.4e}", last(column))]).collect();
        let text = "What was supplied is what is held, what soil and contacts dissipated, and what the method did. At the end of the run:";
        let table = Html::table(&["", "energy [kJ]"].map(str::to_owned), &rows);
        Ok(Html::of("p", text).and(table).and(figures(history::energy(std::slice::from_ref(&run)))?))
    }

    fn fields(&self) -> Result<Html> {
        let pictures = match &self.pictures {
            Ok(pictures) => pictures,
            Err(problem) => return Ok(Html::of("p", &format!("There are no pictures: {problem}"))),
        };
        if pictures.is_empty() {
            return Ok(Html::of("p", "No step has converged, or the output has no field that is shown."));
        }
        let mut html = Html::default();
        for picture in pictures {
            html = html.and(Html::image(&draw::png(picture)?, picture.size()[0], &picture.title));
        }
        Ok(html)
    }

    fn work(&self) -> Result<Html> {
        let log = &self.run.log;
        let count = log.steps.len();
        let sum = |value: fn(&crate::io::solve_log::Step) -> f64| log.steps.iter().map(value).sum::<f64>();
        let per_step = sum(|step| step.iterations) / count.max(1) as f64;
        let rows = [
            ("steps", count.to_string()),
            ("iterations", format!("{} ({per_step:.1} a step)", sum(|step| step.iterations))),
            ("halvings", sum(|step| step.halvings).to_string()),
            ("restorations of the grid", log.steps.iter().filter(|step| step.restored).count().to_string()),
        ];
        let rows = rows.map(|(name, value)| vec![name.to_owned(), value]);
        let mut html = Html::table(&["", "number"].map(str::to_owned), &rows);
        if count > 0 {
            html = html.and(figures(history::work(std::slice::from_ref(self.run)))?);
        }
        html = html.and(Html::list(&log.heading));
        let remarks: Vec<_> =
            log.remarks.iter().map(|remark| format!("t = {} s: {}", remark.time, remark.text)).collect();
        let said = if remarks.is_empty() { "solve.log has no remarks or warnings." } else { "What solve.log remarks:" };
        html = html.and(Html::of("p", said));
        if remarks.len() <= 2 * REMARKS {
            return Ok(if remarks.is_empty() { html } else { html.and(Html::list(&remarks)) });
        }
        let left_out = format!("{} more are in solve.log", remarks.len() - 2 * REMARKS);
        let (first, last) = (&remarks[..REMARKS], &remarks[remarks.len() - REMARKS..]);
        Ok(html.and(Html::list(first)).and(Html::of("p", &left_out)).and(Html::list(last)))
    }

    fn provenance(&self) -> Html {
        let mut html = Html::default();
        for Record { stage, program, inputs, files, sessions, outputs, finished } in self.records {
            let Program { version, commit, sources, build, gmsh } = program;
            let mut rows = vec![
                ["program".to_owned(), format!("mpm {version}, commit {commit}, sources {sources}")],
                ["build".to_owned(), format!("{build}, Gmsh {gmsh}")],
                ["hash of all inputs".to_owned(), inputs.clone()],
            ];
            rows.extend(files.iter().map(|(name, hash)| ["input".to_owned(), format!("{name}: {hash}")]));
            for session in sessions {
                let ended = session.ended.as_deref().unwrap_or("not known");
                rows.push(["command".to_owned(), session.command.join(" ")]);
                rows.push(["time".to_owned(), format!("{} to {ended}", session.started)]);
                rows.extend(session.reason.iter().map(|reason| ["ended because".to_owned(), reason.clone()]));
            }
            rows.push(["outputs".to_owned(), format!("{} files", outputs.len())]);
            let heading = format!("{stage}, {}", if *finished { "finished" } else { "not finished" });
            let rows: Vec<_> = rows.into_iter().map(Vec::from).collect();
            html = html.and(Html::of("h3", &heading)).and(Html::table(&["", "value"].map(str::to_owned), &rows));
        }
        if self.records.is_empty() {
            Html::of("p", "The output folder has no records of what it was made from.")
        } else {
            html
        }
    }
}

/// What an entry of a list is called: by its name, what it is of, or its place in the list.
fn name(i: usize, entry: &Value) -> String {
    let text = |key: &str| entry.get(key).and_then(Value::as_str).map(str::to_owned);
    text("name").unwrap_or_else(|| (i + 1).to_string())
}

/// Each chart as a picture of its own, so that pages break between them.
fn figures(charts: Vec<Chart>) -> Result<Html> {
    let mut html = Html::default();
    for chart in charts {
        html = html.and(figure(&Charts { charts: vec![chart], ..Charts::default() }, "")?);
    }
    Ok(html)
}

fn figure(picture: &impl Picture, caption: &str) -> Result<Html> {
    Ok(Html::figure(draw::svg(picture)?, caption))
}

/// Seconds that the processes of a stage have taken.
fn run_time(record: &Record) -> f64 {
    let at = |text: &str| humantime::parse_rfc3339(text).ok();
    let session = |session: &Session| {
        let ended = at(session.ended.as_deref()?)?;
        Some(ended.duration_since(at(&session.started)?).ok()?.as_secs_f64())
    };
    record.sessions.iter().filter_map(session).sum()
}

fn duration(seconds: f64) -> String {
    humantime::format_duration(std::time::Duration::from_secs_f64(seconds.round())).to_string()
}
