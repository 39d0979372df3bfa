"""Recorded logs as rows, stretches of them, and windows of steady enough motion: {side: [Window]}."""
import csv
import hashlib

SIDES = ("left", "right")


class Window:
    """Means over a short time of one wheel: speed rad/s, mean acceleration of both wheels and half their difference
    (counted for this side) rad/s^2, how clearly the robot turns and this wheel is the one that pushes (-1 to 1),
    current A, voltage V (None: not logged)."""

    def __init__(self, speed, straight_acceleration, turning_acceleration, turn, current, voltage=None):
        self.speed, self.straight_acceleration, self.turning_acceleration = speed, straight_acceleration, turning_acceleration
        self.turn, self.current, self.voltage = turn, current, voltage

    @property
    def sign(self):
        return 1.0 if self.speed > 0 else -1.0


def pair_of_windows(speeds, accelerations, clear_turn_rad_s, currents, voltages=(None, None)):
    """{side: Window} from what left and right do at the same time."""
    straight, turning = mean(accelerations), (accelerations[1] - accelerations[0]) / 2
    turn = max(-1.0, min(1.0, (speeds[1] - speeds[0]) / clear_turn_rad_s))
    return {side: Window(speeds[k], straight, (-1, 1)[k] * turning, (-1, 1)[k] * turn, currents[k], voltages[k])
            for k, side in enumerate(SIDES)}


def mean(values):
    return sum(values) / len(values)


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def stretches(rows, seconds, period_s, moves):
    """A log cut into stretches of `seconds`, those at rest throughout dropped: they take the place of runs."""
    size = max(20, int(seconds / period_s))
    cut = [rows[k:k + size] for k in range(0, len(rows), size)]
    return [piece for piece in cut if len(piece) >= size // 2 and moves(piece)]


def write_set(folder, robot, columns, runs):
    """A dataset of runs from rows; returns the dataset file."""
    folder.mkdir(parents=True)
    lines = ["schema: joulepath/dataset/1", f"robot: {robot}", "columns:" + columns, "runs:"]
    for k, rows in enumerate(runs):
        name = f"run_{k + 1:02d}.csv"
        with open(folder / name, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
        lines.append(f"  - {{file: {name}, payload_kg: 0}}")
    (folder / "dataset.yaml").write_text("\n".join(lines) + "\n")
    return folder / "dataset.yaml"


def checksum(folder):
    """First 16 digits of the SHA-256 over all CSV files in order of path."""
    total = hashlib.sha256()
    for path in sorted(folder.rglob("*.csv")):
        total.update(path.read_bytes())
    return total.hexdigest()[:16]
