"""Section on design studies: does the ranking of ten designs by `joulepath sweep` survive execution in MuJoCo?"""

import copy
import csv
import itertools
import tempfile
from pathlib import Path as File

import numpy as np

import plans
from common import package, table

ROBOT, MISSION = "nomad_super_scout", "warehouse_pick"
STUDY = "gear_and_speed"
GEARS, SPEEDS_M_S = 5, 2  # levels of the study's two ranges
HEADROOM, SHARE = 0.98, 0.95  # of the voltage: below the first a plan leaves the controller some; for a second plan


def designs(size):
    """Gear ratios and top speeds: evenly spaced levels between the ends of the committed study's parameters."""
    parameters = package("yaml").safe_load((plans.SCENARIOS / f"studies/{STUDY}.yaml").read_text())["parameters"]
    gear, speeds = parameters["gear_ratio"], parameters["top_speed_m_s"]["values"]
    gears = np.linspace(gear["from"], gear["to"], size(GEARS, 2))
    return list(itertools.product(map(float, gears), np.linspace(speeds[0], speeds[-1], SPEEDS_M_S).tolist()))


def swept(chosen, scratch):
    """Predicted joules of each design: one study with the levels of both parameters."""
    yaml = package("yaml")
    study = {
        "schema": "joulepath/study/1",
        "missions": str(plans.SCENARIOS / f"missions/{MISSION}.yaml"),
        "parameters": {
            "gear_ratio": {"key": "robot.motor.gear_ratio", "values": sorted({gear for gear, _ in chosen})},
            "top_speed_m_s": {"key": "robot.limits.speed_m_s", "values": sorted({speed for _, speed in chosen})},
        },
        "objectives": {"energy_J": "minimize"},
        "hold_friction": "wheel",
    }
    (scratch / "study.yaml").write_text(yaml.safe_dump(study))
    plans.program("sweep", scratch / "study.yaml", "--out", scratch / "sweep")
    rows = csv.DictReader((scratch / "sweep/sweep.csv").open())
    return {(float(row["gear_ratio"]), float(row["top_speed_m_s"])): float(row["energy_J"]) for row in rows}


def executed(design, file, robot, scratch, planned_share=1.0):
    """Joules of the design's plan, made for a share of the motors' voltage, and of that plan as driven."""
    gear, speed_m_s = design
    file, robot = copy.deepcopy(file), copy.deepcopy(robot)
    file["motor"]["gear_ratio"] = gear
    file["limits"]["speed_m_s"] = speed_m_s
    real_V = file["motor"]["max_voltage_V"]
    file["motor"]["max_voltage_V"] = planned_share * real_V
    robot["motor"]["gear_ratio"] = [gear, gear]
    robot_at, folder = scratch / "robot.yaml", scratch / "plan"
    robot_at.write_text(package("yaml").safe_dump(file))
    mission = plans.SCENARIOS / f"missions/{MISSION}.yaml"
    plans.program("plan", mission, "--robot", robot_at, "--out", folder, "--without", "baselines", "--solver", "fast")
    file["motor"]["max_voltage_V"] = real_V
    return {**plans.drive(folder, robot, file), "voltage_use": plans.voltage_use(folder, file)}


def ranks(values):
    return np.argsort(np.argsort(values))


def rank_correlation(one, other):
    return float(np.corrcoef(ranks(one), ranks(other))[0, 1])


def run(size):
    package("mujoco")
    chosen, file, robot = designs(size), plans.robot_file(ROBOT), plans.robot_values(ROBOT)
    with tempfile.TemporaryDirectory() as scratch:
        predicted = swept(chosen, File(scratch))
        drives = [executed(design, file, robot, File(scratch)) for design in chosen]
        tight = [(design, drive) for design, drive in zip(chosen, drives) if drive["voltage_use"] >= HEADROOM]
        eased = [executed(design, file, robot, File(scratch), SHARE) for design, _ in tight]
    swept_J = np.array([predicted[design] for design in chosen])
    planned_J, driven_J, voltage = (np.array([d[key] for d in drives]) for key in ("planned_J", "energy_J", "voltage_use"))
    rows = [
        [f"{chosen[i][0]:g}", f"{chosen[i][1]:g}", f"{100 * voltage[i]:.0f}", f"{swept_J[i]:.1f}", ranks(swept_J)[i] + 1,
         f"{driven_J[i]:.1f}", ranks(driven_J)[i] + 1, f"{100 * (swept_J[i] / driven_J[i] - 1):+.2f}"]
        for i in np.argsort(swept_J)
    ]  # fmt: skip
    study = f"[{STUDY}.yaml](../../scenarios/studies/{STUDY}.yaml)"
    text = (
        f"{len(chosen)} designs between the ends of {study}, mission {MISSION} (it turns in place and carries up to 10.5 kg): "
        "predicted by `joulepath sweep`, then each design's own plan driven leg by leg with a pose controller. "
        "Joules include standby; friction at the wheel is held. A plan's joules differ from its design's in the sweep by at most "
        f"{100 * abs(planned_J / swept_J - 1).max():.1g} %.\n\n"
    )
    header = ["gear ratio", "top speed, m/s", "planned voltage, % of the limit", "predicted, J", "rank", "driven, J", "rank"]
    short = f"**Ranking of {len(chosen)} designs** by the sweep against MuJoCo: rank correlation {rank_correlation(swept_J, driven_J):.2f}."
    text += table([*header, "predicted over driven, %"], rows) + verdict(swept_J, driven_J, voltage)
    for (design, drive), easy in zip(tight, eased):
        text += (
            f"\nGear ratio {design[0]:g} at {design[1]:g} m/s, planned with all of the voltage: {drive['planned_J']:.1f} J, driven "
            f"{drive['energy_J']:.1f} J, {drive['late_s']:.2f} s late on its worst leg. Planned with {100 * SHARE:.0f} %: "
            f"{easy['planned_J']:.1f} J, driven {easy['energy_J']:.1f} J, {easy['late_s']:.2f} s late.\n"
        )
    return {"text": text, "summary": {}, "short": short}


def verdict(swept_J, driven_J, voltage):
    pairs = list(itertools.combinations(range(len(swept_J)), 2))
    swapped = [(i, j) for i, j in pairs if (swept_J[i] - swept_J[j]) * (driven_J[i] - driven_J[j]) < 0]
    most = max((100 * abs(swept_J[i] / swept_J[j] - 1) for i, j in swapped), default=0)
    within = voltage < HEADROOM
    text = (
        f"\n**Rank correlation (Spearman): {rank_correlation(swept_J, driven_J):.3f}.** Pairs in the other order as driven: "
        f"{len(swapped)} of {len(pairs)}, whose predictions differ by at most {most:.2g} %. The best design by prediction is "
        f"{'' if swept_J.argmin() == driven_J.argmin() else 'not '}the best as driven; all predictions span "
        f"{100 * (swept_J.max() / swept_J.min() - 1):.2g} %."
    )
    if within.all() or within.sum() < 3:
        return text + "\n"
    return text + (
        f" Without the {(~within).sum()} whose plan uses more than {100 * HEADROOM:.0f} % of the voltage: "
        f"{rank_correlation(swept_J[within], driven_J[within]):.3f}. A plan that cruises at that limit leaves the controller nothing to "
        "catch up with: it arrives late and pays standby.\n"
    )
