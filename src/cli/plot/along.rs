//! Curves of a field along a line, one for each time.

use super::curves::{self, finish};
use crate::cli::frames::short;
use crate::cli::print::{Outcome, note, print};
use crate::draw::curves::{Chart, Charts, Series as Curve, Style};
use crate::draw::{self, Format, colour};
use crate::error::{Error, Result};
use crate::io::export::{Section, Series, Sheet};
use std::path::Path;

/// Draws `field` of some frames along the line between two ends (m), at so many places. On a vertical line the height is the vertical axis.
pub fn run(
    series: &Series,
    frames: &[usize],
    field: &str,
    ([x0, y0, x1, y1], stations): ([f64; 4], usize),
    title: &str,
    path: &Path,
    args: &curves::Args,
) -> Outcome {
    let name = field.split_once('.').map_or(field, |(name, _)| name);
    let section = Section::Along { ends: [[x0, y0], [x1, y1]], stations };
    let vertical = x0 == x1;
    let mut chart = Chart::default();
    for &i in frames {
        let sheet = series.section(i, &[name.to_owned()], &section)?;
        let (heading, values) = values(&sheet, field)?;
        let place = if vertical { "y [m]" } else { "distance [m]" };
        let along = column(&sheet, place).unwrap_or_default();
        chart.axes = if vertical { [heading, place.to_owned()] } else { [place.to_owned(), heading] };
        let info = &series.infos[i];
        let places = along.into_iter().zip(values).map(|(s, v)| if vertical { [v, s] } else { [s, v] }).collect();
        let name = format!("{}, t = {} s", info.phase, short(info.time));
        chart.series.push(Curve { name, style: Style::Line, colour: colour(chart.series.len()), places });
    }
    let is_known = |place: &&[f64; 2]| place.iter().all(|v| v.is_finite());
    let all = || chart.series.iter().flat_map(|curve| &curve.places);
    let (count, known) = (all().count(), all().filter(is_known).count());
    if known == 0 {
        let problem = "there is no soil along the line at that time";
        return Err(Error::input("--along", problem, "choose another line or another time").into());
    }
    if known < count {
        note(&format!("note: {} of {count} places along the line have no soil", count - known));
    }
    let mut charts = vec![chart];
    finish(&mut charts, args)?;
    let said = |v: f64| format!("{v}").replace('-', "−");
    let line = format!("from ({}, {}) m to ({}, {}) m", said(x0), said(y0), said(x1), said(y1));
    let times: Vec<&str> = if frames.len() == 1 { vec![charts[0].series[0].name.as_str()] } else { Vec::new() };
    let remark = times.into_iter().chain([line.as_str()]).collect::<Vec<_>>().join(", ");
    Format::of(path)?;
    draw::write(&Charts { title: title.to_owned(), remark, charts }, path)?;
    print(&format!("{}\n", path.display()))
}

/// A column of a sheet by its heading; what is empty is not a number.
fn column(sheet: &Sheet, heading: &str) -> Option<Vec<f64>> {
    let k = sheet.headings.iter().position(|other| other == heading)?;
    Some(sheet.rows.iter().map(|row| row[k].unwrap_or(f64::NAN)).collect())
}

/// The values of a field or its component, with their heading; a vector without a component by its magnitude.
fn values(sheet: &Sheet, field: &str) -> Result<(String, Vec<f64>)> {
    let of = |name: &str| {
        sheet.headings.iter().find(|heading| heading.rsplit_once(" [").is_some_and(|(own, _)| own == name))
    };
    if let Some(heading) = of(field) {
        return Ok((heading.clone(), column(sheet, heading).unwrap_or_default()));
    }
    if let [Some(x), Some(y)] = ["x", "y"].map(|d| of(&format!("{field}.{d}"))) {
        let [a, b] = [x, y].map(|heading| column(sheet, heading).unwrap_or_default());
        let heading = x.replacen(".x [", " [", 1);
        return Ok((heading, a.into_iter().zip(b).map(|(a, b)| a.hypot(b)).collect()));
    }
    let known: Vec<&str> = sheet.headings.iter().filter_map(|h| Some(h.rsplit_once(" [")?.0)).skip(4).collect();
    let remedy = format!("there are {}", known.join(", "));
    Err(Error::input(format!("--field {field}"), "there is no such component", remedy))
}
