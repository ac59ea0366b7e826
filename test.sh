#!/usr/bin/env bash
# Installs what is missing, then checks and tests everything. Needs a Debian-like system with git and
# network; Rust is taken as it is or installed for the user. Usage: ./test.sh
set -euo pipefail
cd "$(dirname "$0")"

step() { printf '\n== %s\n' "$*"; }
say() { printf '   %s\n' "$*"; }
started=$SECONDS
trap 'code=$?; [ $code -eq 0 ] || printf "\n== FAILED after %s s (exit %s)\n" "$((SECONDS - started))" "$code"' EXIT

as_root() { if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi; }

step "tools"
missing=()
{ command -v cc && command -v c++; } >/dev/null || missing+=(build-essential)
command -v cmake >/dev/null || missing+=(cmake)
command -v pkg-config >/dev/null || missing+=(pkg-config)
command -v valgrind >/dev/null || missing+=(valgrind libc6-dbg)
# Headers are compiled with both compilers, and the fuzzer is clang's.
command -v clang++ >/dev/null || missing+=(clang libclang-rt-dev)
# The C interface is compared with these (about 250 MB to download). Debian's VTK draws with an X server alone.
[ -d /usr/include/CGAL ] || missing+=(libcgal-dev)
[ -d /usr/include/OpenMesh ] || missing+=(libopenmesh-dev)
compgen -G '/usr/include/vtk-9*' >/dev/null || missing+=(libvtk9-dev)
command -v xvfb-run >/dev/null || missing+=(xvfb xauth)
[ -f /usr/include/p4est.h ] || missing+=(libp4est-dev)
command -v mpirun >/dev/null || missing+=(openmpi-bin)
command -v mpicc >/dev/null || missing+=(libopenmpi-dev)
# Files are read back by Gmsh, meshes solved on by MFEM: Python packages (about 160 MB) and what Gmsh draws with.
python3 -c 'import ensurepip' 2>/dev/null || missing+=(python3-venv)
for library in libGLU.so.1:libglu1-mesa libXft.so.2:libxft2 libXcursor.so.1:libxcursor1 libXinerama.so.1:libxinerama1; do
    ldconfig -p | grep -qF "${library%%:*}" || missing+=("${library##*:}")
done
if ! command -v cargo >/dev/null && [ ! -x "$HOME/.cargo/bin/cargo" ]; then
    command -v curl >/dev/null || missing+=(curl ca-certificates)
fi
if [ ${#missing[@]} -gt 0 ]; then
    say "installing with apt: ${missing[*]}"
    as_root apt-get update -qq
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
fi
PATH="$PATH:$HOME/.cargo/bin"
if ! command -v cargo >/dev/null; then
    say "installing Rust (stable) with rustup into ~/.cargo"
    curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y --profile minimal -c rustfmt -c clippy
fi
if command -v rustup >/dev/null && ! { cargo fmt --version && cargo clippy --version; } >/dev/null 2>&1; then
    say "adding rustfmt and clippy"
    rustup component add rustfmt clippy
fi
say "$(rustc --version), $(cc --version | head -n 1)"

step "formatting"
cargo fmt --all --check
step "lints"
cargo clippy --release --all-targets --locked -- -D warnings
step "library without the command line"
cargo clippy --release --lib --no-default-features --locked -- -D warnings
step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --release --no-deps --locked --lib
step "tests"
cargo test --release --locked

step "C and C++"
# One folder for all builds of the tests; cargo goes on where it has built the libraries' dependencies already.
interface="$PWD/target/interface"
cargo_folder="${CARGO_TARGET_DIR:-$PWD/target}"
python="$interface/python/bin/python"
if ! "$python" -c 'import gmsh, numpy, mfem' 2>/dev/null; then
    say "installing gmsh, mfem and numpy for Python into target/interface/python"
    python3 -m venv "$interface/python"
    "$python" -m pip install --quiet --disable-pip-version-check numpy gmsh==4.15.2
    # For its C++ library alone: its Python needs much more.
    "$python" -m pip install --quiet --disable-pip-version-check --no-deps mfem==4.10.0.1
fi
configure() {
    cmake -S cpp_tests -B "$@" -DQUADREL_CARGO_TARGET_DIR="$cargo_folder" -DQUADREL_TEST_PYTHON="$python" >/dev/null
}
configure "$interface/tests"
cmake --build "$interface/tests" --parallel 2
ctest --test-dir "$interface/tests" --output-on-failure --parallel 2
step "C and C++ with the address and undefined-behaviour sanitizers"
configure "$interface/sanitized" -DQUADREL_TEST_SANITIZERS=address,undefined
cmake --build "$interface/sanitized" --parallel 2
ctest --test-dir "$interface/sanitized" --output-on-failure --parallel 2

step "60 seconds of fuzzing through the C interface"
cpp_tests/fuzz/run.sh "$interface/fuzz" "${QUADREL_FUZZ_SECONDS:-60}"

step "the commands of the README"
cargo build --release --locked
binary="$cargo_folder/release/quadrel"
scratch=$(mktemp -d)
(
    cd "$scratch"
    "$binary"
    for file in gingerbread.vtu gingerbread.svg; do
        [ -s "$file" ] || { echo "$file was not written"; exit 1; }
    done
    printf '%s\n' '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0H4V3A2 1 0 0 1 0 3Z"/></svg>' > plate.svg
    "$binary" plate.svg --order 4 --relative 1e-4 -o plate.vtu --stats plate.json --stages stages
    [ -s plate.vtu ] && [ -s stages/stages.svg ] && grep -q '"status": "ok"' plate.json
)
rm -r "$scratch"

step "instructions for the Gingerbread man"
benches/speed/count.sh "$binary"

step "package"
cargo package --locked --allow-dirty --no-verify --quiet
say "ok"

step "all passed in $((SECONDS - started)) s"
