#!/usr/bin/env python3
"""Builds the manual with mdBook and follows its links.

    .venv/bin/python pipeline/book.py MDBOOK [target/book]

Pages are those of docs/SUMMARY.md. They are copied into `target/book-src` in the folders that they have here, with every file
that they link to, so that a link is the same in the book and beside the sources. A page that links to something that is not there, a warning
of mdBook, and a link within the book that leads nowhere are errors.
"""

import argparse
import html.parser
import posixpath
import re
import shutil
import subprocess
import sys
import urllib.parse
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DOCS = Path("docs")
LINK = re.compile(r"\]\(([^)\s]+)\)")
IMAGE = re.compile(r'<img [^>]*src="([^"]+)"')


def local(link):
    """The path of a link to a file beside the page; nothing for an anchor or an address."""
    return "" if "://" in link or link.startswith("mailto:") else urllib.parse.unquote(link.partition("#")[0])


def stage(source):
    """Copies pages and what they link to; returns what is not there."""
    shutil.rmtree(source, ignore_errors=True)
    source.mkdir(parents=True)
    for name in ("book.toml", "book.css"):
        shutil.copy(ROOT / DOCS / name, source)
    summary = (ROOT / DOCS / "SUMMARY.md").read_text()
    links = {link: posixpath.normpath(f"docs/{link}") for link in LINK.findall(summary)}
    source.joinpath("SUMMARY.md").write_text(LINK.sub(lambda m: f"]({links[m[1]]})", summary))
    missing = []
    files = set(links.values())
    for page in sorted(files):
        if not (ROOT / page).is_file():
            missing.append(f"docs/SUMMARY.md: {page} is no file")
            continue
        text = (ROOT / page).read_text()
        text = re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.DOTALL)
        for link in LINK.findall(text) + IMAGE.findall(text):
            path = posixpath.normpath(posixpath.join(posixpath.dirname(page), local(link)))
            if not local(link):
                continue
            if not (ROOT / path).is_file():
                missing.append(f"{page}: {link} is no file")
            elif path.endswith(".md") and path not in links.values():
                missing.append(f"{page}: {link} is no page of docs/SUMMARY.md")
            files.add(path)
    for file in files:
        target = source / file
        target.parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / file).is_file():
            shutil.copy(ROOT / file, target)
    return missing


def open_at(book, page):
    """Makes `index.html` lead to the first page: mdBook's copy of it has the links of another folder."""
    book.joinpath("index.html").write_text(
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>mpm</title>\n'
        f'<meta http-equiv="refresh" content="0; url={page}"></head><body><a href="{page}">The manual</a></body></html>\n'
    )


class Page(html.parser.HTMLParser):
    """The anchors of a page and where it links to."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links = set(), set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.links.add(value)


def follow(book):
    """The links of the book that lead nowhere."""
    pages = {file: Page(file.read_text()) for file in sorted(book.rglob("*.html"))}
    dead = []
    for file, page in pages.items():
        # The page to print repeats all others; what is above a page in the tree is for the web server.
        if file.name in ("print.html", "toc.html", "404.html"):
            continue
        for link in sorted(page.links):
            if "://" in link or link.startswith(("mailto:", "data:", "javascript:")):
                continue
            path, _, anchor = link.partition("#")
            target = (file.parent / urllib.parse.unquote(path)).resolve() if path else file
            if not target.is_file():
                dead.append(f"{file.relative_to(book)}: {link}")
            elif anchor and target in pages and urllib.parse.unquote(anchor) not in pages[target].anchors:
                dead.append(f"{file.relative_to(book)}: {link}")
    return dead


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("mdbook", help="the program mdbook")
    parser.add_argument("book", type=Path, nargs="?", default=ROOT / "target/book", help="default: target/book")
    arguments = parser.parse_args()
    source = ROOT / "target/book-src"
    problems = stage(source)
    book = arguments.book.resolve()
    built = subprocess.run([arguments.mdbook, "build", source, "--dest-dir", book], capture_output=True, text=True)
    said = built.stdout + built.stderr
    problems += [line for line in said.splitlines() if re.search(r"\b(WARN|ERROR)\b", line)]
    if built.returncode != 0:
        problems.append(said)
    else:
        open_at(book, "docs/user-guide.html")
        problems += follow(book)
    for problem in problems:
        print(f"book: {problem}", file=sys.stderr)
    if not problems:
        print(f"{book / 'index.html'}; to print: {book / 'print.html'}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
