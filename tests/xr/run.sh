#!/usr/bin/env bash
# Runs the built app in a headset that is not there: Monado, a real OpenXR runtime, with controllers told over its wire.
# Called by ./test once everything is built; CARGO_TARGET_DIR says where. Arguments name scenarios.
# The root file system is built once, in the cache. Where it cannot be, this says why and skips, or fails with
# MIDAIR_XR=required.
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/setup.sh
root=${MIDAIR_XR_ROOTFS:-${XDG_CACHE_HOME:-$HOME/.cache}/midair/xr-rootfs}
limit=${MIDAIR_XR_SECONDS:-2400}

skip() {
  echo "skipped: $1"
  [ "${MIDAIR_XR:-}" != required ] || { echo "FAIL the headset's scenarios are required here"; exit 1; }
  exit 0
}

command -v unshare >/dev/null || skip "util-linux (unshare) is missing"
if [ ! -e "$root/usr/bin/monado-service" ]; then
  [ "$(id -u)" -eq 0 ] || skip "the runtime's root file system is not at $root, and only root can build it (sudo tests/xr/rootfs.sh $root)"
  need debootstrap iproute2 || skip "debootstrap could not be installed"
  echo "     building the runtime's root file system at $root: some minutes, once"
  tests/xr/rootfs.sh "$root" || skip "the runtime's root file system could not be built (is there a Debian mirror?)"
fi
need iproute2 || skip "iproute2 could not be installed"
for folder in job target out; do
  [ -d "$root/$folder" ] || mkdir -p "$root/$folder" || skip "$root/$folder is missing"
done

out=$CARGO_TARGET_DIR/xr
mkdir -p "$out/shaders"
if [ "$(id -u)" -eq 0 ]; then own=(); else own=(--user --map-root-user); fi
unshare "${own[@]}" --mount true 2>/dev/null || skip "this machine allows no namespaces of its own"
export root out job=$PWD
# Network, processes and mounts of its own: the driver's port is reachable from nowhere else, and nothing outlives it.
exec timeout -k 5 "$limit" unshare "${own[@]}" --mount --pid --net --ipc --fork --kill-child bash -c '
  set -eu
  mount --make-rprivate /
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
  mount -t tmpfs -o mode=1777 tmpfs "$root/tmp"
  mount -t tmpfs tmpfs "$root/run"
  mount --bind "$job" "$root/job"
  mount --bind "$CARGO_TARGET_DIR" "$root/target"
  mount --bind "$out" "$root/out"
  ip link set lo up
  mkdir -p -m 700 "$root/run/xr" "$root/tmp/home"
  exec chroot "$root" /usr/bin/env -i PATH=/usr/local/bin:/usr/bin:/bin HOME=/tmp/home LANG=C.UTF-8 \
    XDG_RUNTIME_DIR=/run/xr XDG_CONFIG_HOME=/tmp/cfg VK_DRIVER_FILES=/usr/share/vulkan/icd.d/lvp_icd.json \
    XR_RUNTIME_JSON=/usr/share/openxr/1/openxr_monado.json MESA_SHADER_CACHE_DIR=/out/shaders \
    ${MIDAIR_TIME_SYSTEMS:+MIDAIR_TIME_SYSTEMS=1} \
    /target/debug/examples/xr "$@"
' xr "$@"
