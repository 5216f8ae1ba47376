//! What the program brings for the shell: completions and manual pages.

use crate::support::{in_folder, said, succeeds};

#[test]
fn shells_complete_every_command() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish"] {
        let output = in_folder(folder.path(), &["completions", shell]);
        succeeds(&output);
        let script = said(&output);
        assert!(["sweep", "solve", "export"].iter().all(|name| script.contains(name)), "{shell}");
        assert!(!script.contains("gmsh-worker"), "{shell} offers what is hidden");
    }
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = tempfile::tempdir().unwrap();
    succeeds(&in_folder(folder.path(), &["man", "man1"]));
    let page = |name: &str| std::fs::read_to_string(folder.path().join("man1").join(name)).unwrap();
    assert!(page("mpm.1").contains(".TH mpm 1"));
    for name in ["new", "mesh", "seed", "solve", "export", "run", "sweep", "check", "info", "schema"] {
        let text = page(&format!("mpm-{name}.1"));
        assert!(text.contains(".SH SYNOPSIS") && text.contains(&format!("mpm\\-{name}")), "{text}");
    }
}
