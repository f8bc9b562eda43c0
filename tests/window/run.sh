#!/usr/bin/env bash
# Drives the real window with mouse and keyboard under a virtual display: from the empty room to files.
# Called by ./test once everything is built; CARGO_TARGET_DIR says where.
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/setup.sh
need xvfb xauth xdotool

midair=$CARGO_TARGET_DIR/debug/midair
home=$(mktemp -d)
export MIDAIR_HOME=$home/midair XDG_RUNTIME_DIR=$home
passed=0 app="" xvfb=""

finish() {
  local status=$?
  [ -z "$app" ] || kill -9 "$app" 2>/dev/null || true
  [ -z "$xvfb" ] || kill "$xvfb" 2>/dev/null || true
  if [ $status -ne 0 ]; then
    echo "--- the window's log:"; cat "$home/log" 2>/dev/null || true
    echo "$passed passed, 1 failed"
  fi
  rm -rf "$home"
}
trap finish EXIT

pass() { passed=$((passed + 1)); echo "ok   $1"; }
fail() { echo "FAIL $1"; exit 1; }

# until_true SECONDS WHAT COMMAND... : polls; a loaded machine draws slowly
until_true() {
  local end=$((SECONDS + $1)) what=$2
  shift 2
  until "$@" >/dev/null 2>&1; do
    [ -z "$app" ] || kill -0 "$app" 2>/dev/null || fail "$what: the window has ended"
    [ $SECONDS -lt $end ] || fail "$what"
    sleep 0.1
  done
  pass "$what"
}

# Without a display: one clear line, status 1.
status=0
env -u DISPLAY -u WAYLAND_DISPLAY "$midair" 2>"$home/none" || status=$?
[ $status -eq 1 ] && [ "$(wc -l <"$home/none")" -eq 1 ] && grep -q "no display" "$home/none" ||
  fail "without a display: $(cat "$home/none")"
pass "a missing display is one line and status 1"

# A free display of its own.
Xvfb -noreset -displayfd 3 -screen 0 1280x720x24 3>"$home/display" >/dev/null 2>&1 &
xvfb=$!
until_true 20 "a virtual display" test -s "$home/display"
DISPLAY=:$(cat "$home/display")
export DISPLAY
unset WAYLAND_DISPLAY

# A card that is lost: the window opens anew with the work, its undo list included; lost once more within a minute it
# is one line and status 1, and the next start offers the work.
mkdir "$home/talk"
"$midair" --rehearse "$home/talk" --lose-card 90 >/dev/null 2>"$home/lost" &
app=$!
until_true 60 "a window that will lose its card" test -s "$home/talk/said.jsonl"
printf '%s\n' 'Panel(id: "library", open: true)' 'Place(component: "solid/cube", side: Right)' >"$home/talk/asks.ron"
until_true 120 "a lost graphics card opens the window anew" grep -q "opens anew" "$home/lost"
stands() { tail -n 1 "$home/talk/said.jsonl" | grep -q '"objects":1.*"undo":1'; }
until_true 60 "the work is there again, and can be undone" stands
! grep -q panicked "$home/lost" && [ "$(grep -c '^midair:' "$home/lost")" -eq 1 ] || fail "a lost card: $(cat "$home/lost")"
kill "$app"; wait "$app" 2>/dev/null || true; app=""
rm -rf "$MIDAIR_HOME"
status=0
timeout 90 "$midair" --lose-card 40 --card-lost "$(date +%s)" >/dev/null 2>"$home/none" || status=$?
[ $status -eq 1 ] && [ "$(grep -c '^midair: the graphics card' "$home/none")" -eq 1 ] &&
  ! grep -q panicked "$home/none" || fail "a card lost again: $status, $(cat "$home/none")"
pass "a card that is lost again is one line and status 1"

# Without anything that draws: one clear line, status 1.
status=0
VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent WGPU_BACKEND=vulkan \
  timeout 60 "$midair" >/dev/null 2>"$home/none" || status=$?
[ $status -eq 1 ] && [ "$(grep -c '^midair: no graphics card' "$home/none")" -eq 1 ] ||
  fail "without a graphics card: $status $(cat "$home/none")"
pass "a missing graphics card is one line and status 1"

"$midair" --record "$home/session.ron" >"$home/log" 2>&1 &
app=$!
until_true 60 "the window opens" xdotool search --name "Untitled - Midair"
window=$(xdotool search --name "Untitled - Midair" | tail -1)
xdotool windowfocus "$window"

titled() { xdotool search --name "$1"; }
beat() { sleep "${1:-1.2}"; }
tap() { xdotool keydown "$1"; beat 0.8; xdotool keyup "$1"; beat 0.8; }
click() { xdotool mousemove "$1" "$2"; beat; xdotool mousedown 1; beat 0.8; xdotool mouseup 1; beat 0.8; }

# A window that has only just opened may not hear the first key or click: they are tried again.
placed() {
  for _ in $(seq 20); do
    titled "Untitled\\* - Midair" && return 0
    sleep 0.2
  done
  return 1
}
place_a_cube() {
  xdotool windowfocus "$window" || true
  tap l
  click 48 335
  placed && return 0
  click 48 335
  placed
}
xdotool mousemove 800 600
until_true 90 "a cube is placed" place_a_cube
echo "     drag it a little, mark it, copy it, undo, redo"
xdotool mousemove 740 300; beat
xdotool mousedown 1; beat
xdotool mousemove 730 300; beat
xdotool mousemove 720 300; beat
xdotool mouseup 1; beat
tap u
tap Return
beat 2
xdotool keydown ctrl; tap z; xdotool keydown shift; tap z; xdotool keyup shift; xdotool keyup ctrl
xdotool mousemove 725 300; beat
tap e
mesh() { compgen -G "$MIDAIR_HOME/work/*.stl" || compgen -G "$MIDAIR_HOME/*/work/*.stl"; }
until_true 40 "a mesh is saved" mesh
stl=$(mesh | head -1)
xdotool keydown ctrl; tap s; xdotool keyup ctrl
document() { compgen -G "$(dirname "$stl")/*.midair"; }
until_true 30 "the document is saved" document
beat
"$midair" check "$stl" "$(document | head -1)" >"$home/check" || fail "midair check: $(cat "$home/check")"
pass "both pass midair check"
"$midair" check --json "$(document | head -1)" | grep -qE '"objects": [2-9]' || fail "a cube and its copy"
pass "a cube and its copy, after an undo and a redo"
kill "$app"; app=""
beat 1
"$midair" play "$home/session.ron" --export "$home/played.stl" 2>>"$home/log" || fail "the recording plays"
pass "the recording plays"
"$midair" export "$(document | head -1)" --to "$home/saved.stl"
cmp "$home/played.stl" "$home/saved.stl" || fail "the recording makes the same mesh, byte for byte"
pass "the recording makes the same mesh, byte for byte"
echo "$passed passed, 0 failed"
