#!/usr/bin/env python3
"""One certificate through the checker that Coq knows to be right:  python3 prove.py WRITER CERT.json [--sha256 DIGEST] [--keep FOLDER] [--limit SECONDS]

WRITER is the program of examples/programs/equilibrium_certificate.cpp, which is not trusted. The last line is "proved" or "undecided" with what
was found; lines before it that begin with "..." say what goes on. Exit status 0: proved; 2: undecided, not covered, or Coq is not there.
The theorems are compiled once, into the folder that `prove.py --cache` names."""
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
PACKAGES = "coq, libcoq-mathcomp-algebra, libcoq-mathcomp-algebra-tactics, libcoq-mathcomp-zify"


def undecided(detail):
    print("undecided", " ".join(detail.split())[:1000])
    sys.exit(2)


class Runner:
    """Runs programs until the time is over, or the caller is gone."""

    def __init__(self, limit):
        self.end = time.monotonic() + limit if limit else None
        self.caller = os.getppid()
        self.environment = {k: v for k, v in os.environ.items() if not k.startswith("COQ") and k != "OCAMLRUNPARAM"}

    def __call__(self, words, command, folder, output):
        """Exit status; standard output and error go into `output`."""
        begin = time.monotonic()
        with open(output, "wb") as log:
            process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                                       env=self.environment, start_new_session=True)
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


def cache():
    """Where the compiled theorems are: one folder for each text of the theorems and each Coq."""
    coqc = subprocess.run(["coqc", "--version"], capture_output=True, check=False).stdout
    digest = hashlib.sha256(coqc + os.path.realpath(shutil.which("coqc") or "").encode())
    for name, content in theorems().items():
        digest.update(hashlib.sha256(name.encode() + b"\0" + content).digest())
    home = os.environ.get("XDG_CACHE_HOME", "")
    base = pathlib.Path(home) if os.path.isabs(home) else pathlib.Path(os.path.expanduser("~")) / ".cache"
    return base / "isostat" / f"coq-{digest.hexdigest()[:32]}"


def must_be_own(path, kind):
    """What Coq is to believe must not have been put there by anybody else."""
    found = path.lstat()
    if not kind(found.st_mode) or found.st_uid != os.getuid() or found.st_mode & 0o022:
        undecided(f"{path} is not yours alone, or a link: theorems that were compiled there are not believed (XDG_CACHE_HOME names another folder)")


def compiled(run):
    """The folder of the compiled theorems, which are compiled when they are not there."""
    folder, files = cache(), theorems()
    try:
        folder.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        must_be_own(folder.parent, stat.S_ISDIR)
        if not os.path.lexists(folder):
            made = pathlib.Path(tempfile.mkdtemp(prefix="making-", dir=folder.parent))
            try:
                for number, (name, content) in enumerate(files.items()):
                    (made / f"{name}.v").write_bytes(content)
                    words = f"Coq proves the theorems, once: {number + 1} of {len(files)}"
                    if run(words, ["coqc", "-q", "-noglob", "-Q", ".", "Isostat", "-w", "none", f"{name}.v"], made, made / "log") != 0:
                        undecided(f"{name}.v does not compile here: {last_words(made / 'log')}")
                for file in made.iterdir():
                    file.chmod(0o600)
                made.rename(folder) # as a whole, or another process was quicker
            except OSError:
                if not os.path.lexists(folder):
                    raise
            finally:
                shutil.rmtree(made, ignore_errors=True)
        must_be_own(folder, stat.S_ISDIR)
        for name in files:
            must_be_own(folder / f"{name}.vo", stat.S_ISREG)
    except OSError as error:
        undecided(f"the compiled theorems cannot be kept: {error}")
    return folder


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
    folder = compiled(run)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    shutil.copyfile(here / "questions" / "verdict.v", place / "verdict.v")
    for file, words in (("certificate", "Coq reads the integers"), ("verdict", "Coq checks and proves")):
        if run(words, ["coqc", "-q", "-noglob", "-Q", folder, "Isostat", "-Q", ".", "Data", "-w", "none", f"{file}.v"], place, place / f"{file}.log") != 0:
            undecided(f"not accepted, {words}: {last_words(place / f'{file}.log')}")
    answer = subprocess.run([sys.executable, "-I", "-B", here / "compare.py", place / "certificate.json", place / "verdict.log", place / "certificate.v"],
                            capture_output=True, text=True, check=False)
    if answer.returncode != 0:
        undecided(answer.stderr)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    print("proved", f"{answer.stdout.strip()} ({seconds:.0f} s of processor time)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("writer", nargs="?")
    parser.add_argument("certificate", nargs="?")
    parser.add_argument("--keep", type=pathlib.Path, help="folder in which the files for Coq and its answers stay")
    parser.add_argument("--sha256", help="of the certificate, else nothing is proved")
    parser.add_argument("--limit", type=float, help="seconds")
    parser.add_argument("--cache", action="store_true")
    arguments = parser.parse_args()
    os.umask(0o077)
    if arguments.cache:
        print(cache())
    elif arguments.certificate is None:
        parser.error("a program and a certificate were expected")
    elif arguments.keep:
        prove(arguments, arguments.keep.resolve())
    else:
        with tempfile.TemporaryDirectory(prefix="isostat-") as place:
            prove(arguments, pathlib.Path(place))


if __name__ == "__main__":
    main()
