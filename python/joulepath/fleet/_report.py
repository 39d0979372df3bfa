"""report.html of a fleet: one self-contained page in the style of the program's other reports."""

from __future__ import annotations

import html
import json
from pathlib import Path as FilePath
from typing import Any

from .. import _core
from ._charts import KINDS, batteries, gantt, lanes_of
from ._floor import floor_html, moves_of

HERE = FilePath(__file__).parent


def report_html(source: Any, content: dict[str, Any]) -> str:
    """The page: verdict, playback, Gantt charts of robots and chargers, batteries, map, missions, executions."""
    told = f"<p>{html.escape(_sentence(content))}</p><p class=\"soft\">{html.escape(content['traffic'])}</p>"
    return page_html(f"Fleet {content['fleet']}", _badge(content["status"]),
                     told + (_charts(source, content) if "robots" in content else _helps(content)))


def page_html(name: str, badge: str, body: str) -> str:
    """A page in the style of the program's reports."""
    title, about = html.escape(name), f"{_core.page_day()} · joulepath {_core.version}"
    style = _core.page_style() + (HERE / "report.css").read_text(encoding="utf-8")
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
            f'<meta name="generator" content="joulepath"><title>{title} · {about}</title><link rel="icon" href="data:,"><style>{style}</style></head>'
            f'<body><main><header class="top"><h1>{title}</h1>{badge}</header>'
            f'<p class="soft small">{about}</p>{body}</main></body></html>\n')


def _badge(status: str) -> str:
    return f'<span class="badge{" bad" if status == "infeasible" else ""}">{html.escape(status)}</span>'


def _sentence(content: dict[str, Any]) -> str:
    if "cost_J" not in content:
        return f"No schedule exists: {content['reason']['says']}; " + (
            "each of these helps works." if content["help"] else "no help that was tried works.")
    late = sum(m["late_s"] > 0 for m in content["missions"])
    return (f"{content['cost_J']:.0f} J with the prices of lateness and use; no schedule costs less than {content['bound_J']:.0f} J "
            f"(gap {content['gap_percent']:.2f} %). {late} of {len(content['missions'])} missions are late.")


def _helps(content: dict[str, Any]) -> str:
    return "<ul>" + "".join(f"<li>{html.escape(h['says'])}</li>" for h in content["help"]) + "</ul>"


def _charts(source: Any, content: dict[str, Any]) -> str:
    end_s = max([item["to_s"] for robot in content["robots"] for item in robot["timeline"]] or [1])
    robots = [(robot["name"], [(x["from_s"], x["to_s"], x["does"], x.get("mission", "")) for x in robot["timeline"]])
              for robot in content["robots"]]
    docks = [lane for c, x in zip(content["chargers"], source.problem.chargers) for lane in lanes_of(c["station"], c["visits"], x.count)]
    key = "".join(f'<span class="key"><i class="box {does}"></i>{does}</span>' for does in KINDS)
    moves = moves_of(source, content)
    data = json.dumps({"end_s": end_s, **moves}).replace("<", "\\u003c")
    return (f'<div class="cursor"><div class="tools"><button id="play" aria-pressed="false">Play</button>'
            f'<span id="now" class="readout">0 s</span></div>'
            f'<input id="time" type="range" min="0" max="{end_s}" value="0" step="1" aria-label="Time in seconds"></div>'
            f'<section class="long"><h2>Robots</h2><p>{key}</p>{gantt(robots, end_s)}</section>'
            + (f'<section class="long"><h2>Chargers</h2>{gantt(docks, end_s)}</section>' if docks else "") +
            '<section class="long"><h2>Batteries</h2><p>The mean, and below it the lower 95 % bound, which guards the reserve '
            f'(dashed).</p>{batteries(content["robots"], end_s)}</section>'
            f'<div class="beside"><section class="long"><h2>Map</h2><p>Driven paths of the legs\' plans; a robot moves along them as in its plan, stretched '
            f"to the leg's time.</p>{floor_html(source, content, moves)}</section>"
            f'<div><section class="long"><h2>Missions</h2>{_missions(content)}</section>{_executions(content)}</div></div>'
            f'<script type="application/json" id="data">{data}</script>'
            f"<script>{(HERE / 'report.js').read_text(encoding='utf-8')}</script>")


def _row(cells: list[tuple[str, bool]], head: bool = False) -> str:
    tag = "th" if head else "td"
    return "".join(f'<{tag}{" class=n" if numeric else ""}>{html.escape(text)}</{tag}>' for text, numeric in cells)


def table_html(head: list[tuple[str, bool]], rows: list[tuple[str, list[str]]]) -> str:
    """``rows``: class and texts."""
    body = "".join(f'<tr class="{name}">{_row([(text, numeric) for text, (_, numeric) in zip(texts, head)])}</tr>' for name, texts in rows)
    return f'<div class="scroll"><table><thead><tr>{_row(head, True)}</tr></thead><tbody>{body}</tbody></table></div>'


def _missions(content: dict[str, Any]) -> str:
    head = [("mission", False), ("robot", False), ("begins, s", True), ("ends, s", True), ("due, s", True), ("late, s", True)]
    head += [("why late", False)] if any(m["late_s"] for m in content["missions"]) else []
    return table_html(head, [("late" if m["late_s"] else "", [m["name"], m["robot"], str(m["from_s"]), str(m["to_s"]),
                                                         "" if m["due_s"] is None else str(m["due_s"]), str(m["late_s"]), m["why"]])
                         for m in sorted(content["missions"], key=lambda m: (-m["late_s"], m["from_s"], m["name"]))])


def _executions(content: dict[str, Any]) -> str:
    if "executions" not in content:
        return ""
    head = [("simulated", False), ("runs", True), ("robots-days below the reserve", True), ("where it binds", True), ("late, s a run", True),
            ("waits at chargers, s a run", True)]
    rows = [("", [x["case"], str(x["runs"]), f"{x['breaches']} of {x['days']}", f"{x['breaches_binding']} of {x['days_binding']}",
                  f"{x['late_s']:.1f}", f"{x['waited_s']:.1f}"]) for x in content["executions"]]
    return f'<section class="long"><h2>Executions</h2>{table_html(head, rows)}</section>'
