"""What the tests of faults share: the program in a scratch folder with a robot and a list of missions.

The command line of each of them begins with PROGRAM SOURCE_DIR."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCE = (os.path.abspath(path) for path in sys.argv[1:3])
ROBOT = os.path.join(SOURCE, "tests/data/broken/good/robot.yaml")
MISSIONS = 14
DONE, BAD_INPUT, ENVIRONMENT, INTERRUPTED = 0, 2, 4, 130


def content(*path):
    with open(os.path.join(*path), "rb") as file:
        return file.read()


def tree(folder, without=("timings.jsonl", "timing.json")):
    """Every file below a folder with its bytes; the files that hold times are left out."""
    return {os.path.relpath(os.path.join(at, name), folder): content(at, name)
            for at, _, names in os.walk(folder) for name in names if name not in without}


class WithScratch(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.mkdtemp(prefix="joulepath_faults_")
        os.chmod(self.scratch, 0o777)
        os.environ["XDG_CACHE_HOME"] = self.scratch + "/cache"
        os.environ["SOURCE_DATE_EPOCH"] = "86400"  # reports name the day, also where midnight falls between two of them
        self.addCleanup(shutil.rmtree, self.scratch, ignore_errors=True)
        shutil.copy(ROBOT, self.at("robot.yaml"))
        with open(self.at("m.jsonl"), "w") as file:
            for k in range(MISSIONS):
                curve = [[0, 0], [1, 0], [1 + 0.05 * k, 1], [2 + 0.1 * k, 1]]
                file.write(json.dumps({"name": "m%d" % k, "robot": "robot.yaml",
                                       "legs": [{"path": {"bezier_m": [curve]}}]}) + "\n")

    def at(self, *path):
        return os.path.join(self.scratch, *path)

    def start(self, *arguments, **options):
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "cwd": self.scratch, **options}
        return subprocess.Popen([PROGRAM, *arguments], **options)

    def run_program(self, *arguments, **options):
        process = self.start(*arguments, **options)
        out, err = process.communicate(timeout=300)
        return process.returncode, (out or b"").decode(), (err or b"").decode()
