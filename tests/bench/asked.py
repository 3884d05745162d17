#!/usr/bin/python3
"""The figures that were asked for, from the JSON files of the programs here: median, range, and whether it is met.

    /usr/bin/python3 tests/bench/asked.py FOLDER [--json FILE]
    /usr/bin/python3 tests/bench/asked.py --peak FILE COMMAND...      runs a command, writes its peak memory to FILE

FOLDER: arc_cost.json, arc_cost_2.json (with --threads 2), growth.json (the same program, with 20 000 disks), state_cost.json, linear_programmes.json and
memory.json, as `bash tests/bench/run` makes them; what is not there is left out. Exit status 1 when a figure is not met.
"""
import argparse
import json
import os
import resource
import subprocess
import sys

# figure, file, table, row (what some columns have), column, most that is asked, unit
ASKED = [
    ("an arc, decisions / one KLU, n = 1936, two cores", "arc_cost_2", "arc_cost", {"n": 1936}, "decisions_klu", 0.70, "KLU"),
    ("the same, one core", "arc_cost", "arc_cost", {"n": 1936}, "decisions_klu", 0.70, "KLU"),
    ("growth of an arc, decisions, n = 400 to 20 000", "growth", "growth", {"from": 400, "to": 20000}, "decisions", 1.15, "exponent"),
    ("exact rank / one UMFPACK factorisation, n = 4900", "state_cost", "state_cost",
     {"n": 4900, "work": "exact rank, 31-bit prime (tried first)"}, "umfpack_factorisation", 0.5, "UMFPACK"),
    ("the same, 61-bit prime", "state_cost", "state_cost", {"n": 4900, "work": "exact rank, 61-bit prime"},
     "umfpack_factorisation", 0.5, "UMFPACK"),
    ("linear programmes / HiGHS chain, n = 1936", "linear_programmes", "linear_programmes", {"n": 1936}, "ratio", 0.2,
     "HiGHS"),
    ("peak memory, figure-2 run, n = 4900", "memory", "memory", {"n": 4900}, "megabytes", 400, "MB"),
]


def find(folder, file, table, row):
    path = os.path.join(folder, file + ".json")
    if not os.path.exists(path):
        return None
    with open(path) as stream:
        tables = {t["name"]: t["rows"] for t in json.load(stream)["tables"]}
    return next((r for r in tables.get(table, []) if row.items() <= r.items()), None)


def peak(file, command):
    status = subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode
    kilobytes = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    with open(file, "w") as stream:
        json.dump({"program": "asked.py", "arguments": command, "tables": [
            {"name": "memory", "caption": "Peak memory:",
             "columns": [{"key": "megabytes", "heading": "MB", "unit": "MB"}],
             "rows": [{"n": 4900, "megabytes": kilobytes / 1024, "status": status}]}]}, stream, indent=1)
    return status


def main():
    if sys.argv[1:2] == ["--peak"]:
        return peak(sys.argv[2], sys.argv[3:])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--json")
    arguments = parser.parse_args()
    rows = []
    for figure, file, table, row, column, most, unit in ASKED:
        found = find(arguments.folder, file, table, row)
        if found is None or found.get(column) is None:
            continue
        value = found[column]
        sample = value if isinstance(value, dict) else {"median": value, "low": value, "high": value}
        rows.append({"figure": figure, "asked": most, "unit": unit, **{k: sample[k] for k in ("median", "low", "high")},
                     "met": sample["median"] <= most})
    print("| figure | asked | median (range) | |\n|---|---|---|---|")
    for r in rows:
        found = f"{r['median']:.3g} ({r['low']:.3g}-{r['high']:.3g})"
        print(f"| {r['figure']} | <= {r['asked']:g} {r['unit']} | {found} | {'met' if r['met'] else 'NOT met'} |")
    if arguments.json:
        with open(arguments.json, "w") as stream:
            json.dump({"program": "asked.py", "tables": [{"name": "asked", "rows": rows}]}, stream, indent=1)
    return 0 if all(r["met"] for r in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
