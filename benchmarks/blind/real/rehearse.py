"""Real logs whose cause is known from their folder's name: calibrate on the normal condition, diagnose the others.

Writes benchmarks/results/blind_real.md. The logs are found by JOULEPATH_DATA_DIR (the folder that holds
kobuki_wheelslip/ and husky_borealtc/); sources, commits and licenses stand in ../README.md.

Design: docs/decisions/0802-blind-benchmark.md
"""
import os
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
import answers  # noqa: E402
import husky  # noqa: E402
import kobuki  # noqa: E402
import workspace  # noqa: E402

PAPER_SETS = [("tables_4_and_6", "open: over without payload, error rising with acceleration, under at 10.5 kg on the curve"),
              ("tables_4_and_6_sure", "the same without the doubtful rows")]

CANNOT_SHOW = {
    "kobuki": """What these logs cannot show: a wheel that slips leaves no mark in its own encoder, and there is no pose; a fault shows only where it changes the current.
The scale of the current is open: the inertia that fits belongs to about 2 kg (the robot weighs about 6), the resistance is several times that of such a motor; both would be mended by currents some three times larger. Names and places rest on changes against the normal recording, which no scale touches; joules do not.""",
    "husky": """What these logs cannot show: in an arc the inner side of a skid steer may brake, and a current without sign reads that as driving: arcs are left out. Straight driving is taken as straight only where both sides agree to 5 mm/s: below that it scrubs in full. Slopes outdoors and rolling look alike where nobody logged the pose; rolling and Coulomb friction look alike at one payload.""",
    "paper": """What these rows cannot show: no log, one robot, two kinds of motion, and a protocol (braking, entry speed) that is assumed."""}


def paper(scratch):
    lines = ["Energy only: 40 wheel energies of 20 rows; the motions' braking is assumed (see `scenarios/paper`).", "", answers.TITLE]
    for name, cause in PAPER_SETS:
        answer = answers.diagnose(workspace.ROOT / "scenarios" / "paper" / f"{name}.yaml", scratch / name)
        lines.append(answers.row(name, cause, answer))
    return lines


def main():
    data = pathlib.Path(os.environ.get("JOULEPATH_DATA_DIR", workspace.ROOT.parent / "shared" / "data" / "real"))
    lines = ["# Real logs", "",
             f"Command `benchmarks/blind/real/run`; commit `{workspace.head()}`. The cause is what the folder's name says; the calibration sees the normal condition alone. "
             "Shares of the gap by wheel and phase with their 95 % intervals over runs.", ""]
    with tempfile.TemporaryDirectory(prefix="blind_real_") as folder:
        scratch = pathlib.Path(folder)
        for title, key, base in (("Kobuki (two wheels)", "kobuki", kobuki), ("Husky A200 (skid steer)", "husky", husky)):
            lines += [f"## {title}", ""]
            found = (data / base.FOLDER).exists()
            lines += base.section(data, scratch) + ["", CANNOT_SHOW[key], ""] if found else [f"No logs in {data}: set JOULEPATH_DATA_DIR.", ""]
        lines += ["## Tables 4 and 6 of the source paper", ""] + paper(scratch) + ["", CANNOT_SHOW["paper"]]
    out = workspace.RESULTS / "blind_real.md"
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text("\n".join(lines) + "\n")
    print(out.read_text())
    return 0


if __name__ == "__main__":
    sys.exit(main())
