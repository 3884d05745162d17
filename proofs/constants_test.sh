#!/bin/bash
# The check of constants must find each kind of rot: a number without a mark, a mark without a number, without a page, without a
# statement, without a reason, with a statement of another number.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
top=$(mktemp -d)
trap 'rm -rf "$top"' EXIT
mkdir -p "$top/proofs" "$top/src/verified"
cp "$here/constants.py" "$top/proofs"
printf '**V9.** Three or 4 terms, of 5.01 units, then 8u.\n\n**V10.** 7.01, and 3.\n' >"$top/proofs/page.md"
code=$top/src/verified/a.cpp
write() {
    cat >"$code" <<'END'
// guess: all other numbers of this file: of a search
const char* t = "7.5"; // 8.5
double f(double x) {
    return 5.01 * x + 1 + 0x1p-53 * 5.01; // 5.01: page.md V9 (entries); 0x1p-53: exact: u
}
double g(double x) {
    // A sentence.
    // page.md V9, which is long enough to be
    // continued on another line; 0.5: exact: a half
    return (x < 3 ? 4 : 3) * 0.5 + 5.01 + 0.5;
}
double h = 1e-3;
END
}
check() { python3 "$top/proofs/constants.py" 2>&1; }
write
check >/dev/null || { check; echo "right marks were refused"; exit 1; }
python3 "$top/proofs/constants.py" --list | grep -P '^src/verified/a.cpp\t10\t5.01\tpage.md V9, which is long enough to be continued on another line$' >/dev/null ||
    { echo "--list does not show a mark above its line"; exit 1; }
sed -i 's/0x1p-53: exact: u/0x1p-50: page.md V9/; s/0x1p-53/0x1p-50/' "$code"
check >/dev/null || { check; echo "2^-50 is not found as 8u"; exit 1; }
write
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
sed -i 1d "$code"; finds 'a.cpp:11: 1e-3 has no mark of its own'
sed -i 's|// 5.01: page.md V9 (entries); 0x1p-53: exact: u||' "$code"; sed -i 1d "$code"; finds 'a.cpp:3: 5.01 has no mark of its own'
sed -i 's/5.01: page/6.01: page/; s/; 0x1p-53: exact: u/; page.md V9; exact: u/' "$code"; finds 'a.cpp:4: 5.01 has no mark of its own'
sed -i '1d; s/double h = 1e-3;/double h = 1; \/\/ exact: a unit/' "$code"; finds "a.cpp:11: 'exact: a unit' belongs to no number"
sed -i 's/0x1p-53 \*/u */' "$code"; finds "a.cpp:4: '0x1p-53: exact: u' belongs to no number"
sed -i 's/double h = 1e-3;//' "$code"; finds "a.cpp:2: 'all: guess: all other numbers of this file: of a search' belongs to no number"
sed -i 's/: page.md/: paper.md/' "$code"; finds 'proofs/paper.md is no page'
sed -i 's/V9 (/V8 (/' "$code"; finds "proofs/page.md has no 'V8'"
sed -i 's/V9 (/V10 (/' "$code"; finds "a.cpp:4: proofs/page.md, V10, does not say 5.01"
sed -i 's/V9, which/V10, which/' "$code"; finds "a.cpp:10: proofs/page.md, V10, does not say 4"
sed -i 's/0x1p-53: exact: u/0x1p-50: page.md V10/; s/0x1p-53/0x1p-50/' "$code"; finds "a.cpp:4: proofs/page.md, V10, does not say 0x1p-50"
sed -i 's/; 0x1p-53: exact: u/; 0x1p-53: exact:/; 1d' "$code"; finds 'a.cpp:3: 0x1p-53 has no mark of its own'
mkdir "$top/src/core"; mv "$code" "$top/src/core"; check >/dev/null || { echo "a file that moved to another room was refused"; exit 1; }
echo "the check of constants finds each of $number kinds of rot"
