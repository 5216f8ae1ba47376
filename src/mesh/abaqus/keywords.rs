//! The keywords of an input file with their parameters and data lines.

use crate::error::{Error, Result};

/// A keyword.
pub struct Block<'a> {
    /// Where it stands, from 1 on.
    pub line: usize,
    /// Its name in small letters, with single blanks.
    pub name: String,
    /// Names in small letters, and values as written without quotes.
    parameters: Vec<(String, String)>,
    /// The data below it, by line.
    pub data: Vec<(usize, &'a str)>,
}

impl Block<'_> {
    /// The value of a parameter; empty for one without.
    pub fn get(&self, parameter: &str) -> Option<&str> {
        self.parameters.iter().find(|(name, _)| name == parameter).map(|(_, value)| value.as_str())
    }

    pub fn has(&self, parameter: &str) -> bool {
        self.get(parameter).is_some()
    }
}

/// The entries of a data line; an empty one at its end is none.
pub fn entries(line: &str) -> impl Iterator<Item = &str> {
    let line = line.trim_end();
    split(line.strip_suffix(',').unwrap_or(line)).into_iter().filter(|entry| !entry.is_empty())
}

/// All keywords of a file.
///
/// # Errors
/// Input: text before the first one.
pub fn blocks<'a>(text: &'a str, place: &str) -> Result<Vec<Block<'a>>> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut lines =
        text.lines().enumerate().filter(|(_, line)| !line.starts_with("**") && !line.trim().is_empty()).peekable();
    while let Some((i, line)) = lines.next() {
        let Some(heading) = line.trim().strip_prefix('*') else {
            let Some(block) = blocks.last_mut() else {
                let problem = "it is no input file of Abaqus: it does not begin with a keyword";
                return Err(Error::input(
                    format!("{place}, line {}", i + 1),
                    problem,
                    "name a file with `*Node` and `*Element`",
                ));
            };
            block.data.push((i + 1, line));
            continue;
        };
        let mut heading = heading.to_owned();
        while heading.ends_with(',') && lines.peek().is_some_and(|(_, next)| !next.trim_start().starts_with('*')) {
            heading.push_str(lines.next().map_or("", |(_, next)| next.trim()));
        }
        let mut words = split(&heading).into_iter();
        let name = words.next().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase();
        let parameter = |word: &str| {
            let (name, value) = word.split_once('=').unwrap_or((word, ""));
            (name.trim().to_lowercase(), value.trim().trim_matches('"').to_owned())
        };
        let parameters = words.map(parameter).collect();
        blocks.push(Block { line: i + 1, name, parameters, data: Vec::new() });
    }
    Ok(blocks)
}

/// Text between commas that are not within quotes, without the blanks around it.
fn split(text: &str) -> Vec<&str> {
    let mut quoted = false;
    let parts = text.split(|c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    });
    parts.map(|part| part.trim().trim_matches('"')).collect()
}
