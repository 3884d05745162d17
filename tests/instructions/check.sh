#!/usr/bin/env bash
# Instructions of small fixed scenes under callgrind, compared with recorded counts: fails when one needs more than 10 % more than
# recorded, and then prints where they are spent, now and then. Instructions, unlike seconds, hardly depend on the machine or on
# what else it does.
#   check.sh PROGRAM [--record]        PROGRAM = build/release/tests/count_instructions; --record rewrites recorded*.txt
set -euo pipefail
program=$1
here=$(cd "$(dirname "$0")" && pwd)
command -v valgrind >/dev/null || { echo "valgrind is not installed" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# "count name" of the functions that spend most, themselves: the file, the arguments and nameless namespaces are left out.
functions() {
  callgrind_annotate --auto=no --show-percs=no --threshold=99 "$1" |
    sed -n 's/^ *\([0-9,]*\)  *[^ :]*:\(.*\)$/\1 \2/p' |
    sed 's/(anonymous namespace):://g; s/ \[[^]]*\]$//; s/(.*$//' |
    awk '{ n = $1; gsub(",", "", n); $1 = ""; sub(/^ /, ""); sum[$0] += n }
         END { for (f in sum) printf "%d %s\n", sum[f], f }' | sort -rn | sed -n '1,60p'
}

# Recorded and present shares of the functions that grew most: grown SCENE RECORDED PRESENT FUNCTIONS.
grown() {
  printf '    %12s %12s %6s   %12s %6s   %s\n' more recorded % now % 'function, itself (recorded 0: not among the first 60)'
  awk -v scene="$1" -v then="$2" -v now="$3" '
    NR == FNR { if ($1 == scene) { n = $2; $1 = $2 = ""; sub(/^  /, ""); was[$0] = n } next }
    { n = $1; $1 = ""; sub(/^ /, ""); is[$0] = n }
    END {
      for (f in is) {
        printf "    %+12d %12d %5.1f%%   %12d %5.1f%%   %s\n", is[f] - was[f], was[f], 100 * was[f] / then, is[f],
          100 * is[f] / now, substr(f, 1, 100)
      }
    }' "$here/recorded-functions.txt" "$4" | sort -k1,1gr | sed -n '1,12p'
}

status=0
: >"$work/new-functions"
while read -r vertex equilibria level recorded; do
  case $vertex in '' | '#'*) echo "$vertex $equilibria $level $recorded" >>"$work/new"; continue ;; esac
  # What is loaded before main, and from which libraries, is not counted.
  arcs=$(LD_BIND_NOW=1 valgrind --tool=callgrind --toggle-collect=main --callgrind-out-file="$work/out" \
    "$program" "$here/../data/$vertex" "$equilibria" "$level" 2>"$work/log") || { cat "$work/log" >&2; exit 1; }
  count=$(sed -n 's/^totals: //p' "$work/out")
  echo "$vertex $equilibria $level $count" >>"$work/new"
  functions "$work/out" >"$work/functions"
  sed "s/^/$vertex,$level /" "$work/functions" >>"$work/new-functions"
  change=$(awk -v a="$count" -v b="$recorded" 'BEGIN { printf "%+.1f", 100 * (a - b) / b }')
  echo "$vertex, $level: $equilibria equilibria, $arcs arcs, $count instructions; recorded $recorded: $change %"
  [ "${2:-}" != --record ] || continue
  if awk -v c="$change" 'BEGIN { exit !(c > 10) }'; then
    echo "$vertex, $level needs more than 10 % more instructions than recorded; the functions that grew most:" >&2
    grown "$vertex,$level" "$recorded" "$count" "$work/functions" >&2
    status=1
  elif awk -v c="$change" 'BEGIN { exit !(c < -10) }'; then
    echo "  fewer by more than 10 %: record them (check.sh PROGRAM --record), or the next loss of as much is not seen"
  fi
done <"$here/recorded.txt"
if [ "${2:-}" = --record ]; then
  cp "$work/new" "$here/recorded.txt"
  cp "$work/new-functions" "$here/recorded-functions.txt"
fi
exit $status
