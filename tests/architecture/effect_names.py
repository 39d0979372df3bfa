#!/usr/bin/env python3
"""The diagnosis knows effects by their properties: no file of diagnosis/ names an effect of the catalog."""
import pathlib
import re
import sys

# A name that a unit follows is a constant of the robot file: viscous_friction_Nm_s_rad.
UNIT = r"(?!(_left|_right)?_([A-Z]|m\b))"
# Friction and inertia are what a calibration measures; there, only code is held to the rule.
PROSE_ALLOWED = "diagnosis/calibration/"


def catalog_names(root):
    names = []
    for file in sorted((root / "model/effects").glob("*.hpp")):
        names += re.findall(r'EffectInfo info\{\s*\.name = "(\w+)"', file.read_text())
    return names


def spellings(name, path):
    words = name.split("_")
    yield name + UNIT
    yield "".join(word.capitalize() for word in words) + r"\b"
    if not path.startswith(PROSE_ALLOWED):
        yield r"(?i:\b" + "[ -]".join(words) + r"s?\b)"


def main(root):
    names = catalog_names(root)
    complaints = [] if len(names) >= 29 else [f"only {len(names)} effects found in model/effects"]
    for file in sorted([*(root / "diagnosis").rglob("*"), *(root / "extensions/onboard/monitor").glob("*")]):
        if not file.is_file():
            continue
        path = file.relative_to(root).as_posix()
        complaints += [f"{path}: the file's name names {name}" for name in names if name in path]
        for number, line in enumerate(file.read_text().splitlines(), 1):
            for name in names:
                if any(re.search(spelling, line) for spelling in spellings(name, path)):
                    complaints.append(f"{path}:{number}: names {name}: {line.strip()}")
    print("\n".join(complaints) or f"diagnosis/ names none of {len(names)} effects")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")))
