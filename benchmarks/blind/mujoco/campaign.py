"""A small campaign on a second physics: cases drawn as blind_plant draws them, driven by MuJoCo, diagnosed without a
label, scored by the rules of ../harness/judge.py. Writes benchmarks/results/blind_mujoco.md. Seeds derive from the
commit; nothing is sealed, so this shows how much rests on the plant's own physics, and is no proof."""
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
import examine  # noqa: E402
import judge  # noqa: E402
import plan  # noqa: E402
import scorecard  # noqa: E402
import workspace  # noqa: E402

FORMS = {"rolling_resistance": "rolling friction of the wheels' contacts", "coulomb_friction": "friction loss of both hinges",
         "dragging_wheel": "friction loss of one hinge", "viscous_friction": "damping of the hinges", "payload_mass_error": "mass of the payload's body",
         "floor_slope": "tilted gravity", "wheel_radius_error": "size of the wheels", "track_width_error": "place of the wheels",
         "winding_resistance_error": "gain and bias of the motors", "current_sensor_offset": "reading"}
SIZES, NULLS = 3, 10  # cases per effect, and without any
ROBOTS = ("nomad", "warehouse", "small")


def cases(commit):
    wanted = [(effect, number) for effect in FORMS for number in range(SIZES)] + [("none", number) for number in range(NULLS)]
    return [{"id": f"case_{k + 1:02d}", "bin": "null" if effect == "none" else "single", "effect": effect,
             "robot": ROBOTS[(number + k // SIZES) % 3], "seed": plan.seed_of(commit, f"mujoco/{effect}/{number}")}
            for k, (effect, number) in enumerate(wanted)]


def command(program, case):
    return [workspace.program(program), "--effect", case["effect"], "--robot", case["robot"], "--seed", str(case["seed"])]


def diagnosed(case):
    """(label with the oracle's word, answer, error). The oracle is blind_plant's: the case is the same there."""
    with tempfile.TemporaryDirectory(prefix="mujoco_") as folder:
        scratch = pathlib.Path(folder)
        label_file, data = scratch / "label.json", scratch / case["id"]
        subprocess.run(command("blind_plant", case) + ["--label", str(label_file), "--oracle"], check=True)
        label = {**case, **json.loads(label_file.read_text())}
        label_file.unlink()
        subprocess.run(command("blind_mujoco", case) + ["--out", str(data), "--label", "none"], check=True)
        out = scratch / "out"
        code, errors, _ = examine.run_quietly([workspace.program("joulepath"), "diagnose", str(data / "dataset.yaml"), "--out", str(out)], scratch)
        answer = json.loads((out / "diagnosis.json").read_text()) if code in examine.ANSWERED else None
        return label, judge.Answer(answer), errors[-200:]


def case_row(label, answer):
    effect = label["effects"][0] if label["effects"] else None
    size = f"{next(iter(effect['parameters'].values())):.3g}" if effect else ""
    seen = "yes" if judge.material(label) else ("detectable, below 1 %" if judge.detectable(label) else "no") if effect else ""
    errors = [f"{100 * error:.1f} %" for name, error, _ in judge.parameter_errors(answer, label)]
    energy = f"{answer.energy('before_percent') or 0:.1f} → {answer.energy('after_percent') or 0:.1f}"
    return (f"| {label['id']} | {label['robot']} | {effect['effect'] if effect else 'none'} | {size} | {seen} | {answer.verdict} "
            f"| {', '.join(answer.names) or '–'} | {', '.join(errors) or '–'} | {energy} |")


def main():
    if not (pathlib.Path(workspace.program("blind_plant")).parent / "blind_mujoco").exists():
        sys.exit("blind_mujoco is not built: apt install libmujoco-dev, configure and build again")
    commit = workspace.head()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [(label, answer) for label, answer, _ in pool.map(diagnosed, cases(commit))]
    shown = [r for r in scorecard.rates(found) if r.total and "pairs" not in r.name]
    lines = ["# Diagnosis of robots that MuJoCo drives", "",
             f"Command `benchmarks/blind/mujoco/run`; commit `{commit}`; MuJoCo of the system. {len(found)} cases, {NULLS} of them with calibration error alone; 24 runs each, "
             "white noise; drawn and distorted as in the blind campaign, moved by MuJoCo: rigid bodies in space, contacts, joint friction, implicit integration.",
             "Forms of the effects: " + "; ".join(f"{name}: {form}" for name, form in FORMS.items()) + ".", "",
             "| measure | value | 95 % interval | cases | aim / fails | |", "|---|---|---|---|---|---|"] + [r.row() for r in shown] + [""]
    lines += ["| case | robot | effect | size | material | verdict | named | error of the size | energy gap, % |", "|---|---|---|---|---|---|---|---|---|"]
    lines += [case_row(label, answer) for label, answer in found]
    out = workspace.RESULTS / "blind_mujoco.md"
    out.write_text("\n".join(lines) + "\n")
    print(out.read_text())
    return 0


if __name__ == "__main__":
    sys.exit(main())
