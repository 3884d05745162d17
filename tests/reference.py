#!/usr/bin/env python3
"""The reference set of examples/reference: its scorer accepts the right answers and refuses altered ones, and its numbers are those of its
certificates, which are verified:  python3 -B tests/reference.py isostat PROJECT"""
import contextlib
import copy
import csv
import decimal
import importlib.util
import io
import json
import pathlib
import re
import subprocess
import sys
import tempfile

program, project = sys.argv[1], pathlib.Path(sys.argv[2])
folder = project / "examples/reference"


def module(name):
    spec = importlib.util.spec_from_file_location(name, folder / f"{name}.py")
    loaded = importlib.util.module_from_spec(spec)
    sys.argv = [name, program]
    spec.loader.exec_module(loaded)
    return loaded


score, make = module("score"), module("make")


def answer_of(case):
    """The right answer, as a program in double precision gives it."""
    answer = {"interval": [end and float(end) for end in case["interval"]], "opens": [names[0] if names else None for names in case["opens"]]}
    if "sequence" in case:
        answer["sequence"] = [{"load": float(step["load"]), "opens": step["opens"][0]} for step in case["sequence"]]
    return answer


def rows_of(name):
    with open(folder / "packings" / f"{name}.csv", newline="") as file:
        return [{**row, "force": repr(float(row["force"]))} for row in csv.DictReader(file)]


def scored(cases):
    """Exit status and words of the scorer for answers {name: (rows, answer)}."""
    with tempfile.TemporaryDirectory() as made:
        for name, (rows, answer) in cases.items():
            if rows is not None:
                with open(pathlib.Path(made) / f"{name}.csv", "w", newline="") as file:
                    table = csv.DictWriter(file, rows[0].keys())
                    table.writeheader()
                    table.writerows(rows)
            (pathlib.Path(made) / f"{name}.json").write_text(answer if isinstance(answer, str) else json.dumps(answer))
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            status = score.main([made])
        return status, said.getvalue()


def expect(there, what):
    if not there:
        sys.exit(what)


def right_answers_are_accepted(names):
    status, words = scored({name: (rows_of(name), answer_of(score.read_case(name))) for name in names})
    expect(status == 0 and f"{len(names)} of {len(names)} right" in words, words)


def altered_answers_are_refused(names):
    count = 0
    for name in names:
        case = score.read_case(name)
        rows, answer = rows_of(name), answer_of(case)
        mean = sum(float(row["force"]) for row in rows) / sum(row["force"] != "0.0" for row in rows)
        first = next(k for k, row in enumerate(rows) if float(row["force"]) != 0)

        def refused(change, word):
            nonlocal count
            other_rows, other = copy.deepcopy(rows), copy.deepcopy(answer)
            change(other_rows, other)
            status, words = scored({name: (other_rows, other)})
            expect(status == 1 and word in words, f"{name}: {word}: {status}: {words}")
            count += 1

        def pressed(row):
            row["force"] = repr(float(row["force"]) + 3e-6 * mean)

        refused(lambda r, a: r.pop(first), "contacts missing")
        refused(lambda r, a: r[first].update(j="0" if r[first]["i"] != "0" else "1", mx="2"), "contacts")
        refused(lambda r, a: pressed(r[first]), "forces")
        side = 0 if answer["interval"][0] is not None else 1
        refused(lambda r, a: a["interval"].__setitem__(side, a["interval"][side] + 3e-6 * max(float(case["load"]), *(abs(e) for e in a["interval"] if e is not None))), "interval")
        refused(lambda r, a: a["interval"].__setitem__(1, None if a["interval"][1] is not None else 9.5), "interval, high")
        refused(lambda r, a: a["opens"].__setitem__(side, "0-1" if "0-1" not in case["opens"][side] else "0-2"), "opens")
        if "sequence" in case:
            refused(lambda r, a: a["sequence"].pop(), "structures")
            refused(lambda r, a: a["sequence"][1].update(load=a["sequence"][1]["load"] * 1.00001), "structure 1")
            refused(lambda r, a: a["sequence"][2].update(opens="0-left"), "structure 2: 0-left")
    return count


def what_cannot_be_read_is_said(name):
    rows = rows_of(name)
    for table, answer, word in (
        (rows + rows[:1], {}, "comes twice"),
        ([{"i": "0", "j": "lid", "force": "1"}], {}, "expected i, j, force"),
        ([{"i": "0", "j": "1", "force": "nan"}], {}, "expected a finite number"),
        ([{"x": "0"}], {}, "expected i, j, force"),
        (None, "[1, 2", ""),
        (None, {"intervall": [0, 1]}, "unknown key"),
        (None, {"interval": [0]}, "expected [low, high]"),
        (None, '{"interval": [NaN, 1]}', "expected a finite number"),
        (None, {"opens": ["0 to 1", None]}, "expected 3-7"),
        (None, {"sequence": 3}, "expected a list"),
    ):
        status, words = scored({name: (table, answer)})
        expect(status == 65 and word in words, f"{word}: {status}: {words}")


def numbers_are_those_of_the_certificates(names):
    for name in names:
        file = folder / "certificates" / f"{name}.cert.json"
        done = subprocess.run([program, "verify", file], capture_output=True, text=True)
        expect(done.returncode == (2 if name.startswith("tie") else 0), f"{file}: {done.stdout}{done.stderr}")
        certificate = json.loads(file.read_text())
        expect(not certificate["state"].get("provenance"), f"{file} names folders of the computer that made it")
        case, at, forces = make.case_of(name, "", certificate["state"], certificate)
        kept = json.loads((folder / "packings" / f"{name}.json").read_text())
        for key in case.keys() - {"what"}:
            expect(case[key] == kept[key], f"{name}: {key}: kept {kept[key]}, of the certificate {case[key]}")
        expect([row["force"] for row in csv.DictReader(open(folder / "packings" / f"{name}.csv"))] == [make.short(force) for force in forces], name)
        gaps, matrix = at.rows()
        small = decimal.Decimal("1e-40")
        expect(max(map(abs, gaps)) < small, f"{name}: a gap of {max(map(abs, gaps))}")


def the_page_shows_right_answers():
    page = (folder / "README.md").read_text()
    shown = re.findall(r"^ +(\d+,\w+,[\d.]+)$", page, re.M)
    forces = {f"{row['i']},{row['j']}": float(row["force"]) for row in rows_of("box-20-1")}
    expect(len(shown) == 2 and all(abs(float(line.rpartition(",")[2]) - forces[line.rpartition(",")[0]]) < 1e-4 for line in shown), shown)
    object_ = json.loads(re.search(r"`(\{\"interval\".*?\})`", page)[1])
    step = json.loads(re.search(r"`\"sequence\": \[(\{.*?\})", page)[1])
    rough = score.Fraction(1, 10**4)
    wrong = score.score(score.read_case("box-20-1"), None, object_, rough)["wrong"]
    known = score.read_case("path-20-3")
    expect(not wrong and step["opens"] in known["sequence"][0]["opens"] and abs(step["load"] - float(known["sequence"][0]["load"])) < 1e-4, (wrong, step))


names = score.names()
expect(len(names) >= 30, f"{len(names)} cases")
right_answers_are_accepted(names)
altered = altered_answers_are_refused(names)
what_cannot_be_read_is_said(names[0])
the_page_shows_right_answers()
numbers_are_those_of_the_certificates(names)
size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
expect(size < 3_000_000, f"{size} bytes")
print(f"{len(names)} cases: right answers accepted, {altered} altered ones refused, certificates verified")
