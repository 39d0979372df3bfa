#!/usr/bin/env python3
"""Writes the man page joulepath.1 from the program's own help, so that it cannot go stale.

usage: write_manual.py PROGRAM OUT.1
"""
import re
import subprocess
import sys

HEAD = r""".TH JOULEPATH 1 "" "{version}" "User Commands"
.SH NAME
joulepath \- energy-optimal trajectories and sim-to-real diagnosis for differential-drive robots
.SH SYNOPSIS
.B joulepath
.I COMMAND
[\fIOPTIONS\fR]
.SH DESCRIPTION
Plans missions so that they take the least energy under every limit of a robot, and diagnoses the gap between
its model and what was measured. Files are YAML, JSON and CSV; every key carries its SI unit.
.SH COMMANDS
"""
TAIL = r""".SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
Infeasible or failed (the result file says why), or a gap found where that was asked for.
.TP
.B 2
Bad input or usage, or the output exists already.
.TP
.B 3
Internal error.
.TP
.B 4
Environment: disk, permission, memory.
.TP
.B 130
Interrupted.
.SH OUTPUT
Results go to standard output, talk to standard error. Results are written under a temporary name and renamed:
an interrupted run leaves no half file.
.SH ENVIRONMENT
.TP
.B NO_COLOR
No colors when set.
.SH FILES
.I share/joulepath/scenarios
below the prefix of the installation holds robots, maps and missions to start from.
"""


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join("\\&" + line if line.startswith((".", "'")) else line for line in text.splitlines())


def main():
    program, out = sys.argv[1:]

    def said(*arguments):
        return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout

    commands = re.findall(r"^  ([a-z_]+) {2,}(.*(?:\n {20,}.*)*)$", said("--help").split("Subcommands:")[1], re.MULTILINE)
    with open(out, "w", encoding="utf-8") as page:
        page.write(HEAD.format(version=said("--version").split(" (")[0].strip()))
        for name, says in commands:
            details = said(name, "--help").strip()
            page.write(f".SS {name}\n{escaped(' '.join(says.split()))}\n.PP\n.nf\n{escaped(details)}\n.fi\n")
        page.write(TAIL)


if __name__ == "__main__":
    main()
