"""A hidden effect: more friction in one robot's motors than its file states."""

from __future__ import annotations

from typing import Any

from ..mapping import map as in_threads
from ..plans import Plan
from ..plans import plan as plan_mission
from ..robots import Robot
from ._output import mission_of
from ._problem import Schedule

MORE = 1.1  #: friction of the hidden robot, relative to its file
KEYS = ("friction_torque_Nm", "viscous_friction_Nm_s_rad")


def energy_factor(source: Any, schedule: Schedule, r: int) -> float:
    """Energy of motion of a robot's missions with ``MORE`` friction, relative to that with its file's; 1 without a drive.

    Each mission is planned with either robot when time is free. There the energy with standby is least, so that its change is that
    of the motion, to first order.
    """
    t = source.problem.robots[r].type
    robot, standby_W = Robot.load(source.content["types"][t]["robot_file"]), source.content["types"][t]["standby_W"]
    motor = robot.to_dict()["motor"]
    worn = robot.replace(motor={key: _more(motor[key]) for key in KEYS if key in motor})
    texts = [text for step in schedule.routes[r] if (text := mission_of(source, step.mission, r, 0)) is not None]
    base, changed = (_planned([{"mission": text, "robot": one} for text in texts]) for one in (robot, worn))
    motion_J = sum(x.energy_J - standby_W * x.duration_s for x in base)
    return 1.0 + sum(b.energy_J - a.energy_J for a, b in zip(base, changed)) / motion_J if motion_J > 0 else 1.0


def _more(value: Any) -> Any:
    return {key: MORE * each for key, each in value.items()} if isinstance(value, dict) else MORE * value


def _planned(jobs: list[dict[str, Any]]) -> list[Plan]:
    found = in_threads(plan_mission, [{**job, "solver": "fast", "baselines": False} for job in jobs])
    for one in found:
        if not isinstance(one, Plan):
            raise one
    return [one for one in found if isinstance(one, Plan)]
