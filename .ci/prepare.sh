# Sourced by demo.sh, test.sh and .ci/run: Debian packages, configure, build.

say() { printf '\n\033[1m%s\033[0m\n' "$*"; }

# Names in a list file, without comments.
listed() { sed 's/#.*//' "$1" | xargs; }

# Installs what is missing of a list; as root, else through sudo, else says what to type.
install_packages() {
  local list=$1 missing=() package
  if ! command -v dpkg-query >/dev/null; then
    echo "This is no Debian system; install the equivalents of $list yourself." >&2
    return 0
  fi
  for package in $(listed "$list"); do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -q '^installed$' ||
      missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null || ! sudo -v; then
      echo "Packages are missing. As root, run:" >&2
      echo "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  say "Installing ${#missing[@]} Debian packages"
  "${as_root[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends \
    "${missing[@]}" >/dev/null
}

# configure_and_build PRESET [cmake --build arguments]
configure_and_build() {
  local preset=$1
  shift
  say "Building ($preset)"
  cmake --preset "$preset" >/dev/null
  cmake --build "build/$preset" "$@"
}
