#!/usr/bin/env bash
# Everything in proofs/ that a machine can check:
#   bash proofs/check.sh [BUILD]
# The links of the pages; the numbers in the code, each with a mark that says where the number comes from (constants.py); with Coq and MathComp installed the theorems, with what Print Assumptions says of each; and, when BUILD (a build
# folder with the examples) is given, certificates that its program writes for packings that it prepares.
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/packages.sh
python3 proofs/check_links.py
bash proofs/check_links_test.sh
python3 proofs/constants.py
bash proofs/constants_test.sh
if ! command -v coqc >/dev/null || [ ! -d "$(coqc -where)/user-contrib/mathcomp/algebra_tactics" ] || ! ocamlfind query zarith >/dev/null 2>&1; then
  echo "proofs/coq: SKIPPED, no theorem was checked: Coq, MathComp, OCaml or Zarith is not installed (Debian: ${isostat_proof_packages[*]})"
  exit 0
fi
make --no-print-directory -j "$(nproc)" -C proofs/coq
if [ $# -gt 0 ]; then
  bash proofs/coq/check_certificates.sh "$1/examples/example_rank_certificate" "$1/certificates" 6 24
  bash proofs/coq/check_equilibria.sh "$1/isostat" "$1/examples/example_equilibrium_certificate" "$1/certificates" 6 30 100 30-spheres tests/data/coq/*.json tests/data/contradictions/at_its_limit.json tests/data/cells/*_16.json examples/cells/tilted-100.json
else
  echo "proofs/coq: no build folder given, no certificate was written"
fi
