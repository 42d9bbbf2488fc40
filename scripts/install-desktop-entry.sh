#!/bin/sh
# Puts impactlab into the menu of the desktop, for this user only: entry and icon go below
# ~/.local/share. The program itself must be on the PATH: `cargo install --path .`
set -eu
source=$(cd "$(dirname "$0")/../assets/desktop" && pwd)
share=${XDG_DATA_HOME:-$HOME/.local/share}

install -D -m 644 "$source/impactlab.desktop" "$share/applications/impactlab.desktop"
install -D -m 644 "$source/impactlab.svg" "$share/icons/hicolor/scalable/apps/impactlab.svg"
install -D -m 644 "$source/impactlab.png" "$share/icons/hicolor/256x256/apps/impactlab.png"
if ! command -v impactlab >/dev/null; then
    echo "impactlab is not on the PATH yet; run: cargo install --path ." >&2
fi
