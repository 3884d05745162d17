#!/usr/bin/env python3
"""A root with the essential packages of this computer, those that a .deb names, and the .deb, installed by dpkg:

  python3 tests/package_root.py ROOT PACKAGE.deb FIELD... [-- NAME...]     FIELD: Depends, Suggests, ...; NAME: further packages

Nothing is downloaded: files are copied from where they are installed here."""
import pathlib
import re
import subprocess
import sys

folders = ("bin", "lib", "sbin", "lib32", "lib64", "libx32")


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Installed:
    """The packages of this computer, and what each asks for."""

    def __init__(self):
        form = "${Package}\t${Essential}\t${Pre-Depends}, ${Depends}\t${Provides}\t${db:Status-Status}\n"
        self.asks, self.giver, self.essential = {}, {}, []
        for line in output("dpkg-query", "-W", "-f", form).splitlines():
            name, essential, asks, gives, status = line.split("\t")
            if status != "installed":
                continue
            self.asks[name] = asks
            if essential == "yes":
                self.essential.append(name)
            for given in re.findall(r"[^\s,(]+(?=\s*(?:\(|,|$))", gives):
                self.giver.setdefault(given, name)

    def found(self, alternatives):
        """The package that answers "a (>= 1) | b"."""
        for name in re.split(r"\|", alternatives):
            name = re.sub(r"[(:].*", "", name).strip()
            if name in self.asks or name in self.giver:
                return name if name in self.asks else self.giver[name]
        return None

    def closure(self, wanted):
        """With all that they ask for. Exits where one is not installed here."""
        closed, open_ = set(), [(name, "asked for") for name in wanted]
        while open_:
            text, by = open_.pop()
            if not (name := self.found(text)):
                sys.exit(f"{text} ({by}) is not installed here: sudo apt-get install it")
            if name not in closed:
                closed.add(name)
                open_ += [(ask, name) for ask in re.split(r",", self.asks[name]) if ask.strip()]
        return sorted(closed)


def alternatives():
    """Links that update-alternatives made, which no package owns."""
    for file in pathlib.Path("/var/lib/dpkg/alternatives").iterdir():
        lines = file.read_text().split("\n")
        yield lines[1]
        for slave in range(3, len(lines), 2):
            if not lines[slave - 1]:
                break
            yield lines[slave]


def main():
    root, package, *rest = sys.argv[1:]
    root = pathlib.Path(root)
    fields, more = (rest[: rest.index("--")], rest[rest.index("--") + 1:]) if "--" in rest else (rest, [])
    installed = Installed()
    asked = [ask for field in fields for ask in output("dpkg-deb", "-f", package, field).strip().split(",") if ask.strip()]
    names = installed.closure(installed.essential + asked + more)
    for name in folders:
        if pathlib.Path("/" + name).is_symlink():
            (root / "usr" / name).mkdir(parents=True)
            (root / name).symlink_to("usr/" + name)
    files = [line for line in output("dpkg-query", "-L", *names).splitlines() if line.startswith("/") and not line.startswith("/usr/share/doc/")]
    links = [link for link in alternatives() if pathlib.Path(link).is_symlink()]
    files += links + [f"/etc/alternatives/{path.name}" for path in pathlib.Path("/etc/alternatives").iterdir()]
    listed = "".join(f"{file[1:]}\n" for file in dict.fromkeys(files) if pathlib.Path(file).exists() or pathlib.Path(file).is_symlink())
    copy = subprocess.Popen(["tar", "-C", "/", "--no-recursion", "-c", "-T", "-"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    into = subprocess.Popen(["tar", "-C", root, "-x", "--keep-directory-symlink"], stdin=copy.stdout)
    copy.stdin.write(listed.encode())
    copy.stdin.close()
    if copy.wait() != 0 or into.wait() != 0:
        sys.exit("the files of this computer could not be copied")
    for folder in ("root", "tmp", "dev", "proc", "var/lib/dpkg/info", "var/lib/dpkg/updates", "var/lib/dpkg/triggers"):
        (root / folder).mkdir(parents=True, exist_ok=True)
    (root / "var/lib/dpkg/status").write_text(output("dpkg-query", "-s", *names).rstrip("\n") + "\n\n")
    for name in names:
        for list_ in pathlib.Path("/var/lib/dpkg/info").glob(f"{name}*.list"):
            if list_.stem.split(":")[0] == name:
                (root / "var/lib/dpkg/info" / list_.name).write_bytes(list_.read_bytes())
    for device, minor in (("null", 3), ("zero", 5), ("urandom", 9)):
        if not (root / "dev" / device).exists():
            subprocess.run(["mknod", "-m", "666", root / "dev" / device, "c", "1", str(minor)], check=True)
    subprocess.run(["ldconfig", "-r", root], check=True, stderr=subprocess.DEVNULL)
    subprocess.run(["dpkg", f"--root={root}", "-i", package], check=True, stdout=subprocess.DEVNULL)
    print(f"{package} installed into a root of {len(names)} packages")


main()
