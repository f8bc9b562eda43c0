#!/usr/bin/env bash
# Takes pictures: what sessions make, and the window with its panels, under a virtual display.
#   scripts/pictures.sh                          those of docs/pictures
#   scripts/pictures.sh 2560x1440 FOLDER [NAME]  the window in that size, in the dark and in the light room; all, or NAME
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/setup.sh
need xvfb xauth xdotool pngquant
size=${1:-1280x720} to=${2:-docs/pictures} only=${3:-}
scale=1
[ "${size%x*}" -lt 2000 ] || scale=1.6
midair=$CARGO_TARGET_DIR/debug/midair
home=$(mktemp -d)
export MIDAIR_HOME=$home/midair XDG_RUNTIME_DIR=$home
xvfb=""
trap '[ -z "$xvfb" ] || kill "$xvfb" 2>/dev/null; rm -rf "$home"' EXIT
mkdir -p "$to"

# Fewer colours, a third of the size: nobody sees the difference in a page.
smaller() { pngquant --force --skip-if-larger --quality 75-98 --speed 1 --output "$1" "$1" || true; }

# Nothing is fused in it: many things to list, to select and to mark.
"$midair" play scripts/pictures.ron --save "$home/still.midair"
made() {
  [ -e "$home/$2.midair" ] || "$midair" play "assets/sessions/$1.ron" --save "$home/$2.midair"
}

Xvfb -noreset -displayfd 3 -screen 0 "${size}x24" 3>"$home/display" >/dev/null 2>&1 &
xvfb=$!
until [ -s "$home/display" ]; do sleep 0.1; done
DISPLAY=:$(cat "$home/display")
export DISPLAY
unset WAYLAND_DISPLAY
# Where it points at nothing.
xdotool mousemove $((${size%x*} - 8)) 8

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
  smaller "$to/$name.png"
}
open() { printf 'Panel(id: "%s", open: true)' "$1"; }
shut() { printf 'Panel(id: "%s", open: false)' "$1"; }
lesson() { printf 'Set(key: "help.tutorial", value: "{\\"state\\": \\"Going\\", \\"step\\": %s}")' "$1"; }
mode() { printf 'Mode("%s")' "$1"; }
select='Objects(Select(ids: [1, 3]))'
one='Objects(Select(ids: [1]))'
still=$home/still.midair

# picture NAME ROOM : what can be seen of the app, one by one
picture() {
  case $1 in
    export | settings) made chair chair ;;
    brush) made sagittarius sagittarius ;;
    scaffold) made figure-5 scaffold ;;
    sweep) made twisted-tube sweep ;;
  esac
  case $1 in
    empty) window "$1-$2" "$2" "" "$(open tutorial)" ;;
    library) window "$1-$2" "$2" "" "$(open library)" "$(shut tutorial)" ;;
    operands) window "$1-$2" "$2" "$still" "$(shut tutorial)" "$(open library)" "$(open operands)" ;;
    outline) window "$1-$2" "$2" "$still" "$(shut tutorial)" "$(open outline)" "$(open properties)" "$select" ;;
    export) window "$1-$2" "$2" "$home/chair.midair" "$(shut tutorial)" "$(open export)" ;;
    tutorial) window "$1-$2" "$2" "" "$(open library)" "$(open tutorial)" "$(lesson 1)" ;;
    settings) window "$1-$2" "$2" "$home/chair.midair" "$(shut tutorial)" "$(open settings)" ;;
    brush) window "$1-$2" "$2" "$home/sagittarius.midair" "$(shut tutorial)" "$(mode brush)" "$one" ;;
    scaffold) window "$1-$2" "$2" "$home/scaffold.midair" "$(shut tutorial)" "$(mode scaffold)" "$(open scaffold)" "$one" ;;
    sweep) window "$1-$2" "$2" "$home/sweep.midair" "$(shut tutorial)" "$(mode sweep)" "$(open sweep)" "$one" ;;
    *) echo "there is no picture called $1" >&2; exit 2 ;;
  esac
}

if [ "$to" = docs/pictures ]; then
  for name in chair cup; do
    made "$name" "$name"
    "$midair" play scripts/nobody.ron --open "$home/$name.midair" --shot "$to/$name.png"
    smaller "$to/$name.png"
  done
  for of in empty-Dusk library-Day operands-Day outline-Dusk export-Day tutorial-Dusk settings-Day brush-Dusk; do
    picture "${of%-*}" "${of#*-}"
  done
else
  for name in ${only:-empty library operands outline export tutorial settings brush scaffold sweep}; do
    for room in ${ROOMS:-Dusk Day}; do picture "$name" "$room"; done
  done
fi
