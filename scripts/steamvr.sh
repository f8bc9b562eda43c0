#!/usr/bin/env bash
# Takes the pictures of Midair in SteamVR's and Steam's library, of what a session makes, at the sizes that they show.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/setup.sh
need pngquant
midair=$CARGO_TARGET_DIR/debug/midair
home=$(mktemp -d)
export MIDAIR_HOME=$home/midair
trap 'rm -rf "$home"' EXIT
mkdir -p assets/steamvr
"$midair" play assets/sessions/chair.ron --save "$home/chair.midair"
# header and capsule are named in midair.vrmanifest; hero is the wide one that Steam itself shows over a game's page.
for picture in header=920x430 capsule=600x900 hero=1920x620; do
  file=assets/steamvr/${picture%=*}.png
  "$midair" play scripts/nobody.ron --open "$home/chair.midair" --shot "$file" --size "${picture#*=}"
  pngquant --force --skip-if-larger --quality 75-98 --speed 1 --output "$file" "$file" || true
done
