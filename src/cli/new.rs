//! `mpm new`: a folder with a case that runs, from a template.

mod geometry;
mod templates;

use super::print::{Outcome, note, print};
use crate::case::{self, source::Source, structure::suggest};
use crate::error::{Error, Result, plain, shown};
use crate::io::atomic;
use serde_json::Value;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use templates::{MAKEFILE, TEMPLATES, Template};

#[derive(clap::Args)]
#[group(skip)]
pub struct Args {
    /// The template; without it they are listed
    template: Option<String>,
    /// The folder that is written [default: the name of the template]
    #[arg(value_name = "DIR")]
    folder: Option<PathBuf>,
    /// Change an entry of its case or a parameter of its .geo, e.g. mesh.parameters.h=0.1 or gravity.y=-9.8
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "template")]
    overrides: Vec<String>,
    /// List the templates
    #[arg(long)]
    list: bool,
}

/// The entry of a case whose entries are parameters of the `.geo`: in a template they stand there.
const PARAMETERS: &str = "mesh.parameters";

pub fn run(args: &Args) -> Outcome {
    let Some(name) = args.template.as_ref().filter(|_| !args.list) else { return print(&list()) };
    let template = TEMPLATES.iter().find(|template| template.name == name).ok_or_else(|| {
        let known = TEMPLATES.iter().map(|template| template.name);
        Error::input("mpm new", format!("there is no template `{name}`"), suggest(name, known))
    })?;
    let folder = args.folder.clone().unwrap_or_else(|| template.name.into());
    let parse = |file: &str, text: &str, overrides: &[String]| Source::parse(folder.join(file), text.into(), overrides);
    let read = |overrides: &[String]| parse("case.yaml", template.case, overrides);
    let (parameters, entries): (Vec<String>, Vec<String>) =
        args.overrides.iter().cloned().partition(|argument| is_parameter(argument));
    let mut written = Folder::make(&folder)?;
    let parameters = read(&parameters)?.tree().pointer("/mesh/parameters").cloned().unwrap_or_default();
    let geo = format!("{}.geo", template.name);
    let geometry = with_parameters(template.geo, &geo, &parameters)?;
    written.write(&geo, &geometry)?;
    // With the .geo in place the whole is checked as a case is: messages name the --set that they are about.
    let source = read(&args.overrides)?;
    source.notes().iter().for_each(|text| note(text));
    case::resolved(source)?;
    written.write("case.yaml", &read(&entries)?.rewritten()?)?;
    if let Some(loading) = template.loading {
        // It has the ground and the structure of the first case, and phases of its own.
        let shared: Vec<String> = entries.iter().filter(|entry| !is_of_the_run(entry)).cloned().collect();
        written.write("loading.yaml", &parse("loading.yaml", loading, &shared)?.rewritten()?)?;
    }
    written.write("Makefile", MAKEFILE)?;
    written.write("README.md", &with_changes(template.readme, &args.overrides))?;
    let names: Vec<String> = written.keep().iter().map(|path| path.display().to_string()).collect();
    let place = folder.display();
    print(&format!("{}\nnext: `mpm run {place}`; {place}/README.md says what comes out\n", names.join("\n")))
}

fn list() -> String {
    let lines = TEMPLATES.iter().map(|Template { name, summary, .. }| format!("{name:<14} {summary}\n"));
    lines.collect::<String>() + "\n`mpm new TEMPLATE [DIR]` writes a folder with one, which `mpm run` takes\n"
}

/// Whether an argument `PATH=VALUE` sets parameters of the `.geo`.
fn is_parameter(argument: &str) -> bool {
    argument.strip_prefix(PARAMETERS).is_some_and(|rest| rest.starts_with(['.', '=']))
}

/// Whether an argument `PATH=VALUE` sets what each run of a state has for itself.
fn is_of_the_run(argument: &str) -> bool {
    ["title", "phases", "output"]
        .iter()
        .any(|key| argument.strip_prefix(key).is_some_and(|rest| rest.starts_with(['.', '=', '['])))
}

/// The text of the `.geo` of a template with the values of `parameters`, a block by their names.
fn with_parameters(text: &str, geo: &str, parameters: &Value) -> Result<String> {
    parameters.as_object().into_iter().flatten().try_fold(text.to_owned(), |text, (name, value)| {
        geometry::set(&text, name, value).map_err(|(problem, remedy)| {
            Error::input(format!("--set {PARAMETERS}.{} ({geo})", shown(name)), problem, remedy)
        })
    })
}

/// The `README.md` of a template, which says what was changed.
fn with_changes(text: &str, overrides: &[String]) -> String {
    let mut text = text.to_owned();
    if !overrides.is_empty() {
        text.push_str("\n## Changed\n\nThe numbers above are those of the template. This folder was written with\n\n");
        overrides.iter().for_each(|argument| text.push_str(&format!("    --set {}\n", plain(argument))));
    }
    text
}

/// A folder that is being written; what was made of it goes away with this unless it is kept.
struct Folder {
    path: PathBuf,
    /// The folder and those around it that were not there, innermost first.
    made: Vec<PathBuf>,
    files: Vec<PathBuf>,
}

impl Folder {
    /// Makes the folder, and those around it where they are missing.
    ///
    /// # Errors
    /// Input: a folder that holds something, a file of that name; a machine error where it cannot be made.
    fn make(path: &Path) -> Result<Self> {
        match fs::read_dir(path).map(|mut entries| entries.next().is_some()) {
            Ok(true) => {
                let remedy = "name another one behind the template, or empty it";
                return Err(Error::input(path.display(), "the folder is not empty", remedy));
            }
            Err(e) if e.kind() == ErrorKind::NotADirectory => {
                let remedy = "name another folder behind the template";
                return Err(Error::input(path.display(), "this is a file", remedy));
            }
            Err(e) if e.kind() != ErrorKind::NotFound => return Err(atomic::unreadable(path, &e, "name a folder")),
            _ => {}
        }
        let missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let made = path.ancestors().take_while(missing).map(Path::to_owned).collect();
        let folder = Self { path: path.to_owned(), made, files: Vec::new() };
        fs::create_dir_all(path).map_err(|e| atomic::unwritable(path, &e))?;
        Ok(folder)
    }

    fn write(&mut self, name: &str, text: &str) -> Result<()> {
        let file = self.path.join(name);
        atomic::write(&file, |out| out.write_all(text.as_bytes()))?;
        self.files.push(file);
        Ok(())
    }

    /// Leaves all as it is; returns the files.
    fn keep(mut self) -> Vec<PathBuf> {
        self.made.clear();
        std::mem::take(&mut self.files)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Only tidiness: the report is about the first error.
        self.files.iter().for_each(|file| drop(fs::remove_file(file)));
        self.made.iter().for_each(|folder| drop(fs::remove_dir(folder)));
    }
}
