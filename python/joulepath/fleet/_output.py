"""The files of a fleet's plan."""

from __future__ import annotations

import json
import os
import re
import shutil
import tempfile
from pathlib import Path as FilePath
from typing import Any

from .._errors import refused
from ..mapping import map as in_threads
from ..plans import Plan
from ..plans import plan as plan_mission
from ._problem import NEVER, UNITS_PER_J, Schedule
from ._report import report_html
from ._timeline import timelines

TRAFFIC = "Traffic between robots is not modeled: no time window of a shared aisle is promised."


def fleet_json(source: Any, status: str, schedule: Schedule | None, helps: list[dict[str, Any]]) -> dict[str, Any]:
    """The content of fleet.json."""
    head = {"schema": "joulepath/fleet_schedule/1", "fleet": source.content["name"], "status": status, "traffic": TRAFFIC}
    if schedule is None:
        return {**head, "reason": source.reason or {"says": "no single mission is the reason"}, "help": helps}
    lines = timelines(source.problem, schedule)
    robots = [{"name": robot.name, "start_fraction": round(robot.level / source.problem.kind(r).capacity, 6),
               "reserve_fraction": source.content["types"][robot.type]["reserve_fraction"], "timeline": lines[r]}
              for r, robot in enumerate(source.problem.robots)]
    return {**head, "cost_J": schedule.cost / UNITS_PER_J, "bound_J": schedule.bound / UNITS_PER_J,
            "gap_percent": round(100 * (1 - schedule.bound / schedule.cost), 4) if schedule.cost else 0.0,
            "robots": robots, "missions": _missions(source, lines), "chargers": _chargers(source, lines),
            **({"executions": source.executions} if source.executions else {})}


def _missions(source: Any, lines: list[list[dict[str, Any]]]) -> list[dict[str, Any]]:
    found = []
    for mission in source.problem.missions:
        r, item = next((r, x) for r, line in enumerate(lines) for x in line if x.get("mission") == mission.name)
        found.append({"name": mission.name, "robot": source.problem.robots[r].name, "from_s": item["from_s"], "to_s": item["to_s"],
                      "due_s": None if mission.due_s >= NEVER else mission.due_s, "late_s": item["late_s"],
                      "why": _why(source.problem.robots[r], lines[r], item, mission) if item["late_s"] else ""})
    return found


def _why(robot: Any, line: list[dict[str, Any]], item: dict[str, Any], mission: Any) -> str:
    """How its robot spent the time from the mission's ready time to its begin."""
    needs_s = item["to_s"] - item["from_s"]
    if mission.ready_s + needs_s > mission.due_s:
        return f"it takes {needs_s} s, and its window has {mission.due_s - mission.ready_s} s"
    told = [f"{robot.name} is available from {robot.from_s} s"] if robot.from_s > mission.ready_s else []
    for x in line:
        seconds = min(x["to_s"], item["from_s"]) - max(x["from_s"], mission.ready_s)
        if seconds > 0:
            what = {"mission": f"with {x.get('mission')}", "drive": f"on the way to {x.get('to')}",
                    "charge": f"at the charger {x.get('at')}", "wait": f"waiting at {x.get('at')}"}[x["does"]]
            told.append(f"{seconds} s {what}")
    return f"ready at {mission.ready_s} s; since then {robot.name} was " + ", ".join(told)


def _chargers(source: Any, lines: list[list[dict[str, Any]]]) -> list[dict[str, Any]]:
    return [{"station": charger.place,
             "visits": sorted(({"robot": source.problem.robots[r].name, "from_s": x["from_s"], "to_s": x["to_s"],
                                "charged_J": x["charged_J"]} for r, line in enumerate(lines) for x in line
                               if x["does"] == "charge" and x["at"] == charger.place), key=lambda v: (v["from_s"], v["robot"]))}
            for charger in source.problem.chargers]


def mission_of(source: Any, index: int, r: int, point: int) -> dict[str, Any] | None:
    """The mission file of a driven mission; None: it has one place, and no drive."""
    content, t = source.content["missions"][index], source.problem.robots[r].type
    legs = source.mission_legs(content, t)
    if all(leg[1] == leg[2] for leg in legs):
        return None
    stops, floor = content["stops"], source.content["floor"]
    planned = []
    for leg, stop, goal in zip(legs, stops, stops[1:]):
        points = source.table[leg]
        entry = {"to": leg[2], "payload_kg": stop["payload_kg"], "dwell_s": goal["dwell_s"]}
        if point > 0 and leg[1] != leg[2]:
            entry["duration_s"] = points[min(point, len(points) - 1)][0] * 1.001  # a front's least time is at its edge
        planned.append(entry)
    return {"name": content["name"], "robot": source.content["types"][t]["robot_file"], **floor,
            "start": {"station": stops[0]["station"]}, "legs": planned}


def order_text(found: Plan, robot: str) -> str:
    """The VDA 5050 order that `joulepath export` writes, for a robot."""
    order = json.loads(found._value.exported("vda5050", "order.json")[0][1])
    return _text({**order, "serialNumber": robot})


def _mission_files(source: Any, schedule: Schedule) -> dict[str, str]:
    """plan.json, trajectory.csv and order.json of each mission with a drive between its stops."""
    driven = [(step.mission, r, source.problem.missions[step.mission].drives[source.problem.robots[r].type][step.speed].point)
              for r, route in enumerate(schedule.routes) for step in route]
    files: dict[str, str] = {}
    texts = [mission_of(source, *one) for one in driven]
    jobs = [{"mission": text, "solver": "fast", "baselines": False} for text in texts if text is not None]
    plans = iter(in_threads(plan_mission, jobs))
    for (m, r, _), text in zip(driven, texts):
        if text is None:
            continue
        found = next(plans)
        if not isinstance(found, Plan):
            raise found
        folder = "missions/" + re.sub(r"[^\w.-]", "_", source.problem.missions[m].name)
        files[f"{folder}/order.json"] = order_text(found, source.problem.robots[r].name)
        files[f"{folder}/plan.json"] = found._value.json
        files[f"{folder}/trajectory.csv"] = found.trajectory.text()
    return files


def _text(content: dict[str, Any]) -> str:
    return json.dumps(content, indent=2) + "\n"


def save(source: Any, status: str, schedule: Schedule | None, helps: list[dict[str, Any]], directory: str | os.PathLike[str],
         force: bool, missions: bool) -> FilePath:
    """Writes all files into a part folder, then moves them: all or none."""
    target = FilePath(directory)
    content = fleet_json(source, status, schedule, helps)
    if (target / "fleet.json").exists() and not force:
        raise refused("directory", f"{target / 'fleet.json'}, a file that exists", "a new name", "force=True overwrites it")
    files = {"fleet.json": _text(content), "report.html": report_html(source, content)}
    if missions and schedule is not None:
        files |= _mission_files(source, schedule)
    target.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=target, prefix=".part-") as part:
        for name, text in files.items():
            (FilePath(part) / name).parent.mkdir(parents=True, exist_ok=True)
            (FilePath(part) / name).write_text(text, encoding="utf-8", newline="")
        shutil.rmtree(target / "missions", ignore_errors=True)
        if (FilePath(part) / "missions").exists():
            os.replace(FilePath(part) / "missions", target / "missions")
        for name in ("report.html", "fleet.json"):
            os.replace(FilePath(part) / name, target / name)
    return target
