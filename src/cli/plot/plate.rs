//! Displacement of a plate and forces in its sections, along its axis.

use super::curves::near;
use super::field;
use crate::case::parts;
use crate::cli::frames::{at, short};
use crate::cli::print::{Outcome, print};
use crate::cli::{export, mesh};
use crate::draw::curves::{Chart, Charts, Series, Style};
use crate::draw::{self, Format};
use crate::error::Error;
use crate::io::export::Series as Frames;
use crate::mesh::sections::Section;
use std::path::Path;

/// What is drawn of a section.
type Value = fn(&Section) -> f64;

/// What is drawn, with the titles of the vertical axes.
const SHOWN: [(&str, Value); 5] = [
    ("ux [m]", |s| s.displacement[0]),
    ("uy [m]", |s| s.displacement[1]),
    ("bending moment M [kN m/m]", |s| s.forces.moment),
    ("shear force Q [kN/m]", |s| s.forces.shear),
    ("normal force N [kN/m]", |s| s.forces.normal),
];

/// Draws the plate `name` of the case or output folder `case`.
pub fn run(case: &Path, output: Option<&Path>, name: &str, args: &field::Args) -> Outcome {
    let stage = field::open(case)?;
    stage.lock()?;
    let run = if args.unfinished { export::unfinished(&stage)? } else { export::shown(&stage)? };
    let mesh = mesh::read(&stage)?;
    export::check_run(&stage, &run)?;
    let regions = parts::of_series(&stage.loaded.case, &mesh);
    let frames = Frames::open(&run.results(), &mesh, &regions)?;
    let Some(plate) = frames.plates.iter().position(|plate| plate.name == name) else {
        let names: Vec<&str> = frames.plates.iter().map(|plate| plate.name.as_str()).collect();
        let problem = format!("the case has no plate `{name}`");
        let remedy = if names.is_empty() { "it has none".to_owned() } else { near(name, &names) };
        return Err(Error::input("--plate", problem, remedy).into());
    };
    let numbers = if args.times.is_empty() { vec![frames.infos.len() - 1] } else { at(&frames.infos, &args.times)? };
    let title = |text: &str| text.to_owned();
    let mut charts: Vec<Chart> = SHOWN
        .iter()
        .map(|(unit, _)| Chart { axes: [title("along the axis [m]"), title(unit)], ..Chart::default() })
        .collect();
    for (k, &i) in numbers.iter().enumerate() {
        let sections = &frames.at(i, &[])?.sections[plate];
        for (chart, (_, of)) in charts.iter_mut().zip(SHOWN) {
            chart.series.push(Series {
                name: format!("t = {} s", short(frames.infos[i].time)),
                style: Style::Line,
                colour: draw::colour(k),
                places: sections.iter().map(|section| [section.along, of(section)]).collect(),
            });
        }
    }
    let path = output.map_or_else(|| stage.folder().join(format!("{name}.svg")), Path::to_owned);
    Format::of(&path)?;
    let title = format!("{}: {name}", stage.loaded.case.title);
    draw::write(&Charts { title, remark: String::new(), charts }, &path)?;
    print(&format!("{}\n", path.display()))
}
