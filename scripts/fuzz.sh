#!/usr/bin/env bash
# Fuzzes the scene parser and the readers of stiffness tables and REXS files (clang, libFuzzer, sanitizers).
#   scripts/fuzz.sh [seconds] [scene|table|rexs]    each target for this time; default 60 s
#   scripts/fuzz.sh keep                            copies inputs that reach new code to tests/fuzz/corpus
# A failure ends it with an error; its input is in build/checked/found. Inputs that reach new code are in
# build/checked/corpus.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-60}
read -r -a targets <<<"${2:-scene table rexs}"

command -v clang++ >/dev/null || { echo "fuzz.sh: needs clang (scripts/install_packages.sh --nightly)" >&2; exit 2; }
mkdir -p build
cmake --preset checked >build/checked.log 2>&1 || { cat build/checked.log >&2; exit 1; }
cmake --build build/checked --target fuzz_scene fuzz_table fuzz_rexs
mkdir -p build/checked/found build/checked/corpus/{scene,table,rexs}

# Scenes and earlier inputs of the project.
seeds() {
  [ "$1" = scene ] && echo data/scenes
  echo "tests/fuzz/corpus/$1"
}

for target in "${targets[@]}"; do
  program=build/checked/tests/fuzz/fuzz_$target
  settings=(-max_len=12288 -timeout=30 -rss_limit_mb=4096 -print_funcs=0 "-dict=tests/fuzz/$target.dict" "-artifact_prefix=build/checked/found/$target-")
  read -r -a seeds <<<"$(seeds "$target" | tr '\n' ' ')"
  if [ "$seconds" = keep ]; then
    "$program" "${settings[@]}" -use_counters=0 -set_cover_merge=1 "tests/fuzz/corpus/$target" "build/checked/corpus/$target"
  else
    "$program" "${settings[@]}" "-max_total_time=$seconds" -print_final_stats=1 "build/checked/corpus/$target" "${seeds[@]}" \
      2>&1 | grep -E -v '^#[0-9]+\s+(REDUCE|NEW)'
  fi
done
