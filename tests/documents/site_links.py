"""Follows every link of a folder of pages: files and anchors have to be there, drawings have to be whole. Links to other
hosts are not followed, nor anchors in the reference of the libraries, some of which doxygen invents.

    site_links.py FOLDER
"""

import sys
import xml.etree.ElementTree
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """Anchors of a page, and what it refers to."""

    def __init__(self, file):
        super().__init__()
        self.anchors, self.links = set(), []
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if value is None:
                continue
            if name == "id" or (name == "name" and tag == "a"):
                self.anchors.add(value)
            if name in ("href", "src"):
                self.links.append(value)


def is_whole(drawing):
    try:
        xml.etree.ElementTree.parse(drawing)
    except xml.etree.ElementTree.ParseError:
        return False
    return True


def dead_links(folder):
    """Links that lead nowhere, and the number of those that were followed."""
    pages = {file: Page(file) for file in folder.rglob("*.html")}
    dead, followed = [], 0
    for file, page in pages.items():
        for link in page.links:
            url = urlsplit(link)
            if url.scheme or url.netloc:
                continue
            followed += 1
            path = unquote(url.path)
            base = folder if path.startswith("/") else file.parent
            target = (base / path.lstrip("/")).resolve() if path else file
            if target.is_dir():
                target = target / "index.html"
            anchor = unquote(url.fragment)
            if not target.is_file():
                dead.append(f"{file.relative_to(folder)}: {link} is not there")
            elif anchor and target in pages and "reference" not in target.relative_to(folder).parts and anchor not in pages[target].anchors:
                dead.append(f"{file.relative_to(folder)}: {link} has no such anchor")
    dead += [f"{file.relative_to(folder)}: is no whole drawing" for file in folder.rglob("*.svg") if not is_whole(file)]
    return dead, followed


def main():
    folder = Path(sys.argv[1]).resolve()
    # What is dead is found.
    probes = {
        "probe.html": '<a href="no_such_page.html">a</a><a href="index.html#no_such_anchor">b</a>',
        "probe.svg": "<svg><g></g>",
    }
    for name, text in probes.items():
        (folder / name).write_text(text, encoding="utf-8")
    try:
        found = [text for text in dead_links(folder)[0] if text.startswith("probe.")]
    finally:
        for name in probes:
            (folder / name).unlink()
    if len(found) != 3:
        sys.exit(f"two dead links and half a drawing were reported as {found}")
    dead, followed = dead_links(folder)
    print("\n".join(dead))
    print(f"{followed} links followed, {len(dead)} lead nowhere")
    return 1 if dead or followed < 1000 else 0


if __name__ == "__main__":
    sys.exit(main())
