"""numpy, for the tests of the problem set: of this Python, of Debian's, or of the environment of the peers' benchmark."""
import os
import pathlib
import subprocess
import sys

PEERS = pathlib.Path(__file__).resolve().parents[2] / "build/peers/venv/bin/python"
DEBIAN = pathlib.Path("/usr/bin/python3")  # a python3 of pyenv or conda does not see Debian's packages

try:
    import numpy as np  # noqa: F401
except ImportError:
    for python in (DEBIAN, PEERS):
        if python.exists() and subprocess.run([python, "-c", "import numpy"], capture_output=True).returncode == 0:
            os.execv(python, [str(python), "-B", *sys.argv])
    print("numpy is missing (./dev setup python3-numpy): the problem set is not checked")
    sys.exit(77)  # CTest's code for a skipped test
