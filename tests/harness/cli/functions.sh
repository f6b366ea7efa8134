# Sourced first by the tests of the finished program, each in a folder of its own in the current one.
scratch=$(basename "$0").scratch
rm -rf -- "$scratch" && mkdir "$scratch" && cd "$scratch" || exit
set -u
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

finish() {
  ((failures == 0)) && echo "all well"
  exit $((failures > 0))
}

bench() { "$BENCH_BINARY" "$@"; }

# exits CODE PART ARGUMENTS...: that exit code, and PART in what is printed.
exits() {
  local wanted=$1 part=$2 code
  shift 2
  bench "$@" >stdout.txt 2>stderr.txt </dev/null
  code=$?
  [[ $code == "$wanted" ]] && cat stdout.txt stderr.txt | grep -qF -- "$part" ||
    fail "$* -> exit $code: $(cat stdout.txt stderr.txt)"
}

# refused PART ARGUMENTS...: exit 2, one line on stderr that contains PART, nothing on stdout, no file out.* made.
refused() {
  rm -f out.*
  exits 2 "$@"
  [[ $(wc -l <stderr.txt) == 1 && ! -s stdout.txt && -z $(compgen -G 'out.*') ]] || fail "${*:2}: $(cat stdout.txt stderr.txt)"
}

# holds PYTHON: a condition on the documents that `read` gives.
holds() {
  /usr/bin/python3 -c "import json
def read(name): return json.load(open(name))
$1" || fail "$1"
}
