"""Docstrings, stubs and notebooks hold what they say."""
import doctest
import importlib
import inspect
import os
import pathlib
import pkgutil
import re
import subprocess
import sys

import numpy as np
import pytest

import joulepath

PACKAGE = pathlib.Path(joulepath.__file__).parent
CONFIGURATION = pathlib.Path(__file__).resolve().parents[1] / "pyproject.toml"
PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/python.md"
NOTEBOOKS = sorted((pathlib.Path(__file__).resolve().parents[1] / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("name", [m.name for m in pkgutil.iter_modules([str(PACKAGE)])])
def test_doctests(name):
    module = importlib.import_module(f"joulepath.{name}")
    assert doctest.testmod(module).failed == 0


def test_doctest_of_the_package():
    assert doctest.testmod(joulepath).attempted > 0
    assert doctest.testmod(joulepath).failed == 0


def public_members():
    """Names with what they name: functions, classes, and what each class adds."""
    for name in joulepath.__all__:
        thing = getattr(joulepath, name)
        if not name.startswith("_"):
            yield name, thing
        if isinstance(thing, type):
            yield from ((f"{name}.{key}", getattr(thing, key)) for key in vars(thing)
                        if not key.startswith("_") and key not in getattr(thing, "__dataclass_fields__", ()))


def test_everything_public_has_a_docstring():
    for name, thing in public_members():
        if type(thing).__name__ != "member_descriptor":
            assert (thing.__doc__ or "").strip(), name


def test_functions_tell_every_argument_and_what_they_raise():
    for name, thing in public_members():
        if not callable(thing) or isinstance(thing, type) and issubclass(thing, (Exception, joulepath.Record)):
            continue
        told = (thing.__doc__ or "") + (getattr(thing.__init__, "__doc__", None) or "" if isinstance(thing, type) else "")
        try:
            arguments = inspect.signature(thing).parameters.values()
        except (TypeError, ValueError):
            continue  # of the compiled module
        options = [a.name for a in arguments if a.kind is a.KEYWORD_ONLY]
        assert all(option in told for option in options), (name, [o for o in options if o not in told])
        assert not options or name == "map" or "ConfigError" in told, name


def test_the_examples_of_the_page_run(robot, scenarios, tmp_path, monkeypatch):
    """Every block of Python in docs/python.md, one after the other, with what they take as given."""
    pytest.importorskip("pandas")
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    robot.save("robot.yaml")
    (tmp_path / "mission.yaml").write_text("robot: robot.yaml\nlegs:\n  - {path: {bezier_m: [[[0, 0], [2.7, 0], [2.7, 0], [2.7, 2.7]]]}, payload_kg: 5}\n")
    xy = [[0, 0], [2, 0], [4, 1], [6, 1]]
    logs = [joulepath.simulate(joulepath.profile(robot, xy, time_s=t), seed=k) for k, t in enumerate((10.0, 12.0, 15.0))]
    logs[2].save("run.csv")
    (tmp_path / "dataset.yaml").write_text("robot: robot.yaml\nruns: [{file: run.csv}]\n")
    t = np.linspace(0, 5, 200)
    names = {"xy": xy, "t": t, "v": 0.4 * np.sin(np.pi * t / 5) ** 2, "w": 0 * t, "frame_1": logs[0].to_frame(), "frame_2": logs[1].to_frame(),
             "s": 0.5, "rate": 0.3, "x": 0.5, "y": 0.0, "heading": 0.0,
             "jobs": [{"robot": robot, "xy": xy, "solver": "fast"}, (robot, [[0, 0]])]}
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) >= 3
    for block in blocks:
        exec(block.replace("run.mcap", "run.csv"), names)
        if "jp.energy" in block:  # from here on they are those of an instant
            names.update(t=0.5, v=0.3, w=0.0)


def test_types_are_complete(tmp_path):
    assert (PACKAGE / "py.typed").exists() and (PACKAGE / "_core.pyi").exists()
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-m", "mypy", "--config-file", CONFIGURATION, "--cache-dir=/dev/null", "-p", "joulepath"],
                          capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_there_are_three_notebooks():
    assert len(NOTEBOOKS) == 3


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_run_and_keep_no_output(notebook, tmp_path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    book = nbformat.read(notebook, as_version=4)
    code = [cell for cell in book.cells if cell.cell_type == "code"]
    assert code and not any(cell.outputs or cell.execution_count for cell in code)
    nbclient.NotebookClient(book, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    if pages := os.environ.get("JOULEPATH_NOTEBOOKS"):  # for the site
        write_page(book, notebook.stem, pathlib.Path(pages))


def write_page(book, name, pages):
    """The notebook with its outputs as Markdown, pictures beside it."""
    nbconvert, traitlets = pytest.importorskip("nbconvert"), pytest.importorskip("traitlets.config")
    shown = traitlets.Config({"NbConvertBase": {"display_data_priority": ["image/png", "text/plain"]}})
    text, resources = nbconvert.MarkdownExporter(config=shown).from_notebook_node(
        book, {"unique_key": name, "output_files_dir": f"{name}_files"})
    for file, content in {f"{name}.md": text.encode(), **resources["outputs"]}.items():
        (pages / file).parent.mkdir(parents=True, exist_ok=True)
        (pages / file).write_bytes(content)
