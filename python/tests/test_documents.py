"""Docstrings, stubs and notebooks hold what they say."""
import doctest
import importlib
import pathlib
import pkgutil
import subprocess
import sys

import pytest

import joulepath

PACKAGE = pathlib.Path(joulepath.__file__).parent
CONFIGURATION = pathlib.Path(__file__).resolve().parents[1] / "pyproject.toml"
NOTEBOOKS = sorted((pathlib.Path(__file__).resolve().parents[1] / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("name", [m.name for m in pkgutil.iter_modules([str(PACKAGE)])])
def test_doctests(name):
    module = importlib.import_module(f"joulepath.{name}")
    assert doctest.testmod(module).failed == 0


def test_doctest_of_the_package():
    assert doctest.testmod(joulepath).attempted > 0
    assert doctest.testmod(joulepath).failed == 0


def test_everything_public_has_a_docstring():
    for name in joulepath.__all__:
        if not name.startswith("_"):
            assert getattr(joulepath, name).__doc__, name


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
