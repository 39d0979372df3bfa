#!/usr/bin/env python3
"""Checks of documents: links and cited files exist, decisions have a status and are cited, no page tells
of its making, lines of prose end, README, changelog and pages are short, versions agree.

usage: check_documents.py SOURCE_DIR VERSION
"""
import pathlib
import re
import sys

from extract_files import FILE

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def slug(heading):
    kept = re.sub(r"[^\w\- ]", "", heading.strip().lower().replace("`", ""))
    return kept.replace(" ", "-")


def broken_links(source):
    documents = [*source.glob("*.md"), *source.glob("docs/*.md"), *source.glob("docs/decisions/*.md"), *source.glob("extensions/*/README.md"), source / "scenarios/README.md",
                 source / "benchmarks/README.md"]
    for document in documents:
        for target in LINK.findall(re.sub(r"```.*?```", "", document.read_text(), flags=re.DOTALL)):
            if re.match(r"[a-z]+:", target):
                continue
            file, _, anchor = target.partition("#")
            path = (document.parent / file) if file else document
            if not path.exists():
                yield f"{document.relative_to(source)}: {target} does not exist"
            elif anchor and path.suffix == ".md":
                headings = re.findall(r"^#+ (.*)$", path.read_text(), re.MULTILINE)
                if anchor not in map(slug, headings):
                    yield f"{document.relative_to(source)}: {target} has no such heading"


def missing_paths(source):
    """Paths in code spans that look like files of this repository."""
    tops = "|".join(entry.name for entry in source.iterdir() if entry.is_dir() and not entry.name.startswith((".", "build", "out")))
    for document in [source / "README.md", source / "CONTRIBUTING.md", *source.glob("docs/*.md"),
                     source / "benchmarks/README.md"]:
        text = document.read_text()
        made = {str(pathlib.Path(path).parent) for path, _ in FILE.findall(text)}  # folders of files that the page shows
        for path in re.findall(rf"`((?:{tops})/[\w./-]+)`", text):
            if not (source / path).exists() and not any(path.startswith(folder + "/") for folder in made):
                yield f"{document.relative_to(source)}: {path} does not exist"


CODE = ["*.cpp", "*.hpp", "*.py", "*.js", "*.cmake", "CMakeLists.txt", "run"]
ROOMS = ["model", "planner", "diagnosis", "scenarios", "app", "extensions", "python", "benchmarks", "tests", "fuzz", "cmake"]
DOCUMENT = re.compile(r"(?<![\w./-])(?:docs|benchmarks/results)/[\w/-]+\.(?:md|svg|png)")


def cited_documents(source):
    """Each document that code or a comment cites, with the file that cites it."""
    for room in ROOMS:
        for pattern in CODE:
            for file in sorted((source / room).rglob(pattern)):
                for cited in DOCUMENT.findall(file.read_text(errors="replace")):
                    if not (file.name == "run" and cited.startswith("benchmarks/results/")):  # it writes that file
                        yield file.relative_to(source), cited
    for file in ("CMakeLists.txt", "dev", "site/build"):
        for cited in DOCUMENT.findall((source / file).read_text()):
            yield file, cited


def missing_documents(source):
    for file, cited in cited_documents(source):
        if not (source / cited).exists():
            yield f"{file}: {cited} does not exist"


def decisions(source):
    """Each decision has a status; code cites each one that stands; thresholds name decisions that exist."""
    folder = source / "docs/decisions"
    numbers = {file.name[:4] for file in folder.glob("*.md")}
    cited = {name for _, name in cited_documents(source)}
    for file in sorted(folder.glob("*.md")):
        status = re.search(r"^\W*Status\W+(?:(accepted)\b|superseded by (\d{4})\b)", file.read_text(), re.MULTILINE)
        if not status:
            yield f"docs/decisions/{file.name}: no line 'Status: accepted' or 'Status: superseded by NNNN'"
        elif status[2] and status[2] not in numbers:
            yield f"docs/decisions/{file.name}: superseded by {status[2]}, which does not exist"
        elif status[1] and f"docs/decisions/{file.name}" not in cited:
            yield f"docs/decisions/{file.name}: accepted, but no code cites it"
    thresholds = "diagnosis/thresholds.hpp"
    for number in re.findall(r"\((\d{4})\b[^()]*\)", (source / thresholds).read_text()):
        if number not in numbers:
            yield f"{thresholds}: no decision {number}"


# A note says what holds and why. How it came about is the version history's: cases of a benchmark, commits.
HISTORY = re.compile(r"\bcases? \d{3,}\b|\b(?=[0-9a-f]*\d)(?=[0-9a-f]*[a-f])[0-9a-f]{7,12}\b")
MOST_DECISIONS = 40


def histories(source):
    notes = sorted(source.glob("docs/decisions/*.md"))
    if len(notes) > MOST_DECISIONS:
        yield f"docs/decisions: {len(notes)} notes, at most {MOST_DECISIONS}: extend the note of the room and theme"
    for document in [*sorted(source.glob("docs/*.md")), *notes]:
        for number, line in enumerate(document.read_text().splitlines(), 1):
            for word in HISTORY.findall(line):
                yield f"{document.relative_to(source)}:{number}: tells of its making: {word}"


WIDTH = 110
WRITTEN_BY_COMMANDS = ("benchmarks/results/", "docs/effects.md")


def long_lines(source):
    """Lines of prose are at most WIDTH characters; tables, code, headings, formulas and lines with an address are exempt."""
    for document in sorted(source.rglob("*.md")):
        name = document.relative_to(source).as_posix()
        if name.startswith((*WRITTEN_BY_COMMANDS, "build", "out")):
            continue
        text = re.sub(r"^```.*?^```", lambda code: re.sub(".", "", code[0]), document.read_text(), flags=re.DOTALL | re.MULTILINE)
        for number, line in enumerate(text.splitlines(), 1):
            if len(line) > WIDTH and not line.startswith(("|", "#", "    ", "$$")) and not re.search(r"\]\(|https?:", line):
                yield f"{name}:{number}: {len(line)} characters, at most {WIDTH}"


# What a reader takes in at once: words of the README, lines of the changelog. What can be kept true: words of all pages.
MOST_WORDS, MOST_CHANGES, MOST_WORDS_OF_PAGES = 600, 40, 24_000
NOT_COUNTED = ("docs/references.md", *WRITTEN_BY_COMMANDS)


def words_of_pages(source):
    """Words of docs/*.md; a word has a letter or a digit, bars of tables and signs of formulas are none."""
    pages = [page for page in source.glob("docs/*.md") if not page.relative_to(source).as_posix().startswith(NOT_COUNTED)]
    return sum(bool(re.search(r"\w", word)) for page in pages for word in page.read_text().split())


def too_long(source):
    words, lines = len((source / "README.md").read_text().split()), len((source / "CHANGELOG.md").read_text().splitlines())
    pages = words_of_pages(source)
    if pages > MOST_WORDS_OF_PAGES:
        yield f"docs/*.md: {pages} words, at most {MOST_WORDS_OF_PAGES}: link instead of repeating, delete what a decision or a result holds"
    if words > MOST_WORDS:
        yield f"README.md: {words} words, at most {MOST_WORDS}: move what is special to a page of docs/"
    if lines > MOST_CHANGES:
        yield f"CHANGELOG.md: {lines} lines, at most {MOST_CHANGES}: one line for each change that a user sees"


def differences(source, version):
    consumer = (source / "tests/consumer/plan_and_print.cpp").read_text()
    if consumer not in (source / "docs/installing.md").read_text():
        yield "docs/installing.md: its program is not tests/consumer/plan_and_print.cpp"
    if f"<version>{version}</version>" not in (source / "package.xml").read_text():
        yield f"package.xml: its version is not {version}"
    if "joulepath" not in (source / "THIRD_PARTY_NOTICES.md").read_text():
        yield "THIRD_PARTY_NOTICES.md is empty"


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    problems = [*broken_links(source), *missing_paths(source), *missing_documents(source), *decisions(source),
                *histories(source), *long_lines(source), *too_long(source), *differences(source, sys.argv[2])]
    print("\n".join(problems) or "documents: links, paths, program and versions agree")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
