# A build tells how far it is while it runs; one that fails shows what the compiler printed.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
program=test
source "$root/cmake/bootstrap.sh"
quit() { echo "FAILED: $*"; exit 1; }
progress_every=0

# In ninja's place: two steps, the second of which can fail. Its first line is out long before it ends.
ninja() {
  case "$*" in
    *-n*) printf '[%s] Building CXX object %s.o\n' 1/2 a 2/2 b ;;
    *build.ninja) ;;
    *)
      echo '[1/2] Building CXX object a.o'
      for ((i = 0; i < 100; ++i)); do
        ! grep -q '1 of 2' told || break
        sleep 0.1
      done
      ((i < 100)) || return 0
      [[ $2 != broken ]] || { printf '%s\n' 'FAILED: b.o' 'b.cpp:7:3: error: no b'; return 1; }
      echo '[2/2] Building CXX object b.o'
      ;;
  esac
}
mkdir -p whole broken
touch whole/build.ninja broken/build.ninja

compile whole all 2>told || quit "a build that succeeds: $(cat told)"
grep -q '2 files to compile' told && grep -q '1 of 2 steps' told && grep -q '2 of 2 steps' told || quit "no progress: $(cat told)"
! grep -q 'Building' told || quit "what the compiler printed: $(cat told)"

compile broken all 2>told && quit "a build that fails succeeds"
grep -q 'b.cpp:7:3: error: no b' told && grep -q 'FAILED: b.o' told || quit "the error is lost: $(cat told)"
echo ok
