#!/usr/bin/env bash
# Certificates of full rank, written by a program of this project and checked by Coq:
#   bash proofs/coq/check_certificates.sh PROGRAM FOLDER [STATE.json | DISKS] ...
# Each one must be accepted. Of the first one seven forgeries are made; each must be refused, which means: no theorem comes out of it, and
# Coq *computes* false where the genuine one gives true.
set -euo pipefail
program=$(realpath "$1")
folder=$2
shift 2
theory=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder"
check() { coqc -Q "$theory" Isostat -w none "$1" >"${1%.v}.log" 2>&1; }

number=0
for packing in "$@"; do
  number=$((number + 1))
  file=$folder/certificate_$number.v
  "$program" "$packing" >"$file"
  begin=$SECONDS
  if ! check "$file" || ! grep -q '^Closed under the global context' "${file%.v}.log"; then
    cat "${file%.v}.log"
    echo "the certificate of the packing '$packing' was not accepted"
    exit 1
  fi
  echo "certificate of '$packing': packing_is_isostatic proved in $((SECONDS - begin)) s, closed under the global context"
done

genuine=$folder/certificate_1.v
forge() { # name, sed script
  local file=$folder/forged_$1.v
  sed -E "$2" "$genuine" >"$file"
  if cmp -s "$genuine" "$file"; then
    echo "forgery '$1': the file was not changed"
    exit 1
  fi
  if check "$file"; then
    echo "forgery '$1' was accepted"
    exit 1
  fi
  # For the right reason: the same file with the opposite claim is accepted.
  sed -E '/^Lemma certificate_is_accepted/s/= true\.$/= false./; /^Lemma centres_are_distinct/,$d' "$file" >"$folder/refused_$1.v"
  if ! check "$folder/refused_$1.v"; then
    cat "$folder/refused_$1.log"
    echo "forgery '$1' was refused, but not by the checker"
    exit 1
  fi
  echo "forgery '$1': refused, the checker computes false"
}
forge one_digit_of_the_inverse '/^Definition inverse_rows/,/^Close/{0,/[1-9]/{/^ /s/([0-9])([];])/\1\1\2/}}'
forge one_digit_of_a_coordinate '/^Definition coordinates/{n;s/([0-9])([];])/\1\1\2/}'
forge a_contact_twice '/^Definition contacts/{n;s/(;[^;]*);[^;]*/\1\1/}'
forge a_contact_missing '/^Definition contacts/{n;s/;[^;]*//}'
forge a_row_missing '/^Definition inverse_rows/{n;d}'
forge modulus_one 's/^(Definition modulus.*) 61\)/\1 1)/'
# The same rows under names that no contact of this packing has: "Lower i a" is row 2 i + a, so is "Lower (i-1) (a+2)".
lower=$(grep -oE 'Lower [1-9][0-9]* [01]' "$genuine" | head -1)
read -r _ disk axis <<<"$lower"
forge an_axis_that_does_not_exist "s/$lower/Lower $((disk - 1)) $((axis + 2))/"
