//! Pictures of a field over the soil at one time or several.

use super::{along, curves};
use crate::case::parts;
use crate::cli::args::{CaseArgs, StageArgs};
use crate::cli::frames::{at, box_of, ends, numbered, range, short};
use crate::cli::print::{Outcome, note, print};
use crate::cli::stage::Stage;
use crate::cli::{export, mesh};
use crate::draw::field::{Asked, Field, Options};
use crate::draw::{self, animation};
use crate::error::{Error, Result, shown};
use crate::io::export::{Regions, Series};
use crate::io::frame::Info;
use crate::io::provenance::Record;
use crate::io::run_folder;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub struct Args {
    /// Draw the soil as a body in the colours of a field of the output: mean_stress, stress.yy, displacement (its size), displacement.x
    #[arg(long, value_name = "NAME[.COMPONENT]")]
    pub field: Option<String>,
    /// The time of the picture in s: of the frame that is nearest
    #[arg(long, value_name = "T", requires = "field", conflicts_with_all = ["frame", "times"])]
    time: Option<f64>,
    /// The frame of the picture by its number, from 0, or `last` [default: last]
    #[arg(long, value_name = "N", requires = "field", conflicts_with = "times")]
    frame: Option<String>,
    /// Times of several pictures with the same colours, each in a file named after its time
    #[arg(long, value_name = "T,T,...", value_delimiter = ',')]
    pub times: Vec<f64>,
    /// Values at the ends of the colour bar [default: what all but 1 % of the soil has; the least and the largest are told]
    #[arg(long, value_name = "LOW,HIGH", requires = "field", allow_hyphen_values = true, value_parser = range)]
    range: Option<[f64; 2]>,
    /// What is seen in m [default: all]
    #[arg(long, value_name = "X0,Y0,X1,Y1", requires = "field", allow_hyphen_values = true, value_parser = box_of)]
    window: Option<[f64; 4]>,
    /// Width of the picture in pixels [default: 1600]
    #[arg(long, value_name = "PIXELS", requires = "field", value_parser = clap::value_parser!(u32).range(400..=8000))]
    width: Option<u32>,
    /// Draw arrows of a vector: displacement or velocity
    #[arg(long, value_name = "FIELD", requires = "field", value_parser = ["displacement", "velocity"])]
    arrows: Option<String>,
    /// Draw crosses along the principal stresses, compression dark and tension orange
    #[arg(long, requires = "field")]
    crosses: bool,
    /// Draw the points that are at yield, and those at a limit of tension
    #[arg(long, requires = "field")]
    plastic_points: bool,
    /// Draw lines of one value, at the ticks of the colour bar
    #[arg(long, requires = "field")]
    contours: bool,
    /// Draw a square net of lines that are so far apart, in m, as the displacement has deformed it
    #[arg(long, value_name = "SPACING", requires = "field", value_parser = spacing)]
    net: Option<f64>,
    /// Regions that are not drawn
    #[arg(long, value_name = "REGION,…", requires = "field", value_delimiter = ',',
        conflicts_with_all = ["arrows", "crosses", "plastic_points"])]
    hide: Vec<String>,
    /// Draw a curve of the field along a line, in m, in place of the picture
    #[arg(long, value_name = "X0,Y0,X1,Y1", requires = "field", allow_hyphen_values = true, value_parser = ends,
        conflicts_with_all = ["window", "range", "width", "mesh", "contact", "mirror", "animate", "arrows", "crosses", "plastic_points",
        "contours", "net", "hide"])]
    along: Option<[f64; 4]>,
    /// The number of places along the line, its ends among them [default: 101]
    #[arg(long, value_name = "N", requires = "along", value_parser = clap::value_parser!(u32).range(2..=100_000))]
    stations: Option<u32>,
    /// Draw the lines of the grid
    #[arg(long, requires = "field")]
    mesh: bool,
    /// Draw the contact pressure along structures
    #[arg(long, requires = "field")]
    contact: bool,
    /// Draw the other half too, mirrored at x = 0
    #[arg(long, requires = "field")]
    mirror: bool,
    /// Draw all frames, or those of --times, as an animation
    #[arg(long, value_name = "FILE.gif", requires = "field", conflicts_with_all = ["output", "time", "frame"])]
    animate: Option<PathBuf>,
    /// Draw the run that was not finished, where there are finished results too
    #[arg(long)]
    pub unfinished: bool,
}

/// A distance.
fn spacing(text: &str) -> std::result::Result<f64, String> {
    let found: f64 = text.trim().parse().map_err(|e: std::num::ParseFloatError| e.to_string())?;
    if found > 0.0 && found.is_finite() { Ok(found) } else { Err("it must be above 0".into()) }
}

/// Draws `field` of the case or output folder `case`; what is asked for of `curves` counts along a line.
pub fn run(case: &Path, output: Option<&Path>, field: &str, args: &Args, curves: &curves::Args) -> Outcome {
    let unused = if args.along.is_some() { curves.first_of_histories() } else { curves.first_given() };
    if let Some(name) = unused {
        let problem = "it is for curves of histories, and --field draws a field";
        return Err(Error::input(name, problem, "take one of both out").into());
    }
    let stage = open(case)?;
    stage.lock()?;
    let run = if args.unfinished { export::unfinished(&stage)? } else { export::shown(&stage)? };
    let mesh = mesh::read(&stage)?;
    export::check_run(&stage, &run)?;
    let case = &stage.loaded.case;
    let regions = parts::of_series(case, &mesh);
    let series = Series::open(&run.results(), &mesh, &regions)?;
    let title = curves.title.as_deref().unwrap_or(&case.title);
    let frames = match (&args.frame, args.time) {
        _ if !args.times.is_empty() => at(&series.infos, &args.times)?,
        (Some(number), _) => vec![numbered(&series.infos, number)?],
        (None, Some(time)) => at(&series.infos, &[time])?,
        (None, None) => vec![series.infos.len() - 1],
    };
    if let Some(line) = args.along {
        let path = output.map_or_else(|| stage.folder().join(format!("{field}_along.svg")), Path::to_owned);
        let stations = args.stations.unwrap_or(export::STATIONS) as usize;
        return along::run(&series, &frames, field, (line, stations), title, &path, curves);
    }
    let asked = Asked::of(field);
    let options = Options {
        range: args.range,
        window: args.window,
        width: args.width,
        mesh: args.mesh,
        contact: args.contact,
        mirror: args.mirror,
        axisymmetric: regions.axisymmetric,
        arrows: args.arrows.clone(),
        crosses: args.crosses,
        plastic_points: args.plastic_points,
        contours: args.contours,
        net: args.net,
        hidden: hidden(&mesh.regions, &args.hide)?,
    };
    let picture = |i: usize| of_frame(&series, &regions, i, &asked, title, options.clone());
    if let Some(path) = &args.animate {
        let frames = if args.times.is_empty() { (0..series.infos.len()).collect() } else { frames };
        let (range, window, lines) = common(&frames, &picture)?;
        animation::write(path, frames.len(), |k| {
            let mut picture = picture(frames[k])?;
            picture.fix(range, window, lines);
            Ok(picture)
        })?;
        return print(&format!("{}: {} frames\n", path.display(), frames.len()));
    }
    let path = output.map_or_else(|| stage.folder().join(format!("{field}.png")), Path::to_owned);
    if args.times.is_empty() {
        let i = frames[0];
        draw::write(&picture(i)?, &path)?;
        return print(&format!("{}: t = {} s\n", path.display(), short(series.infos[i].time)));
    }
    let (range, window, lines) = common(&frames, &picture)?;
    for i in frames {
        let mut picture = picture(i)?;
        picture.fix(range, window, lines);
        let time = series.infos[i].time;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let kind = path.extension().unwrap_or_default().to_string_lossy();
        let path = path.with_file_name(format!("{stem}_t{}.{kind}", short(time)));
        draw::write(&picture, &path)?;
        print(&format!("{}: t = {} s\n", path.display(), short(time)))?;
    }
    Ok(())
}

/// The picture of a frame.
pub fn of_frame(
    series: &Series,
    regions: &Regions,
    i: usize,
    asked: &Asked,
    title: &str,
    options: Options,
) -> Result<Field> {
    let mut fields: Vec<String> = std::iter::once(asked.field.clone()).chain(options.needs()).collect();
    fields.sort_unstable();
    fields.dedup();
    let shown = series.at(i, &fields)?;
    let Info { time, phase, .. } = &series.infos[i];
    let parts = [title.to_owned(), format!("phase {phase}"), format!("t = {} s", short(*time))];
    let title = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ");
    Field::of(&shown, &regions.soil, asked, title, options)
}

/// The numbers of regions with some names.
fn hidden(regions: &[String], names: &[String]) -> Result<Vec<u16>> {
    let number = |name: &String| {
        let found = regions.iter().position(|region| region == name).map(|i| i as u16);
        let known: Vec<&str> = regions.iter().map(String::as_str).collect();
        found.ok_or_else(|| {
            let remedy = format!("the regions are {}", known.join(", "));
            Error::input("--hide", format!("the mesh has no region `{}`", shown(name)), remedy)
        })
    };
    names.iter().map(number).collect()
}

/// The range, the window and the lines of the title that hold those of several frames.
fn common(frames: &[usize], picture: &dyn Fn(usize) -> Result<Field>) -> Result<([f64; 2], [f64; 4], usize)> {
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let mut lines = 0;
    let mut window = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    for &i in frames {
        let picture = picture(i)?;
        if let Some([low, high]) = picture.extent() {
            range = [range[0].min(low), range[1].max(high)];
        }
        lines = lines.max(picture.title_lines());
        let b = picture.bounds();
        window = [window[0].min(b[0]), window[1].min(b[1]), window[2].max(b[2]), window[3].max(b[3])];
    }
    Ok((range, window, lines))
}

/// The case and output folder of a path, which may be either. The case of an output folder is that which it was solved from, with the
/// same entries overridden.
pub fn open(path: &Path) -> std::result::Result<Stage, Vec<Error>> {
    let of = |case: &Path, overrides: Vec<String>, output: Option<PathBuf>| {
        let args = StageArgs { case: CaseArgs { case: case.to_owned(), overrides }, output, threads: None };
        Stage::open(&args)
    };
    if path.is_file() || path.join("case.yaml").exists() {
        return of(path, Vec::new(), None);
    }
    let command =
        Record::read(path, run_folder::STAGE).and_then(|record| Some(record.sessions.last()?.command.clone()));
    let command = command.unwrap_or_default();
    let mut overrides = Vec::new();
    for (i, word) in command.iter().enumerate() {
        let beside = if word == "--set" { command.get(i + 1).map(String::as_str) } else { word.strip_prefix("--set=") };
        overrides.extend(beside.map(str::to_owned));
    }
    let case = command.get(2..).unwrap_or_default().iter().find(|word| {
        let path = Path::new(word);
        path.is_file() || path.join("case.yaml").exists()
    });
    let beside = path.parent().map(|parent| parent.join("case.yaml")).filter(|case| case.exists());
    let Some(case) = case.map(PathBuf::from).or(beside) else {
        let remedy = "name the case, or call mpm in the folder in which it was solved";
        return Err(vec![Error::input(
            path.display(),
            "this is no case, and no results whose case is to be found",
            remedy,
        )]);
    };
    note(&format!("note: the case of {} is {}", path.display(), case.display()));
    of(&case, overrides, Some(path.to_owned()))
}
