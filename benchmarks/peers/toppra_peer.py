"""toppra [PhamPham2018]: least time and fixed duration on the same path.

The path of toppra is (arc length, heading): linear, yaw and lateral limits are joint limits, traction is a linear
constraint of second order. Currents and voltages depend on the speed itself and have no place in its constraints; the
judge checks them.
"""

import logging

import numpy as np

from common import Path, cpu_ms, package, rigid_body

# Grid points beside the knots. TOPPRAsd gives up 1e-5 of squared speed per point: nearer ones would need large accelerations.
BESIDE_M = {"least time": 1e-6, "fixed duration": 1e-3}


def geometry(toppra, path):
    class Geometry(toppra.interpolator.AbstractGeometricPath):
        def __call__(self, s, order=0):
            s = np.asarray(s, float)
            one, zero = np.full_like(s, path.along), np.zeros_like(s)
            columns = {0: (path.along * s, path.heading(s)), 1: (one, path.curvature(s)), 2: (zero, path.slope(s))}[order]
            return np.stack(columns, -1)

        dof = property(lambda self: 2)
        path_interval = property(lambda self: np.array([0, path.length]))
        waypoints = property(lambda self: (path.knots, self(path.knots)))

    return Geometry()


def constraints(toppra, problem, path):
    limits, inf = problem["limits"], 1e6
    robot = problem["robot_values"]
    at = lambda key: limits.get(key, inf)

    def speeds(s):
        lateral = np.sqrt(at("lateral_acceleration_m_s2") / max(abs(float(path.curvature(s))), 1e-12))
        most = np.array([min(at("speed_m_s"), lateral), at("yaw_rate_rad_s")])
        return np.stack([-most, most], 1)

    rates = toppra.constraint.JointVelocityConstraintVarying(speeds)
    rates.discretization_type = toppra.constraint.DiscretizationType.Collocation
    accelerations = toppra.constraint.JointAccelerationConstraint(
        np.array(
            [[-at("deceleration_m_s2"), at("acceleration_m_s2")], [-at("yaw_acceleration_rad_s2"), at("yaw_acceleration_rad_s2")]]
        ),
        discretization_scheme=toppra.constraint.DiscretizationType.Interpolation,
    )
    if "traction_coefficient" not in limits:
        return [rates, accelerations]
    l = robot["half_track_m"]
    mass, mu, yaw = rigid_body(problem)

    def forces(q, rate, acceleration):
        force = mass * acceleration[0] - mu * rate[1] ** 2
        moment = yaw * acceleration[1] + mu * rate[0] * rate[1]
        return np.array([force / 2 - moment / (2 * l), force / 2 + moment / (2 * l)])

    most = limits["traction_coefficient"] * mass * 9.80665 / 2
    traction = toppra.constraint.JointTorqueConstraint(
        forces,
        np.array([[-most, most]] * 2),
        np.zeros(2),
        discretization_scheme=toppra.constraint.DiscretizationType.Interpolation,
    )
    return [rates, accelerations, traction]


def run(problem, points, duration_s=None):
    """Least time, or a fixed duration; None where toppra finds no profile."""
    toppra = package("toppra")
    package("toppra.algorithm")
    logging.getLogger("toppra").setLevel(logging.CRITICAL)
    path, beside = Path(problem), BESIDE_M["fixed duration" if duration_s else "least time"]
    # The slope of the curvature jumps at knots: a grid point on each side lets toppra see both values.
    grid = np.unique(
        np.concatenate([np.linspace(0, path.length, points + 1), path.knots[1:-1] - beside, path.knots[1:-1] + beside])
    )
    grid = grid[np.concatenate([[True], np.diff(grid) > 1e-7])]
    grid[-1] = path.length

    def solve():
        kind = toppra.algorithm.TOPPRAsd if duration_s else toppra.algorithm.TOPPRA
        algorithm = kind(constraints(toppra, problem, path), geometry(toppra, path), gridpoints=grid, solver_wrapper="seidel")
        if duration_s:
            algorithm.set_desired_duration(duration_s)
        return algorithm.compute_parameterization(0, 0)

    solve_ms, (_, speeds, *_) = cpu_ms(solve)
    if speeds is None or not np.isfinite(speeds).all():
        return {"solve_ms": solve_ms, "solution": None}
    speeds = np.maximum(np.asarray(speeds, float), 0)
    speeds[[0, -1]] = 0
    return {"solve_ms": solve_ms, "solution": {"s_m": grid.tolist(), "speed_m_s": speeds.tolist()}}
