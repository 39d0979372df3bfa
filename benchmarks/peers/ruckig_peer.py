"""Ruckig [BerscheidKroeger2021]: jerk-limited motion along a straight line, in least time or in a given time."""

from common import cpu_ms, package

CALLS = 200  # one call is too short for the CPU clock


def run(length_m, limits, jerk_m_s3, duration_s=None):
    ruckig = package("ruckig")
    asked = ruckig.InputParameter(1)
    asked.current_position, asked.target_position = [0.0], [length_m]
    asked.max_velocity = [limits["speed_m_s"]]
    asked.max_acceleration, asked.min_acceleration = [limits["acceleration_m_s2"]], [-limits["deceleration_m_s2"]]
    asked.max_jerk = [jerk_m_s3]
    if duration_s:
        asked.minimum_duration = duration_s
    otg, trajectory = ruckig.Ruckig(1), ruckig.Trajectory(1)

    def repeat():
        for _ in range(CALLS):
            answer = otg.calculate(asked, trajectory)
        return answer

    solve_ms, answer = cpu_ms(repeat)
    if answer not in (ruckig.Result.Working, ruckig.Result.Finished):
        return {"solve_ms": solve_ms / CALLS, "solution": None}
    (piece,) = trajectory.profiles[0]
    kept = [(t, j) for t, j in zip(piece.t, piece.j) if t > 1e-12]
    times = [0.0]
    for t, _ in kept:
        times.append(times[-1] + t)
    return {
        "solve_ms": solve_ms / CALLS,
        "duration_s": trajectory.duration,
        "solution": {"time_s": times, "jerk_m_s3": [j for _, j in kept]},
    }
