#!/usr/bin/env python3
"""The program on large packings: CPU time and memory of the preparation, of an inspection, of a certificate, of its verification and of an
arc of a run (its share of the equilibria included), and their growth with n.

    python3 tests/bench/scale.py build/release/isostat FOLDER [--threads T] [--equilibria E] [--arcs A] [n | STATE ...]

A number of disks is prepared with seed 1 (its state stays in FOLDER), a state file is taken as it is. Every stage is a process of its own; its
CPU time (all threads, user and system) and its largest resident memory are what the operating system counted (the memory is at least that of
this script, some 15 MB). Exit status 1 when a stage did
not end as it should: a rearrangement longer than --arcs ends the run with a status of its own, and the stretch is as good."""
import argparse
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import time

HEADS = ("n", "stage", "CPU, s", "CPU per disk, ms", "CPU grows as n to the power of", "memory, MB", "memory per disk, kB",
         "memory grows as n to the power of", "wall, s", "end")


def cost(*command):
    """Exit status, CPU seconds, bytes and seconds on the wall of a process."""
    begin = time.monotonic()
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, used.ru_utime + used.ru_stime, 1024 * used.ru_maxrss, time.monotonic() - begin


class Table:
    def __init__(self):
        self.last, self.good = {}, True
        print("| " + " | ".join(HEADS) + " |\n|" + "---|" * len(HEADS))

    def add(self, n, stage, measured, parts=1, good=None, end="done"):
        """`parts`: what the CPU time is shared out among; growth against the size before."""
        status, cpu, memory, wall = measured
        good = status == 0 if good is None else good
        self.good = self.good and good
        cpu, wall = cpu / parts, wall / parts
        exponents = ["–", "–"]
        if stage in self.last and self.last[stage][0] != n:
            before, *values = self.last[stage]
            exponents = [f"{math.log(now / then) / math.log(n / before):.2f}" for now, then in zip((cpu, memory), values)]
        self.last[stage] = n, cpu, memory
        row = (n, stage, f"{cpu:.3g}", f"{1e3 * cpu / n:.3g}", exponents[0], f"{memory / 1e6:.0f}", f"{memory / 1e3 / n:.2f}", exponents[1],
               f"{wall:.3g}", end if good else f"exit status {status}")
        print("| " + " | ".join(map(str, row)) + " |", flush=True)
        return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("isostat")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("sources", nargs="*", default=["400", "1936"])
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--equilibria", type=int, default=5, help="of the stretch of trajectory, at most")
    parser.add_argument("--arcs", type=int, default=60, help="of one rearrangement, at most: then the stretch ends")
    options = parser.parse_args()
    folder, program, threads = options.folder, options.isostat, ("--threads", options.threads)
    folder.mkdir(parents=True, exist_ok=True)
    table = Table()
    for source in options.sources:
        state = folder / pathlib.Path(source).name
        if source.isdigit():
            scene, state = folder / f"{source}.toml", folder / f"{source}.json"
            scene.write_text(f"[packing]\ndisks = {source}\nseed = 1\n")
            if not table.add(int(source), "preparation", cost(program, "prepare", scene, "-o", state, "-q", *threads)):
                continue
        elif not state.exists():
            shutil.copy(source, state)
        n = len(json.loads(state.read_text())["disks"])
        certificate, scene, run = folder / "certificate.json", folder / "run.toml", folder / "run"
        table.add(n, "inspection", cost(program, "inspect", state, "--json", *threads))
        table.add(n, "certificate", cost(program, "certify", state, "-o", certificate, "--json", *threads))
        table.add(n, "verification", cost(program, "verify", certificate, "--json"))
        scene.write_text(f'[packing]\nfile = "{state.name}"\n[[programme]]\ndo = "up"\nequilibria = {options.equilibria}\n'
                         f"[run]\nmax_arcs = {options.arcs}\n[output]\npictures = false\n")
        measured = cost(program, "run", scene, "-o", run, "--force", "-q", *threads)
        arcs = (run / "events.jsonl").read_text().count('"opened":')
        good = arcs > 0 and (measured[0] == 0 or arcs >= options.arcs)
        table.add(n, "an arc", measured, max(1, arcs), good, f"{arcs} arcs")
    return 0 if table.good else 1


if __name__ == "__main__":
    sys.exit(main())
