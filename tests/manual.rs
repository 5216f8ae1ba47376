//! The manual (docs/SUMMARY.md): its tables have every key of the schema, its links lead to headings, the messages that it explains are
//! those of the program, its words are plain, and the commands of its first steps print what it says.

use crate::support::{PROGRAM, in_folder, project, python, succeeds};
use mpm::case;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The folders of the pages that are the manual alone, beside `docs/user-guide.md`.
const FOLDERS: [&str; 4] = ["docs/first-steps", "docs/how-to", "docs/reference", "docs/coming-from"];

/// The pages that docs/SUMMARY.md names, as paths of the repository.
fn pages() -> Vec<PathBuf> {
    let summary = fs::read_to_string(project("docs/SUMMARY.md")).unwrap();
    let links = summary.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let pages: Vec<PathBuf> = links.map(|link| project("docs").join(link)).collect();
    assert!(pages.len() > 60, "{pages:?}");
    pages
}

/// The pages of [`FOLDERS`] and the first page.
fn guide() -> Vec<PathBuf> {
    let files = FOLDERS.iter().flat_map(|folder| fs::read_dir(project(folder)).unwrap());
    let mut files: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
    files.push(project("docs/user-guide.md"));
    files.sort();
    files
}

/// The blocks of code of a page, each with its language.
fn blocks(text: &str) -> Vec<(String, String)> {
    let parts = text.split("\n```").skip(1).step_by(2);
    parts.filter_map(|part| part.split_once('\n')).map(|(l, code)| (l.to_owned(), code.to_owned())).collect()
}

/// A page without its blocks of code.
fn prose(text: &str) -> String {
    text.split("\n```")
        .step_by(2)
        .map(|part| part.split_once('\n').map_or("", |(_, rest)| rest))
        .collect::<Vec<_>>()
        .join("\n")
}

/// The anchors of the headings of a page, as mdBook and code forges make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let mut found = BTreeSet::new();
    let text = format!("\n{text}");
    for line in text.split("\n```").step_by(2).flat_map(str::lines).filter(|line| line.starts_with('#')) {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let kept = title.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let slug: String = kept.map(|c| if c == ' ' { '-' } else { c }).collect();
        let count = seen.entry(slug.clone()).or_default();
        found.insert(if *count == 0 { slug } else { format!("{slug}-{count}") });
        *count += 1;
    }
    found
}

#[test]
fn the_summary_has_every_page() {
    let named: BTreeSet<PathBuf> = pages().iter().map(|page| page.canonicalize().unwrap()).collect();
    let cases = ["cases", "templates"].iter().flat_map(|folder| fs::read_dir(project(folder)).unwrap());
    let cases = cases.map(|entry| entry.unwrap().path().join("README.md")).filter(|page| page.exists());
    let top = fs::read_dir(project("docs")).unwrap().map(|entry| entry.unwrap().path());
    let top = top.filter(|page| page.extension().is_some_and(|e| e == "md") && !page.ends_with("SUMMARY.md"));
    for page in guide().into_iter().chain(cases).chain(top) {
        assert!(named.contains(&page.canonicalize().unwrap()), "docs/SUMMARY.md lacks {}", page.display());
    }
}

#[test]
fn every_link_leads_to_a_heading() {
    let mut count = 0;
    for page in pages().into_iter().chain([project("README.md")]) {
        let text = fs::read_to_string(&page).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let Some((file, anchor)) = link.split_once('#').filter(|_| !link.contains("://")) else { continue };
            let target = if file.is_empty() { page.clone() } else { page.with_file_name(file) };
            let found = anchors(&fs::read_to_string(&target).unwrap());
            assert!(found.contains(anchor), "{}: there is no heading for {link}: {found:?}", page.display());
            count += 1;
        }
    }
    assert!(count > 50, "{count}");
}

#[test]
fn the_tables_have_every_key_of_the_schema() {
    let folder = tempfile::tempdir().unwrap();
    let schema = folder.path().join("schema.json");
    let check = |text: &str| {
        fs::write(&schema, text).unwrap();
        python().arg(project("pipeline/keys.py")).arg("--check").arg(&schema).output().unwrap()
    };
    let text = case::schema().to_string();
    let output = check(&text);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    // A key that no page has, and one that no case has, are told with their names.
    let mut more = case::schema();
    more["$defs"]["Mesh"]["properties"]["smoothing"] = serde_json::json!({"description": "Sweeps.", "type": "integer"});
    let output = check(&more.to_string());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && said.contains("the table of Mesh differs"), "{said}");
    assert!(said.contains("Mesh.smoothing has no example"), "{said}");
}

/// The files of a folder of the repository, copied to the same place in `to`.
fn copied(folder: &Path, to: &Path) {
    for entry in fs::read_dir(project(folder)).unwrap() {
        let (path, target) = (entry.as_ref().unwrap().path(), to.join(folder));
        let name = entry.unwrap().file_name();
        if !path.is_dir() {
            fs::create_dir_all(&target).unwrap();
            fs::copy(&path, target.join(&name)).unwrap();
        } else if !name.to_string_lossy().starts_with("out") {
            copied(&folder.join(name), to);
        }
    }
}

#[test]
fn the_examples_have_no_mistakes() {
    let folder = tempfile::tempdir().unwrap();
    copied(Path::new("templates"), folder.path());
    copied(Path::new("docs/examples"), folder.path());
    let examples = folder.path().join("docs/examples");
    // The one goes on from the other.
    succeeds(&in_folder(&examples, &["run", "first_push"]));
    let examples: Vec<PathBuf> = fs::read_dir(examples).unwrap().map(|e| e.unwrap().path()).collect();
    assert!(examples.len() > 4, "{examples:?}");
    for example in examples {
        succeeds(&in_folder(&example, &["check", "."]));
    }
}

/// What `mpm` prints as the help of a command.
fn help(command: &[&str]) -> String {
    let output = in_folder(&project("."), &[command, &["--help"]].concat());
    succeeds(&output);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn the_commands_have_every_option() {
    let pages = ["docs/reference/commands.md", "docs/how-to/sweeps.md", "docs/how-to/pictures.md"];
    let text: String = pages.iter().map(|page| fs::read_to_string(project(page)).unwrap()).collect();
    let overview = help(&[]);
    let commands = overview.split("Commands:").nth(1).unwrap().split("Options:").next().unwrap();
    // Names are two blanks to the right of the heading, the lines that go on are farther.
    let commands = commands.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let mut count = 0;
    for command in commands.map(|line| line.split_whitespace().next().unwrap()).filter(|name| *name != "help") {
        assert!(text.contains(&format!("`mpm {command}")), "{} lacks mpm {command}", pages[0]);
        let text_of_help = help(&[command]);
        let words = text_of_help.split_whitespace().filter(|word| word.starts_with("--"));
        let options = words.map(|word| word.trim_end_matches(|c: char| !c.is_alphanumeric()));
        for option in options.filter(|option| option.len() > 2 && *option != "--help") {
            assert!(text.contains(option), "{pages:?} lack {option} of mpm {command}");
            count += 1;
        }
    }
    assert!(count > 50, "{count}");
}

/// Whether the parts between the … and ` … ` of a quoted message are in the sources, where lines of a text may be split.
fn is_said(message: &str, sources: &str) -> bool {
    message.split('…').map(str::trim).filter(|part| !part.is_empty()).all(|part| sources.contains(part))
}

#[test]
fn the_messages_are_those_of_the_program() {
    fn read(folder: &Path, found: &mut String) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                read(&path, found);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push_str(&fs::read_to_string(&path).unwrap().replace("\\\n", " "));
            }
        }
    }
    let mut sources = String::new();
    read(&project("src"), &mut sources);
    let sources = sources.split_whitespace().collect::<Vec<_>>().join(" ");
    let page = fs::read_to_string(project("docs/reference/messages.md")).unwrap();
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let mut count = 0;
    for row in rows {
        let cell = row.split(" | ").next().unwrap().trim_start_matches("| ");
        for message in cell.split('`').skip(1).step_by(2) {
            // That of the system's loader is not the program's.
            let foreign = message == "error while loading shared libraries";
            assert!(foreign || is_said(message, &sources), "docs/reference/messages.md: no source says {message:?}");
            count += 1;
        }
    }
    assert!(count > 20, "{count}");
}

/// What reads as a riddle, and words of the sources that no textbook has (with what to write in their place).
const RIDDLES: [(&str, &str); 24] = [
    ("hat", "contact node"),
    ("hats", "contact nodes"),
    ("is told", "is reported"),
    ("are told", "are reported"),
    ("tells of", "reports"),
    ("comes at once", "is sudden"),
    ("out of balance", "unbalanced"),
    ("grains bear", "effective stress"),
    ("not given to", "not prescribed"),
    ("held against", "compared with"),
    ("bearer", "host cell"),
    ("borne", "carried"),
    ("taking part", "active"),
    ("let fall", "switched to dynamics"),
    ("let rest", "back to quasi-static"),
    ("put back", "projected to the boundary"),
    ("pushed out", "moved out"),
    ("water bond", "pressure stabilisation"),
    ("stencil", "interpolation"),
    ("clique", "connectivity"),
    ("skin", "initial surface"),
    ("kinks", "table points"),
    ("laid down", "in contact"),
    ("goes back to", "is returned to"),
];

#[test]
fn the_words_are_plain() {
    for page in guide() {
        let text = prose(&format!("\n{}", fs::read_to_string(&page).unwrap())).to_lowercase();
        let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        let text = format!(" {} ", words.join(" "));
        for (riddle, plain) in RIDDLES {
            assert!(!text.contains(&format!(" {riddle} ")), "{}: `{riddle}`; write {plain}", page.display());
        }
    }
}

/// The longest sentence (words); more need a second reading.
const LONGEST: usize = 45;

#[test]
fn sentences_are_short() {
    for page in guide() {
        let text = prose(&format!("\n{}", fs::read_to_string(&page).unwrap()));
        let is_text = |p: &&str| !p.starts_with("    ") && !p.trim_start().starts_with(['|', '#', '<']);
        for paragraph in text.split("\n\n").filter(is_text) {
            for item in paragraph.split("\n- ").map(|item| item.split_whitespace().collect::<Vec<_>>().join(" ")) {
                for sentence in item.split([';', ':']).flat_map(|part| part.split(". ")) {
                    let words = sentence.split(' ').count();
                    assert!(words <= LONGEST, "{}: a sentence of {words} words: {sentence}", page.display());
                }
            }
        }
    }
}

/// Whether a line of output is what the page prints: the same words from its beginning on, and numbers to one unit of the last digit
/// that is printed.
fn is_line(printed: &str, line: &str) -> bool {
    let words = |text: &str| text.split([' ', ',']).filter(|w| !w.is_empty()).map(str::to_owned).collect::<Vec<_>>();
    let (printed, line) = (words(printed), words(line));
    let is_word = |(a, b): (&String, &String)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(x), Ok(y)) => {
            let digits = a.split_once('.').map_or(0, |(_, decimals)| decimals.len());
            (x - y).abs() < 1.01 * 10f64.powi(-i32::try_from(digits).unwrap())
        }
        _ => a == b,
    };
    printed.len() <= line.len() && printed.iter().zip(&line).all(is_word)
}

#[test]
fn lines_are_compared_to_the_digits_that_are_printed() {
    assert!(is_line("1.0,-0.004,107.04", "1.0,-0.004,107.03785037584069"));
    assert!(is_line("factor 1.40 to", "factor 1.4000 to 1.4062"));
    assert!(!is_line("1.0,-0.004,107.04", "1.0,-0.004,107.06"));
    assert!(!is_line("factor 1.40 to 1.41", "factor 1.4000 to"));
    assert!(!is_line("time,uy", "time,ux"));
}

/// Runs the commands of a page in one shell, in an empty folder with the program on the path. What each block prints has the lines of
/// the block of text behind it, in their order.
fn runs(page: &str) {
    const MARK: &str = "-- end of block";
    let blocks = blocks(&fs::read_to_string(project(page)).unwrap());
    let commands: Vec<&str> = blocks.iter().filter(|(l, _)| l == "sh").map(|(_, code)| code.as_str()).collect();
    let script: String = commands.iter().map(|code| format!("{code}\necho '{MARK}'\n")).collect();
    let folder = tempfile::tempdir().unwrap();
    let bin = Path::new(PROGRAM).parent().unwrap();
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    let mut shell = std::process::Command::new("bash");
    let output = shell
        .args(["-e", "-c", &script])
        .env("PATH", path)
        .env("RAYON_NUM_THREADS", "1")
        .current_dir(folder.path())
        .output()
        .unwrap();
    succeeds(&output);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let said: Vec<&str> = said.split(MARK).collect();
    let mut number = 0;
    let mut compared = 0;
    for (language, code) in &blocks {
        if language == "sh" {
            number += 1;
        }
        if language == "text" {
            let mut lines = said[number - 1].lines();
            for printed in code.lines() {
                let found = lines.any(|line| is_line(printed, line));
                assert!(
                    found,
                    "{page}: {printed:?} is not printed, or not in this order, by\n{}{}",
                    commands[number - 1],
                    said[number - 1]
                );
                compared += 1;
            }
        }
    }
    assert!(commands.len() >= 3 && compared >= 3, "{page}: {} blocks, {compared} lines", commands.len());
}

mod slow {
    use super::*;

    #[test]
    fn the_slope_of_the_manual() {
        runs("docs/first-steps/slope.md");
    }

    #[test]
    fn the_footing_of_the_manual() {
        runs("docs/first-steps/footing.md");
    }

    #[test]
    fn the_penetration_of_the_manual() {
        runs("docs/first-steps/penetration.md");
    }
}
