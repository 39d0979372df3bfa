"""Datasets of a given size for the speed and memory of `joulepath diagnose`: what they hold matters less than how much."""
import json
import pathlib
import subprocess

import workspace

PAYLOADS_KG = (0, 2.55, 5.7, 8.25, 10.5)
RATE_Hz = 50  # of the blind plant's logs


def legs(seed, seconds):
    """A run that lasts about so long: lanes both ways, arcs, spins and stops, varied by `seed`."""
    payload = PAYLOADS_KG[seed % len(PAYLOADS_KG)]
    speed = 0.3 + 0.05 * (seed % 7)
    left, turned = "" if seed % 2 else "-", "" if seed % 3 else "-"
    lane = f"profile:trapezoid,speed_m_s:{speed:.2f},acceleration_m_s2:0.25,distance_m:3"
    parts = [lane, "profile:stand,duration_s:1", lane + ",direction:reverse",
             f"profile:arc,radius_m:{0.8 + 0.2 * (seed % 3):.1f},angle_rad:{left}3,speed_m_s:{speed:.2f}",
             f"profile:spin,angle_rad:{turned}4,yaw_rate_rad_s:0.8"]
    one_round_s = 6 / speed + 12
    whole = parts * (int(seconds / one_round_s) + 2)
    return "+".join([whole[0] + f",payload_kg:{payload}"] + whole[1:])


def cut(log, rows):
    """Keeps the log's first rows; how many there are then."""
    lines = log.read_text().splitlines()
    log.write_text("\n".join(lines[: rows + 1]) + "\n")
    return min(rows, len(lines) - 1)


def many_runs(folder, runs, rows):
    """A dataset of `runs` logs of `rows` samples (the plant's own first run may be shorter): (file, samples)."""
    motions = ";".join(legs(seed, rows / RATE_Hz) for seed in range(runs - 1))
    subprocess.run([workspace.program("blind_plant"), "--effect", "rolling_resistance", "--size", "0.012", "--protocol", "1",
                    "--seed", "7", "--out", str(folder), "--label", "none", "--append", motions], check=True)
    return folder / "dataset.yaml", sum(cut(log, rows) for log in sorted(folder.glob("*.csv")))


def one_long_log(folder, seconds, rate_Hz):
    """One log of a robot that goes up and down a lane for so long: (file, samples)."""
    lane_s = 2 * (4 / 0.5 + 2)
    lane = {"profile": "trapezoid", "speed_m_s": 0.5, "acceleration_m_s2": 0.25, "distance_m": 4}
    pair = [{"motion": lane, "payload_kg": 0}, {"motion": {**lane, "direction": "reverse"}, "payload_kg": 0}]
    mission = {"schema": "joulepath/mission/1", "robot": str(workspace.ROOT / "scenarios/robots/nomad_super_scout.yaml"),
               "start": {"x_m": 0, "y_m": 0, "heading_rad": 0}, "legs": pair * int(seconds / lane_s + 1)}
    source = pathlib.Path(folder, "mission.yaml")
    source.write_text(json.dumps(mission))
    subprocess.run([workspace.program("joulepath"), "simulate", str(source), "--out", str(folder / "log"), "--effect",
                    "rolling_resistance:coefficient=0.012", "--sample-rate-Hz", str(rate_Hz), "--quiet"], check=True)
    logs = sorted((folder / "log").glob("run_*.csv"))
    return folder / "log" / "dataset.yaml", sum(cut(log, int(seconds * rate_Hz)) for log in logs)
