//! What a `.geo` may do: a reader of Gmsh's script language that refuses statements that execute or write, and finds
//! every file that Gmsh will open.
//!
//! The words and their separation are those of Gmsh's own scanner (`Gmsh.l` and `Gmsh.y` of Gmsh 4): strings in `"` or
//! `'` without escapes, comments of C and C++. Expressions are not evaluated, so a file name must stand in quotes. Text
//! that Gmsh would split otherwise while it skips a branch or repeats a loop is refused.
//!
//! `--allow-system-calls` leaves this out; the sandbox of the worker protects beside it.

use super::files::check_readable;
use super::ranges;
use super::token::{Kind, Token};
use crate::error::{Error, Result};
use crate::reading;
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};

/// The files of a geometry, sorted: the `.geo`, and all that it names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sources {
    pub files: Vec<PathBuf>,
}

/// The most bytes of scripts of one geometry.
const MOST_BYTES: usize = 64 << 20;

/// Gmsh's own limit of a string; it splits the text of a longer one into words.
const LONGEST_STRING: usize = 1022;

/// Words that execute, write or end the program wherever they stand, and what to do instead.
const REFUSED: [(&str, &str, &str); 13] = [
    ("SystemCall", "executes a program", ALLOW),
    ("NonBlockingSystemCall", "executes a program", ALLOW),
    ("OnelabRun", "executes a program", ALLOW),
    ("ExternalProcess", "executes a program", ALLOW),
    ("CreateDir", "makes a folder", ALLOW),
    ("SendToServer", "connects to another program", ALLOW),
    ("AutomaticMeshSizeField", "writes files", "use other fields, or allow it with --allow-system-calls"),
    ("Exit", "ends the program before the mesh is made", "delete the statement"),
    ("Abort", "ends the reading, and the rest would be left out", "delete the statement"),
    ("GetEnv", "reads the environment, on which the mesh would depend", "use a DefineConstant and mesh.parameters"),
    ("StringToName", "computes a name, which may be that of a command", "write the name itself"),
    ("S2N", "computes a name, which may be that of a command", "write the name itself"),
    ("Solver", "sets options of programs that Gmsh starts", "delete the statement"),
];

/// Commands only where a string follows; elsewhere they are names of variables or options.
const COMMANDS: [(&str, &str); 3] =
    [("System", "executes a program"), ("Save", "writes a file"), ("Print", "writes a file")];

const ALLOW: &str = "delete the statement, or allow it with --allow-system-calls if you trust the file";

/// Formats of geometries and meshes that Gmsh recognises by the end of the name, and which hold data alone.
const GEOMETRIES: [&str; 6] = ["step", "stp", "iges", "igs", "brep", "med"];

/// Ends of the names of scripts; for others Gmsh may start a program (`.gz`, `.py`, …).
const SCRIPTS: [&str; 9] = ["", "geo", "geo_unrolled", "opt", "txt", "inc", "par", "dat", "pos"];

/// Reads the geometry `geo` and all that it includes or merges.
///
/// # Errors
/// Input: the first statement that executes, writes or ends the program, with file, line and remedy; a file name that is
/// computed; a file that includes itself; files that cannot be read or are too long.
pub fn sources(geo: &Path) -> Result<Sources> {
    check_readable(geo)?;
    let mut scan = Scan::default();
    scan.merge(geo)?;
    Ok(Sources { files: scan.files.into_iter().collect() })
}

#[derive(Default)]
struct Scan {
    files: BTreeSet<PathBuf>,
    bytes: usize,
    /// The files in hand, each included by the one before, without symbolic links.
    open: Vec<PathBuf>,
    done: BTreeSet<PathBuf>,
}

impl Scan {
    /// A file that Gmsh takes by its kind, and the options beside it, which Gmsh takes by itself.
    fn merge(&mut self, path: &Path) -> Result<()> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        let is_data = match extension.as_str() {
            "msh" => begins_with(path, b"$MeshFormat"),
            "pos" => begins_with(path, b"$PostFormat"),
            extension => GEOMETRIES.contains(&extension),
        };
        if is_data {
            self.files.insert(path.to_owned());
        } else if SCRIPTS.contains(&extension.as_str()) {
            self.script(path)?;
        } else {
            return Err(Error::input(
                path.display(),
                "it is neither a script of Gmsh nor a geometry in a known format",
                format!("use a file that ends in .geo, .pos, .{} or .msh", GEOMETRIES.join(", .")),
            ));
        }
        let mut options = path.as_os_str().to_owned();
        options.push(".opt");
        let options = PathBuf::from(options);
        if options.exists() { self.merge(&options) } else { Ok(()) }
    }

    fn script(&mut self, path: &Path) -> Result<()> {
        check_readable(path)?;
        let unreadable = |error| Error::input(path.display(), error, "check the path");
        let real = path.canonicalize().map_err(unreadable)?;
        if self.open.contains(&real) {
            let remedy = "take out the Include or Merge that leads back to it";
            return Err(Error::input(path.display(), "it includes itself", remedy));
        }
        self.files.insert(path.to_owned());
        if !self.done.insert(real.clone()) {
            return Ok(());
        }
        let too_long = || {
            let problem = format!("its scripts have more than {} MB", MOST_BYTES >> 20);
            Error::input(path.display(), problem, "use a geometry in another format, such as STEP")
        };
        let length = fs::metadata(path).map_err(unreadable)?.len();
        if usize::try_from(length).map_or(true, |length| length > MOST_BYTES - self.bytes) {
            return Err(too_long());
        }
        let text = reading::bytes(path).map_err(unreadable)?;
        self.bytes += text.len();
        if self.bytes > MOST_BYTES {
            return Err(too_long());
        }
        self.open.push(real);
        let tokens = tokens(&text).map_err(|(line, problem, remedy)| at(path, line, problem, remedy))?;
        check_statements(path, &tokens)?;
        if let Some((line, count)) = ranges::too_long(&tokens) {
            return Err(at(path, line, format!("a range of about {count:.1e} numbers"), "use a larger step"));
        }
        self.follow(path, &tokens)?;
        self.open.pop();
        Ok(())
    }

    /// The files that the script `path` names.
    fn follow(&mut self, path: &Path, tokens: &[Token]) -> Result<()> {
        for (i, token) in tokens.iter().enumerate() {
            match token.kind {
                Kind::Word(b"Include") => self.script(&named(path, tokens, i)?)?,
                Kind::Word(b"Merge" | b"MergeWithBoundingBox") => self.merge(&named(path, tokens, i)?)?,
                // Data: a list of numbers, a field, a shape. Whatever names a file may be read.
                Kind::Text(text) => {
                    let file = beside(path, text);
                    if !text.is_empty() && file.is_file() {
                        self.files.insert(file);
                    }
                }
                _ => (),
            }
        }
        Ok(())
    }
}

fn at(path: &Path, line: usize, problem: impl std::fmt::Display, remedy: &str) -> Error {
    Error::input(format!("{}, line {line}", path.display()), problem, remedy)
}

/// A file name in a script is relative to the script.
fn beside(path: &Path, name: &[u8]) -> PathBuf {
    path.with_file_name("").join(OsStr::from_bytes(name))
}

/// The file that the `Include` or `Merge` at `i` names: `Include "a.geo";` or `Include Str("a.geo");`.
fn named(path: &Path, tokens: &[Token], i: usize) -> Result<PathBuf> {
    let line = tokens[i].line;
    let kinds: Vec<Kind> = tokens[i + 1..].iter().take(5).map(|token| token.kind).collect();
    let name = match kinds[..] {
        [Kind::Text(name), Kind::Symbol(b';'), ..] => name,
        [
            Kind::Word(b"Str"),
            Kind::Symbol(b'(' | b'['),
            Kind::Text(name),
            Kind::Symbol(b')' | b']'),
            Kind::Symbol(b';'),
        ] => name,
        _ => {
            let problem = "the name of the file is computed, and mpm must know beforehand which files are read";
            return Err(at(path, line, problem, "write the name in quotes: Include \"name.geo\";"));
        }
    };
    let file = beside(path, name);
    match fs::metadata(&file) {
        Ok(metadata) if metadata.is_file() => Ok(file),
        Ok(_) => Err(at(path, line, format!("{} is no regular file", file.display()), "name a file")),
        Err(error) => Err(at(path, line, format!("{}: {error}", file.display()), "correct the name")),
    }
}

/// Whether a file begins with the `header` of its format: without it Gmsh takes it for a script, whatever its name.
fn begins_with(path: &Path, header: &[u8; 11]) -> bool {
    use std::io::Read;
    let mut found = [0; 11];
    reading::open(path).and_then(|mut file| file.read_exact(&mut found)).is_ok() && found == *header
}

/// The tokens of a script without its comments, or the line, problem and remedy of what Gmsh and this reader might
/// separate differently.
fn tokens(text: &[u8]) -> std::result::Result<Vec<Token<'_>>, (usize, &'static str, &'static str)> {
    let mut tokens = Vec::new();
    let (mut i, mut line, mut line_start) = (0, 1, 0);
    while let Some(&c) = text.get(i) {
        let next = text.get(i + 1).copied().unwrap_or_default();
        let start = i;
        let opens = matches!(c, b'"' | b'\'') || c == b'/' && matches!(next, b'/' | b'*');
        if opens && is_overlooked(text, i) {
            let problem = "Gmsh overlooks the beginning of this comment or string where it skips a branch or a loop";
            return Err((line, problem, "put a blank before it"));
        }
        let mut kind = None;
        match c {
            0 => return Err((line, "it contains a zero byte: it is no text", "name a script of Gmsh")),
            b'\r' if next != b'\n' => {
                return Err((line, "its lines end with a carriage return alone", "save it with line feeds"));
            }
            b'/' if next == b'/' => i += text[i..].iter().position(|&c| c == b'\n').unwrap_or(text.len() - i),
            b'/' if next == b'*' => {
                let end = text[i + 2..].windows(2).position(|end| end == b"*/");
                i += end.ok_or((line, "the comment has no end", "end it with */"))? + 4;
            }
            b'"' | b'\'' => {
                let end = text[i + 1..].iter().position(|&end| end == c);
                let end = i + 1 + end.ok_or((line, "the string has no end", "end it with the same quotation mark"))?;
                let text = &text[i + 1..end];
                if text.len() > LONGEST_STRING {
                    return Err((line, "the string is longer than the 1022 bytes that Gmsh takes", "shorten it"));
                }
                kind = Some(Kind::Text(text));
                i = end + 1;
            }
            _ if is_alpha(c) => {
                i += text[i..].iter().take_while(|&&c| is_alpha(c) || c.is_ascii_digit()).count();
                kind = Some(Kind::Word(&text[start..i]));
            }
            _ if c.is_ascii_digit() => {
                i += number_length(&text[i..]);
                kind = Some(Kind::Number(&text[start..i]));
            }
            _ => {
                i += 1;
                kind = (!c.is_ascii_whitespace()).then_some(Kind::Symbol(c));
            }
        }
        let breaks = text[start..i].iter().filter(|&&c| c == b'\n').count();
        // Gmsh goes back to the beginning of a line, which must not lie within a comment or a string.
        if opens && breaks > 0 && !text[line_start..start].iter().all(u8::is_ascii_whitespace) {
            let problem = "a comment or string over several lines begins behind other text, where Gmsh may overlook it";
            return Err((line, problem, "begin it on a line of its own"));
        }
        tokens.extend(kind.map(|kind| Token { kind, line }));
        line += breaks;
        if let Some(last) = text[start..i].iter().rposition(|&c| c == b'\n') {
            line_start = start + last + 1;
        }
    }
    Ok(tokens)
}

fn is_alpha(c: u8) -> bool {
    c.is_ascii_alphabetic() || c == b'_'
}

fn number_length(text: &[u8]) -> usize {
    let digits = |from: usize| text[from..].iter().take_while(|c| c.is_ascii_digit()).count();
    let mut end = digits(0);
    if text.get(end) == Some(&b'.') {
        end += 1 + digits(end + 1);
    }
    if matches!(text.get(end), Some(b'e' | b'E')) {
        let signed = usize::from(matches!(text.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits((end + 1 + signed).min(text.len()));
        if exponent > 0 {
            end += 1 + signed + exponent;
        }
    }
    end
}

/// Whether Gmsh, where it skips a branch, a loop or a macro, may swallow the beginning of the comment or string at `i`:
/// it drops the character behind a letter with which `EndIf`, `If`, `For` or `Return` could begin, and as many behind
/// `If` and `For` as `EndFor` is longer.
fn is_overlooked(text: &[u8], i: usize) -> bool {
    let swallows = |back: usize| {
        let Some(before) = i.checked_sub(back).map(|at| text.split_at(at)) else { return false };
        let ends = before.0.ends_with(b"End") || before.0.ends_with(b"Else");
        !ends && (before.1.starts_with(b"If") || back > 2 && before.1.starts_with(b"For"))
    };
    let last = i.checked_sub(1).map(|last| text[last]);
    matches!(last, Some(b'E' | b'I' | b'F' | b'R')) || (2..=5).any(swallows)
}

/// The statements that a script may not have.
fn check_statements(path: &Path, tokens: &[Token]) -> Result<()> {
    let kind = |i: usize| tokens.get(i).map(|token| token.kind);
    for (i, token) in tokens.iter().enumerate() {
        let Kind::Word(word) = token.kind else { continue };
        let name = String::from_utf8_lossy(word);
        let refuse = |does: &str, remedy: &str| Err(at(path, token.line, format!("{name} {does}"), remedy));
        if let Some((_, does, remedy)) = REFUSED.iter().find(|(refused, ..)| *refused == name) {
            return refuse(does, remedy);
        }
        if let Some((_, does)) = COMMANDS.iter().find(|(command, _)| *command == name)
            && matches!(kind(i + 1), Some(Kind::Text(_) | Kind::Word(_)))
        {
            return refuse(does, ALLOW);
        }
        // Gmsh has read the line to its end when it goes on elsewhere, and joins what follows to what stands there.
        let left = match word {
            b"EndFor" | b"Return" => Some(i),
            b"Include" | b"Merge" | b"MergeWithBoundingBox" | b"Call" => {
                (i..tokens.len()).find(|&j| tokens[j].kind == Kind::Symbol(b';'))
            }
            _ => None,
        };
        if let Some(last) = left
            && tokens.get(last + 1).is_some_and(|next| next.line == tokens[last].line)
        {
            let remedy = "put what follows on a line of its own";
            return refuse("is followed by more on its line, which Gmsh reads in another order", remedy);
        }
        match word {
            b"General" if kind(i + 1) == Some(Kind::Symbol(b'.')) => {
                if let Some(Kind::Word(option)) = kind(i + 2)
                    && reaches_files(&String::from_utf8_lossy(option))
                    && kind(i + 4) != Some(Kind::Text(b""))
                {
                    let option = String::from_utf8_lossy(option);
                    let problem = format!("General.{option} names a file or program of Gmsh's own");
                    return Err(at(path, token.line, problem, "delete the statement"));
                }
            }
            b"Plugin" => match kind(i + 2) {
                Some(Kind::Word(b"Crack")) => (),
                _ => {
                    return refuse(
                        "may write files",
                        "use the plugin Crack only, or allow it with --allow-system-calls",
                    );
                }
            },
            b"Macro" if i > 0 && kind(i - 1) == Some(Kind::Symbol(b',')) => {
                return refuse("as an attribute runs a macro of the window", "delete the attribute");
            }
            b"Printf" | b"Sprintf" | b"Error" | b"Warning" if kind(i + 1) == Some(Kind::Symbol(b'(')) => {
                check_print(path, &tokens[i..])?;
            }
            _ => (),
        }
    }
    Ok(())
}

/// Options of `General` by which Gmsh reads, writes or starts something.
fn reaches_files(option: &str) -> bool {
    let named = ["SaveOptions", "SaveSession", "TextEditor", "WatchFilePattern", "ScriptingLanguages", "Display"];
    option.contains("File") || named.contains(&option)
}

/// A `Printf` or the like at the beginning of `tokens`: it must not write to a file, and convert numbers only.
fn check_print(path: &Path, tokens: &[Token]) -> Result<()> {
    let (mut depth, mut first) = (0usize, true);
    for token in &tokens[1..] {
        match token.kind {
            Kind::Symbol(b'(' | b'[' | b'{') => depth += 1,
            Kind::Symbol(b')' | b']' | b'}') => depth = depth.saturating_sub(1),
            Kind::Symbol(b'>') if depth == 0 && tokens[0].kind == Kind::Word(b"Printf") => {
                return Err(at(path, token.line, "Printf writes a file", ALLOW));
            }
            Kind::Symbol(b';') => break,
            Kind::Symbol(b',') if depth == 1 => first = false,
            Kind::Text(text) if first && depth > 0 => {
                if let Some(conversion) = bad_conversion(text) {
                    let problem = format!("the conversion {conversion} makes Gmsh read or write where it may not");
                    return Err(at(path, token.line, problem, "use %g for numbers"));
                }
            }
            _ => (),
        }
        if depth == 0 && tokens[0].kind != Kind::Word(b"Printf") {
            break;
        }
    }
    Ok(())
}

/// The first conversion of a format that is not one of a number, or wider than Gmsh has room for.
fn bad_conversion(format: &[u8]) -> Option<String> {
    let mut rest = format;
    while let Some(start) = rest.iter().position(|&c| c == b'%') {
        let behind = &rest[start + 1..];
        let flags = behind.iter().take_while(|c| b"-+ #.0123456789".contains(c)).count();
        let wide = behind[..flags].split(|c| !c.is_ascii_digit()).any(|digits| digits.len() > 2);
        match behind.get(flags) {
            Some(b'%' | b'g' | b'G' | b'f' | b'F' | b'e' | b'E' | b'd' | b'i' | b'u' | b'x' | b'X' | b'c') if !wide => {
                rest = &behind[flags + 1..];
            }
            last => {
                let end = (flags + usize::from(last.is_some())).min(16);
                return Some(format!("%{}", String::from_utf8_lossy(&behind[..end])));
            }
        }
    }
    None
}
