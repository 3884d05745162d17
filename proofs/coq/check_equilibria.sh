#!/usr/bin/env bash
# Certificates of equilibria, made by the program, proved again by Coq alone:
#   bash proofs/coq/check_equilibria.sh ISOSTAT WRITER FOLDER CERTIFICATE.json | DISKS ...
# Each one must be accepted, and what Coq prints of it must agree with the file (compare.py). The first one is forged, one
# number at a time: Coq must compute that each forgery is refused, and compare.py must see each change of the file.
set -euo pipefail
isostat=$(realpath "$1")
writer=$(realpath "$2")
folder=$3
shift 3
theory=$(cd "$(dirname "$0")" && pwd)
coq() { (cd "$1" && coqc -Q "$theory" Isostat -Q . Data -w none "$2.v" >"$2.log" 2>&1) || { cat "$1/$2.log"; return 1; }; }

first=
for packing in "$@"; do
  place=$folder/equilibrium_$(basename "$packing" .json)
  mkdir -p "$place"
  first=${first:-$place}
  if [ -f "$packing" ]; then
    cp "$packing" "$place/certificate.json"
  else
    printf '[packing]\ndisks = %d\ndiameters = [1.0, 2.0]\nseed = 1\n' "$packing" >"$place/scene.toml"
    "$isostat" prepare "$place/scene.toml" -o "$place/state.json" --quiet
    "$isostat" certify "$place/state.json" -o "$place/certificate.json" >"$place/certify.log"
  fi
  "$writer" "$place/certificate.json" >"$place/certificate.v"
  cp "$theory/questions/verdict.v" "$place"
  begin=$SECONDS
  coq "$place" certificate
  coq "$place" verdict
  python3 "$theory/compare.py" "$place/certificate.json" "$place/verdict.log" "$place/certificate.v"
  echo "equilibrium '$packing': packing_is_in_equilibrium proved in $((SECONDS - begin)) s, closed under the global context"
done

cp "$theory/questions/forgeries.v" "$first"
coq "$first" forgeries
echo "$(sed -n 's/^ *= \([0-9]*\).*/\1/p' "$first/forgeries.log") forgeries of '$1': Coq computes that each is refused"

python3 - "$theory/compare.py" "$first" <<'END'
import copy, json, subprocess, sys
compare, first = sys.argv[1:]
genuine = json.load(open(f"{first}/certificate.json", encoding="utf-8"))
def scale(*path, by):
    def change(c):
        for key in path[:-1]:
            c = c[key]
        c[path[-1]] *= by
    return change
changes = {
    "radius": scale("claims", "vertex", "radius", by=1e-6),
    "radius of uniqueness": scale("claims", "vertex", "unique_radius", by=1.01),
    "smallest gap": scale("claims", "gaps", "smallest", by=1.01),
    "rank": scale("claims", "counting", "rank", by=2),
    "a force from below": lambda c: c["claims"]["forces"]["finite"][-1].__setitem__(0, c["claims"]["forces"]["finite"][-1][1]),
    "a force from above": lambda c: c["claims"]["forces"]["finite"][-1].__setitem__(1, c["claims"]["forces"]["finite"][-1][0]),
    "a coordinate": scale("state", "disks", 0, 0, by=1 + 2**-52),
    "a radius of a disk": scale("state", "disks", 0, 2, by=1 + 2**-52),
    "a length": scale("state", "length", 0, by=1 + 2**-52),
    "a stress": scale("state", "load", "stress", 0, by=1.5),
    "an infinitesimal load": scale("state", "infinitesimal", 0, 0, by=1.5),
    "the nearer end of the load": lambda c: c["claims"]["load_interval"]["high"]["stress"].__setitem__(0, c["claims"]["load_interval"]["high"]["stress"][1]),
    "the further end of the load": lambda c: c["claims"]["load_interval"]["low"]["stress"].__setitem__(0, c["claims"]["load_interval"]["low"]["stress"][1]),
    "what opens": lambda c: c["claims"]["load_interval"]["low"].__setitem__("opens", c["claims"]["load_interval"]["high"]["opens"]),
    "an end that is none": lambda c: c["claims"]["load_interval"].__setitem__("high", {"unbounded": True}),
    "the loaded axis": lambda c: c["state"]["load"].__setitem__("loaded_axis", 0),
    "a path of the load": lambda c: c["state"]["load"].__setitem__("path", [0, 1]),
    "stability": lambda c: c["claims"].__setitem__("stable", False),
    "a contact": lambda c: c["state"]["contacts"].reverse(),
}
for name, change in changes.items():
    other = copy.deepcopy(genuine)
    change(other)
    with open(f"{first}/changed.json", "w", encoding="utf-8") as file:
        json.dump(other, file)
    answer = subprocess.run([sys.executable, compare, f"{first}/changed.json", f"{first}/verdict.log", f"{first}/certificate.v"],
                            capture_output=True, text=True)
    if answer.returncode != 1 or not answer.stderr.startswith("compare.py: "):
        sys.exit(f"compare.py did not see the change of {name}")
print(f"{len(changes)} changes of the file: compare.py sees each")
END
