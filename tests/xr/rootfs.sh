#!/usr/bin/env bash
# Builds the root file system that tests/xr runs in: Debian 13 with Monado (an OpenXR runtime), the OpenXR loader, Mesa's
# software Vulkan driver and Xvfb. Once, some minutes, 700 MB; it needs root, debootstrap and a Debian mirror.
#   tests/xr/rootfs.sh FOLDER
set -euo pipefail
root=$1
mirror=$(awk '/^URIs:/ { print $2; exit }' /etc/apt/sources.list.d/debian.sources 2>/dev/null || true)
mirror=${mirror:-http://deb.debian.org/debian}
new=$root.new
log=$root.log
mkdir -p "$(dirname "$root")"
rm -rf "$new"
debootstrap --variant=minbase trixie "$new" "$mirror" >"$log" 2>&1 || { tail -3 "$log" >&2; exit 1; }
cp -L /etc/resolv.conf "$new/etc/resolv.conf"
printf 'APT::Install-Recommends "false";\nAcquire::Languages "none";\nAcquire::Check-Valid-Until "false";\nAcquire::Check-Date "false";\n' \
  >"$new/etc/apt/apt.conf.d/99midair"
# No daemon is started in there.
printf '#!/bin/sh\nexit 101\n' >"$new/usr/sbin/policy-rc.d"
chmod +x "$new/usr/sbin/policy-rc.d"
packages="monado-service libopenxr1-monado monado-cli libopenxr-loader1 libopenxr-utils mesa-vulkan-drivers libvulkan1
  xvfb libasound2t64 libudev1 libxkbcommon0 libxkbcommon-x11-0 libx11-6 libx11-xcb1 libxcursor1 libxi6 libxrandr2 libxcb1"
# A mount namespace of its own: what is mounted goes with it.
unshare --mount --fork bash -c '
  set -e
  mount --make-rprivate /
  mount -t proc proc "$1/proc"
  mount --rbind /dev "$1/dev"
  chroot "$1" /bin/sh -c "apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -y -q $2 && apt-get clean"
' _ "$new" "$(echo $packages)" >>"$log" 2>&1 || { tail -3 "$log" >&2; exit 1; }
rm -rf "$new"/var/lib/apt/lists/* "$new"/usr/share/doc/* "$new"/usr/share/man/* "$new"/usr/share/locale/*
mkdir -p "$new/job" "$new/target" "$new/out"
rm -rf "$root"
mv "$new" "$root"
