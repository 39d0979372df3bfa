#!/usr/bin/env python3
"""Each threshold of the diagnosis says where it comes from, and no name of a constant has two values."""
import pathlib
import re
import sys

ORIGIN = re.compile(r"derived|physical scale|declared|calibrated by|chosen|same command", re.IGNORECASE)
CONSTANT = re.compile(r"^(?:inline )?constexpr [\w:<>, ]+ (k[A-Z]\w*)(?:\[\])?\s*[={]")


def undocumented(header):
    comment = ""
    for line in header.read_text().splitlines():
        match = CONSTANT.match(line)
        if match and not ORIGIN.search(comment):
            yield f"{header.name}: {match[1]} does not say where it comes from"
        comment = comment + line if line.startswith("///") else ""


def declared_twice(root):
    """A constant of the header, or of any other header, that a second file of diagnosis/ or of the monitor declares."""
    places = {}
    for file in sorted([*(root / "diagnosis").rglob("*.[ch]pp"), *(root / "extensions/onboard/monitor").glob("*.[ch]pp")]):
        for line in file.read_text().splitlines():
            if match := CONSTANT.match(line):
                places.setdefault(match[1], []).append(file)
    for name, files in places.items():
        if len(files) > 1 and any(file.suffix == ".hpp" for file in files):
            yield f"{name} is declared in " + ", ".join(str(file.relative_to(root)) for file in files)


def main(root):
    complaints = [*undocumented(root / "diagnosis/thresholds.hpp"), *declared_twice(root)]
    print("\n".join(complaints) or "thresholds: each has one value and an origin")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")))
