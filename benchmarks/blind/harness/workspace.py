"""Where things are: the tree, the programs, the sealed folder outside the tree; git questions."""
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
RESULTS = ROOT / "benchmarks" / "results"
sys.path.insert(0, str(ROOT / "benchmarks" / "spoilt"))  # the module spoils
UNFROZEN = ["benchmarks/results"]  # what may change after the freeze: results and manifests alone


IN_PYTHON = {"blind_field": ROOT / "benchmarks" / "blind" / "field" / "blind_field"}  # not built


def program(name):
    if name in IN_PYTHON:
        return str(IN_PYTHON[name])
    path = pathlib.Path(os.environ.get("JOULEPATH_BIN", ROOT / "build" / "release" / "bin")) / name
    if not path.exists():
        sys.exit(f"{path} is missing: {'apt install libmujoco-dev, configure and build again' if name == 'blind_mujoco' else 'run ./dev build first'}")
    return str(path)


def git(*arguments):
    return subprocess.run(["git", "-C", str(ROOT), *arguments], check=True, capture_output=True, text=True).stdout.strip()


def head():
    return git("rev-parse", "HEAD")


def dirty(against="HEAD"):
    """Files of the tree that differ from a commit, results aside, untracked ones included."""
    exclude = [f":!{path}" for path in UNFROZEN]
    changed = git("diff", "--name-only", against, "--", ".", *exclude).splitlines()
    return changed + git("ls-files", "--others", "--exclude-standard", "--", ".", *exclude).splitlines()


def sealed_folder(frozen, name):
    state = os.environ.get("XDG_STATE_HOME") or os.path.join(os.path.expanduser("~"), ".local", "state")
    folder = pathlib.Path(os.environ.get("JOULEPATH_SEALED_DIR", os.path.join(state, "joulepath", "blind")))
    return folder / f"{name}-{frozen[:12]}"


def manifest_path(frozen, name):
    return RESULTS / f"blind_manifest_{name}_{frozen[:12]}.json"


def effect_names(generator="blind_plant"):
    lines = subprocess.run([program(generator), "--list"], check=True, capture_output=True, text=True).stdout.split("\n")
    pairs = [line.split() for line in lines if line]
    return [n for k, n in pairs if k == "catalog"], [n for k, n in pairs if k == "foreign"]
