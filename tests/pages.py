#!/usr/bin/env python3
"""Links of the pages, and numbers that one page quotes from another, or from a table that a program wrote:  python3 -B tests/pages.py [PROJECT]

What a test of the program holds is not here: commands, keys, columns and what README's first run prints (tests/cli, tests/python)."""
import collections
import decimal
import json
import pathlib
import re
import sys

import static_site

top = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
wrong = []


def read(name):
    return (top / name).read_text()


def expect(there, what):
    if not there:
        wrong.append(what)


def rows(page, head):
    """The cells of the rows below a row of names that begins with `head`."""
    found = []
    lines = read(page).split("\n")
    begin = next((k for k, line in enumerate(lines) if line.startswith(head)), None)
    if begin is None:
        wrong.append(f"{page}: no table {head}")
        return found
    for line in lines[begin + 2:]:
        if not line.startswith("|"):
            break
        found.append([cell.strip() for cell in line.strip("|").split("|")])
    return found


def lammps():
    """README's rows are those of step 0.01, rounded."""
    known = {row[0]: row for row in rows("src/compare/README.md", "| kn / P | step | samples, frames |") if row[1] == "0.01" and "n =" not in row[0]}
    shown = rows("README.md", "| kn / P | frames on the exact list |")
    expect([row[0] for row in shown] == list(known), f"README: kn/P {[row[0] for row in shown]}, src/compare has {list(known)}")
    for stiffness, same, error, following, lammps_time, exact_time in shown:
        _, _, frames, same_known, *_, = row = known[stiffness]
        following_known, error_known, seconds, exact = row[8], row[10], row[12], row[13]
        expect(same == f"{same_known.rstrip('%')} % of {frames.split(', ')[1]}", f"README, LAMMPS at {stiffness}: {same}, src/compare {same_known} of {frames}")
        expect(following == following_known, f"README, LAMMPS at {stiffness}: {following}, src/compare {following_known}")
        for text, source in ((error, error_known), (lammps_time.rstrip(" s"), seconds.rstrip(" s")), (exact_time.rstrip(" s"), exact.rstrip(" s"))):
            digits = max(1, len(re.sub(r"e.*|\.|^0+", "", text.replace("0.0", ""))))
            rounded = decimal.Context(prec=digits, rounding=decimal.ROUND_HALF_UP).create_decimal(source)
            expect(decimal.Decimal(text) == rounded, f"README, LAMMPS at {stiffness}: {text}, src/compare {source}")


def biaxial():
    """README's table is a part of that of examples."""
    head = "| n | φ at start"
    whole = {row[0]: row for row in rows("examples/README.md", head)}
    for row in rows("README.md", head):
        known = whole.get(row[0], [""] * 9)
        expect(row == known[:5] + known[6:8], f"README, biaxial test: {row}, examples/README {known}")


def samples_of_the_paper():
    totals = [sum(int(number) for number in column) for column in zip(*[
        (row[1], row[5].split(" of ")[0], row[5].split(" of ")[1]) for row in rows("examples/paper/results/summary.md", "| n | samples |")])]
    page = re.sub(r"\s+", " ", read("examples/README.md"))
    expect(f"{totals[0]} samples of" in page and f"all {totals[1]:,} equilibria proved".replace(",", " ") in page and totals[1] == totals[2],
           f"examples/README: expected {totals[0]} samples, {totals[1]} of {totals[2]} equilibria proved")


def extremes():
    words = collections.Counter(re.match(r"\w+", row[3])[0] for row in rows("tests/extreme/extremes.md", "| family | case |") if len(row) > 3)
    page = read("README.md")
    expected = (f"[{sum(words.values())} extreme cases](tests/extreme/extremes.md)): {words['proved']} proved, {words['refuted']} refuted, "
                f"{words['undecided']} undecided and {words['refused']} refused with the reason; no outcome contradicts the independent check named in its row")
    expect(expected in page, f"README: expected '{expected}'")


def mutants():
    found = rows("tests/mutants/README.md", "| mutant | result |")
    killed = sum(row[1].startswith("killed") for row in found)
    expect(len(json.loads(read("tests/mutants/table.json"))) == len(found), f"tests/mutants: {len(found)} rows, and another number in table.json")
    expected = f"Of {len(found)} [breakages on purpose](tests/mutants/README.md) the tests notice {killed}; {len(found) - killed} no test notices"
    expect(expected in read("README.md"), f"README: expected '{expected}'")


def reference():
    cases = read("examples/reference/cases.csv").strip().split("\n")[1:]
    paths = sum(not line.endswith(",0") for line in cases)
    words = {5: "five", 6: "six", 7: "seven", 30: "Thirty", 31: "Thirty-one"}
    page = read("examples/reference/README.md")
    expect(f"{words.get(len(cases))} packings" in page and f"{words.get(paths)} sequences" in page, f"examples/reference/README: {len(cases)} packings, {paths} sequences")


def headers():
    count = len(list((top / "include/isostat").glob("*/*.hpp")))
    expect(f"{count} public headers" in read("CHANGELOG.md"), f"CHANGELOG: there are {count} public headers")


def links():
    """They lead to files that are there, and to headings that these have."""
    static_site.top, seen = top, 0
    for page in static_site.pages():
        for _, target, _ in static_site.link.findall(page.read_text()):
            name, mark, anchor = target.partition("#")
            there = page.parent / name if name else page
            if "://" not in target:
                seen += 1
                expect(there.exists(), f"{page.relative_to(top)} links to {target}")
                if mark and there.suffix == ".md" and there.exists():
                    headings = re.findall(r"^#+ (.*)", re.sub(r"^```.*?^```", "", there.read_text(), flags=re.M | re.S), re.M)
                    expect(anchor in map(static_site.slugify, headings), f"{page.relative_to(top)} links to {target}: no such heading")
    expect(seen > 100, f"{seen} links")


for check in (lammps, biaxial, samples_of_the_paper, extremes, mutants, reference, headers, links):
    check()
print(*wrong, sep="\n", end="\n" if wrong else "")
sys.exit(1 if wrong else 0)
