#!/usr/bin/env python3
"""The numbers of an extracted program are those of Coq:  python3 check_extraction.py [--mutants]

Coq and the program that it extracts (integers_in_zarith.v, arithmetic.v in questions/) compute the same list. With --mutants one
line of the mapping is made wrong at a time: the lists have to differ, or the program to fail. Exit status 1 otherwise."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).resolve().parent
MAPPING = "integers_in_zarith.v"
# What stands in the mapping exactly once, and what the mutant has.
MUTANTS = [
    ('"Zarith.zero" "Zarith.succ" ]', '"Zarith.one" "Zarith.succ" ]'),
    ("zero () else next (Zarith.pred k)", "zero () else next k"),
    ('"(fun p -> Zarith.succ (Zarith.shift_left p 1))"', '"(fun p -> Zarith.shift_left p 1)"'),
    ('"(fun p -> Zarith.shift_left p 1)" "Zarith.one"', '"(fun p -> Zarith.shift_left p 2)" "Zarith.one"'),
    ("then odd (Zarith.shift_right p 1) else even", "then even (Zarith.shift_right p 1) else odd"),
    ('"Zarith.zero" "" "Zarith.neg" ]', '"Zarith.zero" "" "" ]'),
    ("| _ -> negative (Zarith.neg k)", "| _ -> negative k"),
    ("if Zarith.sign k = 0 then zero () else positive k", "if Zarith.sign k = 1 then zero () else positive k"),
    ('int [ "0" "(-1)" "1" ]', 'int [ "0" "1" "(-1)" ]'),
    ('Init.Nat.add => "Zarith.add"', 'Init.Nat.add => "Zarith.sub"'),
    ("Zarith.max Zarith.zero (Zarith.sub a b)", "Zarith.sub a b"),
    ('eqn => "Zarith.equal"', 'eqn => "Zarith.leq"'),
    ("Zarith.shift_left a 1", "Zarith.shift_left a 2"),
    ('Pos.to_nat => "(fun p -> p)"', 'Pos.to_nat => "Zarith.pred"'),
    ('Pos.of_succ_nat => "Zarith.succ"', 'Pos.of_succ_nat => "(fun p -> p)"'),
    ('Pos.eqb => "Zarith.equal"', 'Pos.eqb => "Zarith.leq"'),
    ('Pos.compare => "Zarith.compare"', 'Pos.compare => "(fun a b -> Zarith.compare b a)"'),
    ('Z.add => "Zarith.add"', 'Z.add => "(fun a b -> Zarith.signed_extract (Zarith.add a b) 0 63)"'),
    ('Z.mul => "Zarith.mul"', 'Z.mul => "(fun a b -> Zarith.of_int (Zarith.to_int a * Zarith.to_int b))"'),
    ('Z.compare => "Zarith.compare"', 'Z.compare => "(fun a b -> Zarith.compare a (Zarith.abs b))"'),
    ('andb => "(&&)"', 'andb => "(||)"'),
    ('orb => "(||)"', 'orb => "(&&)"'),
]


def results(folder):
    """Those of Coq and those of the program."""
    def run(*command, limit=600):
        return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=limit)

    for name in (MAPPING, "arithmetic.v"):
        coq = run("coqc", "-q", "-noglob", "-Q", ".", "Data", "-w", "none", name)
        if coq.returncode != 0:
            sys.exit(f"{name}: {coq.stderr}")
    compiled = run("ocamlfind", "ocamlopt", "-package", "zarith", "-linkpkg", "-w", "-a", "zarith.ml", "arithmetic.mli", "arithmetic.ml",
                   "arithmetic_test.ml", "-o", "arithmetic")
    if compiled.returncode != 0:
        sys.exit(f"OCaml: {compiled.stderr}")
    try:
        program = run("bash", "-c", "ulimit -v 4000000; ./arithmetic", limit=20).stdout.split()
    except subprocess.TimeoutExpired:
        program = []
    return re.findall(r"-?\d+", coq.stdout.split("\n     : ")[0]), program


def main(folder, *mutants):
    for file in [*(here / "questions" / name for name in (MAPPING, "arithmetic.v")), *(here / "extracted").glob("*.ml")]:
        shutil.copy(file, folder)
    coq, program = results(folder)
    if coq != program or not coq:
        sys.exit(f"{len(coq)} results of Coq and {len(program)} of the extracted program: they differ")
    print(f"{len(coq)} results of arithmetic: those of Coq are those of the extracted program")
    mapping = (here / "questions" / MAPPING).read_text()
    survivors = 0
    for text, mutant in MUTANTS if mutants == ("--mutants",) else []:
        if mapping.count(text) != 1:
            sys.exit(f"'{text}' stands {mapping.count(text)} times in {MAPPING}, expected once")
        (folder / MAPPING).write_text(mapping.replace(text, mutant))
        coq, program = results(folder)
        survivors += coq == program
        print(f"{mutant}: {'NOT SEEN' if coq == program else 'seen'}", flush=True)
    sys.exit(survivors > 0)


with tempfile.TemporaryDirectory() as made:
    main(pathlib.Path(made), *sys.argv[1:])
