//! The templates: the files of the folder `templates` of the repository, within the program.

/// A template of a case.
pub struct Template {
    /// Its name, and that of its `.geo`.
    pub name: &'static str,
    /// What it models, on a line.
    pub summary: &'static str,
    pub geo: &'static str,
    pub case: &'static str,
    /// `loading.yaml`, a case that starts from the state that the first one leaves.
    pub loading: Option<&'static str>,
    pub readme: &'static str,
}

macro_rules! file {
    ($path:expr) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/templates/", $path))
    };
}

macro_rules! template {
    ($name:literal, $summary:literal) => {
        template!($name, $summary, None)
    };
    ($name:literal, $summary:literal, $loading:expr) => {
        Template {
            name: $name,
            summary: $summary,
            geo: file!(concat!($name, "/", $name, ".geo")),
            case: file!(concat!($name, "/case.yaml")),
            loading: $loading,
            readme: file!(concat!($name, "/README.md")),
        }
    };
}

/// All of them, as they are listed.
pub const TEMPLATES: [Template; 13] = [
    template!("footing", "a strip or circular footing on clay, loaded to its limit"),
    template!("penetration", "a round bar, a flat strip or a thin wall pushed deep into clay"),
    template!("anchor", "a plate anchor pulled up in clay"),
    template!("slope", "a slope: its factor of safety, then failure and run-out"),
    template!("pipe", "a pipe pressed into the seabed and moved sideways"),
    template!("consolidation", "a layer of clay that is loaded and drains through its top"),
    template!("silo", "a silo of dry sand: filled, opened and emptied"),
    template!("impact", "a body that falls on clay: a penetrometer, an anchor or a block"),
    template!("wall", "a wall pushed into sand, or moved away from it"),
    template!("excavation", "a pit beside an anchored wall in sand, dug in stages"),
    template!("embankment", "an embankment in lifts on soft clay, which consolidates between them"),
    template!("cpt", "a cone penetrometer pushed into clay"),
    template!(
        "monopile",
        "an open pile pushed into clay, and a second case that pulls it",
        Some(file!("monopile/loading.yaml"))
    ),
];

/// The `Makefile` of every template.
pub const MAKEFILE: &str = file!("Makefile");
