#!/usr/bin/env python3
"""Checks what the pages of proofs/ name, so that no link rots: exit 1 and a list when something is missing.

  python3 proofs/check_links.py [TOP]     another top folder: for check_links_test.sh

  `name`, `other` (code)     some file of src, include, tests or examples has each name as a word outside of comments
  `name`, `other` (test)     a test case has this name; so functions and tests may move from file to file
  `name`, `other` (src|include|tests|proofs|examples/... file)
                             the file exists and has each name; one in a .v file must be stated there, one in a
                             test_*.cpp file be a test case
  (Coq: `name`, ...)         some file of proofs/coq states it
  word.md, coq/word.v        exists in proofs/
  @key                       is in references.bib
Each file is read once."""
import functools
import pathlib
import re
import sys

top = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent).resolve()
names = r"`[A-Za-z_:0-9]+`"
group = re.compile(rf"({names}(?:(?:,| and|, and) {names})*) \((code|test|(?:src|include|tests|proofs|examples)/[A-Za-z0-9_/.-]+)\)")
wrong, checked = [], 0


def expect(there, words):
    global checked
    checked += 1
    if not there:
        wrong.append(words)


def read(path):
    return (top / path).read_text()


@functools.cache
def named_in(path):
    """The names that a file may be asked for, or all code, or all tests."""
    if path in ("code", "test"):
        folders = ("src", "include", "tests", "examples") if path == "code" else ("tests",)
        kinds = ("*.cpp", "*.hpp", "*.py") if path == "code" else ("test_*.cpp",)
        files = [file for folder in folders for kind in kinds for file in (top / folder).rglob(kind)]
        return set().union(*(named_in(str(file.relative_to(top))) for file in files))
    text = read(path)
    if path.endswith(".v"):
        return set(re.findall(r"^(?:Theorem|Lemma|Corollary|Fact) (\w+)", text, re.M))
    if re.search(r"/test_[^/]*\.cpp$", path):
        return set(re.findall(r"_TEST_CASE(?:_[A-Z]+)?\((\w+)", text))
    return set(re.findall(r"\w+", re.sub(r"//.*", "", text)))


def check_page(page, coq):
    text = read(page)
    flat = re.sub(r"[ \n]+", " ", text)
    for listed, path in group.findall(flat):
        if path not in ("code", "test") and not (top / path).is_file():
            wrong.append(f"{page}: no file {path}")
            continue
        has = "states no" if path.endswith(".v") else "has no test case" if "/test_" in path or path == "test" else "has no"
        for name in re.findall(r"`([^`]+)`", listed):
            expect(name.split("::")[-1] in named_in(path), f"{page}: {path} {has} {name}")
    for listed in re.findall(r"Coq: (`[a-z0-9_]+`(?:, `[a-z0-9_]+`)*)", flat):
        for name in re.findall(r"`([^`]+)`", listed):
            expect(any(name in named_in(file) for file in coq), f"{page}: no Coq statement {name}")
    for file in sorted(set(re.findall(r"\b(coq/[a-z_]+\.v|[a-z_]+\.md)\b", text))):
        expect((top / "proofs" / file).is_file(), f"{page}: no proofs/{file}")
    for key in sorted(set(re.findall(r"@([a-z]+[0-9]{4}[a-z]*)", text))):
        expect(f"{{{key}," in read("proofs/references.bib"), f"{page}: references.bib has no {key}")


def check_coq(coq, pages):
    project = read("proofs/coq/_CoqProject").split("\n")
    wrong.extend(f"_CoqProject: no {name}" for name in project if name.endswith(".v") and f"proofs/coq/{name}" not in coq)
    words = set(re.findall(r"\w+", "\n".join(map(read, pages))))
    for file in coq:
        expect(pathlib.Path(file).name in project, f"_CoqProject leaves out {file}")
        for name in re.findall(r"^(?:Theorem|Corollary) (\w+)", read(file), re.M):
            printed = f"\nPrint Assumptions {name}.\n" in read(file)
            expect(printed, f"{file}: the assumptions of {name} are not printed")
            expect(name in words, f"{file}: no page names {name}")


def main():
    pages, coq = ([str(path.relative_to(top)) for path in sorted(top.glob(kind))] for kind in ("proofs/*.md", "proofs/coq/*.v"))
    for page in pages:
        check_page(page, coq)
    check_coq(coq, pages)
    print(*wrong, sep="\n", end="\n" if wrong else "")
    print(f"{len(wrong)} of {checked} names in proofs/ lead nowhere" if wrong
          else f"{checked} names in proofs/ lead to a file, a function or a theorem")
    return 1 if wrong else 0


sys.exit(main())
