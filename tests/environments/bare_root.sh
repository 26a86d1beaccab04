#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# `navvy` in a bare root: bare_root.sh NAVVY DATA [CASE]. NAVVY is the program, DATA the folder with
# scenarios/, vehicles/ and terrain/. The root contains this machine's libraries, bound read-only,
# and only the writable folders that a case adds. Each case gives the expected exit status and texts
# (docs/reference/results.md, "Faults and exit status").
#
# Requires root and permission to mount, and ends with status 77 (a skipped test) without it. It
# mounts in a separate mount namespace, so nothing remains after any kind of end.
set -euo pipefail

skip() {
  echo "SKIPPED: $*"
  exit 77
}

if [[ ${IN_NAMESPACE:-} != 1 ]]; then
  [[ $(id -u) == 0 ]] || skip "needs root, to run as 'nobody' in a separate root"
  for tool in unshare setpriv; do command -v "$tool" >/dev/null || skip "there is no $tool"; done
  unshare --mount true 2>/dev/null || skip "this machine does not let root mount (a container without CAP_SYS_ADMIN?)"
  # Its mounts end with it and are invisible to other processes.
  exec env IN_NAMESPACE=1 unshare --mount --propagation private -- "${BASH_SOURCE[0]}" "$@"
fi

navvy=$(realpath "$1")
data=$(realpath "$2")
only=${3:-}
root=$(mktemp -d)
mount -t tmpfs -o mode=755 tmpfs "$root"
trap 'umount -l "$root" 2>/dev/null && rmdir "$root"' EXIT

# Libraries and driver description of this machine; /proc and processors as the driver expects them.
bind() { # SOURCE [TARGET]
  local target=$root${2:-$1}
  [[ -e $1 ]] || return 0
  if [[ -d $1 ]]; then mkdir -p "$target"; else mkdir -p "$(dirname "$target")" && touch "$target"; fi
  mount --bind "$1" "$target"
  mount -o remount,bind,ro "$target"
}
for one in usr etc/OpenCL etc/ld.so.cache etc/alternatives; do bind "/$one"; done
for one in bin lib lib64; do
  if [[ -L /$one ]]; then ln -s "$(readlink "/$one")" "$root/$one"; else bind "/$one"; fi
done
bind "$navvy" /navvy/navvy
for one in scenarios vehicles terrain; do bind "$data/$one" "/navvy/$one"; done
mkdir -p "$root"/{proc,sys,dev,etc}
mount -t proc -o ro proc "$root/proc"
bind /sys
for one in null zero urandom; do
  touch "$root/dev/$one"
  mount --bind "/dev/$one" "$root/dev/$one"
done
echo 'nobody:x:65534:65534:nobody:/nonexistent:/usr/sbin/nologin' >"$root/etc/passwd"
# Locales of this root besides C: German, with commas in its numbers.
locales=
if command -v localedef >/dev/null && mkdir -p "$root/locales" &&
  localedef --no-archive -i de_DE -f UTF-8 "$root/locales/de_DE.UTF-8" >/dev/null 2>&1; then
  locales=/locales
fi
# Folders that cases write to are mounted over these.
mkdir -p "$root"/{out,cache,other,tmp,home}
mount -o remount,ro "$root"

failures=0 cases=0
say=$(mktemp)
trap 'umount -l "$root" 2>/dev/null && rmdir "$root"; rm -f "$say"' EXIT

# Mounts a folder of the given size that user nobody may write to, in place of the last one.
mount_folder() { # FOLDER [SIZE]
  umount -l "$root$1" 2>/dev/null || true
  mount -t tmpfs -o "mode=700,uid=65534,gid=65534,size=${2:-256m}" tmpfs "$root$1"
}
remove_folders() {
  local one
  for one in "$@"; do umount -l "$root$one" 2>/dev/null || true; done
}

# Runs navvy as nobody with only these variables.
as_nobody() { # [NAME=VALUE...] -- ARGUMENTS
  local variables=(NAVVY_DATA_DIR=/navvy)
  while [[ $1 != -- ]]; do
    variables+=("$1")
    shift
  done
  shift
  chroot --userspec=65534:65534 --groups= "$root" /usr/bin/env -i PATH=/usr/bin "${variables[@]}" /navvy/navvy "$@"
}

SMALL=(run bucket_path --no-render --duration 0.02 --device cpu)
hash_of() { sed -n 's/.*"state_hash": *"\([^"]*\)".*/\1/p' "$root$1/summary.json" 2>/dev/null; }

fail() {
  echo "  FAILED: $*"
  sed 's/^/    /' "$say"
  failures=$((failures + 1))
}
# Expected result of the last case: status, then texts in its output ("!" before a text: absent).
expect() { # STATUS GOT [WORDS...]
  local wanted=$1 got=$2 words
  shift 2
  [[ $got == "$wanted" ]] || fail "ended with $got, not $wanted"
  for words in "$@"; do
    if [[ $words == !* ]]; then
      if grep -qF -- "${words#!}" "$say"; then fail "its output has '${words#!}'"; fi
    else
      grep -qF -- "$words" "$say" || fail "its output lacks '$words'"
    fi
  done
}
run_case() { # STATUS [WORDS...] ++ [NAME=VALUE...] -- ARGUMENTS
  local status=$1 words=() got=0
  shift
  while [[ $1 != ++ ]]; do
    words+=("$1")
    shift
  done
  shift
  as_nobody "$@" >"$say" 2>&1 || got=$?
  expect "$status" "$got" "${words[@]}"
}
begin() {
  [[ -z $only || $1 == *"$only"* ]] || return 1
  cases=$((cases + 1))
  # Every case begins without writable folders.
  remove_folders /out /cache /other /tmp
  printf '%s\n' "$1"
}
no_kernels_left() { # FOLDER
  ! compgen -G "$root$1/navvy-kernels-*" >/dev/null || fail "a temporary kernel folder is left in $1"
}

# Reference for all other cases.
mount_folder /out && mount_folder /cache
as_nobody POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run >"$say" 2>&1 || { cat "$say"; echo "no sound run in the root"; exit 1; }
sound=$(hash_of /out/run)
same() { [[ -n $sound && $(hash_of /out/run) == "$sound" ]] || fail "the state is another one: $(hash_of /out/run), not $sound"; }

if begin "user nobody, read-only root, no HOME, no /tmp: no folder for kernels, no device"; then
  mount_folder /out
  run_case 3 "no folder can be written for compiled kernels" "neither POCL_CACHE_DIR, XDG_CACHE_HOME nor HOME is set" \
    "set POCL_CACHE_DIR to a folder that can be written" ++ -- "${SMALL[@]}" --out /out/run
fi
if begin "the same with a folder for kernels: a run like any other"; then
  mount_folder /out && mount_folder /cache
  run_case 0 "!warning" ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
  same
fi
if begin "pictures there"; then
  mount_folder /out && mount_folder /cache
  run_case 0 "!warning" ++ POCL_CACHE_DIR=/cache -- run bucket_path --duration 0.02 --device cpu --pictures png \
    --out /out/run
  [[ -s $root/out/run/frames/side_00000.png ]] || fail "no picture"
fi
if begin "what needs no device there: check, scenes, soils"; then
  run_case 0 "0 errors" ++ -- check trench
  run_case 0 "trench" ++ -- scenes
  run_case 0 "cohesion_pa" ++ -- soils loam
fi
if begin "no folder for results: reported before a device is opened"; then
  mount_folder /cache
  run_case 4 "/out/run" "Read-only file system" ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
  # The default, below the working directory.
  run_case 4 "out/bucket_path" "Read-only file system" ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}"
fi
if begin "no HOME, but /tmp: a temporary folder for kernels, removed afterwards"; then
  mount_folder /out && mount_folder /tmp
  run_case 0 "neither POCL_CACHE_DIR, XDG_CACHE_HOME nor HOME is set" \
    "compiled again for this run, in /tmp/navvy-kernels-" ++ -- "${SMALL[@]}" --out /out/run
  same
  no_kernels_left /tmp
fi
if begin "a HOME that cannot be written, and TMPDIR"; then
  mount_folder /out && mount_folder /other
  run_case 0 "kernel cache '/home/.cache/navvy/kernels': the folder cannot be created: Read-only file system" \
    "compiled again for this run, in /other/navvy-kernels-" ++ HOME=/home TMPDIR=/other -- "${SMALL[@]}" --out /out/run
  same
  no_kernels_left /other
fi
if begin "a poisoned cache: every compiled file cut short, another one flipped, a list of nonsense"; then
  mount_folder /out && mount_folder /cache
  run_case 0 ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
  count=0
  while read -r file; do
    # Every other file keeps its length.
    if ((count++ % 2)); then truncate -s 100 "$file"; else printf 'poison' | dd of="$file" conv=notrunc status=none; fi
  done < <(find "$root/cache" -type f -name '*.so' -o -type f -name '*.bc')
  ((count > 3)) || fail "only $count files to poison"
  run_case 0 "were damaged or left over from a killed run: they are compiled again" ++ POCL_CACHE_DIR=/cache -- \
    "${SMALL[@]}" --out /out/run
  same
  echo nonsense >"$root/cache/navvy/kernels/navvy.manifest"
  run_case 0 "!crash" ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
  same
  # Repaired permanently.
  run_case 0 "!damaged" ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
fi
if begin "a cache of another user"; then
  mount_folder /out && mount_folder /tmp && mount_folder /cache
  chown -R 0:0 "$root/cache" && chmod -R go-w "$root/cache"
  run_case 0 "kernel cache '/cache/navvy/kernels': the folder cannot be created: Permission denied" "/tmp/navvy-kernels-" ++ \
    POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
  same
  no_kernels_left /tmp
fi
if begin "a full cache"; then
  mount_folder /out && mount_folder /tmp && mount_folder /cache 4m
  run_case 0 "kernel cache '/cache/navvy/kernels': its disk is full (less than 16 MiB left)" "/tmp/navvy-kernels-" ++ \
    POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
  same
  no_kernels_left /tmp
  # No other folder: the driver uses the space left, and the user is warned; without any space it
  # fails.
  remove_folders /tmp
  run_case 0 "warning: no folder can be written for compiled kernels" "its disk is full" ++ POCL_CACHE_DIR=/cache -- \
    "${SMALL[@]}" --out /out/run
  same
  mount_folder /cache 32k
  run_case 3 "warning: no folder can be written for compiled kernels" ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
fi
if begin "a full disk for results"; then
  mount_folder /out 64k && mount_folder /cache
  run_case 4 "No space left on device" ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
fi
if begin "locale de_DE: numbers keep their points"; then
  if [[ -z $locales ]]; then
    echo "  left out: this machine cannot make the locale (localedef, package locales)"
  else
    mount_folder /out && mount_folder /cache
    german=(LC_ALL=de_DE.UTF-8 LANG=de_DE.UTF-8 "LOCPATH=$locales" POCL_CACHE_DIR=/cache)
    # Checks that the locale exists: a program that requests it writes commas.
    [[ $(chroot "$root" /usr/bin/env -i "${german[@]}" /usr/bin/printf '%.1f' 0,5) == 0,5 ]] || fail "no German here"
    run_case 0 "!warning" ++ "${german[@]}" -- "${SMALL[@]}" --set soil.cohesion_pa=6000.5 --out /out/run
    german_hash=$(hash_of /out/run)
    grep -q '"simulated_time_s": 0\.0' "$root/out/run/summary.json" || fail "no point in summary.json"
    columns=$(head -1 "$root/out/run/telemetry.csv" | tr ',' '\n' | wc -l)
    awk -F, -v n="$columns" 'NF != n { exit 1 }' "$root/out/run/telemetry.csv" || fail "another number of columns in a row"
    run_case 0 ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --set soil.cohesion_pa=6000.5 --out /out/run
    [[ -n $german_hash && $german_hash == "$(hash_of /out/run)" ]] || fail "German and English come to different states"
  fi
fi
if begin "two cold starts at once in one cache"; then
  mount_folder /out && mount_folder /cache
  as_nobody POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/other >"$say.other" 2>&1 &
  other=$! got=0
  run_case 0 "!crash" ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
  same
  wait "$other" || got=$?
  mv "$say.other" "$say"
  expect 0 "$got" "!crash"
  [[ $(hash_of /out/other) == "$sound" ]] || fail "the other one came to another state"
  # The remaining files are intact.
  run_case 0 "!damaged" ++ POCL_CACHE_DIR=/cache -- "${SMALL[@]}" --out /out/run
  same
fi
echo "$cases cases, $failures failures"
[[ $failures == 0 ]]
