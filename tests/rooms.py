#!/usr/bin/env python3
"""No room includes a later one of src/rooms.txt, public headers include public ones only, the
umbrella has them all, and a type has one definition:  python3 tests/rooms.py [the tree]"""
import collections
import pathlib
import re
import sys

top = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
order = (top / "src/rooms.txt").read_text().split()
wrong = []
for folder in (top / "include/isostat", top / "src"):
    for path in sorted(folder.rglob("*.[ch]pp")):
        room = path.relative_to(folder).parts[0]
        for line in path.read_text().splitlines():
            included = re.match(r'#include (?:<isostat/|")(\w+)/', line)
            if included and room in order and included[1] not in order[: order.index(room) + 1]:
                wrong.append(f"{path.relative_to(top)}: {line}: {room} comes before {included[1]} in src/rooms.txt")
            if folder.name == "isostat" and line.startswith('#include "'):
                wrong.append(f"{path.relative_to(top)}: {line}: a private header in a public one")
public = sorted(str(path.relative_to(top / "include")) for path in (top / "include/isostat").glob("*/*.hpp"))
umbrella = (top / "include/isostat/isostat.hpp").read_text()
wrong += [f"isostat.hpp does not include {header}" for header in public if f"#include <{header}>\n" not in umbrella]
# What goes to the terminal passes `say`, which makes the text of files and names harmless.
for path in sorted((top / "src").rglob("*.[ch]pp")):
    if re.search(r"fmt::v?print\b|std::c(?:out|err)\b|std::printf", path.read_text()) and path.name != "terminal.hpp":
        wrong.append(f"{path.relative_to(top)}: prints past cli/terminal.hpp")
# Two types of one name in one namespace are one type to the linker, which does not say so.
types = collections.defaultdict(set)
for folder in (top / "include/isostat", top / "src"):
    for path in folder.rglob("*.[ch]pp"):
        namespace = [""]
        for line in path.read_text().splitlines():
            if opened := re.match(r"namespace ([\w:]*) ?\{$", line):
                namespace.append(opened[1] or str(path)) # of a file alone
            elif line.startswith("} // namespace"):
                namespace.pop()
            elif defined := re.match(r"(?:template <[^>]*> )?(?:struct|class|enum class) (\w+)(?: final)?(?: : .*)? \{", line):
                types[namespace[-1], defined[1]].add(str(path.relative_to(top)))
wrong += [f"{name}: defined in {' and in '.join(sorted(files))}" for (_, name), files in types.items() if len(files) > 1]
if wrong:
    sys.exit("\n".join(wrong))
print(f"{len(order)} rooms in order, {len(public)} public headers, {len(types)} types")
