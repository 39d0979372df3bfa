#!/usr/bin/env python3
"""Copies what the site shows into one folder: README, docs/README.md, every page that a page of these links to, and the
files that they show. Groups of docs/README.md become the site's navigation.

usage: stage.py SOURCE_DIR OUT_DIR. Design: docs/decisions/0702-studio-and-reports.md
"""
import pathlib
import re
import shutil
import sys

LINK = re.compile(r"(\]\()([^)\s]+)(\))")
CODE = re.compile(r"```.*?^\s*```|`[^`\n]+`", re.DOTALL | re.MULTILINE)
FRONT = "README.md"
MAP = "docs/README.md"
DECISIONS = "docs/decisions/README.md"
# Pages that the site alone has, by the group of the map that shows them.
GENERATED = {"Start": ["docs/gallery.md"], "Use": ["docs/python_api.md", "docs/cpp_api.md"], "Trust": ["docs/leaderboard.md"]}
NOTEBOOKS = "docs/notebooks"  # as pages, in the place of python/notebooks
WITHOUT_GROUP = "---\norphan: true\n---\n\n"


def outside_code(text, change):
    """The text with `change` applied to what is no code."""
    parts, end = [], 0
    for code in CODE.finditer(text):
        parts += [change(text[end:code.start()]), code[0]]
        end = code.end()
    return "".join([*parts, change(text[end:])])


class Stage:
    def __init__(self, source, out):
        self.source, self.out, self.pages, self.broken = source, out, {}, []

    def target_of(self, page, link):
        """The file that a link of a page means, from the source's folder; None where it leads to another site."""
        if re.match(r"[a-z]+:|#", link):
            return None
        path = (self.source / page).parent / link.partition("#")[0]
        if path.is_dir():
            path /= "README.md"
        target = path.resolve().relative_to(self.source)
        return f"{NOTEBOOKS}/{target.stem}.md" if target.suffix == ".ipynb" else target.as_posix()

    def renamed(self, page, link):
        """A link of a page as it is on the site; files that are no pages are shown beside them."""
        target, anchor = self.target_of(page, link), link.partition("#")[1:]
        if target is None:
            return link
        if target.endswith(".md"):
            self.add(target, page)
        else:
            self.copy(target, page)
        up = "../" * page.count("/")
        return up + self.place(target) + "".join(anchor)

    @staticmethod
    def place(target):
        """Where a file stands in the stage: README.md is the index of its folder."""
        return re.sub(r"(^|/)README\.md$", r"\1index.md", target)

    def copy(self, target, page):
        if not (self.source / target).is_file():
            self.broken.append(f"{page}: {target} does not exist")
            return
        copied = self.out / target
        copied.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(self.source / target, copied)

    def add(self, page, linked_from="the site"):
        if page in self.pages:
            return
        if (self.out / page).is_file():  # already as the site needs it
            self.pages[page] = (self.out / page).read_text()
            (self.out / page).unlink()
            return
        if not (self.source / page).is_file():
            self.broken.append(f"{linked_from}: {page} does not exist")
            return
        self.pages[page] = text = (self.source / page).read_text()
        self.pages[page] = outside_code(text, lambda part: LINK.sub(lambda m: m[1] + self.renamed(page, m[2]) + m[3], part))

    def write(self, grouped):
        for page, text in self.pages.items():
            file = self.out / self.place(page)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text if page in grouped or page == FRONT else WITHOUT_GROUP + text)


def groups(text):
    """(caption, [pages]) of each paragraph 'Caption: [page](file.md) · ...' of docs/README.md."""
    for paragraph in re.split(r"\n\s*\n", text):
        caption = re.match(r"([A-Z][^:\[]*): \[", paragraph)
        if caption:
            yield caption[1], [link for _, link, _ in LINK.findall(paragraph) if link.endswith((".md", "/"))]


def titles(folder):
    """'- [title](file)' for each page of a folder, by its first heading."""
    for file in sorted(folder.glob("*.md")):
        heading = re.search(r"^# (.*)$", file.read_text(), re.MULTILINE)
        if heading and file.name != "README.md":
            yield f"- [{heading[1].replace('[', '(').replace(']', ')')}]({file.name})"


def write_decisions(source, out):
    """The page that lists the decisions."""
    (out / DECISIONS).parent.mkdir(parents=True, exist_ok=True)
    words = "For those who change the program: what holds, why, and what was rejected."
    (out / DECISIONS).write_text("\n".join(["# Decisions", "", words, "", *titles((source / DECISIONS).parent), ""]))


def main():
    source, out = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    write_decisions(source, out)
    stage = Stage(source, out)
    GENERATED["Use"] += sorted(f"{NOTEBOOKS}/{page.name}" for page in (out / NOTEBOOKS).glob("*.md"))
    for page in (FRONT, MAP, *sum(GENERATED.values(), [])):
        stage.add(page)
    for decision in sorted((source / DECISIONS).parent.glob("*.md")):
        stage.add(decision.relative_to(source).as_posix())
    navigation, grouped = [], {MAP}
    for caption, links in groups((source / MAP).read_text()):
        pages = [stage.target_of(MAP, link) for link in links] + GENERATED.get(caption, [])
        grouped.update(pages)
        navigation += ["```{toctree}", ":hidden:", f":caption: {caption}", "", *(stage.place(page)[:-3] for page in pages), "```", ""]
    stage.pages[FRONT] += "\n" + "\n".join(["```{toctree}", ":hidden:", "", "docs/index", "```", "", *navigation])
    stage.write(grouped)
    print("\n".join(stage.broken) or f"site: {len(stage.pages)} pages")
    return 1 if stage.broken else 0


if __name__ == "__main__":
    sys.exit(main())
