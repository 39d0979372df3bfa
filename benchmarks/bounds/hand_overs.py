"""Hand-overs of the fast solver from the CSV of bench_hand_overs -> results/hand_overs.md"""

import pathlib
import sys

GOALS = ["exactly", "at most", "free", "at a price", "least"]
ROOT = pathlib.Path(__file__).resolve().parents[2]


def main(file, note):
    problems, sums = [], [0] * 5
    for line in pathlib.Path(file).read_text().splitlines():
        kind, *cells = line.split(",", 8)
        if kind == "sum":
            sums = [a + int(b) for a, b in zip(sums, cells[1:6])]
        else:
            cells[5] = GOALS[int(cells[5].split()[1])]
            problems.append(cells)
    count, none, handed_over, unsolved, cpu_ms = sums
    text = [
        "# What the fast solver hands over\n",
        note + "\n",
        "Random problems of four robots (`benchmarks/problems/campaign.cpp`: 6 to 600 kg, straight lines, bends, corners, corners in which the inner wheel "
        "reverses; every goal of time; with and without jerk limit, standby, effects, ends at speed), planned with `--solver fast`. "
        "A program that the fast solver does not solve is handed over to Ipopt.\n",
        f"| problems | no fastest drive | planned | handed over | not planned | CPU time |\n|---|---|---|---|---|---|\n"
        f"| {count} | {none} | {count - none - unsolved} | {handed_over} | {unsolved} | {cpu_ms / 1000:.0f} s |\n",
    ]
    if problems:
        text.append("| problem | robot | path | effect | jerk limit | goal of time | why | outcome |\n|---|---|---|---|---|---|---|---|")
        text += ["| " + " | ".join([*cells[:7], ": ".join(cells[7:])]) + " |" for cells in problems]
    out = "\n".join(text) + "\n"
    (ROOT / "benchmarks/results/hand_overs.md").write_text(out)
    print(out)


main(*sys.argv[1:])
