//! Which program this is: what provenance, stamps and `mpm --version` say of it. Set by `build.rs`.

/// Version of the crate.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Git commit it was built at, `+` where tracked sources differed from it, `unknown` outside a repository.
pub const COMMIT: &str = env!("MPM_COMMIT");
/// XXH64 of its sources: two builds with the same number compute the same.
pub const SOURCE: &str = env!("MPM_SOURCE");
/// Target and profile of the build.
pub const BUILD: &str = env!("MPM_PROFILE");
/// Version of the Gmsh that it is linked with.
pub const GMSH: &str = env!("MPM_GMSH");

/// All of it but Gmsh in one line, as `mpm --version` and files have it.
pub const IDENTITY: &str =
    concat!(env!("CARGO_PKG_VERSION"), " (commit ", env!("MPM_COMMIT"), ", sources ", env!("MPM_SOURCE"), ")");
