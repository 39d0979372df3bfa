"""Cases of a scored campaign once more, by the program as it is now: development data, blind no longer.

Design: docs/decisions/0512-a-scored-campaign-is-asked-again.md
"""
import concurrent.futures
import sys

import plan
import report
import workspace
from examine import examine


def newest_scored(name):
    """The frozen commit of the newest campaign of that name that was scored on this machine."""
    found = [(marker.read_text(), marker.parent.name.rsplit("-", 1)[1])
             for marker in workspace.sealed_folder("", name).parent.glob(f"{name}-*/opened")]
    if not found:
        sys.exit("no campaign is scored on this machine: its labels stay sealed until then")
    return workspace.git("rev-parse", max(found)[1])


def again(name, count, jobs):
    frozen = newest_scored(name)
    labels, then, _ = report.load(frozen, name)
    cases = [case for case in plan.plan(frozen, *workspace.effect_names(), plan.FULL)[: count or None] if case["id"] in then]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        now = {result["id"]: result for result in pool.map(lambda case: examine(case, with_controls=False), cases)}
    changed = [i for i in now if now[i].get("data_sha256") != then[i].get("data_sha256")]
    if changed:
        sys.exit(f"the generator has changed since: {len(changed)} of {len(now)} cases have other logs, the first is {changed[0]}")
    last = report.values_of(report.card_table(labels, {i: then[i] for i in now}, {}))
    lines = ["# Cases of the blind benchmark, asked again", "",
             f"Command `./dev bench blind again --cases {len(now)}`; program of commit `{workspace.head()[:12]}`; campaign `{name}` of `{frozen[:12]}`; {report.machine()}.",
             f"The first {len(now)} cases of a campaign that was scored before: development data, which the program's thresholds have seen. The column",
             "\"last campaign\" holds the sealed answers to the same cases. What the rows mean: [blind.md](blind.md).", ""]
    lines += report.card_table(labels, now, last)
    page = workspace.RESULTS / "blind_again.md"
    page.write_text("\n".join(lines) + "\n")
    print(page.read_text())
    return 0
