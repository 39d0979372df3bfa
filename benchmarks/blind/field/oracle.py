"""What an observer could see who knows a case's causes, their sizes and the noise, but not the errors of the robot file.

The same day is driven with the causes, without them, and without them but with each constant of the file off by its sigma.
"""
import copy

import numpy as np

import logs
from machines import UNCERTAINTY, scale
from physics import RECORD_STEPS, STEP_s, Batch

ENOUGH = 25.0  # 2 ln(likelihood ratio) of a cause that counts as detectable
CELL_s = 2.0  # powers are compared by their means over cells of this length
NOTHING = {"likelihood_ratio": 0.0, "detectable": False, "battery_percent": 0.0, "effect_percent": 0.0, "effect_pose_rms": 0.0,
           "energy_gap_percent": 0.0, "each": {}, "each_change": {}, "where": {"phase": {}, "wheel": {}}}
PHASES = ("standstill", "spin", "turn", "accelerate", "brake", "cruise")


def off_by_sigma(machine):
    """The machine with one constant at a time off by its uncertainty."""
    for key, sigma in UNCERTAINTY.items():
        for side in ((0, 1) if key == "T" else (None,)):
            other = copy.deepcopy(machine)
            if side is None:
                scale(other, key, 1 + sigma)
            else:
                other[key][side] *= 1 + sigma
            yield other


def split(values, variants, runs):
    """(rows, ..., B) as a list of (rows, ..., runs) per variant."""
    return [values[..., k * runs: (k + 1) * runs] for k in range(variants)]


def odometry(columns, file, period, pose):
    """Poses that the wheels alone tell, by the robot file: (rows, 3, B)."""
    r, l = file["r"][0], file["l"]
    v, w = r * (columns[:, 1] + columns[:, 2]) / 2, r * (columns[:, 2] - columns[:, 1]) / (2 * l)
    heading = pose[2] + np.cumsum(w, axis=0) * period
    x = pose[0] + np.cumsum(v * np.cos(heading - w * period / 2), axis=0) * period
    y = pose[1] + np.cumsum(v * np.sin(heading - w * period / 2), axis=0) * period
    return np.stack([x, y, heading], axis=1)


def seen(batch, record, machines):
    """Channels as the observer compares them, per variant: drives, battery, gyro less the wheels', pose less odometry."""
    file, period = batch.file, batch.file["log_s"]
    every = []
    for k in range(len(machines)):
        part = copy.copy(batch)
        part.machines, part.variants = [machines[k]], 1
        mine = {key: split(value, len(machines), batch.count)[k] for key, value in record.items()}
        columns = logs.channels(part, mine, period)
        pose = np.array([run["pose"] for run in batch.runs], float).T
        way = odometry(columns, file, period, pose)
        columns[:, 9] -= file["r"][0] * (columns[:, 2] - columns[:, 1]) / (2 * file["l"])
        columns[:, 10:13] -= way
        every.append(columns[:, 3:])
    return every


def inside(batch, rows, period):
    """1 where a run is under way: (rows, 1, runs)."""
    lengths = np.array([len(run["command"][0]) * 0.004 for run in batch.runs])
    return (np.arange(1, rows + 1)[:, None, None] * period <= lengths).astype(float)


def likelihood(difference, slopes):
    """2 ln(likelihood ratio) that remains where the constants of the file may move, each with a prior of one sigma."""
    projected = np.linalg.solve(np.eye(len(slopes)) + slopes @ slopes.T, slopes @ difference)
    return float(difference @ difference - (slopes @ difference) @ projected)


def cells(energy):
    """Mean power of each cell: (cells, ...), W."""
    step = round(CELL_s / (RECORD_STEPS * STEP_s))
    return np.diff(energy[::step], axis=0) / CELL_s


def phases(batch):
    """The phase of each cell and run, by the command in its middle: (cells, runs) of numbers of PHASES."""
    step = round(CELL_s / 0.004)
    middle = slice(step // 2, None, step)
    v, w, rise = batch.v_ref[middle], batch.w_ref[middle], np.gradient(batch.v_ref, 0.004, axis=0)[middle]
    moving, turning = np.abs(v) > 0.02, np.abs(w) > 0.05
    faster = rise * np.sign(v)
    return np.select([~moving & ~turning, ~moving, turning, faster > 0.05, faster < -0.05], [0, 1, 2, 3, 4], 5)


def shares(batch, gap):
    """Where the motors' power differs: by phase of the command and by wheel; gap: (cells, 2, runs) in W."""
    phase, total = phases(batch)[: len(gap)], max(gap.sum(), 1e-12)
    both = gap.sum(axis=1)[: len(phase)]
    return {"phase": {name: float(both[phase == k].sum() / total) for k, name in enumerate(PHASES)},
            "wheel": {"left": float(gap[:, 0].sum() / total), "right": float(gap[:, 1].sum() / total)}}


def word(machines, runs, errors):
    """The oracle's word on a case; `machines`: with the causes, and without."""
    if machines[0] == machines[1]:
        return NOTHING
    all_machines = [*machines, *off_by_sigma(machines[1])]
    batch = Batch(all_machines, runs, errors)
    record = batch.drive()
    views = seen(batch, record, all_machines)
    rows, period = len(views[0]), batch.file["log_s"]
    weight = inside(batch, rows, period) / logs.sigmas(batch.file)[3:, None]
    flat = [(view - views[1]) * weight for view in views]
    ratio = likelihood(flat[0].ravel(), np.array([f.ravel() for f in flat[2:]]))
    return {"likelihood_ratio": ratio, "detectable": ratio >= ENOUGH, **changes(batch, record, all_machines, views, inside(batch, rows, period))}


def changes(batch, record, machines, views, running):
    """How much the causes change: energies in percent, the pose in m and rad (rms)."""
    read = split(logged_energy(record, machines, batch), len(machines), batch.count)[:2]
    gap = np.abs(cells(read[0]) - cells(read[1]))
    motors = 100 * gap.sum() / np.abs(cells(read[1])).sum()
    battery = [cells(part) for part in split(record["E_bat"], len(machines), batch.count)[:2]]
    battery_percent = 100 * np.abs(battery[0] - battery[1]).sum() / np.abs(battery[1]).sum()
    moved = (views[0] - views[1])[:, 7:] * running
    per_run = np.abs((read[0] - read[1])[-1].sum(axis=0)).sum() / np.abs(read[1][-1].sum(axis=0)).sum()
    return {"battery_percent": float(battery_percent), "effect_percent": float(max(motors, battery_percent)),
            "effect_pose_rms": float(np.sqrt((moved**2).sum() / (3 * running.sum()))), "energy_gap_percent": float(100 * per_run),
            "each": {}, "each_change": {}, "where": shares(batch, gap)}


def logged_energy(record, machines, batch):
    """The motors' energy as logged, J: a wrong gain or offset of the currents is in it."""
    factor, offset = np.repeat([1 + m["gain"] for m in machines], batch.count), batch.per("offset_A")
    return record["E"] * factor + record["V"] * offset


