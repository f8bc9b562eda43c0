# Sourced by ./run and ./test: brings in what a fresh Debian or Ubuntu machine with Rust lacks.
# Packages are asked for only when something is missing, so a second start costs nothing.

# One target folder for every checkout: the engine is built once.
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/midair/target}"

# need PACKAGE... : install those that are not there
need() {
  local missing=() package
  command -v dpkg-query >/dev/null || { echo "midair: this is not Debian or Ubuntu; please install: $*" >&2; return 0; }
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "midair: installing ${missing[*]}"
  local as_root=""
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "midair: please install as root: apt-get install ${missing[*]}" >&2; return 1; }
    as_root=sudo
  fi
  # A stale package list is the usual reason for a first failure.
  DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -q --no-install-recommends "${missing[@]}" >/dev/null 2>&1 ||
    { $as_root apt-get update -q >/dev/null && DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -q --no-install-recommends "${missing[@]}" >/dev/null; }
}

if ! command -v cargo >/dev/null; then
  echo "midair: Rust is missing. Install it from https://rustup.rs (1.95 or newer) and run this again." >&2
  exit 1
fi

# To build: a C linker, mold, and libudev (gamepads). To run: a Vulkan driver and what winit loads.
need build-essential pkg-config libudev-dev mold \
  mesa-vulkan-drivers libvulkan1 libxkbcommon-x11-0 libx11-6 libx11-xcb1 libxcursor1 libxi6 libxrandr2
