#!/usr/bin/env python3
"""Every number in the rooms that prove something has a mark: a comment that says where the number comes from.

  python3 proofs/constants.py           exit 1 unless each number has its mark, and each mark its number
  python3 proofs/constants.py --list    prints file, line, number and mark, separated by tabs

A mark is a part of a // comment, at the line of the number or directly above; "; " separates the parts of a comment:
  page.md LABEL ...        a statement: the page of proofs/ has the word LABEL, and says the number after the
                           heading or bold words with LABEL, or in a paragraph with LABEL
  cost: ...                changes how long it takes, or when something is given up as undecided, and no answer
  choice: ...              a choice that pages call one (a rule, a default, a limit of a record)
  exact: ...               a factor or size that is exact (a half, the bits of a type, a format)
  guess: ...               enters a guess only, which is checked afterwards
  message: ...             is printed
One mark holds for the numbers of its line that have none of their own. "0.5: exact: a half" is the mark of 0.5 from there to the
end of the function; "guess: all other numbers of this file: ..." holds for the file. 0, 1 and 2 have no mark (indices, squares,
signs), nor have comments and strings."""
import functools
import pathlib
import re
import sys

top = pathlib.Path(__file__).resolve().parent.parent
rooms = "core verified motion certificate checker contact statics".split()
trivial = {"0", "1", "2", "0.0", "1.0", "2.0"}
digits = r"(?:0[xX][0-9a-fA-F.']+(?:[pP][+-]?\d+)?|(?:\d[\d']*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
number = re.compile(rf"(?<![\w.])({digits})[fFlLuUzZ]*(?![\w.])")
silent = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])'|^[ \t]*#[^\n]*""", re.S | re.M)
whole_file = re.compile(r"(?:cost|exact|guess): all other numbers of this file: .+")
mark = re.compile(rf"(?:({digits}): )?((?:cost|choice|exact|guess|message): .+|(\w+\.md) ([\w-]+).*)")


def comments(lines):
    """The text of the // comment of each line, and whether the line is nothing else."""
    for line in lines:
        bare = re.sub(r'"(?:\\.|[^"\\])*"', lambda m: "_" * len(m[0]), line)
        at = bare.find("//")
        yield ("", False) if at < 0 else (line[at:].lstrip("/!< "), not line[:at].strip())


def marks_of(text):
    """(number or nothing, reason, problem or nothing) for each mark of a comment."""
    for part in text.split("; "):
        if found := mark.fullmatch(part.strip()):
            page, label = found[3], found[4]
            problem = None
            if page and not (top / "proofs" / page).is_file():
                problem = f"proofs/{page} is no page"
            elif page and not re.search(rf"(?<!\w){re.escape(label)}(?!\w)", (top / "proofs" / page).read_text()):
                problem = f"proofs/{page} has no '{label}'"
            yield found[1], found[2], problem


words = dict(enumerate("three four five six seven eight nine ten eleven twelve".split(), 3))
shares = {1 / 2: "hal(f|ves|ved)|1/2", 1 / 4: "quarter|1/4", 1 / 10: "tenth", 1 / 100: "hundredth", 16: "sixteenth"}
starts = re.compile(r"^(?=#{2,} |\*\*[A-Z]+\d)", re.M)


def spellings(n):
    """A regular expression for the ways to write a number of the code on a page, where u is 2^-53."""
    value = float.fromhex(n) if n[:2].lower() == "0x" else float(n.replace("'", ""))
    units = value * 2.0**53
    ways = [re.escape(n), re.escape(f"{value:g}"), words.get(value), shares.get(value)]
    ways += [rf"2\^{re.escape(power)}" for power in re.findall(r"^0x1p(.+)", n)]
    ways += [rf"10\^{re.escape(power)}" for power in re.findall(r"^1e(.+)", n)]
    ways += [f"{units:.0f} ?u"] if "p" in n and 1 < units < 1e6 else []
    return rf"(?<![\w.])({'|'.join(filter(None, ways))})(?!\w?\.?\d)"


@functools.lru_cache(None)
def statement(page, label):
    """What follows the headings and the bold words with the label, or else all paragraphs with it."""
    text = (top / "proofs" / page).read_text()
    has = re.compile(rf"(?<!\w){re.escape(label)}(?!\w)")
    parts = [part for part in starts.split(text) if has.search(re.match(r"(#{2,}.*|\*\*.*?\*\*)?", part)[0])]
    return "\n".join(parts or [part for part in text.split("\n\n") if has.search(part)])


def unsaid(n, reason):
    """Where the mark of a number names a statement that does not say the number, the words for this."""
    page, label = mark.fullmatch(reason).group(3, 4)
    said = not page or not (top / "proofs" / page).is_file() or re.search(spellings(n), statement(page, label), re.I)
    return [] if said else [f"proofs/{page}, {label}, does not say {n}"]


def check(path):
    """Rows (line, number, reason) and faults (line, text) of one file."""
    source = path.read_text()
    code = silent.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), source).split("\n")
    rows, faults, named, above, others = [], [], {}, [], None
    for at, (text, (comment, alone)) in enumerate(zip(code, comments(source.split("\n"))), 1):
        if alone:
            above.append(comment)
            continue
        marks = [*marks_of("".join(f"; {line}" if mark.match(line) else f" {line}" for line in above)), *marks_of(comment)]
        above = []
        faults += [(at, problem) for *_, problem in marks if problem]
        named.update({what: [reason, at, False] for what, reason, _ in marks if what})
        unnamed = [reason for what, reason, _ in marks if not what]
        if unnamed and whole_file.fullmatch(unnamed[0]):
            others, unnamed = [unnamed[0], at, False], unnamed[1:]
        unmarked = False
        for n in dict.fromkeys(number.findall(text)):
            if n in trivial:
                continue
            if n in named:
                named[n][2] = True
                rows.append((at, n, named[n][0]))
            elif len(unnamed) == 1:
                unmarked = True
                rows.append((at, n, unnamed[0]))
            elif others and not unnamed:
                others[2] = True
                rows.append((at, n, others[0]))
            else:
                faults.append((at, f"{n} has no mark of its own"))
        if unnamed and not unmarked:
            faults.append((at, f"'{'; '.join(unnamed)}' belongs to no number"))
        if text.startswith("}"):
            faults += unused(named)
            named = {}
    faults += [(at, problem) for at, n, reason in rows for problem in unsaid(n, reason)]
    return rows, faults + unused(named) + (unused({"all": others}) if others else [])


def unused(named):
    return [(line, f"'{n}: {reason}' belongs to no number") for n, (reason, line, used) in named.items() if not used]


def main():
    listed, wrong, files = 0, 0, 0
    for room in rooms:
        for folder in (top / "src" / room, top / "include/isostat" / room):
            for path in sorted(folder.rglob("*.[ch]pp")):
                rows, faults = check(path)
                listed, files, wrong = listed + len(rows), files + bool(rows), wrong + len(faults)
                for line, n, reason in rows if "--list" in sys.argv else ():
                    print(path.relative_to(top), line, n, reason, sep="\t")
                for line, text in faults:
                    print(f"{path.relative_to(top)}:{line}: {text}: {path.read_text().splitlines()[line - 1].strip()}")
    if "--list" not in sys.argv:
        print(f"{listed} numbers in {files} files: {'each has a mark' if not wrong else f'{wrong} faults (see proofs/constants.py)'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
