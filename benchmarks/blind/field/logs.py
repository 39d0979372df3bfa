"""What a robot's computer logs of a day: channels of the drives, the battery, a gyro and a lidar localizer.

The drives count encoder ticks and average current and voltage over the period of the log; the battery's monitor averages
over its own, longer one; the localizer's last pose is held.
"""
import numpy as np

from physics import RECORD_STEPS, STEP_s

RECORD_s = RECORD_STEPS * STEP_s
POSE_NOISE = (0.004, 0.004, 0.002)  # m, m, rad: white, of each pose
POSE_DRIFT = (0.004, 0.004, 0.001)  # the same, wandering over DRIFT_s: level 1 alone
DRIFT_s, GYRO_NOISE_rad_s = 3.0, 0.003
COLUMNS = ("time_s", "wheel_speed_left_rad_s", "wheel_speed_right_rad_s", "motor_voltage_left_V", "motor_voltage_right_V",
           "motor_current_left_A", "motor_current_right_A", "battery_voltage_V", "battery_current_A", "gyro_yaw_rate_rad_s", "position_x_m",
           "position_y_m", "heading_rad")
SIGMAS = dict(zip(COLUMNS, (0, 0, 0, "V", "V", "A", "A", "V", "A", GYRO_NOISE_rad_s, *POSE_NOISE)))


def localizer_errors(file, seconds, runs, level, rng):
    """Errors of each pose of each run: (updates, 3, runs), m and rad."""
    count = round(seconds / file["lidar_s"]) + 2
    white = rng.normal(size=(count, 3, runs)) * np.array(POSE_NOISE)[:, None]
    if level == 0:
        return white
    return white + wandering(rng.normal(size=(count, 3, runs)), np.exp(-file["lidar_s"] / DRIFT_s)) * np.array(POSE_DRIFT)[:, None]


def wandering(white, memory):
    """AR(1) noise of unit variance from white noise, along the first axis."""
    out = white.copy()
    for k in range(1, len(out)):
        out[k] = memory * out[k - 1] + np.sqrt(1 - memory**2) * white[k]
    return out


def at(record, times):
    """A recorded integral at other times, linear between records; before the start it is that of the start."""
    place = np.clip(times / RECORD_s, 0, len(record) - 1)
    low = np.minimum(place.astype(int), len(record) - 2)
    part = (place - low).reshape((-1,) + (1,) * (record.ndim - 1))
    return record[low] * (1 - part) + record[low + 1] * part


def means(record, times, period):
    return (at(record, times) - at(record, times - period)) / period


def channels(batch, record, period):
    """The channels without noise, (rows, columns, B), at every `period` s of the longest run."""
    times = np.arange(1, int(batch.steps * STEP_s / period + 1e-9) + 1) * period
    slow_s = batch.file["slow_s"]
    held = np.floor(times / slow_s + 1e-9) * slow_s
    speed = means(record["q"], times, period)
    electric, gain = times - batch.machines[0]["late_s"], batch.per("gain")
    V, i = means(record["V"], electric, period), means(record["i"], electric, period) * (1 + gain) + batch.per("offset_A")
    seen = record["seen"][np.round(times / RECORD_s).astype(int)]
    shape = speed[:, 0].shape
    columns = [np.broadcast_to(times[:, None], shape), speed[:, 0], speed[:, 1], V[:, 0], V[:, 1], i[:, 0], i[:, 1],
               means(record["U_bat"], held, slow_s), means(record["I_bat"], held, slow_s), means(record["heading"], times, period),
               seen[:, 0], seen[:, 1], seen[:, 2]]
    first = times < slow_s  # the battery's monitor shows its first mean from the start
    for column in columns[7:9]:
        column[first] = column[np.argmin(first)]
    return np.stack(columns, axis=1)


def sigmas(file):
    """Noise of each column, in its unit."""
    units = {"V": 3 * file["lsb_V"], "A": 3 * file["lsb_A"]}
    return np.array([units.get(value, value) for value in SIGMAS.values()], float)


def measured(clean, batch, run, level, rng):
    """The log of one run, with the drives' quantized counts and noisy, quantized readings."""
    file = batch.file
    rows = min(len(clean), int(len(batch.runs[run]["command"][0]) * 0.004 / file["log_s"]))
    log = clean[:rows, :, run].copy()
    for k in (1, 2):
        angle = np.concatenate([[0.0], np.cumsum(log[:, k]) * file["log_s"]])
        log[:, k] = np.diff(np.floor(angle / batch.count_rad + rng.random())) * batch.count_rad / file["log_s"]
    noise = rng.normal(size=(rows, len(COLUMNS)))
    noise[:, 10:] = 0.0  # the localizer's errors are in the poses already
    slow = max(1, round(file["slow_s"] / file["log_s"]))
    noise[:, 7:9] = noise[(np.arange(1, rows + 1) // slow) * slow % rows, 7:9]
    if level:
        noise[:, 3:7] = wandering(noise[:, 3:7], 0.6)
    log += noise * sigmas(file)
    for k, step in ((3, "lsb_V"), (4, "lsb_V"), (5, "lsb_A"), (6, "lsb_A"), (7, "lsb_V"), (8, "lsb_A")):
        log[:, k] = np.round(log[:, k] / file[step]) * file[step]
    log[:, 12] = np.remainder(log[:, 12] + np.pi, 2 * np.pi) - np.pi
    return log


def csv_text(log):
    lines = [",".join(COLUMNS)] + [",".join(f"{value:.6g}" for value in row) for row in log]
    return "\n".join(lines) + "\n"


def dataset_text(runs):
    lines = ["schema: joulepath/dataset/1", "robot: robot.yaml", "runs:"]
    for k, run in enumerate(runs, 1):
        lines.append(f"  - {{file: run_{k:02d}.csv, payload_kg: {run['load']:g}, start_time_s: {run['start_s']:g}}}")
    return "\n".join(lines) + "\n"
