#!/usr/bin/env bash
# The check of links can fail: each kind of rot is made in a copy and must be found.
set -euo pipefail
cd "$(dirname "$0")/.."
top=$PWD
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
fresh() {
  rm -rf "$copy"
  mkdir "$copy"
  cp -r --parents proofs/*.md proofs/*.bib proofs/coq/*.v proofs/coq/_CoqProject proofs/*.sh proofs/coq/*.sh "$copy"
  ln -s "$top/src" "$top/include" "$top/examples" "$top/tests" "$top/bench" "$copy"
}
rot() { # what, expected message, sed script, file
  fresh
  sed -i -E "$3" "$copy/$4"
  if cmp -s "$4" "$copy/$4"; then
    echo "link test '$1': nothing was changed"
    exit 1
  fi
  local said
  if said=$(python3 proofs/check_links.py "$copy"); then
    echo "link test '$1': not found"
    exit 1
  fi
  if ! grep -q "$2" <<<"$said"; then
    echo "link test '$1': another message: $said"
    exit 1
  fi
}
fresh
python3 proofs/check_links.py "$copy" >"$copy/said" || { cat "$copy/said"; exit 1; }
rot "a function is renamed" "has no find_limit_" 's/`find_limit`/`find_limit_`/' proofs/map.md
rot "a file is moved" "no file proofs/coq/moved.v" 's,proofs/coq/counting.v,proofs/coq/moved.v,' proofs/map.md
rot "a test is renamed" "has no test case the_rules" 's/`the_rules_choose_what_their_names_say`/`the_rules`/' proofs/map.md
rot "a theorem is renamed" "states no counting" 's/^Theorem counting/Theorem count/' proofs/coq/counting.v
rot "a theorem is not asked for its assumptions" "the assumptions of counting" 's/^Print Assumptions counting\.//' proofs/coq/counting.v
rot "a page is renamed" "no proofs/account.md" 's/counting\.md/account.md/' proofs/map.md
rot "a reference is removed" "has no rump2006" 's/rump2006/rump/' proofs/references.bib
rot "a Coq file is left out" "leaves out proofs.coq.statics.v" '/^statics/d' proofs/coq/_CoqProject
echo "the check of links finds each of 8 kinds of rot"
