# What the two commands of the README need from the system, and how it gets there.
# Sourced by `run`, `test` and `.ci/run`. All messages go to stderr, so that `./run … --json` stays JSON.
# shellcheck shell=sh

say() {
    echo "impactlab: $*" >&2
}

# rustup adds cargo to the PATH of the next login only.
need_cargo() {
    if ! command -v cargo >/dev/null && [ -x "${HOME:-}/.cargo/bin/cargo" ]; then
        PATH="$HOME/.cargo/bin:$PATH"
        export PATH
    fi
    if ! command -v cargo >/dev/null; then
        say "cargo is not there; install the Rust toolchain from https://rustup.rs first"
        exit 1
    fi
}

# install WHY PACKAGE…: installs Debian or Ubuntu packages; elsewhere names them and goes on.
install() {
    why=$1
    shift
    if ! command -v apt-get >/dev/null; then
        say "$why may need what Debian calls $*"
        return 0
    fi
    if [ "$(id -u)" -eq 0 ]; then
        as_root=
    elif command -v sudo >/dev/null; then
        as_root=sudo
    else
        say "$why needs packages; as root, run: apt-get update && apt-get install --no-install-recommends -y $*"
        exit 1
    fi
    say "installing for $why: $*"
    # Old or no package lists are what a fresh machine has. If they cannot be renewed, the old may do.
    $as_root apt-get -qq update >&2 || say "the package lists could not be renewed"
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=120 \
        install --no-install-recommends -y "$@" </dev/null >/dev/null || {
        say "that failed; as root, run: apt-get update && apt-get install --no-install-recommends -y $*"
        exit 1
    }
}

# A C compiler is what rustc links with; the encoder of films is C++.
need_linker() {
    if [ "$(uname -s)" != Linux ]; then
        return 0
    fi
    if ! echo 'int main(void) { return 0; }' | cc -x c -o /dev/null - 2>/dev/null; then
        install "linking Rust programs" gcc libc6-dev
    fi
    if ! echo '#include <string>
int main() { return std::string().size(); }' | c++ -x c++ -o /dev/null - 2>/dev/null; then
        install "compiling the encoder of films" g++
    fi
}

# With nasm, films are encoded five times as fast (BENCHMARKS.md). It counts for a first build alone, and
# nothing fails without it.
want_assembler() {
    if [ "$(uname -sm)" != "Linux x86_64" ] || command -v nasm >/dev/null; then
        return 0
    fi
    (install "encoding films fast" nasm) || say "films will be encoded more slowly"
}

has_display() {
    [ -n "${DISPLAY:-}" ] || [ -n "${WAYLAND_DISPLAY:-}" ]
}

# has_file PATTERN…: whether one of the expanded patterns is a file.
has_file() {
    for path in "$@"; do
        [ -e "$path" ] && return 0
    done
    return 1
}

# What a window loads at run time: a graphics driver, and the libraries of the display server.
need_window() {
    if [ "$(uname -s)" != Linux ] || ! has_display; then
        return 0
    fi
    libraries=$(PATH="$PATH:/usr/sbin:/sbin" ldconfig -p 2>/dev/null) || libraries=
    packages=
    wants() {
        case $libraries in
            *"$1 "*) ;;
            *) packages="$packages $2" ;;
        esac
    }
    # Vulkan, or else OpenGL: a loader and a driver that has registered with it.
    has_vulkan() {
        case $libraries in *"libvulkan.so.1 "*) ;; *) return 1 ;; esac
        has_file /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json
    }
    has_opengl() {
        case $libraries in *"libEGL.so.1 "*) ;; *) return 1 ;; esac
        has_file /usr/share/glvnd/egl_vendor.d/*.json /etc/glvnd/egl_vendor.d/*.json
    }
    if ! has_vulkan && ! has_opengl; then
        # OpenGL draws the window faster than Vulkan where both are software.
        packages="mesa-vulkan-drivers libvulkan1 libegl1 libgl1-mesa-dri"
    fi
    wants libxkbcommon.so.0 libxkbcommon0
    if [ -n "${WAYLAND_DISPLAY:-}" ]; then
        wants libwayland-client.so.0 libwayland-client0
    else
        wants libX11.so.6 libx11-6
        wants libX11-xcb.so.1 libx11-xcb1
        wants libXcursor.so.1 libxcursor1
        wants libXi.so.6 libxi6
        wants libxkbcommon-x11.so.0 libxkbcommon-x11-0
    fi
    if [ -n "$packages" ]; then
        # shellcheck disable=SC2086 # a list of words
        install "a window" $packages
    fi
}
