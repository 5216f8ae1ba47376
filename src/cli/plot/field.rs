//! Pictures of a field over the soil at one time or several.

use crate::case::parts;
use crate::cli::args::{CaseArgs, StageArgs};
use crate::cli::print::{Outcome, note, print};
use crate::cli::stage::Stage;
use crate::cli::{export, mesh};
use crate::draw::field::{Asked, Field, Options};
use crate::draw::{self, animation};
use crate::error::{Error, Result};
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
    #[arg(long, value_name = "T,T,...", requires = "field", value_delimiter = ',')]
    times: Vec<f64>,
    /// Values at the ends of the colour bar [default: the least and the greatest]
    #[arg(long, value_name = "LOW,HIGH", requires = "field", allow_hyphen_values = true, value_parser = numbers::<2>)]
    range: Option<[f64; 2]>,
    /// What is seen in m [default: all]
    #[arg(long, value_name = "X0,Y0,X1,Y1", requires = "field", allow_hyphen_values = true, value_parser = numbers::<4>)]
    window: Option<[f64; 4]>,
    /// Width of the picture in pixels [default: 1600]
    #[arg(long, value_name = "PIXELS", requires = "field", value_parser = clap::value_parser!(u32).range(400..=8000))]
    width: Option<u32>,
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

/// Numbers with commas between them.
fn numbers<const N: usize>(text: &str) -> std::result::Result<[f64; N], String> {
    let numbers: std::result::Result<Vec<f64>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    let numbers = numbers.map_err(|e| e.to_string())?;
    let found: [f64; N] = numbers.try_into().map_err(|all: Vec<f64>| format!("{} numbers for {N}", all.len()))?;
    let grows = (0..N / 2).all(|d| found[d] < found[d + N / 2]);
    if grows && found.iter().all(|v| v.is_finite()) {
        Ok(found)
    } else {
        Err("the second is not above the first".into())
    }
}

/// Draws `field` of the case or output folder `case`.
pub fn run(case: &Path, output: Option<&Path>, field: &str, args: &Args) -> Outcome {
    let stage = open(case)?;
    stage.lock()?;
    let run = if args.unfinished { export::unfinished(&stage)? } else { export::shown(&stage)? };
    let mesh = mesh::read(&stage)?;
    export::check_run(&stage, &run)?;
    let case = &stage.loaded.case;
    let regions = parts::of_series(case, &mesh);
    let series = Series::open(&run.results(), &mesh, &regions)?;
    let asked = Asked::of(field);
    let options = Options {
        range: args.range,
        window: args.window,
        width: args.width,
        mesh: args.mesh,
        contact: args.contact,
        mirror: args.mirror,
        axisymmetric: regions.axisymmetric,
    };
    let picture = |i: usize| of_frame(&series, &regions, i, &asked, &case.title, options.clone());
    if let Some(path) = &args.animate {
        let frames =
            if args.times.is_empty() { (0..series.infos.len()).collect() } else { at(&series.infos, &args.times)? };
        let (range, window) = common(&frames, &picture)?;
        animation::write(path, frames.len(), |k| {
            let mut picture = picture(frames[k])?;
            picture.fix(range, window);
            Ok(picture)
        })?;
        return print(&format!("{}: {} frames\n", path.display(), frames.len()));
    }
    let path = output.map_or_else(|| stage.folder().join(format!("{field}.png")), Path::to_owned);
    if args.times.is_empty() {
        let i = match (&args.frame, args.time) {
            (Some(number), _) => numbered(&series.infos, number)?,
            (None, Some(time)) => at(&series.infos, &[time])?[0],
            (None, None) => series.infos.len() - 1,
        };
        draw::write(&picture(i)?, &path)?;
        return print(&format!("{}: t = {} s\n", path.display(), short(series.infos[i].time)));
    }
    let frames = at(&series.infos, &args.times)?;
    let (range, window) = common(&frames, &picture)?;
    for i in frames {
        let mut picture = picture(i)?;
        picture.fix(range, window);
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
    let shown = series.at(i, std::slice::from_ref(&asked.field))?;
    let title = format!("{title}, t = {} s", short(series.infos[i].time));
    Field::of(&shown, &regions.soil, asked, title, options)
}

/// A time with as many digits as one wants to read.
fn short(time: f64) -> String {
    let text = format!("{time:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The range and the window that hold those of several frames.
fn common(frames: &[usize], picture: &dyn Fn(usize) -> Result<Field>) -> Result<([f64; 2], [f64; 4])> {
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let mut window = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    for &i in frames {
        let picture = picture(i)?;
        if let Some([low, high]) = picture.extent() {
            range = [range[0].min(low), range[1].max(high)];
        }
        let b = picture.bounds();
        window = [window[0].min(b[0]), window[1].min(b[1]), window[2].max(b[2]), window[3].max(b[3])];
    }
    Ok((range, window))
}

/// The frames that are nearest to some times (s).
pub fn at(infos: &[Info], times: &[f64]) -> Result<Vec<usize>> {
    let nearest = |time: &f64| {
        let off = |i: &usize| (infos[*i].time - time).abs();
        (0..infos.len())
            .min_by(|a, b| off(a).total_cmp(&off(b)))
            .ok_or_else(|| Error::input("--time", format!("there is no frame at {time} s"), "run `mpm solve` first"))
    };
    times.iter().map(nearest).collect()
}

fn numbered(infos: &[Info], number: &str) -> Result<usize> {
    let last = infos.len() - 1;
    let found = if number == "last" { Some(last) } else { number.parse().ok().filter(|&i| i <= last) };
    found.ok_or_else(|| {
        Error::input(
            "--frame",
            format!("there is no frame {number}"),
            format!("it is `last`, or a number from 0 to {last}"),
        )
    })
}

/// The case and output folder of a path, which may be either. The case of an output folder is that which it was solved from, with the
/// same entries overridden.
fn open(path: &Path) -> std::result::Result<Stage, Vec<Error>> {
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
