#!/usr/bin/env python3
"""Scores the answers of another program against the reference set of this folder; needs the Python standard library alone.

  python3 score.py ANSWERS                        a folder with NAME.csv and NAME.json for the cases that were done
  python3 score.py ANSWERS --tolerance 1e-4       forces in mean forces, loads relative to the largest (default 1e-6)
  python3 score.py ANSWERS --all --json           cases without an answer are wrong; a JSON object for programs

NAME.csv: a row of names, then one row per contact: `i`, `j` and `force`; in a cell also `mx`, `my` (of spheres `mz`), the periods by
which the second grain is moved. Grains count from 0; a wall is j = left, bottom, right, top, of spheres back, front, or -1 to -6 in that order
of left, bottom, right, top, back, front. Other columns are not looked at: what `isostat inspect --contacts` writes is such a table.
NAME.json, every key optional: {"interval": [low, high], "opens": ["3-7", "0-left"], "sequence": [{"load": 1.128, "opens": "3-7"}, ...]}:
the range of the loaded stress under which the contacts hold, what opens at its ends, and, of cases with a sequence, the load at which
each structure ends and what opens there. Null is unbounded.

Exit status: 0 all answers are right, 1 one is wrong, 65 a file cannot be read."""
import argparse
import csv
import json
import pathlib
import re
import sys
from fractions import Fraction

here = pathlib.Path(__file__).resolve().parent
walls = {-1: "left", -2: "bottom", -3: "right", -4: "top", -5: "back", -6: "front"}


class Bad(Exception):
    """A file that cannot be read: file, what, what was expected."""


def number(value, where):
    try:
        found = Fraction(str(value))
    except (ValueError, ZeroDivisionError):
        raise Bad(f"{where}: {value!r}: expected a finite number") from None
    return found


def name_of(i, j, image):
    """One spelling for one contact: "3-7", "3-8(1,0)", "3-left"."""
    if isinstance(j, str):
        return f"{i}-{j}"
    turned = i > j or (i == j and next((m for m in image if m), 1) < 0)
    i, j, image = (j, i, [-m for m in image]) if turned else (i, j, image)
    return f"{i}-{j}" + (f"({','.join(map(str, image))})" if any(image) else "")


def spelt(name, where):
    """The same of a name that somebody wrote."""
    match = re.fullmatch(r"\s*(\d+)\s*-\s*(?:(\d+)\s*(?:\(([-\d, ]+)\))?|(\w+))\s*", str(name), re.ASCII)
    if not match or (match[4] and match[4] not in walls.values()):
        raise Bad(f"{where}: contact {name!r}: expected 3-7, 3-8(1,0) or 3-left")
    image = [int(m) for m in match[3].split(",")] if match[3] else []
    return name_of(int(match[1]), match[4] or int(match[2]), image)


def row_name(row, where):
    try:
        image = [int(row[name]) for name in ("mx", "my", "mz") if row.get(name)]
        word = row["j"].strip()
        if word not in walls.values():
            word = int(word)
            word = walls[word] if word < 0 else word
        return name_of(int(row["i"]), word, image)
    except (KeyError, ValueError, AttributeError):
        raise Bad(f"{where}: expected i, j, force, with j a grain or a wall") from None


def read_table(path):
    """Forces by contact."""
    forces = {}
    with open(path, newline="") as file:
        rows = csv.DictReader((line for line in file if not line.startswith("#")), skipinitialspace=True)
        if not {"i", "j", "force"} <= set(rows.fieldnames or []):
            raise Bad(f"{path}: columns {rows.fieldnames}: expected i, j, force")
        for line, row in enumerate(rows, 2):
            where = f"{path}:{line}"
            name = row_name(row, where)
            if name in forces:
                raise Bad(f"{where}: contact {name} comes twice")
            forces[name] = number(row["force"], where)
    return forces


def few(names):
    names = sorted(names)
    return " ".join(names[:6]) + (f" and {len(names) - 6} more" if len(names) > 6 else "")


def same_load(given, known, scale, tolerance):
    if given is None or known is None:
        return given is None and known is None
    return abs(given - known) <= tolerance * scale


def score_contacts(case, forces, tolerance):
    """Wrong things of a table, and the largest error of a force in mean forces."""
    known = {name: Fraction(force) for name, force in case["forces"].items()}
    carrying = {name for name, force in known.items() if force != 0}
    mean = sum(known[name] for name in carrying) / len(carrying)
    wrong = []
    if missing := carrying - forces.keys():
        wrong.append(f"contacts missing: {few(missing)}")
    if extra := {name for name, force in forces.items() if name not in carrying and abs(force) > tolerance * mean}:
        wrong.append(f"contacts with a force that has none: {few(extra)}")
    errors = {name: abs(forces[name] - known[name]) / mean for name in carrying & forces.keys()}
    worst = max(errors, key=errors.get, default=None)
    largest = errors[worst] if worst else Fraction(0)
    if largest > tolerance:
        wrong.append(f"forces: {worst} is {float(forces[worst]):.9g}, reference {float(known[worst]):.9g}, {float(largest):.2g} of a mean force")
    return wrong, largest


def score_interval(case, answer, where, tolerance):
    wrong, error = [], Fraction(0)
    ends = [None if end is None else number(end, where) for end in case["interval"]]
    scale = max([abs(end) for end in ends if end is not None] + [number(case["load"], where)])
    if "interval" in answer:
        given = answer["interval"]
        if not isinstance(given, list) or len(given) != 2:
            raise Bad(f"{where}: interval {given!r}: expected [low, high]")
        for side, value, known in zip(("low", "high"), given, ends):
            value = None if value is None else number(value, where)
            if not same_load(value, known, scale, tolerance):
                wrong.append(f"interval, {side}: {value and float(value)}, reference {known and float(known)}")
            elif known is not None:
                error = max(error, abs(value - known) / scale)
    if "opens" in answer:
        if not isinstance(answer["opens"], list) or len(answer["opens"]) != 2:
            raise Bad(f"{where}: opens {answer['opens']!r}: expected [low, high]")
        for side, value, known in zip(("low", "high"), answer["opens"], case["opens"]):
            if (value is None) != (not known) or (value is not None and spelt(value, where) not in known):
                wrong.append(f"opens, {side}: {value}, reference {' or '.join(known) or None}")
    return wrong, error


def score_sequence(case, answer, where, tolerance):
    wrong = []
    known, given = case.get("sequence", []), answer.get("sequence")
    if given is None:
        return wrong
    if not isinstance(given, list) or not all(isinstance(step, dict) for step in given):
        raise Bad(f"{where}: sequence: expected a list of objects")
    for number_of, (step, right) in enumerate(zip(given, known)):
        load = Fraction(right["load"])
        if not same_load(number(step.get("load"), where), load, abs(load), tolerance):
            wrong.append(f"sequence, structure {number_of}: ends at {step.get('load')}, reference {float(load):.12g}")
        elif "opens" in step and spelt(step["opens"], where) not in right["opens"]:
            wrong.append(f"sequence, structure {number_of}: {step['opens']} opens, reference {' or '.join(right['opens'])}")
        if wrong:
            return wrong  # another path from here on
    if len(given) != len(known):
        wrong.append(f"sequence: {len(given)} structures, reference {len(known)}")
    return wrong


def score(case, table, answer, tolerance=Fraction(1, 10**6), where="answer"):
    """What is wrong with an answer, in words, and its errors. `table`: forces by contact, or None; `answer`: an object, or {}."""
    wrong, force = score_contacts(case, table, tolerance) if table is not None else ([], None)
    more, interval = score_interval(case, answer, where, tolerance)
    wrong += more + score_sequence(case, answer, where, tolerance)
    return {"wrong": wrong, "force_error": None if force is None else float(force), "interval_error": float(interval)}


def read_case(name):
    case = json.loads((here / "packings" / f"{name}.json").read_text())
    if "sequence" in case:
        with open(here / "sequences" / f"{name}.csv", newline="") as file:
            case["sequence"] = [{"load": row["load"], "opens": row["opens"].split(" or ")} for row in csv.DictReader(file)]
    return case


def names():
    return sorted(path.stem for path in (here / "packings").glob("*.json"))


def read_object(path):
    try:
        answer = json.loads(path.read_text(), parse_float=Fraction, parse_int=Fraction, parse_constant=lambda word: word)
    except (ValueError, UnicodeDecodeError) as error:
        raise Bad(f"{path}: {error}") from None
    if not isinstance(answer, dict):
        raise Bad(f"{path}: expected an object")
    if unknown := answer.keys() - {"interval", "opens", "sequence"}:
        raise Bad(f"{path}: unknown key {unknown.pop()!r}: expected interval, opens, sequence")
    return answer


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("answers", type=pathlib.Path)
    parser.add_argument("--tolerance", type=Fraction, default=Fraction(1, 10**6))
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args(arguments)
    results = {}
    try:
        if not options.answers.is_dir():
            raise Bad(f"{options.answers}: expected a folder with NAME.csv and NAME.json")
        for name in names():
            table, answer = options.answers / f"{name}.csv", options.answers / f"{name}.json"
            if table.is_file() or answer.is_file():
                results[name] = score(read_case(name), read_table(table) if table.is_file() else None,
                                      read_object(answer) if answer.is_file() else {}, options.tolerance, str(answer))
            elif options.all:
                results[name] = {"wrong": ["no answer"], "force_error": None, "interval_error": None}
        if not results:
            raise Bad(f"{options.answers}: has no answer: expected {names()[0]}.csv or {names()[0]}.json, for one of {len(names())} cases")
    except (Bad, OSError) as error:
        print(error, file=sys.stderr)
        return 65
    right = sum(not result["wrong"] for result in results.values())
    if options.json:
        print(json.dumps({"right": right, "answers": len(results), "cases": results}, indent=1))
    else:
        for name, result in results.items():
            shown = "" if result["force_error"] is None else f", force error {result['force_error']:.1e} of a mean force"
            print(f"{name:<28} {'; '.join(result['wrong']) if result['wrong'] else 'right' + shown}")
        print(f"{right} of {len(results)} right, of {len(names())} cases")
    return 0 if right == len(results) else 1


if __name__ == "__main__":
    sys.exit(main())
