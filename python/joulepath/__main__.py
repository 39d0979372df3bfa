"""The program: ``python -m joulepath plan mission.yaml``, or ``joulepath plan mission.yaml``."""

import sys

from . import _core


def main() -> int:
    """Runs the command line of this process."""
    return _core.program_main(["joulepath", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
