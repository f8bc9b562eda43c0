#!/usr/bin/env bash
# Takes the pictures of docs/pictures: what sessions make, and the window with its panels, under a virtual display.
# `scripts/pictures.sh 2560x1440 FOLDER` takes them in another size and puts them elsewhere.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/setup.sh
need xvfb xauth
size=${1:-1280x720} to=${2:-docs/pictures}
scale=1
[ "${size%x*}" -lt 2000 ] || scale=2
midair=$CARGO_TARGET_DIR/debug/midair
home=$(mktemp -d)
export MIDAIR_HOME=$home/midair XDG_RUNTIME_DIR=$home
xvfb=""
trap '[ -z "$xvfb" ] || kill "$xvfb" 2>/dev/null; rm -rf "$home"' EXIT
mkdir -p "$to"

if [ "$to" = docs/pictures ]; then
  for name in chair cup; do
    "$midair" play "assets/sessions/$name.ron" --shot "$to/$name.png"
  done
fi
# Nothing is fused in it: many things to list, to select and to mark.
"$midair" play scripts/pictures.ron --save "$home/still.midair"

Xvfb -displayfd 3 -screen 0 "${size}x24" 3>"$home/display" >/dev/null 2>&1 &
xvfb=$!
until [ -s "$home/display" ]; do sleep 0.1; done
DISPLAY=:$(cat "$home/display")
export DISPLAY
unset WAYLAND_DISPLAY

# window NAME ROOM FILE ASK... : one picture of the window after what is asked for
window() {
  local name=$1 room=$2 file=$3
  shift 3
  {
    echo '(format: 1, steps: ['
    echo "Ask(Set(key: \"look.room\", value: \"\\\"$room\\\"\")),"
    echo "Ask(Set(key: \"look.interface_scale\", value: \"$scale\")),"
    printf 'Ask(%s),\n' "$@"
    echo '])'
  } >"$home/$name.ron"
  rm -rf "$MIDAIR_HOME"
  "$midair" ${file:+"$file"} --shot "$to/$name.png" --size "$size" --play "$home/$name.ron"
}
open() { printf 'Panel(id: "%s", open: true)' "$1"; }
select='Objects(Select(ids: [1, 3]))'
still=$home/still.midair

window empty Dusk "" "$(open library)"
window assemble Dusk "$still" "$(open library)" "$(open properties)" "$select"
window assemble-day Day "$still" "$(open library)" "$(open outline)" "$select"
window assemble-paper Paper "$still" "$(open properties)" "$select"
window export Dusk "$still" "$(open export)"
window controls Day "$still" "$(open controls)"
