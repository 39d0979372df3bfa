#!/usr/bin/env python3
"""Documents that stay true: links lead somewhere, the README's program is the one that is compiled, versions agree.

usage: check_documents.py SOURCE_DIR VERSION
"""
import pathlib
import re
import sys

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def slug(heading):
    kept = re.sub(r"[^\w\- ]", "", heading.strip().lower().replace("`", ""))
    return kept.replace(" ", "-")


def broken_links(source):
    documents = [*source.glob("*.md"), *source.glob("docs/*.md"), *source.glob("docs/decisions/*.md")]
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
    for document in [source / "README.md", source / "CONTRIBUTING.md", *source.glob("docs/*.md")]:
        for path in re.findall(rf"`((?:{tops})/[\w./-]+)`", document.read_text()):
            if not (source / path).exists():
                yield f"{document.relative_to(source)}: {path} does not exist"


def differences(source, version):
    consumer = (source / "tests/consumer/plan_and_print.cpp").read_text()
    if consumer not in (source / "README.md").read_text():
        yield "README.md: its program is not tests/consumer/plan_and_print.cpp"
    if f"<version>{version}</version>" not in (source / "package.xml").read_text():
        yield f"package.xml: its version is not {version}"
    if "joulepath" not in (source / "THIRD_PARTY_NOTICES.md").read_text():
        yield "THIRD_PARTY_NOTICES.md is empty"


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    problems = [*broken_links(source), *missing_paths(source), *differences(source, sys.argv[2])]
    print("\n".join(problems) or "documents: links, paths, program and versions agree")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
