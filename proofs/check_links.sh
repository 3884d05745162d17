#!/bin/bash
# Checks what the pages of proofs/ name, so that no link rots: exit 1 and a list when something is missing.
#   `name`, `other` (src|include|tests|proofs/... file)   the file exists and contains each name as a word outside of comments;
#                                                        a name in a .v file must be stated there, one in a test_*.cpp file be a test case
#   (Coq: `name`, ...)                                    some file of proofs/coq states it
#   word.md, coq/word.v                                   exists in proofs/
#   @key                                                  is in references.bib
set -u
cd "${1:-$(dirname "$0")/..}" || exit 1 # another top folder: for the test of this script
missing=0
checked=0
fail() {
    echo "$1"
    missing=$((missing + 1))
}
stated() { grep -qE "^(Theorem|Lemma|Corollary|Fact) $2\\b" "$1"; }

for page in proofs/*.md; do
    text=$(tr '\n' ' ' <"$page" | tr -s ' ')
    while IFS= read -r group; do
        [ -n "$group" ] || continue
        path=$(sed -E 's/.*\(([^()]*)\)$/\1/' <<<"$group")
        if [ ! -f "$path" ]; then
            fail "$page: no file $path"
            continue
        fi
        while IFS= read -r name; do
            word=${name##*::}
            checked=$((checked + 1))
            if [[ $path == *.v ]]; then
                stated "$path" "$word" || fail "$page: $path states no $name"
            elif [[ $path == */test_*.cpp ]]; then
                grep -qE "_TEST_CASE(_[A-Z]+)?\\($word\\b" "$path" || fail "$page: $path has no test case $name"
            else
                sed 's,//.*,,' "$path" | grep -qwF -- "$word" || fail "$page: $path has no $name"
            fi
        done < <(sed -E 's/ \([^()]*\)$//' <<<"$group" | grep -oE '`[^`]+`' | tr -d '`')
    done < <(grep -oE '`[A-Za-z_:0-9]+`((,| and|, and) `[A-Za-z_:0-9]+`)* \((src|include|tests|proofs|examples)/[A-Za-z0-9_/.-]+\)' <<<"$text")

    while IFS= read -r name; do
        [ -n "$name" ] || continue
        checked=$((checked + 1))
        found=0
        for file in proofs/coq/*.v; do
            stated "$file" "$name" && found=1
        done
        [ $found = 1 ] || fail "$page: no Coq statement $name"
    done < <(grep -oE 'Coq: `[a-z0-9_]+`(, `[a-z0-9_]+`)*' <<<"$text" | grep -oE '`[^`]+`' | tr -d '`')

    for file in $(grep -oE '\b(coq/[a-z_]+\.v|[a-z_]+\.md)\b' "$page" | sort -u); do
        checked=$((checked + 1))
        [ -f "proofs/$file" ] || [ -f "proofs/${file#proofs/}" ] || fail "$page: no proofs/$file"
    done
    for key in $(grep -oE '@[a-z]+[0-9]{4}[a-z]*' "$page" | tr -d '@' | sort -u); do
        checked=$((checked + 1))
        grep -q "{$key," proofs/references.bib || fail "$page: references.bib has no $key"
    done
done
for file in $(grep '\.v$' proofs/coq/_CoqProject); do
    [ -f "proofs/coq/$file" ] || fail "_CoqProject: no $file"
done
for file in proofs/coq/*.v; do
    grep -qx "$(basename "$file")" proofs/coq/_CoqProject || fail "_CoqProject leaves out $file"
    for name in $(sed -nE 's/^(Theorem|Corollary) ([A-Za-z0-9_]+).*/\2/p' "$file"); do
        checked=$((checked + 1))
        grep -q "^Print Assumptions $name\\.$" "$file" || fail "$file: the assumptions of $name are not printed"
        grep -qw "$name" proofs/*.md || fail "$file: no page names $name"
    done
done
if [ "$missing" -gt 0 ]; then
    echo "$missing of $checked names in proofs/ lead nowhere"
    exit 1
fi
echo "$checked names in proofs/ lead to a file, a function or a theorem"
