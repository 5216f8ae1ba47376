//! What the child process that runs Gmsh takes from itself before Gmsh opens a file: limits of memory and file
//! size, and with Landlock (Linux 5.13 or newer) all files but those of the geometry, all programs and all of the network.

use landlock::{
    ABI, Access, AccessFs, AccessNet, CompatLevel, Compatible, PathBeneath, PathFd, Ruleset, RulesetAttr,
    RulesetCreatedAttr, RulesetError, RulesetStatus, Scope,
};
use rustix::process::{Resource, Rlimit, Signal, getppid, set_parent_process_death_signal, setrlimit};
use std::path::{Path, PathBuf};

/// The process ends with its parent, of number `parent`, which looks after its time, and stays below `memory` (bytes).
///
/// # Errors
/// Limits that the system does not set; a parent that has ended already.
pub fn limit(parent: u32, memory: u64) -> std::io::Result<()> {
    set_parent_process_death_signal(Some(Signal::KILL))?;
    if getppid().map(|parent| parent.as_raw_nonzero().get().unsigned_abs()) != Some(parent) {
        return Err(std::io::Error::other("the program that started it has ended"));
    }
    for (resource, most) in [(Resource::As, memory), (Resource::Fsize, memory), (Resource::Core, 0)] {
        let most = rustix::process::getrlimit(resource).maximum.map_or(most, |maximum| maximum.min(most));
        setrlimit(resource, Rlimit { current: Some(most), maximum: Some(most) })?;
    }
    Ok(())
}

/// From here on the process reads `files` only, writes in `folder` only, starts no program and opens no connection, as
/// far as the kernel can see to it; whether it sees to any of that.
///
/// # Errors
/// A file that is not there; a kernel that has Landlock and refuses it.
pub fn enter(files: &[PathBuf], folder: Option<&Path>) -> Result<bool, RulesetError> {
    let newest = ABI::V6;
    let mut rules = Ruleset::default()
        .set_compatibility(CompatLevel::BestEffort)
        .handle_access(AccessFs::from_all(newest))?
        .handle_access(AccessNet::from_all(newest))?
        .scope(Scope::from_all(newest))?
        .create()?;
    for file in files {
        if let Ok(file) = PathFd::new(file) {
            rules = rules.add_rule(PathBeneath::new(file, AccessFs::ReadFile))?;
        }
    }
    if let Some(folder) = folder.and_then(|folder| PathFd::new(folder).ok()) {
        rules = rules.add_rule(PathBeneath::new(folder, AccessFs::from_all(newest) & !AccessFs::Execute))?;
    }
    Ok(rules.restrict_self()?.ruleset != RulesetStatus::NotEnforced)
}
