#!/usr/bin/env python3
"""Samples with equal radii: how their runs end under each policy for ties.

    python3 tests/bench/ties.py build/release/isostat OUT --law bidisperse --disks 100 --seeds 20 --policy choose

Policies: stop, choose, first (choose with max_choices = 0), or a jitter such as 1e-9 (with ties = "stop"). One process, one line per sample and one of
sums: finished, failed (caps), tied, undecided, other, seconds. Folders of the runs stay in OUT."""
import argparse
import collections
import json
import pathlib
import subprocess
import time


def scene(options, policy, seed):
    jitter = "" if policy in ("stop", "first", "choose") else policy
    ties = {"first": 'choose"\nmax_choices = 0', "choose": 'choose"'}.get(policy, 'stop"')
    return f"""[packing]
disks = {options.disks}
law = "{options.law}"
seed = {seed}
{f"jitter = {jitter}" if jitter else ""}
[run]
ties = "{ties}
[output]
pictures = false
[[programme]]
do = "up"
equilibria = {options.equilibria}
"""


def kind_of(status, reason):
    if status == 0:
        return "finished"
    if "the sample fails" in reason:
        return "failed"
    if reason.startswith("tie") or "exactly equal" in reason or "gaps that are zero" in reason or "cannot order" in reason:
        return "tied"
    return "undecided" if status == 2 else "other"


def run(options, policy, seed):
    folder = pathlib.Path(options.out) / f"{options.law}-{options.disks}-{policy}-{seed}"
    file = folder.with_suffix(".toml") if "." not in folder.name else pathlib.Path(str(folder) + ".toml")
    file.write_text(scene(options, policy, seed))
    begin = time.monotonic()
    command = [options.isostat, "run", str(file), "-o", str(folder), "-q", "--force", "--threads", "1"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=options.limit)
        status, said = done.returncode, done.stderr.strip().split("\n")[-1]
    except subprocess.TimeoutExpired:
        status, said = 99, f"stopped after {options.limit} s"
    seconds = time.monotonic() - begin
    counters = {}
    if (folder / "summary.json").exists():
        counters = json.loads((folder / "summary.json").read_text()).get("counters", {})
    ties = counters.get("decisions", {}).get("ties", {})
    return kind_of(status, said), seconds, {
        "equilibria": counters.get("equilibria", 0),
        "arcs": counters.get("arcs", 0),
        "first order": sum(ties.get("perturbed", {}).values()),
        "choices": ties.get("choices", 0),
    }, said


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("isostat")
    parser.add_argument("out")
    parser.add_argument("--law", default="bidisperse")
    parser.add_argument("--disks", type=int, default=100)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--equilibria", type=int, default=30)
    parser.add_argument("--limit", type=float, default=600, help="seconds for one sample")
    parser.add_argument("--policy", nargs="+", default=["stop", "first", "choose", "1e-9"])
    options = parser.parse_args()
    pathlib.Path(options.out).mkdir(parents=True, exist_ok=True)
    for policy in options.policy:
        sums = collections.Counter()
        total = 0.0
        for seed in range(options.first, options.first + options.seeds):
            kind, seconds, counts, said = run(options, policy, seed)
            sums[kind] += 1
            total += seconds
            numbers = ", ".join(f"{name} {value}" for name, value in counts.items())
            print(f"{options.law} {policy} seed {seed}: {kind}, {numbers}, {seconds:.1f} s{'' if kind == 'finished' else ': ' + said}",
                  flush=True)
        print(f"{options.law} n = {options.disks} {policy}: {dict(sums)}, {total:.0f} s", flush=True)


if __name__ == "__main__":
    main()
