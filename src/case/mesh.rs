//! What a case says of its mesh: a `.geo` and how it is meshed, or a mesh that is given.

use super::check::Checker;
use super::checked::{self, Order, Source};
use super::locate::{At, Path};
use super::raw;
use crate::mesh::given;
use std::path::Path as FilePath;

impl Checker {
    pub(super) fn mesh(&mut self, mesh: &raw::Mesh, folder: &FilePath, path: &Path) -> checked::Mesh {
        let source = self.source(mesh, folder, path);
        let second = mesh.order.is_none_or(|order| order == 2);
        if mesh.incomplete && !second {
            let remedy = "take `incomplete` out, or set `order: 2`";
            let problem = match mesh.order {
                Some(1) => "cells of order 1 have no centre node to leave out",
                _ => "only cells of order 2 can be without a centre node",
            };
            self.issue(&path.key("incomplete"), At::Key, problem, remedy);
        }
        let order = match (mesh.order, mesh.incomplete) {
            (Some(1), _) => Some(Order::First),
            (Some(3), _) => Some(Order::Third),
            (None, false) if matches!(source, Source::Mesh(_)) => None,
            (_, false) => Some(Order::Second),
            (_, true) => Some(Order::SecondIncomplete),
        };
        checked::Mesh { source, order, parameters: mesh.parameters.clone() }
    }

    /// The file that a mesh comes from.
    fn source(&mut self, mesh: &raw::Mesh, folder: &FilePath, block: &Path) -> Source {
        let (key, name) = match (&mesh.geo, &mesh.file) {
            (Some(geo), None) => ("geo", geo),
            (None, Some(file)) => ("file", file),
            (Some(geo), Some(_)) => {
                let remedy = "keep `geo` to mesh a geometry, or `file` for a mesh that is there";
                self.issue(&block.key("file"), At::Key, "`geo` and `file` are both given", remedy);
                ("geo", geo)
            }
            (None, None) => {
                let remedy = "add `geo: …`, a .geo file, or `file: …`, a mesh";
                self.issue(block, At::Key, "neither `geo` nor `file` is given", remedy);
                return Source::Geo(folder.to_owned());
            }
        };
        let path = block.key(key);
        let file = folder.join(name);
        let is_mesh = given::is_read(&file);
        if !file.is_file() {
            let kind = if key == "geo" { "a .geo file" } else { "a mesh" };
            let remedy = format!("name {kind}, relative to the case file");
            self.issue(&path, At::Value, format!("there is no file {}", file.display()), remedy);
        } else if key == "geo" && is_mesh {
            self.issue(
                &path,
                At::Value,
                "it is a mesh, and no geometry",
                format!("write `file: {name}` in place of `geo`"),
            );
        } else if key == "file" && !is_mesh {
            let remedy = match file.extension().is_some_and(|end| end == "geo") {
                true => format!("write `geo: {name}` in place of `file`"),
                false => format!(
                    "convert it: `.venv/bin/python pipeline/import_mesh.py {name} mesh.msh` in the folder of mpm, and write `file: mesh.msh`"
                ),
            };
            self.issue(&path, At::Value, format!("it is no mesh that ends in {}", given::ENDS.join(", ")), remedy);
        }
        if key == "geo" {
            return Source::Geo(file);
        }
        if !mesh.parameters.is_empty() {
            let remedy = "take `parameters` out, or name a .geo under `geo`";
            self.issue(&block.key("parameters"), At::Key, "a mesh has no parameters", remedy);
        }
        Source::Mesh(file)
    }
}
