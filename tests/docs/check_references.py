#!/usr/bin/env python3
"""Published methods: each key that a file cites stands in docs/references.md, and each key there is cited by the
files that its entry names.

usage: check_references.py SOURCE_DIR
"""
import pathlib
import re
import sys

ROOMS = ["model", "planner", "diagnosis", "scenarios", "app", "extensions", "python", "benchmarks", "tests",
         "docs"]
REFERENCES = "docs/references.md"
CITING = {".hpp", ".cpp", ".py", ".js", ".md"}
KEY = r"P1|[A-Z]\w*(?:19|20)\d\d[a-z]?"
ENTRY = re.compile(rf"^- \*\*\[({KEY})\]\*\*(.*?)(?=^- |^#|\Z)", re.MULTILINE | re.DOTALL)
CITED = re.compile(rf"\[({KEY})(?=[],])")
FILE = re.compile(r"`([\w/.]+\.(?:hpp|cpp|py|js))`")


def citations(source):
    """(file, keys) of all code and pages that cite one."""
    for room in ROOMS:
        for file in sorted((source / room).rglob("*")):
            if file.suffix not in CITING or file in (pathlib.Path(__file__).resolve(), source / REFERENCES):
                continue
            keys = set(CITED.findall(file.read_text(errors="replace")))
            if keys:
                yield file.relative_to(source).as_posix(), keys


def complaints(entries, cited):
    keys = [key for key, _ in entries]
    yield from (f"docs/references.md: [{key}] stands twice" for key in sorted({k for k in keys if keys.count(k) > 1}))
    for key, text in entries:
        files = FILE.findall(text)
        if not files:
            yield f"docs/references.md: [{key}] names no file that uses it"
        for file in files:
            if key not in cited.get(file, ()):
                yield f"docs/references.md: [{key}] names {file}, which does not cite it"
    for file, found in cited.items():
        yield from (f"{file}: [{key}] is not in docs/references.md" for key in sorted(found - set(keys)))


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    entries = ENTRY.findall((source / REFERENCES).read_text())
    cited = dict(citations(source))
    problems = [*complaints(entries, cited), *([] if entries else ["docs/references.md: no entries"])]
    print("\n".join(problems) or f"references: {len(entries)} keys, cited by {len(cited)} files")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
