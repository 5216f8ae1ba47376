"""A copy of the program in which numerical constants can be changed at run time: MPM_CONSTANTS=FILE::NAME=VALUE,….

Each `const NAME: f64 = …;` of the solver becomes a function that reads its value once, and each use of it a call. Integers that are not sizes of arrays do so, too.
"""

import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "target/constants"
# Where results come from; drawing, reading and reporting are left out.
FOLDERS = ["contact", "surface", "quadrature", "step", "interpolation", "system", "term"]
FILES = ["case/scene.rs", "case/incompressible.rs", "case/water.rs", "case/contact_interfaces.rs"]
DECLARED = re.compile(r"^(?P<indent> *)(?P<vis>pub(?:\([a-z]+\))? )?const (?P<name>[A-Z][A-Z_0-9]*): (?P<kind>f64|usize|u32|i32) = (?P<value>[^;]*);", re.M)
READS = """

/// The value of a constant: that of the source, or of MPM_CONSTANTS. What is read is written to MPM_CONSTANTS_READ.
pub(crate) fn constant(name: &str, value: f64) -> f64 {
    static CHANGED: std::sync::OnceLock<Vec<(String, f64)>> = std::sync::OnceLock::new();
    let changed = CHANGED.get_or_init(|| {
        let text = std::env::var("MPM_CONSTANTS").unwrap_or_default();
        let entry = |entry: &str| entry.split_once('=').map(|(name, value)| (name.to_owned(), value.parse().unwrap()));
        text.split(',').filter_map(entry).collect()
    });
    if let Ok(file) = std::env::var("MPM_CONSTANTS_READ") {
        use std::io::Write;
        let file = std::fs::OpenOptions::new().append(true).open(file);
        let _ = file.and_then(|mut file| file.write_all(format!("{name}={value:?}\n").as_bytes()));
    }
    changed.iter().find(|(other, _)| other == name).map_or(value, |(_, changed)| *changed)
}
"""


@dataclass
class Constant:
    """A constant of the solver."""

    file: str  # under src
    name: str
    kind: str
    value: str  # as it is written
    why: str  # its documentation
    public: bool

    @property
    def key(self):
        return f"{self.file}::{self.name}"


def files():
    src = ROOT / "src"
    found = [path for folder in FOLDERS for path in sorted((src / folder).rglob("*.rs"))]
    found += [src / f"{folder}.rs" for folder in FOLDERS if (src / f"{folder}.rs").exists()]
    found += [src / name for name in FILES]
    return [path for path in found if "tests" not in path.relative_to(src).parts and path.name != "tests.rs"]


def program_text(text):
    """A file without its tests."""
    return text.split("#[cfg(test)]")[0]


def constants():
    """All of them, in the order of the files."""
    found = []
    for path in files():
        text = program_text(path.read_text())
        for match in DECLARED.finditer(text):
            name, kind = match["name"], match["kind"]
            # What messages name is an entry of the case, too.
            if kind != "f64" and fixed(name) or re.search(rf"\{{{name}[:}}]", text):
                continue
            lines = text[: match.start()].rstrip("\n").split("\n")
            why = []
            while lines and lines[-1].lstrip().startswith("///"):
                why.insert(0, lines.pop().strip()[3:].strip())
            found.append(Constant(str(path.relative_to(ROOT / "src")), name, kind, match["value"], " ".join(why), bool(match["vis"])))
    return [constant for constant in found if not LEFT_OUT.search(constant.key)]


# Sizes that only the speed depends on, and indices.
LEFT_OUT = re.compile(r"resampled/fields\.rs|^system/(scatter|assembly|factor|separator)\.rs|::(NUMBERS|ABSENT|NAMED|SIDE_BY_SIDE)$")


def fixed(name):
    """Whether an integer is the size of an array or a pattern somewhere, or an index, which cannot change at run time."""
    use = re.compile(rf"(; |<|\{{ ){name}\b|const [A-Z_0-9]+: [a-z0-9]+ = [^;]*\b{name}\b|\b{name} =>")
    return name == "NONE" or any(use.search(path.read_text()) for path in files())


def instrument():
    """Writes the copy and returns its folder. Files that have not changed keep their time, so that only what changed is built."""
    copy = KEPT / "source"
    command = ["git", "ls-files", "src", "tests", "benches", "templates", "build.rs", "Cargo.toml", "Cargo.lock", "README.md", "geo", "docs"]
    names = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    names = [name for name in names if (ROOT / name).exists()]
    known = constants()
    for name in names:
        content = (ROOT / name).read_bytes()
        if name.startswith("src/") and name.endswith(".rs"):
            content = instrumented(name.removeprefix("src/"), content.decode(), known).encode()
        file = copy / name
        if not file.exists() or file.read_bytes() != content:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
    if (copy / "src").exists():
        for path in (copy / "src").rglob("*.rs"):
            if str(path.relative_to(copy)) not in names:
                path.unlink()
    if not (copy / ".venv").exists():
        (copy / ".venv").symlink_to((ROOT / ".venv").resolve())
    return copy


def instrumented(name, text, known):
    """A source file, of this name under src, with functions in place of constants."""
    changed = program_text(text)
    rest = text[len(changed) :]
    for constant in known:
        own = constant.file == name
        if own or (constant.public and used(changed, constant, known, name)):
            changed = replaced(changed, constant, own)
    if name == "lib.rs":
        changed += READS
    return changed + rest


def used(text, constant, known, name):
    """Whether a file other than its own uses a public constant: it imports or qualifies the name, and has none of that name itself."""
    if not re.search(rf"\b{constant.name}\b", text) or any(c.file == name and c.name == constant.name for c in known):
        return False
    module = Path(constant.file).stem if Path(constant.file).stem != "mod" else Path(constant.file).parent.name
    return bool(re.search(rf"use [^;]*\b{constant.name}\b", text, re.S) or re.search(rf"\b{module}::{constant.name}\b", text))


def replaced(text, constant, own):
    """The text with uses of the constant as calls, and its declaration as a function if it is here."""
    imports = re.compile(r"^ *(?:pub(?:\([a-z]+\))? )?use [^;]*;", re.M)
    kept = [match.span() for match in imports.finditer(text)]
    out, at = [], 0
    for match in re.finditer(rf"\b{constant.name}\b(?!\()", text):
        start = match.start()
        line = text[text.rfind("\n", 0, start) + 1 : start]
        if "//" in line or any(a <= start < b for a, b in kept) or re.search(r"\bconst $", line) or re.search(r"(?<!::)\bfn $", line):
            continue
        out.append(text[at:start] + constant.name + "()")
        at = match.end()
    text = "".join(out) + text[at:]
    if own:
        declaration = re.compile(rf"^( *)((?:pub(?:\([a-z]+\))? )?)const {constant.name}: {constant.kind} = ([^;]*);", re.M)
        cast = "" if constant.kind == "f64" else f" as {constant.kind}"
        value = r"\3" if constant.kind == "f64" else r"(\3) as f64"
        call = f'static VALUE: std::sync::OnceLock<f64> = std::sync::OnceLock::new(); *VALUE.get_or_init(|| crate::constant("{constant.key}", {value}))'
        body = f"{{ {call} }}" if not cast else f"{{ ({{ {call} }}){cast} }}"
        text = declaration.sub(rf"\1#[allow(non_snake_case)]\n\1\2fn {constant.name}() -> {constant.kind} {body}", text)
    return text


def build():
    """The program with constants that can be changed."""
    copy = instrument()
    # Shared with nothing: the package has the name of the original.
    subprocess.run(["cargo", "build", "--quiet", "--release", "--bin", "mpm", "--target-dir", KEPT / "build"], cwd=copy, check=True)
    return KEPT / "build/release/mpm"
