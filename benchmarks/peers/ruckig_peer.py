"""Ruckig: jerk-limited motion along a straight line, in least time or in a given time."""

import numpy as np

from common import cpu_ms, package

CALLS = 200  # one call is too short for the CPU clock


def run(length_m, limits, jerk_m_s3, duration_s=None, nodes=4000):
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
    times = trajectory.duration * (1 - np.cos(np.linspace(0, np.pi, nodes + 1))) / 2  # closer next to rest
    states = [trajectory.at_time(t) for t in times]
    s, v = (np.array([state[i][0] for state in states]) for i in (0, 1))
    kept = np.concatenate([[True], (np.diff(s) > 1e-12)[:-1] & (s[-1] - s[1:-1] > 1e-12), [True]])
    s, v = s[kept], v[kept]
    s[0], s[-1], v[0], v[-1] = 0, length_m, 0, 0
    return {
        "solve_ms": solve_ms / CALLS,
        "duration_s": trajectory.duration,
        "solution": {"s_m": s.tolist(), "speed_m_s": v.tolist()},
    }
