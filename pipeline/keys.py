#!/usr/bin/env python3
"""Writes the tables of keys in docs/reference from the schema of `case.yaml`.

    .venv/bin/python pipeline/keys.py [--check] SCHEMA

SCHEMA is a file with what `mpm schema` prints. Between `<!-- keys NAME -->` and `<!-- end of keys -->` a page gets the table of
the block NAME, a definition of the schema (`case` is the file itself): key, values with their unit, default, meaning, and an example
from a case of the repository that has the key. A block without a place, a key without a meaning or an example is an error. `--check`
writes nothing and names the tables that differ.
"""

import argparse
import json
import os
import re
import sys
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parent.parent
PAGES = ROOT / "docs/reference"
TABLE = re.compile(r"<!-- keys (\w+) -->\n(.*?)<!-- end of keys -->", re.DOTALL)
UNIT = re.compile(r" [(\[](-|degrees|1/s|kN|kN/m|kN/m²|kN/m³|kNm²/m|kPa|kPa s/m|m|m/s|m/s²|rad|rad/m|s|t/m³)[)\]]")
DEFAULT = re.compile(r"(?:\. |; )[Dd]efault:? (.+?)(?=\.$|\. |$)")
MODELS = re.compile(r" of ((?:`?\w+`?, )*`?\w+`?)$")
LONGEST = 56  # characters of an example
TYPES = {"a number": {"number"}, "a whole number": {"integer"}, "text": {"string"}}

# Places of examples, the best first.
FOLDERS = ("templates", "cases", "docs/examples", "tests/data")

# What is said of definitions that many keys share.
PROFILE = "number or [profile](case-file.md#numbers-that-vary)"
IN_TIME = "number, constant or [in time](case-file.md#numbers-that-vary)"
SHARED = {"InDepth": PROFILE, "InTime": IN_TIME, "Load": f"{IN_TIME}, or a profile", "WaterTable": f"{IN_TIME}, or a [line](loads.md#line)", "OneOrMore": "a name or a list of names",
          "Quantity": "a [quantity](output.md#quantities)", "Field": "a [field](output.md#fields)"}


def definition(schema, part):
    """The name of the definition that a part refers to, and what it says."""
    name = part["$ref"].rsplit("/", 1)[1] if "$ref" in part else None
    return name, schema["$defs"][name] if name else part


def alternatives(part):
    """What a part may be, without null."""
    return [each for each in part.get("anyOf", [part]) if each.get("type") != "null"]


def kinds(part):
    """The JSON types of a part."""
    given = part.get("type", [])
    return {given} if isinstance(given, str) else set(given)


def flow(value):
    """A value as YAML on one line; of a case, whose scalars are read as text, as it is written there."""
    if isinstance(value, dict):
        text = "{" + ", ".join(f"{key}: {flow(entry)}" for key, entry in value.items()) + "}"
    elif isinstance(value, list):
        text = "[" + ", ".join(flow(entry) for entry in value) + "]"
    elif isinstance(value, str):
        text = f'"{value}"' if re.search(r"[:,#\[\]{}]", value) else value
    else:
        text = json.dumps(int(value) if isinstance(value, float) and value.is_integer() else value)
    return text.replace("|", "\\|")


def collect(schema, part, value, file, found):
    """Records what a case has at the keys of a part, by block and key."""
    for each in alternatives(part):
        name, said = definition(schema, each)
        if "anyOf" in said:
            collect(schema, said, value, file, found)
        elif isinstance(value, dict) and set(value) <= set(said.get("properties", {})):
            for key, entry in value.items():
                found.setdefault((name or "case", key), []).append((file, entry))
                collect(schema, said["properties"][key], entry, file, found)
        elif isinstance(value, dict) and isinstance(said.get("additionalProperties"), dict):
            for entry in value.values():
                collect(schema, said["additionalProperties"], entry, file, found)
        elif isinstance(value, list) and "items" in said:
            for entry in value:
                collect(schema, said["items"], entry, file, found)


def examples(schema):
    """For each block and key an example and the case that has it."""
    found = {}
    for folder in FOLDERS:
        for file in sorted((ROOT / folder).glob("*/case.yaml")):
            collect(schema, schema, yaml.load(file.read_text(), yaml.BaseLoader), file, found)
    best = {}
    for place, entries in found.items():
        texts = [(file, flow(entry)) for file, entry in entries]
        best[place] = next((each for each in texts if len(each[1]) <= LONGEST), (entries[0][0], ""))
    return best


def bounds(part):
    """The range of a number."""
    said = [f"{sign} {part[key]:g}" for key, sign in
            (("minimum", "≥"), ("exclusiveMinimum", ">"), ("maximum", "≤"), ("exclusiveMaximum", "<")) if key in part]
    kind = "whole number" if "integer" in kinds(part) else "number"
    return " ".join([kind, " and ".join(said)]).strip()


def values(schema, part, place):
    """What may be written at a key."""
    said = []
    for each in alternatives(part):
        name, inner = definition(schema, each)
        if name in SHARED:
            said.append(SHARED[name])
        elif "anyOf" in inner:
            said.append(values(schema, inner, place))
        elif "enum" in inner:
            said.append(", ".join(f"`{one}`" for one in inner["enum"] if one is not None))
        elif "properties" in inner:
            said.append(f"[block]({place(name)})")
        elif "items" in inner:
            said.append(f"list of: {values(schema, inner['items'], place)}")
        elif isinstance(inner.get("additionalProperties"), dict):
            said.append(f"by name: {values(schema, inner['additionalProperties'], place)}")
        elif "array" in kinds(inner):
            said.append("list")
        elif "boolean" in kinds(inner):
            said.append("`true`, `false`")
        else:
            said.append("text" if "string" in kinds(inner) else bounds(inner))
    return " or ".join(dict.fromkeys(said))


def table(schema, name, known, page, place):
    """The table of a block, and what it lacks."""
    block = schema if name == "case" else schema["$defs"][name]
    lines = ["| key | values | default | meaning | example |", "|---|---|---|---|---|"]
    lacks = []
    required = block.get("required", [])
    for key in required + sorted(set(block["properties"]) - set(required)):
        part = block["properties"][key]
        meaning = " ".join(part.get("description", "").split())
        if not meaning:
            lacks.append(f"{name}.{key} has no description in the schema")
        models = MODELS.search(meaning.removesuffix(".")) if name == "Material" else None
        if models:
            meaning = MODELS.sub("", meaning.removesuffix("."))
        unit = UNIT.search(meaning)
        meaning = UNIT.sub("", meaning, count=1)
        default = DEFAULT.search(meaning)
        meaning = DEFAULT.sub("", meaning)
        if models:
            takers = models[1].split(", ")
            first = meaning[0].upper() if meaning[0].isascii() and meaning[1].isalpha() else meaning[0]
            meaning = f"{first + meaning[1:]}. Of {'all models' if len(takers) >= 6 else ', '.join(f'`{m}`' for m in takers)}"
        if default:
            shown = f"`{default[1]}`" if re.fullmatch(r"(?!none$|empty$|unchanged$)[\w.]+", default[1]) else default[1]
        elif key in required:
            shown = "*required*"
        else:
            shown = f"`{flow(part['default'])}`" if part.get("default") not in (None, {}, [], "") else ""
        example = known.get((name, key))
        if example is None:
            lacks.append(f"{name}.{key} has no example in {', '.join(FOLDERS)}")
            shown_example = ""
        else:
            file, text = example
            target = next((f for f in (file.with_name("README.md"), file) if f.exists()))
            shown_example = " ".join([f"`{text}`"] * bool(text) + [f"([{file.parent.name}]({os.path.relpath(target, page.parent)}))"])
        wide = values(schema, part, place) + (f" [{'°' if unit[1] == 'degrees' else unit[1]}]" if unit else "")
        lines.append(f"| `{key}` | {wide} | {shown} | {meaning.removesuffix('.')} | {shown_example} |")
    return "\n".join(lines) + "\n", lacks


def links(texts, places, page):
    """From a page to the heading above the table of a block."""
    def link(name):
        if name not in places:
            return ""
        before = texts[places[name]].partition(f"<!-- keys {name} -->")[0]
        heading = re.findall(r"^#+ (.+)$", before, re.MULTILINE)[-1].lower()
        anchor = re.sub(r"[^\w\- ]", "", heading).replace(" ", "-")
        return ("" if places[name] == page else places[name].name) + f"#{anchor}"
    return link


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--check", action="store_true", help="write nothing; fail where a page differs")
    parser.add_argument("schema", type=Path, help="what `mpm schema` prints")
    arguments = parser.parse_args()
    schema = json.loads(arguments.schema.read_text())
    known = examples(schema)
    texts = {page: page.read_text() for page in sorted(PAGES.glob("*.md"))}
    places = {found[1]: page for page, text in texts.items() for found in TABLE.finditer(text)}
    wanted = {"case"} | {name for name, block in schema["$defs"].items() if "properties" in block}
    problems = [f"no page has the block {name}: add `<!-- keys {name} -->`" for name in sorted(wanted - set(places))]
    problems += [f"{places[name].name}: the schema has no block {name}" for name in sorted(set(places) - wanted)]
    for page, text in texts.items():
        changed = text
        for found in TABLE.finditer(text):
            if found[1] in wanted:
                new, lacks = table(schema, found[1], known, page, links(texts, places, page))
                problems += [f"{page.name}: {each}" for each in lacks]
                if arguments.check and new != found[2]:
                    problems.append(f"{page.name}: the table of {found[1]} differs from the schema; run `make keys`")
                changed = changed.replace(found[0], f"<!-- keys {found[1]} -->\n{new}<!-- end of keys -->")
        if not arguments.check and changed != text:
            page.write_text(changed)
    for problem in problems:
        print(f"keys: {problem}", file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
