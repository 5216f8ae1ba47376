//! Finds Gmsh, links it, and makes the Rust side of its C API from its own header.
//!
//! Gmsh is looked for in `$GMSH_DIR`, else in the project's `.venv` (the `gmsh` wheel), else through
//! `pkg-config`. The library is linked by its versioned name with its folder as run path, so the program
//! starts without any environment variable. What is missing is said together with its remedy.

use std::env;
use std::fs;
use std::hash::Hasher;
use std::panic;
use std::path::{Path, PathBuf};
use std::process::{Command, exit};
use twox_hash::XxHash64;

/// The oldest Gmsh whose C API has the functions used, with these arguments.
const OLDEST: (u32, u32) = (4, 11);

/// The functions `src/mesh/gmsh/session.rs` calls.
const FUNCTIONS: &str = "gmsh(Initialize|Finalize|Merge|Write|Free|OptionSetNumber|OptionGetNumber|ModelGetEntities|\
    ModelGetBoundary|ModelGetBoundingBox|ModelMeshGetSizes|ModelGetPhysicalGroups|ModelGetPhysicalName|\
    ModelGetEntitiesForPhysicalGroup|ModelMeshGenerate|ModelMeshClear|ModelMeshSetOrder|\
    ModelMeshGetNodes|ModelMeshGetElements|ParserClear|ParserGetNames|ParserGetNumber|ParserSetNumber|\
    LoggerStart|LoggerStop|LoggerGet|LoggerGetLastError)";

struct Gmsh {
    header: PathBuf,
    library: PathBuf,
}

fn main() {
    identify();
    for name in ["GMSH_DIR", "LIBCLANG_PATH"] {
        println!("cargo::rerun-if-env-changed={name}");
    }
    println!("cargo::rerun-if-changed=build.rs");
    let venv = Path::new(&env::var("CARGO_MANIFEST_DIR").unwrap_or_default()).join(".venv");
    let gmsh = find_gmsh(&venv);
    let (version, text) = version(&gmsh.header);
    println!("cargo::rustc-env=MPM_GMSH={text}");
    check_version(&gmsh.header, version);
    link(&gmsh.library);
    bind(&gmsh.header, &venv);
}

fn find_gmsh(venv: &Path) -> Gmsh {
    if let Some(root) = env::var_os("GMSH_DIR") {
        let root = PathBuf::from(root);
        return gmsh_under(&root).unwrap_or_else(|| {
            fail(&format!(
                "GMSH_DIR is {}, which has no include/gmshc.h or no lib/libgmsh.so; correct it, or unset it and run \
                 `make setup`",
                root.display()
            ))
        });
    }
    gmsh_under(venv).or_else(gmsh_of_pkg_config).unwrap_or_else(|| {
        // A folder that is not there yet: look again as soon as `make setup` has made it.
        println!("cargo::rerun-if-changed={}", venv.display());
        fail(
            "Gmsh was not found in .venv nor through pkg-config; run `make setup`, or set GMSH_DIR to a Gmsh SDK (the \
             folder with include/gmshc.h and lib/libgmsh.so)",
        )
    })
}

fn gmsh_under(root: &Path) -> Option<Gmsh> {
    let root = root.canonicalize().ok()?;
    let header = root.join("include/gmshc.h");
    let library = ["lib", "lib64", "lib/x86_64-linux-gnu"].iter().find_map(|lib| library_in(&root.join(lib)))?;
    header.is_file().then_some(Gmsh { header, library })
}

fn gmsh_of_pkg_config() -> Option<Gmsh> {
    let variable = |name: &str| {
        let output = Command::new("pkg-config").arg(format!("--variable={name}")).arg("gmsh").output().ok()?;
        let value = String::from_utf8(output.stdout).ok()?;
        (output.status.success() && !value.trim().is_empty()).then(|| PathBuf::from(value.trim()))
    };
    let header = variable("includedir")?.join("gmshc.h");
    let library = library_in(&variable("libdir")?)?;
    header.is_file().then_some(Gmsh { header, library })
}

/// The shared library in `folder` with the fullest version in its name.
fn library_in(folder: &Path) -> Option<PathBuf> {
    let libraries = fs::read_dir(folder).ok()?.filter_map(|entry| Some(entry.ok()?.path()));
    libraries.filter(|path| path.file_name().is_some_and(|n| n.to_string_lossy().starts_with("libgmsh.so"))).max()
}

/// Tells the program which one it is (`src/program.rs`): a hash of its sources, and the commit they were built at.
fn identify() {
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR").unwrap_or_default());
    let parts = ["src", "build.rs", "Cargo.toml", "Cargo.lock"];
    let mut files = Vec::new();
    for part in parts {
        println!("cargo::rerun-if-changed={part}");
        collect(&root.join(part), &mut files);
    }
    files.sort();
    let mut hasher = XxHash64::with_seed(0);
    for file in files {
        hasher.write(file.strip_prefix(&root).unwrap_or(&file).to_string_lossy().as_bytes());
        hasher.write(&fs::read(&file).unwrap_or_default());
    }
    println!("cargo::rustc-env=MPM_SOURCE={:016x}", hasher.finish());
    let git = |arguments: &[&str]| {
        // The repository of the program itself, not one that it was unpacked in.
        let output =
            root.join(".git").exists().then(|| Command::new("git").args(arguments).current_dir(&root).output());
        let output = output?.ok().filter(|output| output.status.success())?;
        String::from_utf8(output.stdout).ok().map(|text| text.trim().to_owned())
    };
    let changed = git(&[&["status", "--porcelain", "--"][..], &parts].concat()).is_some_and(|list| !list.is_empty());
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(|| "unknown".to_owned());
    println!("cargo::rustc-env=MPM_COMMIT={commit}{}", if changed { "+" } else { "" });
    let variable = |name: &str| env::var(name).unwrap_or_default();
    println!("cargo::rustc-env=MPM_PROFILE={} {}", variable("TARGET"), variable("PROFILE"));
}

/// The files of a folder and those below it, or the one file.
fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    match fs::read_dir(path) {
        Ok(entries) => entries.flatten().for_each(|entry| collect(&entry.path(), files)),
        Err(_) => files.push(path.to_owned()),
    }
}

/// The version of the C API, and its text.
fn version(header: &Path) -> ((u32, u32), String) {
    println!("cargo::rerun-if-changed={}", header.display());
    let text = fs::read_to_string(header).unwrap_or_default();
    let number = |name: &str| {
        let line = text.lines().find(|line| line.contains(&format!("define GMSH_API_VERSION_{name} ")))?;
        line.split_whitespace().last()?.parse::<u32>().ok()
    };
    let [major, minor, patch] = ["MAJOR", "MINOR", "PATCH"].map(|name| number(name).unwrap_or(0));
    ((major, minor), format!("{major}.{minor}.{patch}"))
}

fn check_version(header: &Path, version: (u32, u32)) {
    if version < OLDEST {
        fail(&format!(
            "{} is of Gmsh {}.{}, whose C API is too old ({}.{} or newer is needed); run `make setup`",
            header.display(),
            version.0,
            version.1,
            OLDEST.0,
            OLDEST.1
        ));
    }
}

fn link(library: &Path) {
    println!("cargo::rerun-if-changed={}", library.display());
    if let (Some(folder), Some(name)) = (library.parent(), library.file_name()) {
        println!("cargo::rustc-link-search=native={}", folder.display());
        println!("cargo::rustc-link-lib=dylib:+verbatim={}", name.to_string_lossy());
        // First where a wheel has it: the program in bin/, Gmsh's library in lib/ beside it.
        println!("cargo::rustc-link-arg=-Wl,-rpath,$ORIGIN/../lib");
        println!("cargo::rustc-link-arg=-Wl,-rpath,{}", folder.display());
    }
}

/// Calls the functions `initialize`, `model_get_entities`, … instead of `gmshInitialize`, `gmshModelGetEntities`.
#[derive(Debug)]
struct Names;

impl bindgen::callbacks::ParseCallbacks for Names {
    fn item_name(&self, item: bindgen::callbacks::ItemInfo) -> Option<String> {
        let mut name = String::new();
        for c in item.name.strip_prefix("gmsh")?.chars() {
            if c.is_ascii_uppercase() && !name.is_empty() {
                name.push('_');
            }
            name.push(c.to_ascii_lowercase());
        }
        Some(name)
    }
}

fn bind(header: &Path, venv: &Path) {
    if env::var_os("LIBCLANG_PATH").is_none()
        && let Some(folder) = libclang_of(venv)
    {
        // SAFETY: the build script has no other thread.
        unsafe { env::set_var("LIBCLANG_PATH", folder) };
    }
    // The wheel of libclang comes without stddef.h; the C compiler has one.
    let include = Command::new("cc").arg("-print-file-name=include").output().ok();
    let include = include.and_then(|output| String::from_utf8(output.stdout).ok()).unwrap_or_default();
    let mut builder = bindgen::Builder::default()
        .header(header.to_string_lossy())
        .allowlist_function(FUNCTIONS)
        .rust_edition(bindgen::RustEdition::Edition2024)
        .layout_tests(false)
        .generate_comments(false)
        .parse_callbacks(Box::new(Names));
    if !include.trim().is_empty() {
        builder = builder.clang_args(["-isystem", include.trim()]);
    }
    // bindgen panics where it finds no libclang.
    panic::set_hook(Box::new(|_| {}));
    let bindings = panic::catch_unwind(panic::AssertUnwindSafe(|| builder.generate()));
    let _ = panic::take_hook();
    let Ok(bindings) = bindings else {
        fail("libclang was not found; run `make setup`, or set LIBCLANG_PATH to the folder of libclang.so")
    };
    let out = Path::new(&env::var("OUT_DIR").unwrap_or_default()).join("gmsh.rs");
    match bindings {
        Ok(bindings) => {
            if let Err(error) = bindings.write_to_file(&out) {
                fail(&format!("{}: {error}", out.display()));
            }
        }
        Err(error) => fail(&format!("{}: {error}; run `make setup`", header.display())),
    }
}

/// The folder of the libclang wheel.
fn libclang_of(venv: &Path) -> Option<PathBuf> {
    let pythons = fs::read_dir(venv.join("lib")).ok()?.filter_map(|entry| Some(entry.ok()?.path()));
    pythons.map(|python| python.join("site-packages/clang/native")).find(|folder| folder.is_dir())
}

fn fail(message: &str) -> ! {
    println!("cargo::error={message}");
    exit(1)
}
