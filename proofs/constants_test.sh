#!/bin/bash
# The check of constants must find each kind of rot: an entry that is missing, stale, counted otherwise, without a page, without a
# statement, without a reason, written twice.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
top=$(mktemp -d)
trap 'rm -rf "$top"' EXIT
mkdir -p "$top/proofs" "$top/src/verified"
cp "$here/constants.py" "$top/proofs"
echo '**V9.** Five units.' >"$top/proofs/page.md"
code=$top/src/verified/a.cpp
table=$top/proofs/constants.tsv
write() {
    printf 'const char* t = "7.5"; // 8.5\ndouble f(double x) { return 5.01 * x + 1 + 0x1p-53 * 5.01; }\n' >"$code"
    printf 'src/verified/a.cpp\t0x1p-53\t1\texact: u\nsrc/verified/a.cpp\t5.01\t2\tpage.md V9 (entries); cost: none\n' >"$table"
}
check() { python3 "$top/proofs/constants.py" --where 2>&1; }
write
check >/dev/null || { check; echo "a right table was refused"; exit 1; }
number=0
finds() { # words of the message; the rot was made
    number=$((number + 1))
    if check >"$top/said"; then
        echo "not found: $1"
        exit 1
    fi
    grep -qF -- "$1" "$top/said" || { cat "$top/said"; echo "said something else than: $1"; exit 1; }
    write
}
echo 'double g = 3.5;' >>"$code"; finds 'a.cpp: 3.5 has no entry'
sed -i 's/0x1p-53/u/' "$code"; finds 'a.cpp: 0x1p-53 is in the table, but no longer in the code'
echo 'double g = 5.01;' >>"$code"; finds 'a.cpp: 5.01 is written 3 times, 2 in the table'
sed -i 's/page.md/paper.md/' "$table"; finds "names no page of proofs/"
sed -i 's/V9/V8/' "$table"; finds "proofs/page.md has no 'V8'"
sed -i 's/page.md V9/page.md/' "$table"; finds "proofs/page.md has no '(entries)'"
sed -i 's/exact: u/exact: /' "$table"; finds "'exact' without a word"
sed -i 's/exact: u/u/' "$table"; finds "'u' names no page"
sed -i '1p' "$table"; finds 'each file and number once'
printf 'src/verified/a.cpp\t*\t0\texact: one format\n' >"$table"
check >/dev/null || { echo "a file of one format was refused"; exit 1; }
sed -i 's/a.cpp/gone.cpp/' "$table"; finds 'gone.cpp: * is in the table, but no longer in the code'
mkdir "$top/src/core"; mv "$code" "$top/src/core"; check >/dev/null || { echo "a file that moved to another room was refused"; exit 1; }
echo "the check of constants finds each of $number kinds of rot"
