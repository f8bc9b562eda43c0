#!/usr/bin/env bash
# Midair's kernels beside their peers, measured in turns in one run.
#
#     benches/peers.sh PEERS [ROUNDS]
#
# PEERS is a folder with fuse.c (the clipped loop in C), rust/ (parry3d) and bench_mvc.py (scipy). VTK and
# scipy are taken from the Python that PYTHON names; without it, or without one of the others, those rows are left out.
#
#   BLENDER   a Python with bpy, Blender as a module                          [PYTHON]
#   PYTHON    with vtk and numpy           [PEER_CACHE/venv/bin/python, else python3]
#   PREFIX    put before what is measured, as 'chrt -r 1' on a busy machine
#   THREADS   for both sides                                   [what nproc says, at most 2]
set -euo pipefail
[ $# -ge 1 ] || { sed -n '2,13s/^# \{0,1\}//p' "$0" >&2; exit 2; }
peers=$(cd "$1" && pwd)
rounds=${2:-3}
here=$(cd "$(dirname "$0")" && pwd)
cache=${PEER_CACHE:-$HOME/.cache/midair-peers}
mkdir -p "$cache"
python=${PYTHON:-$cache/venv/bin/python}
[ -x "$python" ] || python=python3
cores=$(nproc)
threads=${THREADS:-$((cores < 2 ? cores : 2))}

target=${CARGO_TARGET_DIR:-$here/../target}
cargo build --quiet --manifest-path "$here/../Cargo.toml" -p midair-bench --example bench
cc -O3 -march=native -fopenmp -o "$cache/fuse" "$peers/fuse.c" -lm || echo "no C compiler with OpenMP: the loop in C is left out" >&2
if [ ! -x "$cache/target/release/rbench" ]; then
  cargo build --quiet --release --manifest-path "$peers/rust/Cargo.toml" --target-dir "$cache/target" ||
    echo "the peers in Rust cannot be built: parry3d is left out" >&2
fi
if [ -f "$peers/bench_mvc.py" ] && "$python" -c 'import scipy' 2>/dev/null; then
  cargo build --quiet --manifest-path "$here/../Cargo.toml" -p midair-beautify --example mvc
  ${PREFIX:-} "$python" "$here/mvc.py" --ours "$target/debug/examples/mvc" --peer "$peers/bench_mvc.py"
else
  echo "no scipy: fair curves are left out" >&2
fi
exec "$python" "$here/peers.py" --ours "$target/debug/examples/bench" --loop "$cache/fuse" \
  --parry "$cache/target/release/rbench" --blender-python "${BLENDER:-$python}" --rounds "$rounds" --threads "$threads" --prefix "${PREFIX:-}"
