"""benchmarks/blind/run: the blind benchmark from sealing to the report. See benchmarks/blind/README.md.

Design: docs/decisions/0802-blind-benchmark.md
"""
import argparse
import json
import os
import pathlib
import shutil
import sys
import tempfile

import again
import campaign
import report
import seal
import workspace


def sealed_commit(name):
    """The frozen commit of the newest campaign of that name that fits the tree as it is."""
    found = []
    for path in workspace.RESULTS.glob(f"blind_manifest_{name}_*.json"):
        frozen = json.loads(path.read_text())["frozen_commit"]
        if not workspace.dirty(frozen):
            found.append((path.stat().st_mtime, frozen))
    return max(found)[1] if found else None


def is_committed(path):
    relative = str(path.relative_to(workspace.ROOT))
    return bool(workspace.git("ls-files", relative)) and not workspace.git("status", "--porcelain", "--", relative)


def short(jobs):
    """60 cases in a scratch folder: shows that everything runs. Fails if a diagnosis fails; says nothing of quality."""
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="blind_short_"))
    os.environ["JOULEPATH_SEALED_DIR"] = str(scratch)
    results, workspace.RESULTS = workspace.RESULTS, scratch
    workspace.dirty = lambda against="HEAD": []
    try:
        frozen = workspace.head()
        seal.seal("short", 60, jobs)
        left = campaign.diagnose_all(frozen, "short", 3600, jobs)
        output = results.parents[1] / "build" / "blind_short"
        missing, failed = report.score(frozen, "short", output, False, "blind", True)
        return 1 if left or missing or failed else 0
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(prog="benchmarks/blind/run")
    parser.add_argument("stage", nargs="?", default="all", choices=["all", "seal", "diagnose", "score", "again"])
    parser.add_argument("--short", action="store_true", help="60 cases, mechanics only, nothing is sealed")
    parser.add_argument("--name", default="full", choices=["full", "mujoco", "field"],
                        help="mujoco: cases that MuJoCo drives; field: those of the field generator")
    parser.add_argument("--cases", type=int, default=0, help="seal, or ask again, the first N cases only (any prefix keeps the bins' proportions)")
    parser.add_argument("--minutes", type=float, default=55, help="stop diagnosing after this long; call again to go on")
    parser.add_argument("--partial", action="store_true", help="score although cases are not diagnosed yet")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    if arguments.name != "full" and (arguments.short or arguments.stage == "again"):
        parser.error("--short and again know the campaign full alone")
    if arguments.short:
        return short(arguments.jobs)
    if arguments.stage == "again":
        return again.again(arguments.cases, arguments.jobs)
    name, frozen = arguments.name, sealed_commit(arguments.name)
    if arguments.stage in ("all", "seal") and not frozen:
        frozen = seal.seal(name, arguments.cases, arguments.jobs)
        if arguments.stage == "all":
            print("no campaign was sealed at this commit: commit the manifest, then call this again", file=sys.stderr)
            return 0
    if not frozen:
        sys.exit("no campaign is sealed that fits this tree: benchmarks/blind/run seal")
    committed = is_committed(workspace.manifest_path(frozen, name))
    if not committed and arguments.stage != "seal":
        sys.exit("the manifest is not committed: commit it before diagnosing")
    if arguments.stage in ("all", "diagnose"):
        left = campaign.diagnose_all(frozen, name, 60 * arguments.minutes, arguments.jobs)
        print(f"{left} cases left", file=sys.stderr)
        if left and arguments.stage == "all":
            return 0
    if arguments.stage in ("all", "score"):
        report.score(frozen, name, workspace.RESULTS, True, "blind" if name == "full" else f"blind_{name}", arguments.partial)
    return 0


if __name__ == "__main__":
    sys.exit(main())
