#!/usr/bin/env bash
# Measures error against degrees of freedom on quadrel's meshes and on Gmsh's, and draws it:
#   benches/accuracy/run.sh [--quick] [--tool quadrel|gmsh] [DOMAIN...]
# Writes target/accuracy/accuracy.{csv,md,svg}. Needs what test.sh installs; Python's packages go to target/accuracy.
set -euo pipefail
cd "$(dirname "$0")/../.."
cargo build --release --locked --lib
folder="$PWD/target/accuracy"
python="$folder/python/bin/python"
if ! "$python" -c 'import gmsh, matplotlib, scipy' 2>/dev/null; then
    python3 -m venv "$folder/python"
    "$python" -m pip install --quiet --disable-pip-version-check numpy scipy matplotlib gmsh==4.15.2
fi
"$python" benches/accuracy/accuracy.py "${CARGO_TARGET_DIR:-target}/release/libquadrel.so" "$folder" "$@"
"$python" benches/accuracy/report.py "$folder"
