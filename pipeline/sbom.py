#!/usr/bin/env python3
"""Writes the software bill of materials: what is linked into `mpm`, as CycloneDX 1.6.

    .venv/bin/python pipeline/sbom.py [--check] [docs/sbom.cdx.json]

Crates are those that cargo links into the program on x86-64 Linux, with the checksums of `Cargo.lock`; build scripts,
procedural macros and test dependencies are left out. Gmsh and the libraries within it are those of the wheel in
`.venv`, as Gmsh itself reports them. Not listed: Rust's standard library, and what Gmsh loads from the system
(docs/legal.md). The file depends on nothing else, so `--check` compares it with what would be written, and names the
components that differ.
"""

import argparse
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGET = "x86_64-unknown-linux-gnu"
GMSH = "GPL-2.0-or-later"

# The libraries within Gmsh by the name of its build option, with their licence: as Gmsh's contrib/README.txt and
# CREDITS.txt state it, and the library's own where these say nothing. An empty licence is Gmsh's own code.
OPTIONS = {
    "ALGLIB": ("ALGLIB", "GPL-2.0-or-later"),
    "ANN": ("ANN", "LGPL-2.1-or-later"),
    "Bamg": ("bamg", "LGPL-2.1-or-later"),
    "Blas": ("BLAS (f2cblaslapack)", "BSD-3-Clause"),
    "Blossom": ("Concorde and Blossom IV", "permission for use within Gmsh (contrib/blossom/README.txt)"),
    "Cgns": ("CGNS", "Zlib"),
    "Eigen": ("Eigen", "MPL-2.0"),
    "Fltk": ("FLTK", "LGPL-2.0-or-later WITH FLTK-exception"),
    "Gmm": ("gmm++", "LGPL-3.0-or-later"),
    "Hxt": ("HXT", GMSH),
    "Jpeg": ("libjpeg", "IJG"),
    "Kbipack": ("kbipack", "GPL-2.0-or-later"),
    "Lapack": ("LAPACK (f2cblaslapack)", "BSD-3-Clause"),
    "MathEx": ("MathEx", "LGPL-2.1-or-later, with a static linking exception"),
    "Med": ("MED", "LGPL-3.0-or-later"),
    "Metis": ("METIS", "Apache-2.0"),
    "Mmg": ("Mmg", "LGPL-3.0-or-later"),
    "Mpeg": ("mpeg_encode", "permission of the Regents of the University of California (Gmsh's CREDITS.txt)"),
    "Netgen": ("Netgen", "LGPL-2.1-only"),
    "Nii2mesh": ("nii2mesh", "BSD-2-Clause"),
    "ONELAB": ("ONELAB", "MIT"),
    "OpenCASCADE": ("Open CASCADE Technology", "LGPL-2.1-only WITH OCCT-exception-1.0"),
    "OptHom": ("MeshOptimizer", "MIT"),
    "PETSc": ("PETSc", "BSD-2-Clause"),
    "Png": ("libpng", "libpng-2.0"),
    "TetGen/BR": ("TetGen/BR", GMSH),
    "TinyXML2": ("TinyXML-2", "Zlib"),
    "Untangle": ("HLBFGS and untangle", "no licence, freely available for non-commercial purposes (contrib/README.txt)"),
    "Voro++": ("Voro++", "BSD-3-Clause-LBNL"),
    "tinyobjloader": ("tinyobjloader", "MIT"),
} | dict.fromkeys(
    """64Bit DIntegration Dlopen DomHex LinuxJoystick Mesh ONELABMetamodel OpenCASCADE-CAF OpenGL OpenMP Parser Plugins
    Post QuadMeshingTools QuadTri Solver WinslowUntangler Zlib""".split()
)

# In Gmsh without a build option: named in its CREDITS.txt, and HDF5, on which CGNS and MED are built.
ALWAYS = [
    ("HDF5", "BSD-3-Clause"),
    ("libOL", "MIT"),
    ("nanoflann", "BSD-2-Clause"),
    ("picojson", "BSD-2-Clause"),
    ("robin_hood", "MIT"),
    ("zipper and MiniZip", "Zlib"),
]

# The versions that Gmsh reports.
VERSIONS = {"FLTK": "FLTK", "PETSc": "PETSc", "Open CASCADE Technology": "OCC", "MED": "MED"}


def licence(text):
    """An SPDX expression, or in words where there is none."""
    words = text.replace("/", " OR ")
    if re.fullmatch(r"[A-Za-z0-9.+\-]+( (OR|AND|WITH) [A-Za-z0-9.+\-]+|[()])*", words.replace("(", "").replace(")", "")):
        return [{"expression": words}]
    return [{"license": {"name": text}}]


def crates():
    """The crates linked into the program, and for each those that it links; the program comes first."""
    command = ["cargo", "tree", "--locked", "--offline", "--edges", "normal,no-proc-macro", "--target", TARGET]
    command += ["--no-dedupe", "--prefix", "depth", "--format", " {p}|{l}"]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if run.returncode:
        sys.exit(f"sbom: {run.stderr.strip()}")
    locked = tomllib.loads((ROOT / "Cargo.lock").read_text())["package"]
    checksum = {(package["name"], package["version"]): package.get("checksum") for package in locked}
    components, links, path = {}, {}, []
    for line in run.stdout.splitlines():
        depth, package, terms = re.fullmatch(r"(\d+) (\S+ v\S+).*\|(.*)", line).groups()
        name, version = package.split(" v")
        purl = f"pkg:cargo/{name}@{version}"
        component = {"type": "library", "bom-ref": purl, "name": name, "version": version, "purl": purl}
        if checksum[name, version]:
            component["hashes"] = [{"alg": "SHA-256", "content": checksum[name, version]}]
        components[purl] = component | {"licenses": licence(terms)}
        path[int(depth):] = [purl]
        links.setdefault(purl, set())
        if len(path) > 1:
            links[path[-2]].add(purl)
    return components, links


def gmsh():
    """Gmsh and the libraries within it, Gmsh first."""
    try:
        import gmsh as library
    except ImportError as error:
        sys.exit(f"sbom: {error}; run `make setup`, and this with .venv/bin/python")
    library.initialize(readConfigFiles=False)
    version, options, info = (
        library.option.getString(f"General.{name}") for name in ("Version", "BuildOptions", "BuildInfo")
    )
    library.finalize()
    parts = list(ALWAYS)
    for option in options.split():
        option = re.sub(r"\[.*\]", "", option)
        if option not in OPTIONS:
            sys.exit(f"sbom: Gmsh {version} has the part `{option}`, whose licence pipeline/sbom.py does not know")
        parts += [OPTIONS[option]] if OPTIONS[option] else []
    purl = f"pkg:pypi/gmsh@{version}"
    yield {
        "type": "library", "bom-ref": purl, "name": "gmsh", "version": version, "purl": purl,
        "description": "with an exception for Netgen, METIS, Open CASCADE and ParaView (its LICENSE.txt)",
        "licenses": licence(GMSH),
    }  # fmt: skip
    for name, terms in sorted(parts, key=lambda part: part[0].lower()):
        component = {"type": "library", "bom-ref": f"gmsh/{name}", "name": name, "licenses": licence(terms)}
        if found := re.search(rf"{VERSIONS.get(name, name)} version: ([0-9.]+)", info):
            component["version"] = found[1]
        yield component


def document():
    components, links = crates()
    program, *rest = components.values()
    wheel, *parts = gmsh()
    components = rest + [wheel, *parts]
    components.sort(key=lambda component: component["bom-ref"])
    links[program["bom-ref"]].add(wheel["bom-ref"])
    links[wheel["bom-ref"]] = {part["bom-ref"] for part in parts}
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {"component": program | {"type": "application"}},
        "components": components,
        "dependencies": [{"ref": ref, "dependsOn": sorted(links[ref])} for ref in sorted(links)],
    }


def names(bill):
    return {f"{component['name']} {component.get('version', '')}".strip() for component in bill.get("components", [])}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; fail where the file is not what it would be")
    parser.add_argument("file", nargs="?", type=Path, default=ROOT / "docs/sbom.cdx.json")
    args = parser.parse_args()
    bill = document()
    text = json.dumps(bill, indent=1, ensure_ascii=False) + "\n"
    if not args.check:
        args.file.write_text(text)
    elif not args.file.exists() or args.file.read_text() != text:
        written = names(json.loads(args.file.read_text())) if args.file.exists() else set()
        differ = [f"+ {name}" for name in sorted(names(bill) - written)]
        differ += [f"- {name}" for name in sorted(written - names(bill))]
        sys.exit("\n".join([f"{args.file} is not of the present Cargo.lock and Gmsh; run `make sbom`", *differ]))


if __name__ == "__main__":
    main()
