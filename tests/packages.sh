# shellcheck shell=bash
# The Debian packages that building, testing and drawing need. Sourced by tests/run and examples/run.
# Nothing is installed, and no network is used, when all of them are there.

isostat_packages=(
  g++ cmake ninja-build pkg-config
  libcgal-dev libeigen3-dev libboost-dev libboost-test-dev libgmp-dev libmpfr-dev libflint-dev nettle-dev zlib1g-dev
  libsuitesparse-dev libqd-dev coinor-libclp-dev
  libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libfmt-dev
  gnuplot-nox python3 python3-jsonschema
)

# For the machine-checked part of proofs/: optional, installed by continuous integration.
isostat_proof_packages=(make coq libcoq-mathcomp-algebra libcoq-mathcomp-algebra-tactics libcoq-mathcomp-zify
  ocaml ocaml-findlib libzarith-ocaml-dev)
# For `mpirun isostat ensemble` (ISOSTAT_WITH_MPI): optional, built and tested by continuous integration.
isostat_mpi_packages=(libopenmpi-dev openmpi-bin)
# For the Python module: installed where ISOSTAT_WITH_PYTHON is ON, as in continuous integration.
isostat_python_packages=(pybind11-dev python3-dev python3-numpy python3-scipy python3-matplotlib)
# For a wheel of it (src/python/pyproject.toml).
isostat_wheel_packages=(python3-pip python3-setuptools python3-wheel)
# For a Debian package (tests/package).
isostat_deb_packages=(dpkg-dev file)
# For the type hints of it: optional, installed by continuous integration.
isostat_types_packages=(mypy)
# For counting instructions (tests/instructions/check.sh): optional, installed by continuous integration.
isostat_count_packages=(valgrind)
# For the page of `report --html` in a browser (tests/report/page.py): optional, installed by continuous integration.
isostat_page_packages=(chromium)
# For LAMMPS against the exact trajectory (examples/peers/lammps): optional, installed by continuous integration.
isostat_peer_packages=(lammps)
# For the style of the sources, the pages of the headers and the site of all pages: optional, installed by continuous integration.
isostat_lint_packages=(clang-format-16 clang-tidy-16 doxygen mkdocs)
if [ "${CI:-}" = true ]; then
  isostat_packages+=("${isostat_proof_packages[@]}" "${isostat_mpi_packages[@]}" "${isostat_wheel_packages[@]}" "${isostat_deb_packages[@]}"
    "${isostat_types_packages[@]}" "${isostat_count_packages[@]}" "${isostat_page_packages[@]}" "${isostat_peer_packages[@]}" "${isostat_lint_packages[@]}")
fi
if [ "${ISOSTAT_WITH_PYTHON:-}" = ON ]; then
  isostat_packages+=("${isostat_python_packages[@]}")
fi

# Installs what is missing; a message with the list when it cannot.
isostat_install_packages() {
  local missing=() package status
  for package in "${isostat_packages[@]}"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "Debian packages to install: ${missing[*]}"
  local sudo=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "Not root, and sudo is not there. Ask an administrator for:" >&2
      echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
    sudo=(sudo)
  fi
  if ! command -v apt-get >/dev/null; then
    echo "apt-get is not there: this is not Debian. Install what corresponds to: ${missing[*]}" >&2
    return 1
  fi
  if ! { "${sudo[@]}" apt-get update -q &&
         "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"; }; then
    echo "The packages could not be installed. They are needed: ${missing[*]}" >&2
    return 1
  fi
}
