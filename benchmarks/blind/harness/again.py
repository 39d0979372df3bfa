"""Cases of the published campaign once more, by the program as it is now: development data, blind no longer.

Design: docs/decisions/0802-blind-benchmark.md
"""
import concurrent.futures
import re
import sys

import plan
import report
import seal
import workspace
from examine import examine

PAGE = workspace.RESULTS / "blind.md"


def published():
    """(name, frozen commit) of the campaign whose scores are published; {case: the first digits of its data's hash}."""
    name, frozen = re.search(r"campaign `(\w+)`, frozen commit `(\w+)`", PAGE.read_text()).groups()
    rows = [line.split("\t") for line in (workspace.RESULTS / "blind/cases.tsv").read_text().splitlines()]
    return name, frozen, {row[0]: row[-1] for row in rows}


def asked(case):
    return seal.label_of(case), examine(case, with_controls=False)


def refuse_other_logs(results, hashes):
    changed = [i for i in results if not results[i].get("data_sha256", "").startswith(hashes[i])]
    if changed:
        sys.exit(f"the generator has changed since: {len(changed)} of {len(results)} cases have other logs, the first is {changed[0]}")


def again(count, jobs):
    name, frozen, hashes = published()
    cases = [case for case in plan.campaign(name, frozen)[: count or None] if case["id"] in hashes]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        answers = list(pool.map(asked, cases))
    labels, results = {label["id"]: label for label, _ in answers}, {result["id"]: result for _, result in answers}
    refuse_other_logs(results, hashes)
    lines = ["# Cases of the blind benchmark, asked again", "",
             f"Command `./dev bench blind again --cases {len(results)}`; program of commit `{workspace.head()[:12]}`; campaign `{name}` of `{frozen[:12]}`; {report.machine()}.",
             f"The first {len(results)} cases of a campaign whose labels are published: development data, which the program's thresholds have seen. The column",
             "\"last campaign\" holds the sealed answers to all cases of that campaign. What the rows mean: [blind.md](blind.md).", ""]
    lines += report.card_table(labels, results, report.last_campaign(PAGE))
    page = workspace.RESULTS / "blind_again.md"
    page.write_text("\n".join(lines) + "\n")
    print(page.read_text())
    return 0
