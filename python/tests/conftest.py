"""Where things are: the repository's scenarios, and the program where it is built."""
import os
import pathlib
import shutil

import matplotlib
import pytest

import joulepath as jp

matplotlib.use("Agg")
os.environ["SOURCE_DATE_EPOCH"] = "86400"  # reports name the day, also where midnight falls between two of them
ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def scenarios():
    return ROOT / "scenarios"


@pytest.fixture(scope="session")
def robot(scenarios):
    return jp.Robot.load(scenarios / "robots" / "nomad_super_scout.yaml")


@pytest.fixture(scope="session")
def program():
    """The joulepath program: JOULEPATH_PROGRAM, or the release build's."""
    found = os.environ.get("JOULEPATH_PROGRAM") or ROOT / "build/release/bin/joulepath"
    if not shutil.which(found):
        pytest.skip("the joulepath program is not built")
    return found


@pytest.fixture(scope="session")
def curve(robot):
    return jp.profile(robot, [[0, 0], [2, 0], [4, 1], [6, 1]], payload_kg=5)
