"""Datasets of a given size for the speed of `joulepath diagnose`: what they hold matters less than how much."""
import subprocess

PAYLOADS_KG = (0, 2.55, 5.7, 8.25, 10.5)
RATE_Hz = 50


def legs(seed, seconds):
    """A run that lasts at least so long: lanes both ways, arcs, spins and stops, varied by `seed`."""
    payload = PAYLOADS_KG[seed % len(PAYLOADS_KG)]
    speed = 0.3 + 0.05 * (seed % 7)
    lane = f"profile:trapezoid,speed_m_s:{speed:.2f},acceleration_m_s2:0.25,distance_m:3"
    parts = [lane, "profile:stand,duration_s:1", lane + ",direction:reverse",
             f"profile:arc,radius_m:{0.8 + 0.2 * (seed % 3):.1f},angle_rad:{'-' if seed % 2 else ''}3,speed_m_s:{speed:.2f}",
             f"profile:spin,angle_rad:{'-' if seed % 3 else ''}4,yaw_rate_rad_s:0.8"]
    each = 3 / speed * 2 + 12
    repeated = parts * (int(seconds / each) + 2)
    return "+".join(f"{part},payload_kg:{payload}" if k == 0 else part for k, part in enumerate(repeated))


def cut(log, rows):
    """The log's first rows; how many it had."""
    lines = log.read_text().splitlines()
    log.write_text("\n".join(lines[: rows + 1]) + "\n")
    return len(lines) - 1


def make(plant, folder, runs, rows, effect="rolling_resistance", size="0.012"):
    """A dataset of `runs` logs of `rows` samples each, written by the blind plant."""
    motions = ";".join(legs(seed, rows / RATE_Hz) for seed in range(runs - 1))
    subprocess.run([plant, "--effect", effect, "--size", size, "--protocol", "1", "--seed", "7", "--out", str(folder),
                    "--label", "none", "--append", motions], check=True)
    logs = sorted(folder.glob("*.csv"))
    lengths = [cut(log, rows) for log in logs]
    return len(logs), sum(min(length, rows) for length in lengths)
