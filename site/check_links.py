#!/usr/bin/env python3
"""Every link of the site and of its styles leads to a file and a place of the site; nothing is loaded from another server.

usage: check_links.py SITE_DIR
"""
import html.parser
import pathlib
import re
import sys
import urllib.parse

LINKS = {"a": "href", "link": "href", "img": "src", "script": "src", "iframe": "src", "source": "src"}
MADE_BY_COMMANDS = ("gallery",)  # whole pages of the program, which tests of their own check
STYLE = re.compile(r"url\(\s*['\"]?([^'\")]+)")
GENERATED_SEARCH = re.compile(r"cpp/search/")  # Doxygen's, filled by a script


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.places = [], {"", "top"}
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.places.update(values[key] for key in ("id", "name") if values.get(key))
        link = values.get(LINKS.get(tag, ""))
        if link:
            self.links.append((tag, link))


def pages(site):
    for file in sorted(site.rglob("*.html")):
        name = file.relative_to(site).as_posix()
        if not name.startswith(MADE_BY_COMMANDS) and not GENERATED_SEARCH.match(name):
            yield name, Page(file.read_text(errors="replace"))


def problems_of(site, name, page, known):
    for tag, link in page.links:
        address = urllib.parse.urlsplit(link)
        if address.scheme in ("http", "https") or link.startswith("//"):
            if tag != "a" and not (tag == "link"):
                yield f"{name}: loads {link}"
            continue
        if address.scheme:
            continue
        file = (site / name).parent / urllib.parse.unquote(address.path) if address.path else site / name
        target = file.resolve()
        if target.is_dir():
            target /= "index.html"
        if not target.is_file():
            yield f"{name}: {link} does not exist"
            continue
        place, shown = urllib.parse.unquote(address.fragment), target.relative_to(site).as_posix()
        if shown in known and place not in known[shown].places:
            yield f"{name}: {link} has no such place"


def problems_of_styles(site):
    for file in sorted(site.rglob("*.css")):
        name = file.relative_to(site).as_posix()
        for link in STYLE.findall(file.read_text(errors="replace")):
            address = urllib.parse.urlsplit(link)
            if address.scheme in ("http", "https") or link.startswith("//"):
                yield f"{name}: loads {link}"
            elif not address.scheme and address.path:
                target = file.parent / urllib.parse.unquote(address.path)
                if address.path.startswith("/") or not target.is_file():
                    yield f"{name}: {link} does not exist"


def main():
    site = pathlib.Path(sys.argv[1]).resolve()
    known = dict(pages(site))
    problems = [problem for name, page in known.items() for problem in problems_of(site, name, page, known)]
    problems += problems_of_styles(site)
    print("\n".join(problems[:100]) or f"site: {len(known)} pages, {sum(len(page.links) for page in known.values())} links, 0 broken")
    return 1 if problems or not known else 0


if __name__ == "__main__":
    sys.exit(main())
