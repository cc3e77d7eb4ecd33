# SPDX-License-Identifier: Apache-2.0
# scripts/common.sh: what the scripts here share. It is sourced by them, not run.
# shellcheck shell=bash
set -euo pipefail

# Decimal points, sort order and the tools' closing lines read the same on every machine.
export LC_ALL=C.UTF-8

cd "$(dirname "${BASH_SOURCE[0]}")/.."

# fail MESSAGE...: one line for each argument on stderr, then exit code 1.
fail() {
  printf '%s\n' "$@" >&2
  exit 1
}

# help_if_asked ARGUMENTS...: with -h or --help among them, prints the comment at the head of the
# running script, below its licence, and ends it. Arguments behind -- belong to another program.
help_if_asked() {
  local argument
  for argument in "$@"; do
    case "$argument" in
      -h | --help)
        awk 'NR > 2 { if (!/^#/) exit; sub(/^# ?/, ""); print }' "scripts/${0##*/}"
        exit 0
        ;;
      --) return 0 ;;
    esac
  done
}

# install_packages PRESET: what a build with that preset needs.
install_packages() {
  if [[ $1 == clang || $1 == fuzz ]]; then
    scripts/setup --dev
  elif [[ $1 == minimal ]]; then
    scripts/setup --minimal
  else
    scripts/setup
  fi
}

# debian_mirror: DEBIAN_MIRROR, else the first mirror of Debian itself (not of its security updates)
# that apt here reads; nothing where there is none.
debian_mirror() {
  if [[ ${DEBIAN_MIRROR:-} ]]; then
    echo "$DEBIAN_MIRROR"
  else
    # shellcheck disable=SC2016  # the names are apt's
    apt-get indextargets --format '$(REPO_URI) $(LABEL)' 'Created-By: Packages' 2>/dev/null |
      awk '$2 == "Debian" { print $1; exit }' || true
  fi
}

# compile_jobs: all cores, but no more compilers at once than memory holds. The largest files
# (SIMD kernels for every target, tests with JSON tables) take a compiler to 1.3 GiB.
compile_jobs() {
  local kib_per_job=$((3 << 19)) cores jobs
  cores=$(nproc)
  jobs=$cores
  if [[ -r /proc/meminfo ]]; then
    jobs=$(awk -v k="$kib_per_job" '/^MemAvailable:/ { print int($2 / k) }' /proc/meminfo)
  fi
  ((jobs >= 1)) || jobs=1
  echo $((jobs < cores ? jobs : cores))
}
