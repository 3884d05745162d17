#!/usr/bin/env python3
"""Every number in the rooms that prove something, with the statement it comes from.

  python3 proofs/constants.py           exit 1 unless proofs/constants.tsv says of every number in the code where it comes from
  python3 proofs/constants.py --where   prints the lines behind each entry that is missing, stale or counted otherwise
  python3 proofs/constants.py --count   takes over the counts of entries that are there (read what --where shows first)

A row of the table: file (its folder does not count: files may move), number as written, how often it is written there, and
why it is what it is; number * and 0 times: every number of a file that writes one format, say:
  page.md LABEL ...        a statement: the page of proofs/ has the word LABEL (several, separated by "; ", for several uses)
  cost: ...                changes how long it takes, or when something is given up as undecided, and no answer
  choice: ...              a choice that pages call one (a rule, a default, a limit of a record)
  exact: ...               a factor or size that is exact (a half, the bits of a type, a format)
  guess: ...               enters a guess only, which is checked afterwards
  message: ...             is printed
0, 1 and 2 are left out (indices, squares, signs), comments and strings too. A new number fails here until it has a row."""
import collections
import pathlib
import re
import sys

top = pathlib.Path(__file__).resolve().parent.parent
table = top / "proofs/constants.tsv"
rooms = "core verified motion certificate checker contact statics".split()
trivial = {"0", "1", "2", "0.0", "1.0", "2.0"}
kinds = ("cost", "choice", "exact", "guess", "message")
silent = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])'|^[ \t]*#[^\n]*""", re.S | re.M)
number = re.compile(r"(?<![\w.])(0[xX][0-9a-fA-F.']+(?:[pP][+-]?\d+)?|(?:\d[\d']*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)[fFlLuUzZ]*(?![\w.])")


def numbers():
    """(name of the file, number) -> file and line, for each time."""
    found = collections.defaultdict(list)
    for room in rooms:
        for folder in (top / "src" / room, top / "include/isostat" / room):
            for path in sorted(folder.rglob("*.[ch]pp")):
                text = silent.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), path.read_text())
                for line, code in enumerate(text.split("\n"), 1):
                    for match in number.finditer(code):
                        if match[1] not in trivial:
                            found[path.name, match[1]].append((path, line))
    return found


def rows():
    """(name of the file, number) -> how often, why; of files of one name together."""
    known, listed = {}, set()
    for line, text in enumerate(table.read_text().splitlines(), 1):
        cells = text.split("\t")
        if not text or text.startswith("#"):
            continue
        if len(cells) != 4 or not cells[2].isdigit() or (cells[0], cells[1]) in listed:
            sys.exit(f"proofs/constants.tsv:{line}: four cells separated by tabs, each file and number once, were expected")
        listed.add((cells[0], cells[1]))
        key = pathlib.PurePath(cells[0]).name, cells[1]
        count, reason = known.get(key, (0, ""))
        known[key] = count + int(cells[2]), f"{reason}; {cells[3]}" if reason else cells[3]
    return known


def problem_of(reason):
    """What is wrong with a reason, or nothing."""
    for part in reason.split("; "):
        kind, colon, words = part.partition(": ")
        if colon and kind in kinds:
            if not words.strip():
                return f"'{kind}' without a word"
            continue
        page, _, labels = part.partition(" ")
        if not page.endswith(".md") or not (top / "proofs" / page).is_file():
            return f"'{part}' names no page of proofs/"
        label = labels.split(",")[0].split(" (")[0].strip()
        if not label or not re.search(rf"(?<!\w){re.escape(label)}(?!\w)", (top / "proofs" / page).read_text()):
            return f"proofs/{page} has no '{label}'"
    return None


def main():
    found, known = numbers(), rows()
    if "--count" in sys.argv:
        text = [line for line in table.read_text().splitlines() if not line or line.startswith("#")]
        text += ["\t".join((*key, str(len(found[key])), known[key][1])) for key in sorted(known) if key in found]
        table.write_text("\n".join(text) + "\n")
        known = rows()
    whole = {name for name, number in known if number == "*"}
    wrong = []
    for key in sorted(set(found) | set(known)):
        where = f"{key[0]}: {key[1]}"
        if key not in known and key[0] in whole:
            continue
        if key not in known:
            wrong.append((key, f"{where} has no entry"))
        elif key not in found and not (key[1] == "*" and any(name == key[0] for name, _ in found)):
            wrong.append((key, f"{where} is in the table, but no longer in the code"))
        elif known[key][0] != len(found.get(key, [])):
            wrong.append((key, f"{where} is written {len(found[key])} times, {known[key][0]} in the table"))
        elif problem := problem_of(known[key][1]):
            wrong.append((key, f"{where}: {problem}"))
    for key, text in wrong:
        print(text)
        if "--where" in sys.argv:
            for path, line in dict.fromkeys(found.get(key, [])):
                print(f"    {path.relative_to(top)}:{line}: {path.read_text().splitlines()[line - 1].strip()}")
    if wrong:
        print(f"{len(wrong)} of {len(set(found) | set(known))} entries of proofs/constants.tsv are not right (see proofs/constants.py)")
        return 1
    print(f"{sum(map(len, found.values()))} numbers in {len({f for f, _ in found})} files: each has a statement or a reason")
    return 0


sys.exit(main())
