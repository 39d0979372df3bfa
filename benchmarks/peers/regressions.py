"""Regressions that users know, on the logs of one day: a refit, two sparse ones [Brunton2016], a black box.

All see the same columns, residuals and held-out runs: currents and voltages of both wheels, every fourth run held out.
They name the column that explains most of the residual.
"""

import csv
import warnings

import numpy as np

from common import package

STRIDE = 3
SILENT = 0.05  # a regression that explains a smaller share of the residual names nothing


def column(rows, name):
    return np.array([float(row[name] or "nan") for row in rows])


def smooth(values, dt):
    signal = package("scipy.signal")
    window = 21
    return signal.savgol_filter(values, window, 2), signal.savgol_filter(values, window, 2, deriv=1, delta=dt)


def day_of(folder, robot):
    """Per run: library columns, residuals (current left, right, voltage left, right) and what energies need."""
    runs = []
    lines = [line for line in (folder / "dataset.yaml").read_text().splitlines() if "file:" in line]
    for number, line in enumerate(lines):
        payload = float(line.split("payload_kg:")[1].split(",")[0])
        rows = list(csv.DictReader(open(folder / f"run_{number + 1:02d}.csv")))
        dt = float(rows[1]["time_s"]) - float(rows[0]["time_s"])
        (ql, al), (qr, ar) = (smooth(column(rows, f"wheel_speed_{side}_rad_s"), dt) for side in ("left", "right"))
        runs.append(
            run_columns(
                robot,
                payload,
                np.stack([ql, qr]),
                np.stack([al, ar]),
                np.stack([column(rows, f"motor_current_{s}_A") for s in ("left", "right")]),
                np.stack([column(rows, f"motor_voltage_{s}_V") for s in ("left", "right")]),
                dt,
            )
        )
    return runs


def run_columns(robot, pay, q, dq, amps, volts, dt):
    r, l, K, ohm = robot["wheel_radius_m"], robot["half_track_m"], robot["K"], robot["ohm"]
    mass = robot["chassis_kg"] + 2 * robot["wheel_kg"] + pay
    yaw = robot["chassis_yaw"] + robot["payload_yaw"] * pay + 2 * robot["wheel_kg"] * l * l + 2 * robot["diameter"]
    v, w, a, dw = r * q.sum(0) / 2, r * (q[1] - q[0]) / (2 * l), r * dq.sum(0) / 2, r * (dq[1] - dq[0]) / (2 * l)
    turning, sign = np.array([[-1.0], [1.0]]), np.where(abs(q) > 0.05, np.sign(q), 0)
    share = lambda force, moment: r * (force / 2 + turning * moment / (2 * l))
    torque = share(mass * a, yaw * dw) + robot["axle"] * dq + robot["viscous"] * q + robot["friction"][:, None] * sign
    nominal_A = torque / K
    nominal_V = ohm * amps + K * q  # from the measured current, as the circuit's equation stands
    zero, one = np.zeros_like(q), np.ones_like(q)
    left = np.array([[1.0], [0.0]])
    weight = mass * 9.80665 / 2
    in_torque = {
        "rolling_resistance": weight * r * sign,
        "coulomb_friction": sign * np.array([[1.0], [0.93]]),
        "dragging_wheel": sign * left,
        "dragging_wheel ": sign * (1 - left),
        "viscous_friction": q,
        "gear_efficiency": abs(torque) * sign,
        "quadratic_drag": share(v * abs(v), 0 * v),
        "turning_scrub": share(0 * v, np.where(abs(w) > 0.02, np.sign(w), 0)),
        "payload_mass_error": share(pay * a, robot["payload_yaw"] * pay * dw),
        "center_of_mass_offset": share(-(robot["chassis_kg"] + pay) * w * w, (robot["chassis_kg"] + pay) * v * w),
        "yaw_inertia_error": share(0 * v, robot["chassis_yaw"] * dw),
    }
    columns = {name: np.concatenate([value / K, zero]) for name, value in in_torque.items()}
    columns |= {
        "winding_resistance_error": np.concatenate([zero, ohm * amps]),
        "driver_voltage_drop": np.concatenate([zero, np.where(abs(amps) > 0.03, np.sign(amps), 0)]),
        "torque_constant_error": np.concatenate([-nominal_A, K * q]),
        "current_sensor_gain": np.concatenate([nominal_A, -ohm * amps]),
        "current_sensor_offset": np.concatenate([one * left, -ohm * left * one]),
        "current_sensor_offset ": np.concatenate([one * (1 - left), -ohm * (1 - left) * one]),
    }
    return {
        "columns": columns,
        "residual": np.concatenate([amps - nominal_A, volts - nominal_V]),
        "amps": amps,
        "volts": volts,
        "q": q,
        "dq": dq,
        "pay": pay,
        "nominal_A": nominal_A,
        "dt": dt,
        "K": K,
        "ohm": ohm,
    }


def stack(runs, names):
    """Weighted least squares: rows scaled by the noise of their channel, every third sample."""
    noise = np.array([np.sqrt(np.mean([np.mean(np.diff(run["residual"][c]) ** 2) / 2 for run in runs])) for c in range(4)])
    matrix = np.concatenate(
        [np.stack([(run["columns"][n] / noise[:, None])[:, ::STRIDE].ravel() for n in names], 1) for run in runs]
    )
    return matrix, np.concatenate([(run["residual"] / noise[:, None])[:, ::STRIDE].ravel() for run in runs])


def held_out_energy(runs, names, values):
    """Sums of the absolute errors of the motor energy of each held-out run, before and after the correction."""
    before = after = 0.0
    for run in runs:
        more = (
            sum(x * run["columns"][n] for n, x in zip(names, values) if x) if np.any(values) else np.zeros_like(run["residual"])
        )
        measured = (run["volts"] * run["amps"]).sum() * run["dt"]
        energy = lambda i, extra: ((run["ohm"] * i + run["K"] * run["q"] + extra) * i).sum() * run["dt"]
        before += abs(energy(run["nominal_A"], 0) - measured)
        after += abs(energy(run["nominal_A"] + more[:2], more[2:]) - measured)
    return before, after


PARAMETERS = [
    "dragging_wheel",
    "dragging_wheel ",
    "viscous_friction",
    "payload_mass_error",
    "yaw_inertia_error",
    "winding_resistance_error",
    "torque_constant_error",
]


def refit(matrix, target, names):
    """scipy: least squares on the robot file's own parameters."""
    keep = [names.index(n) for n in PARAMETERS]
    scale = np.linalg.norm(matrix, axis=0)[keep]
    found = package("scipy.optimize").lsq_linear(matrix[:, keep] / scale, target).x / scale
    values = np.zeros(len(names))
    values[keep] = found
    return values


def sparse(kind):
    def fit(matrix, target, names):
        pysindy = package("pysindy")
        scale = np.linalg.norm(matrix, axis=0)
        y = (target / np.linalg.norm(target))[:, None]
        optimizer = (
            pysindy.STLSQ(threshold=0.15, alpha=0.01, max_iter=30)
            if kind == "STLSQ"
            else pysindy.SSR(alpha=0.01, max_iter=30, kappa=1e-3)
        )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            optimizer.fit(matrix / scale, y)
        return optimizer.coef_.ravel() * np.linalg.norm(target) / scale

    return fit


METHODS = {"plain refit (scipy)": refit, "PySINDy STLSQ": sparse("STLSQ"), "PySINDy best subset (SSR)": sparse("SSR")}


def regress(fit, runs):
    train, held = [run for i, run in enumerate(runs) if i % 4 != 3], [run for i, run in enumerate(runs) if i % 4 == 3]
    names = list(runs[0]["columns"])
    matrix, target = stack(train, names)
    values = fit(matrix, target, names)
    explained = values[None] * matrix
    gain = 1 - np.sum((target - explained.sum(1)) ** 2) / np.sum(target**2)
    if gain < SILENT or not np.any(values):
        return None, held_out_energy(held, names, np.zeros(len(names)))
    power = (explained**2).sum(0)
    return names[int(power.argmax())].strip(), held_out_energy(held, names, values)


def black_box(runs):
    """A quadratic polynomial of speeds, accelerations and payload on the residual power; it has no names."""

    def inputs(run):
        x = np.concatenate([run["q"], run["dq"], abs(run["q"]), np.full((1, run["q"].shape[1]), run["pay"])]).T
        return np.concatenate([np.ones((len(x), 1)), x, *(x[:, i : i + 1] * x[:, i:] for i in range(x.shape[1]))], 1)

    def rest(run):
        nominal = ((run["ohm"] * run["nominal_A"] + run["K"] * run["q"]) * run["nominal_A"]).sum(0)
        return (run["volts"] * run["amps"]).sum(0) - nominal

    train, held = [run for i, run in enumerate(runs) if i % 4 != 3], [run for i, run in enumerate(runs) if i % 4 == 3]
    X, y = np.concatenate([inputs(run) for run in train]), np.concatenate([rest(run) for run in train])
    coefficients = np.linalg.lstsq(X, y, rcond=1e-8)[0]
    before = sum(abs(rest(run).sum() * run["dt"]) for run in held)
    after = sum(abs((rest(run) - inputs(run) @ coefficients).sum() * run["dt"]) for run in held)
    return None, (before, after)


def nominal_robot():
    """The generator's Nomad: benchmarks/blind/plant writes these numbers into every robot.yaml of that robot."""
    return {
        "wheel_radius_m": 0.1,
        "half_track_m": 0.165,
        "K": 0.069 * 24.9,
        "ohm": 2.74,
        "chassis_kg": 21.2,
        "wheel_kg": 1.39,
        "chassis_yaw": 0.5,
        "payload_yaw": 0.02,
        "axle": 0.0281,
        "diameter": 0.007,
        "viscous": 0.0017,
        "friction": np.array([0.3728, 0.346]),
    }
