#!/usr/bin/env python3
"""Writes the files of a document: every fenced block after a line "`FOLDER/FILE`:".

usage: extract_files.py DOCUMENT.md OUT_DIR     A file that would not change keeps its time.
"""
import pathlib
import re
import sys

FILE = re.compile(r"^`([\w./]+/[\w.]+)`:\n\n```\w*\n(.*?)^```", re.MULTILINE | re.DOTALL)


def main():
    document, out = map(pathlib.Path, sys.argv[1:])
    files = FILE.findall(document.read_text())
    if not files:
        sys.exit(f"{document}: no block with the name of a file above it")
    for name, text in files:
        path = out / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text() != text:
            path.write_text(text)


if __name__ == "__main__":
    main()
