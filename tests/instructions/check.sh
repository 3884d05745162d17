#!/usr/bin/env bash
# Instructions of two small fixed scenes under callgrind, compared with recorded counts: fails when one needs more than 10 %
# more than recorded. Instructions, unlike seconds, hardly depend on the machine or on what else it does.
#   check.sh PROGRAM [--record]        PROGRAM = build/release/tests/count_instructions; --record rewrites recorded.txt
set -euo pipefail
program=$1
here=$(cd "$(dirname "$0")" && pwd)
command -v valgrind >/dev/null || { echo "valgrind is not installed" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
while read -r vertex equilibria recorded; do
  case $vertex in '' | '#'*) echo "$vertex $equilibria $recorded" >>"$work/new"; continue ;; esac
  arcs=$(valgrind --tool=callgrind --callgrind-out-file="$work/out" "$program" "$here/../data/$vertex" "$equilibria" 2>"$work/log") ||
    { cat "$work/log" >&2; exit 1; }
  count=$(sed -n 's/^totals: //p' "$work/out")
  echo "$vertex $equilibria $count" >>"$work/new"
  change=$(awk -v a="$count" -v b="$recorded" 'BEGIN { printf "%+.1f", 100 * (a - b) / b }')
  echo "$vertex: $equilibria equilibria, $arcs arcs, $count instructions; recorded $recorded: $change %"
  if awk -v c="$change" 'BEGIN { exit !(c > 10) }'; then
    echo "$vertex needs more than 10 % more instructions than recorded" >&2
    status=1
  fi
done <"$here/recorded.txt"
if [ "${2:-}" = --record ]; then
  cp "$work/new" "$here/recorded.txt"
  exit 0
fi
exit $status
