#!/usr/bin/env python3
"""Weakens the checker that Coq proves, one place at a time: none of the weaker ones may still have a proof.

  python3 proofs/coq/mutants.py [NAME ...]     all mutants, or those whose names contain NAME

By night: four minutes of processor time. The sources are compiled in a folder that is removed afterwards; those of the project stay as they are. Of each
mutant the changed file is compiled again, with those that need it, until one of them fails. That has to be *after* the changed definition:
a mutant that is no definition at all says nothing. Exit status 1: a mutant still has a proof, or does not fit the sources."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).parent

# Name, file, what stands there exactly once, what the mutant has.
MUTANTS = [
    ("the derivative changes less", "box_certificate.v", "+ bend * bend * (ball v * ball v)", "+ bend * (ball v * ball v)"),
    ("one entry of a row of the defect counts", "sparse_rows.v", "foldr (fun e => Z.add (Z.abs e.2)) Z0 row", "foldr (fun e => Z.max (Z.abs e.2)) Z0 row"),
    ("the defect without a shift", "box_certificate.v", "(diagonal N (- shift v))", "(diagonal N 0)"),
    ("gaps may be twice as large", "box_certificate.v", "<=? 2 * (fine_stiffness * error v)", "<=? 4 * (fine_stiffness * error v)"),
    ("the chord may take larger steps", "box_certificate.v", "4 * bend * error v <=? fine_stiffness &", "bend * error v <=? fine_stiffness &"),
    ("the ball does not hold the vertex", "box_certificate.v", "(distance v + error v <=?", "(distance v <=?"),
    ("radii may be 0", "box_certificate.v", "all (Z.ltb 0) (radii v)", "all (Z.leb 0) (radii v)"),
    ("a gap with the squares of the radii", "box.v", "- (radius i + radius j) * (radius i + radius j)",
     "- (radius i * radius i + radius j * radius j)"),
    ("a normal that points outwards", "box.v", "| Upper i a => [:: ((n * d + a)%N, w); ((i * d + a)%N, - w)]",
     "| Upper i a => [:: ((n * d + a)%N, w); ((i * d + a)%N, w)]"),
    ("what is merged is lost", "sparse_rows.v", "(i, Z.add (Z.mul a b) c) ::", "(i, Z.mul a b) ::"),
    ("no blur of forces", "equilibrium_certificate.v", "+ error v * nth 0 bl k", "+ nth 0 bl k"),
    ("an entry changes by its own coordinate alone", "box.v", "let t := spread s in", "let t := 1%N in"),
    ("a force may be 0", "equilibrium_certificate.v", "[&& 0 <? nth 0 (low p) l,", "[&& 0 <=? nth 0 (low p) l,"),
    ("a lower end of a force without the slack", "equilibrium_certificate.v", "scale_of l * (nth 0 (quotients p) l - slack p)",
     "scale_of l * nth 0 (quotients p) l"),
    ("more zeros than degrees of freedom", "equilibrium_certificate.v", "(count id free + more)%N", "(count id free + more.+1)%N"),
    ("degrees of freedom with a load", "equilibrium_certificate.v", "(nth 0 p k =? 0)) (iota 0 N).", "(0 <=? nth 0 p k)) (iota 0 N)."),
    ("infinitesimal forces are not asked for", "equilibrium_certificate.v",
     "interval_claimed (if zero_at l then infinitesimal e else finite e) l) (iota 0 N).", "zero_at l || interval_claimed (finite e) l) (iota 0 N)."),
    ("one error between two disks", "box_gaps.v", "let e := 2 * blur in", "let e := blur in"),
    ("disks are out of reach too soon", "box_gaps.v", "2 * widest + gap + 2 * blur.", "widest + gap + 2 * blur."),
    ("the sweep ends with the first disk", "box_gaps.v", "if settled_until_far codes s rest then sweep codes rest else false", "if settled_until_far codes s rest then true else false"),
    ("one end makes a contact", "box_gaps.v", "[&& j =? p.1.2, k =?", "[&& k =?"),
    ("any image makes a contact", "box_gaps.v", "[&& j =? p.1.2, k =? p.2.1.1, l =?", "[&& j =? p.1.2, l =?"),
    ("the other end names the same image", "box_gaps.v", "[&& j =? p.1.1, k =? - p.2.1.1", "[&& j =? p.1.1, k =? p.2.1.1"),
    ("one row of images fewer", "box_gaps.v", "<=? (m + 1) * (cell a - error)", "<=? (m + 2) * (cell a - error)"),
    ("columns of images without the tilt", "box_gaps.v", "reach + moved rows d + moved layers d.+1 in", "reach + moved layers d.+1 in"),
    ("images near the cell are left out", "box_gaps.v", "beyond (ordinate s - y1),", "(y1 <? ordinate s),"),
    ("images however many periods away are well known", "box_gaps.v", "+ Z.abs p.1.2 + Z.abs p.2 <=? 256", "+ Z.abs p.2 <=? 256"),
    ("disks outside the extent", "box_gaps.v", "[&& (x0 <=? abscissa s) && (abscissa s <=? x1),", "[&& (x0 <=? abscissa s) && true,"),
    ("pairs with an image are not asked for", "box_gaps.v", "if central s || central t then", "if central s && central t then"),
    ("an image moved by the wrong period", "box.v", "[:: (1%N, l); (d.+2, m)]", "[:: (0%N, l); (d.+2, m)]"),
    ("a tilt that counts for images along x", "box.v", "(d : nat, l); (d.+1, m)]", "(d : nat, k); (d.+1, m)]"),
    ("a separation is a sum", "box.v", "((j * d + a)%N, -1)])", "((j * d + a)%N, 1)])"),
    ("curvature along x alone", "box.v", "^ 2 | a <- iota 0 d]%N else", "^ 2 | a <- iota 0 1]%N else"),
    ("the curvature of the last row", "box.v", "foldr (fun c m => maxn (curvature_of d n c) m) 1%N", "foldr (fun c m => curvature_of d n c) 1%N"),
    ("images along axes with walls", "box.v", "(k == Z0) || repeats d periodic 0\n", "(k == Z0) || repeats d periodic 1\n"),
    ("two pins along an axis", "equilibrium_certificate.v", "(l == first) || ~~ pins d n a", "(l <= first)%N || ~~ pins d n a"),
    ("walls along a periodic axis", "equilibrium_certificate.v", "~~ nth false (walls v) a, ~~ nth false", "true, ~~ nth false"),
    ("the top wall is not looked at", "box_gaps.v", "settled_wall (d + a) (Upper i a)) (iota 0 d).", "settled_wall (d + a) (Lower i a)) (iota 0 d)."),
    ("what is held may be refined elsewhere", "box_gaps.v", "& kept && all walls_settled", "& all walls_settled"),
    ("a pair stays where one of it does", "box_gaps.v", "all (held contacts) (coordinates d n c).", "has (held contacts) (coordinates d n c)."),
    ("what stays may overlap", "box_gaps.v", "far d n radius x 0 0 c else false", "true else false"),
    ("a held row bears no force", "equilibrium_certificate.v", "if held_at l then ~~ zero_at l else", "if held_at l then true else"),
    ("what is held opens", "load_certificate.v", "~~ (zero_at e m || held_at e m)", "~~ zero_at e m"),
    ("any row is one of the packing", "box_certificate.v", "all (in_the_packing d n (walls v) (periodic v)) (contacts v), size", "true, size"),
    ("another force may vanish before", "load_certificate.v", "outlasts up m l) (iota 0 N)]", "outlasts up l m) (iota 0 N)]"),
    ("uncertain products without the last term", "load_certificate.v",
     "Z.abs b * slack (finite e) + slack (finite e) * slack (rate c).", "Z.abs b * slack (finite e)."),
    ("the force that vanishes may not fall", "load_certificate.v", "slack (rate c) <? fall up m,", "- slack (rate c) <? fall up m,"),
    ("a place without the slack of the slope", "load_certificate.v", "(ahead up (far x) * fall up m - Z.abs", "(ahead up (far x) * fall up m + Z.abs"),
    ("forces of an end that do not vary together", "load_certificate.v", "[&& counted e 1 (mute x)", "[&& counted e 2 (mute x)"),
    ("sums over two axes of space", "box.v", "f a + sum) 0 (iota 0 d).", "f a + sum) 0 (iota 0 2)."),
    ("the upper walls of space are numbered as those of the plane", "box.v", "nth false walls (d + a)", "nth false walls (2 + a)"),
    ("images along z without walls or periods", "box.v", "((m == Z0) || repeats d periodic 2)", "true"),
    ("one tilt for images along z", "box.v", "[:: (1%N, l); (d.+2, m)]", "[:: (1%N, l); (d.+1, m)]"),
    ("heights are known without an error", "box_gaps.v", "surely (applicate s - applicate t) e", "surely (applicate s - applicate t) 0"),
    ("layers of images are not counted", "box_gaps.v", "[&& enough 2 along_z layers, enough", "[&& true, enough"),
    ("columns of images without the tilt of layers", "box_gaps.v", "reach + moved rows d + moved layers d.+1 in", "reach + moved rows d in"),
    ("a pin of space along an axis of the plane", "box_forces.v", "(k %% d == a)%N else false", "(k %% 2 == a)%N else false"),
    ("no end where a force falls", "load_certificate.v", "(fall up l + slack (rate c) <? 0)", "(fall up l - slack (rate c) <? 0)"),
]


def needing(files):
    """File -> files that have to be compiled with it, in the order of _CoqProject."""
    direct = {f: set(re.findall(r"\w+", " ".join(re.findall(r"From Isostat Require Import ([^.]*)\.", (here / f).read_text())))) for f in files}
    result = {}
    for first in files:
        seen = [first]
        for f in files[files.index(first) + 1:]:
            if any(s[:-2] in direct[f] for s in seen):
                seen.append(f)
        result[first] = seen
    return result


def coqc(folder, file):
    """Nothing, or the line of the error with its words."""
    run = subprocess.run(["coqc", "-Q", ".", "Isostat", "-w", "none", file], cwd=folder, capture_output=True, text=True)
    if run.returncode == 0:
        return None
    where = re.search(r'line (\d+), characters', run.stderr)
    return (int(where[1]) if where else 0, run.stderr.strip().splitlines()[-1])


def main(folder, *names):
    files = [line for line in (here / "_CoqProject").read_text().split() if line.endswith(".v")]
    order = needing(files)
    chosen = [m for m in MUTANTS if any(n in m[0] for n in names or ("",))]
    wanted = [f for f in files if any(needed in order[f] for m in chosen for needed in order[m[1]])]
    for f in files:
        shutil.copy(here / f, folder)
    for f in files:
        if f in wanted and coqc(folder, f):
            sys.exit(f"{f} does not compile without any change")
    survivors = 0
    for name, file, text, mutant in chosen:
        source = (here / file).read_text()
        if source.count(text) != 1:
            print(f"{name}: its text stands {source.count(text)} times in {file}, expected once")
            survivors += 1
            continue
        before = source[:source.index(text)].count("\n") + 1
        saved = {f: (folder / f"{f}o").read_bytes() for f in order[file]}
        (folder / file).write_text(source.replace(text, mutant))
        answer = "STILL HAS A PROOF"
        for f in order[file]:
            error = coqc(folder, f)
            if error:
                sound = f != file or error[0] > before
                answer = f"refused, {f} line {error[0]}" if sound else f"NO DEFINITION: {error[1]}"
                break
        survivors += not answer.startswith("refused")
        print(f"{name}: {answer}", flush=True)
        shutil.copy(here / file, folder)
        for f, old in saved.items():
            (folder / f"{f}o").write_bytes(old)
    print(f"{len(chosen)} mutants, {survivors} not refused")
    sys.exit(survivors > 0)


with tempfile.TemporaryDirectory() as made:
    main(pathlib.Path(made), *sys.argv[1:])
