#!/usr/bin/env python3
"""No room includes a higher one (the order is that of CONTRIBUTING.md), public headers include public ones only, and the
umbrella has them all:  python3 tests/rooms.py [the tree]"""
import pathlib
import re
import sys

top = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
order = re.search(r"only rooms to its left: `([a-z, ]+)`", (top / "CONTRIBUTING.md").read_text())[1].split(", ")
wrong = []
for folder in (top / "include/isostat", top / "src"):
    for path in sorted(folder.rglob("*.[ch]pp")):
        room = path.relative_to(folder).parts[0]
        for line in path.read_text().splitlines():
            included = re.match(r'#include (?:<isostat/|")(\w+)/', line)
            if included and room in order and included[1] not in order[: order.index(room) + 1]:
                wrong.append(f"{path.relative_to(top)}: {line}: {room} is not to the right of {included[1]}")
            if folder.name == "isostat" and line.startswith('#include "'):
                wrong.append(f"{path.relative_to(top)}: {line}: a private header in a public one")
public = sorted(str(path.relative_to(top / "include")) for path in (top / "include/isostat").glob("*/*.hpp"))
umbrella = (top / "include/isostat/isostat.hpp").read_text()
wrong += [f"isostat.hpp does not include {header}" for header in public if f"#include <{header}>\n" not in umbrella]
if wrong:
    sys.exit("\n".join(wrong))
print(f"{len(order)} rooms in order, {len(public)} public headers")
