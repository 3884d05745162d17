#!/usr/bin/env bash
# Certificates of equilibria, made by the program, proved again by Coq alone:
#   bash proofs/coq/check_equilibria.sh ISOSTAT WRITER FOLDER STATE.json | DISKS | COUNT-spheres ...
# Each one must be accepted, and what Coq prints of it must agree with the file (compare.py). The extracted program must accept it too, print the
# same values, and refuse every forgery, one number each. Of the first one and those of a folder coq, which are small, Coq must compute
# that each forgery is refused, and compare.py must see each change of the file.
set -euo pipefail
isostat=$(realpath "$1")
writer=$(realpath "$2")
folder=$3
shift 3
theory=$(cd "$(dirname "$0")" && pwd)
coq() { (cd "$1" && coqc -Q "$theory" Isostat -Q . Data -w none "$2.v" >"$2.log" 2>&1) || { cat "$1/$2.log"; return 1; }; }

# What `make` has compiled is what prove.py would compile; `isostat verify --coq` uses it as well.
mkdir -p -m 700 "$folder/cache"
XDG_CACHE_HOME=$(realpath "$folder/cache")
export XDG_CACHE_HOME
compiled=$(python3 -B "$theory/prove.py" --cache)
if [ ! -e "$compiled" ]; then
  (umask 077 && mkdir -p "$compiled" && cp --no-preserve=mode "$theory"/*.vo "$compiled")
fi

forged=()
for packing in "$@"; do
  place=$folder/equilibrium_$(basename "$packing" .json)
  mkdir -p "$place"
  [ "${#forged[@]}" -gt 0 ] && [[ "$packing" != */coq/* ]] || forged+=("$place")
  if [ -f "$packing" ]; then
    cp "$packing" "$place/state.json"
  else
    grains=disks
    [[ "$packing" != *-spheres ]] || grains=spheres
    printf '[packing]\n%s = %d\ndiameters = [1.0, 2.0]\nseed = 1\n' "$grains" "${packing%-spheres}" >"$place/scene.toml"
    "$isostat" prepare "$place/scene.toml" -o "$place/state.json" --quiet
  fi
  "$isostat" certify "$place/state.json" -o "$place/certificate.json" >"$place/certify.log"
  answer=$(python3 -B "$theory/prove.py" "$writer" "$place/certificate.json" --keep "$place" | tail -1) || { echo "$answer"; exit 1; }
  echo "equilibrium '$packing': $answer"
  mkdir -p "$place/extracted"
  answer=$(python3 -B "$theory/prove.py" --extracted "$writer" "$place/certificate.json" --keep "$place/extracted" | tail -1) || { echo "$answer"; exit 1; }
  python3 -B - "$theory" "$place" <<'END'
import sys
sys.path.insert(0, sys.argv[1])
from compare import CLOSED, EXTRACTED, printed
kernel, extracted = (printed(open(f"{sys.argv[2]}/{log}", encoding="utf-8").read(), first) for log, first in (("verdict.log", CLOSED), ("extracted/verdict.log", EXTRACTED)))
if kernel != extracted:
    sys.exit("the extracted program prints other values than Coq")
END
  echo "  the extracted program: the same values ($(grep -o '[0-9.]* s of processor time' <<<"$answer"))"
done
python3 -B "$theory/check_extraction.py"

first=${forged[0]}
# The same by `isostat verify --coq`, of a file and of one with a larger gap (its digest is the one that the program asks for).
says() { # STATUS WORDS FILE...
  local answer status=0
  answer=$("$isostat" verify --coq "${@:3}" 2>&1) || status=$?
  grep -qE "$2" <<<"$answer" && [ "$status" -eq "$1" ] || { echo "$answer"; echo "expected status $1 and '$2', found status $status"; exit 1; }
}
says 0 '^coq +proved' "$first/certificate.json"
says 0 '^coq-extracted +proved .*trusted besides' --coq-extracted "$first/certificate.json"
python3 - "$first" "$isostat" <<'END'
import json, re, subprocess, sys
first, isostat = sys.argv[1:]
forged = json.load(open(f"{first}/certificate.json", encoding="utf-8"))
forged["claims"]["gaps"]["smallest"] *= 1.5
for _ in range(2):
    with open(f"{first}/forged.json", "w", encoding="utf-8") as file:
        json.dump(forged, file)
    answer = subprocess.run([isostat, "verify", f"{first}/forged.json"], capture_output=True, text=True).stderr
    forged["digest"] = (re.findall(r"[0-9a-f]{64}", answer) or [""])[-1]
END
says 1 '^coq +undecided not accepted' "$first/forged.json"
says 1 '^coq-extracted +undecided not accepted.*false' --coq-extracted "$first/forged.json"
answer=$(python3 -B "$theory/prove.py" "$writer" "$first/certificate.json" --sha256 "$(sha256sum <"$first/forged.json" | cut -c1-64)" | tail -1) || true
[ "$answer" = "undecided the certificate has changed since it was read" ] || { echo "$answer"; exit 1; }
echo "isostat verify --coq, --coq-extracted: each accepts '$1', refuses the one with a larger gap"

for place in "${forged[@]}"; do
cp "$theory/questions/forgeries.v" "$place"
coq "$place" forgeries
echo "$(sed -n 's/^ *= \([0-9]*\).*/\1/p' "$place/forgeries.log") forgeries of '$(basename "$place")': Coq computes that each is refused"

python3 - "$theory/compare.py" "$place" <<'END'
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
    "an interval too many": lambda c: c["claims"]["forces"]["infinitesimal"].append([0, 1]),
    "a coordinate": scale("state", "disks", 0, 0, by=1 + 2**-52),
    "a radius": scale("state", "disks", 0, genuine["state"]["dimension"], by=1 + 2**-52),
    "the dimension": lambda c: c["state"].__setitem__("dimension", 5 - c["state"]["dimension"]),
    "a length": scale("state", "length", 1, by=1 + 2**-52),
    "a stress": scale("state", "load", "stress", genuine["state"]["load"]["loaded_axis"], by=1.5),
    "an infinitesimal load": lambda c: c["state"]["infinitesimal"][0].__setitem__(0, 1.5 * c["state"]["infinitesimal"][0][0] + 1),
    "the nearer end of the load": lambda c: c["claims"]["load_interval"]["high"]["stress"].__setitem__(0, c["claims"]["load_interval"]["high"]["stress"][1]),
    "the further end of the load": lambda c: c["claims"]["load_interval"]["low"]["stress"].__setitem__(0, c["claims"]["load_interval"]["low"]["stress"][1]),
    "what opens": lambda c: c["claims"]["load_interval"]["low"].__setitem__("opens", c["claims"]["load_interval"]["high"]["opens"]),
    "an end that is none": lambda c: c["claims"]["load_interval"].__setitem__("high", {"unbounded": True}),
    "the loaded axis": lambda c: c["state"]["load"].__setitem__("loaded_axis", 0 if genuine["state"]["load"]["loaded_axis"] else 1),
    "a path of the load": lambda c: c["state"]["load"].__setitem__("path", [0, 1]),
    "stability": lambda c: c["claims"].__setitem__("stable", False),
    "a contact": lambda c: c["state"]["contacts"].reverse(),
    "an upper wall": lambda c: c["state"]["walls"]["upper"].__setitem__(0, "fixed" if genuine["state"]["walls"]["upper"][0] == "movable" else "movable"),
    "a lower wall": lambda c: c["state"]["walls"]["lower"].__setitem__(0, "absent" if genuine["state"]["walls"]["lower"][0] == "fixed" else "fixed"),
    "a lower wall that moves": lambda c: c["state"]["walls"]["lower"].__setitem__(1, "movable"),
    "a fixed disk": lambda c: c["state"].__setitem__("fixed", genuine["state"].get("fixed", []) + [0]),
    "disks that are fixed": lambda c: c["state"].__setitem__("fixed", genuine["state"].get("fixed", [0, 1])[1:]),
    "a reference length": scale("state", "load", "reference_length", 0, by=1.5),
}
if "cell" in genuine["state"]:
    cell = genuine["state"]["cell"]
    shifted = [m[:2] + [[m[2][0] + 1, *m[2][1:]]] if len(m) == 3 else m for m in genuine["state"]["contacts"]]
    changes.update({
        "a cell": lambda c: c["state"].pop("cell"),
        "an axis": lambda c: c["state"]["cell"]["axes"].__setitem__(1, "walls" if cell["axes"][1] == "periodic" else "periodic"),
        "a period that moves": lambda c: c["state"]["cell"].__setitem__("moves", cell["moves"][1:]),
        "what moves is the size": lambda c: c["state"]["cell"].__setitem__("moves", ["scale"]),
        "the tilt": lambda c: c["state"]["cell"]["tilt"].__setitem__(0, cell["tilt"][0] + 2**-40),
        "the pin": lambda c: c["state"]["cell"].__setitem__("pin", cell["pin"] + 1),
        "images": lambda c: c["state"].__setitem__("contacts", shifted),
    })
    if "xy" in cell["moves"]:
        changes["a shear stress"] = lambda c: c["state"]["load"].__setitem__("shear", [0.5] * len(cell["tilt"]))
if genuine["claims"]["load_interval"]["high"]["unbounded"]:
    for name in ("the nearer end of the load", "what opens", "an end that is none"):
        del changes[name]
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
done

# Forgeries by the extracted program, also those that would take Coq minutes.
cp "$theory"/questions/{integers_in_zarith,extract,extract_forgeries}.v "$theory"/extracted/*.ml "$first"
for question in integers_in_zarith extract extract_forgeries; do coq "$first" $question; done
(cd "$first" && ocamlfind ocamlopt -package zarith -linkpkg -w -a zarith.ml checker.mli checker.ml reader.ml test.ml -o test)
for packing in "$@"; do
  [[ "$packing" != *100* ]] || continue # a minute each
  answer=$("$first/test" "$folder/equilibrium_$(basename "$packing" .json)/certificate.v")
  echo "forgeries of '$packing' by the extracted program: $answer"
  [[ "$answer" == [1-9]*" refused, 0 accepted" ]]
done
# What only the reader can refuse: a natural number that is negative.
for change in 's/disks := /&-/' 's/Disks [1-9]/Disks -9/' 's/Some /&-/'; do
  sed "$change" "$first/certificate.v" >"$first/negative.v"
  ! "$(python3 -B "$theory/prove.py" --cache --extracted)/program" "$first/negative.v" >"$first/negative.log" 2>&1
  grep -q 'a natural number was expected' "$first/negative.log"
done
