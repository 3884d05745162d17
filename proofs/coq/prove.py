#!/usr/bin/env python3
"""One certificate through the checker that Coq knows to be right:  python3 prove.py WRITER CERT.json [--extracted] [--sha256 DIGEST] [--keep FOLDER] [--limit SECONDS]

WRITER is the program of examples/programs/equilibrium_certificate.cpp, which is not trusted. The last line is "proved" or "undecided" with what
was found; lines before it that begin with "..." say what goes on. Exit status 0: proved; 2: undecided, not covered, or Coq is not there.
The theorems are compiled once, into the folder that `prove.py --cache` names; so is, with --extracted, the program that Coq extracts."""
import argparse
import hashlib
import os
import pathlib
import re
import resource
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here))
from compare import CLOSED, EXTRACTED # noqa: E402
PACKAGES = "coq, libcoq-mathcomp-algebra, libcoq-mathcomp-algebra-tactics, libcoq-mathcomp-zify"
COQC = ["coqc", "-q", "-noglob", "-w", "none"]
OCAML_PACKAGES = "ocaml, ocaml-findlib, libzarith-ocaml-dev"
QUESTIONS = ("integers_in_zarith", "extract")
SOURCES = ("zarith.ml", "checker.mli", "checker.ml", "reader.ml", "program.ml") # Coq writes the second and the third


def undecided(detail):
    print("undecided", " ".join(detail.split())[:1000])
    sys.exit(2)


class Runner:
    """Runs programs until the time is over, or the caller is gone."""

    def __init__(self, limit):
        self.end = time.monotonic() + limit if limit else None
        self.caller = os.getppid()

    def __call__(self, words, command, folder, output):
        """Exit status; standard output and error go into `output`."""
        begin = time.monotonic()
        with open(output, "wb") as log:
            process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                                       start_new_session=True)
            try:
                while True:
                    try:
                        return process.wait(0.2)
                    except subprocess.TimeoutExpired:
                        now = time.monotonic()
                    if os.getppid() != self.caller:
                        sys.exit(70)
                    if self.end and now > self.end:
                        undecided(f"the time was over: {words}")
                    print(f"... {words}, {now - begin:.0f} s", flush=True)
            finally:
                if process.poll() is None:
                    os.killpg(process.pid, signal.SIGKILL)
                    process.wait()


def theorems(name="load_certificate"):
    """The files that this one needs, in order, and their bytes."""
    content, result = (here / f"{name}.v").read_bytes(), {}
    for sentence in re.findall(r"From Isostat Require Import ([^.]*)\.", content.decode()):
        for needed in sentence.split():
            result.update(theorems(needed))
    return {**result, name: content}


def cache(extracted=False):
    """Where the compiled theorems are, or the extracted program: one folder for each text of the theorems, or of the program too, and each Coq."""
    digest = hashlib.sha256()
    for program in ("coqc", "ocamlfind ocamlopt")[:1 + extracted]:
        command = program.split()
        digest.update(subprocess.run([*command, "-version"], capture_output=True, check=False).stdout)
        digest.update(os.path.realpath(shutil.which(command[0]) or "").encode())
    files = theorems()
    if extracted:
        files.update({path.name: path.read_bytes() for path in [*extraction(), *sorted((here / "extracted").glob("*.ml"))]})
    for name, content in files.items():
        digest.update(hashlib.sha256(name.encode() + b"\0" + content).digest())
    home = os.environ.get("XDG_CACHE_HOME", "")
    base = pathlib.Path(home) if os.path.isabs(home) else pathlib.Path(os.path.expanduser("~")) / ".cache"
    return base / "isostat" / f"{'extracted' if extracted else 'coq'}-{digest.hexdigest()[:32]}"


def extraction():
    return [here / "questions" / f"{name}.v" for name in QUESTIONS]


def must_be_own(path, kind):
    """What Coq is to believe must not have been put there by anybody else."""
    found = path.lstat()
    if not kind(found.st_mode) or found.st_uid != os.getuid() or found.st_mode & 0o022:
        undecided(f"{path} is not yours alone, or a link: theorems that were compiled there are not believed (XDG_CACHE_HOME names another folder)")


def kept(folder, names, make):
    """A folder with these files, which are made when it is not there."""
    try:
        folder.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        must_be_own(folder.parent, stat.S_ISDIR)
        if not os.path.lexists(folder):
            made = pathlib.Path(tempfile.mkdtemp(prefix="making-", dir=folder.parent))
            try:
                make(made)
                for file in made.iterdir():
                    file.chmod(file.stat().st_mode & 0o700)
                made.rename(folder) # as a whole, or another process was quicker
            except OSError:
                if not os.path.lexists(folder):
                    raise
            finally:
                shutil.rmtree(made, ignore_errors=True)
        must_be_own(folder, stat.S_ISDIR)
        for name in names:
            must_be_own(folder / name, stat.S_ISREG)
    except OSError as error:
        undecided(f"the compiled theorems cannot be kept: {error}")
    return folder


def compiled(run):
    """The folder of the compiled theorems."""
    files = theorems()

    def make(made):
        for number, (name, content) in enumerate(files.items()):
            (made / f"{name}.v").write_bytes(content)
            words = f"Coq proves the theorems, once: {number + 1} of {len(files)}"
            if run(words, [*COQC, "-Q", ".", "Isostat", f"{name}.v"], made, made / "log") != 0:
                undecided(f"{name}.v does not compile here: {last_words(made / 'log')}")

    return kept(cache(), [f"{name}.vo" for name in files], make)


def extracted(run):
    """The program that Coq extracts from the check of which the theorem speaks."""
    if not shutil.which("ocamlfind") or subprocess.run(["ocamlfind", "query", "zarith"], capture_output=True, check=False).returncode != 0:
        undecided(f"OCaml or Zarith is not installed (Debian packages {OCAML_PACKAGES})")
    folder = compiled(run)

    def make(made):
        for file in [*extraction(), *(here / "extracted").glob("*.ml")]:
            shutil.copyfile(file, made / file.name)
        for name in QUESTIONS:
            if run("Coq extracts the check, once", [*COQC, "-Q", folder, "Isostat", "-Q", ".", "Data", f"{name}.v"], made, made / "log") != 0:
                undecided(f"nothing was extracted: {last_words(made / 'log')}")
        if (made / "log").read_text() != CLOSED + "\n":
            undecided(f"the theorem about the extracted check has assumptions: {last_words(made / 'log')}")
        command = ["ocamlfind", "ocamlopt", "-package", "zarith", "-linkpkg", "-w", "-a", *SOURCES, "-o", "program"]
        if run("OCaml compiles what was extracted, once", command, made, made / "log") != 0:
            undecided(f"OCaml does not compile what was extracted: {last_words(made / 'log')}")

    return kept(cache(extracted=True), ["program"], make) / "program"


def last_words(log):
    return " ".join(log.read_text(encoding="utf-8", errors="replace").split())[-300:]


def prove(arguments, place):
    run = Runner(arguments.limit)
    try:
        content = pathlib.Path(arguments.certificate).read_bytes()
        if arguments.sha256 and hashlib.sha256(content).hexdigest() != arguments.sha256:
            undecided("the certificate has changed since it was read")
        (place / "certificate.json").write_bytes(content)
        with open(place / "certificate.v", "wb") as data:
            written = subprocess.run([arguments.writer, place / "certificate.json"], stdin=subprocess.DEVNULL, stdout=data, stderr=subprocess.PIPE, check=False)
    except OSError as error:
        undecided(str(error))
    if written.returncode != 0:
        undecided(written.stderr.decode(errors="replace"))
    if not shutil.which("coqc"):
        undecided(f"Coq is not installed (Debian packages {PACKAGES})")
    where = subprocess.run(["coqc", "-where"], capture_output=True, text=True, check=False).stdout.strip()
    if not os.path.isdir(f"{where}/user-contrib/mathcomp/algebra_tactics"):
        undecided(f"MathComp is not installed for {shutil.which('coqc')} (Debian packages {PACKAGES})")
    if arguments.extracted:
        accepted, besides = EXTRACTED, "; trusted besides Coq's kernel: its extraction, OCaml's compiler, Zarith"
        steps = [("verdict", "the extracted program checks", [extracted(run), "certificate.v"])]
        hard = resource.getrlimit(resource.RLIMIT_STACK)[1]
        resource.setrlimit(resource.RLIMIT_STACK, (hard, hard)) # extracted functions on lists recurse over them
    else:
        accepted, besides = CLOSED, ""
        command = [*COQC, "-Q", compiled(run), "Isostat", "-Q", ".", "Data"]
        shutil.copyfile(here / "questions" / "verdict.v", place / "verdict.v")
        steps = [("certificate", "Coq reads the integers", [*command, "certificate.v"]), ("verdict", "Coq checks and proves", [*command, "verdict.v"])]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    for file, words, command in steps:
        if run(words, command, place, place / f"{file}.log") != 0:
            undecided(f"not accepted, {words}: {last_words(place / f'{file}.log')}")
    answer = subprocess.run([sys.executable, "-I", "-B", here / "compare.py", place / "certificate.json", place / "verdict.log", place / "certificate.v", accepted],
                            capture_output=True, text=True, check=False)
    if answer.returncode != 0:
        undecided(answer.stderr)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    print("proved", f"{answer.stdout.strip()} ({seconds:.{int(arguments.extracted)}f} s of processor time{besides})")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("writer", nargs="?")
    parser.add_argument("certificate", nargs="?")
    parser.add_argument("--keep", type=pathlib.Path, help="folder in which the files for Coq and its answers stay")
    parser.add_argument("--extracted", action="store_true", help="by the program that Coq extracts: quick, and more is trusted")
    parser.add_argument("--sha256", help="of the certificate, else nothing is proved")
    parser.add_argument("--limit", type=float, help="seconds")
    parser.add_argument("--cache", action="store_true")
    arguments = parser.parse_args()
    os.umask(0o077)
    for variable in set(os.environ) - {"PATH", "HOME", "LANG", "LC_ALL", "TMPDIR", "XDG_CACHE_HOME"}: # others name libraries of Coq and OCaml
        del os.environ[variable]
    if arguments.cache:
        print(cache(arguments.extracted))
    elif arguments.certificate is None:
        parser.error("a program and a certificate were expected")
    elif arguments.keep:
        prove(arguments, arguments.keep.resolve())
    else:
        with tempfile.TemporaryDirectory(prefix="isostat-") as place:
            prove(arguments, pathlib.Path(place))


if __name__ == "__main__":
    main()
